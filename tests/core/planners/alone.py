"""What a planner decides for many beliefs, one after the other: what `decide_many` is held against."""

from __future__ import annotations

import numpy as np
from numpy.random import default_rng

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Planner, code_of
from fetch_pomdp.core.problem import Problem


def decided_alone(
    planner: Planner, problem: Problem, beliefs: Vector, asked: Integers, *, seed: int, phases: Integers | None = None
) -> list[int]:
    """Return the code of the action for each belief (k, n_items), item asked about (k,) or -1, and phase (k,) or 0."""
    rng = default_rng(seed)
    each = zip(beliefs, asked, np.zeros(len(beliefs), int) if phases is None else phases, strict=True)
    return [
        code_of(
            planner.decide(
                problem, Belief(belief), None if about < 0 else int(about), rng=rng, phase=int(phase)
            ).action,
            problem,
        )
        for belief, about, phase in each
    ]

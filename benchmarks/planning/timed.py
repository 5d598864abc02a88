"""A planner under the clock."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from numpy.random import Generator

from fetch_pomdp import Belief, Decision, Planner, Problem


@dataclass(slots=True)
class Timed:
    """A planner, and how long its decisions took (s of processor time, on one core)."""

    planner: Planner
    times: list[float] = field(default_factory=list)

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Pass the planner's decision on."""
        start = time.process_time()
        decision = self.planner.decide(problem, belief, asked, rng=rng, phase=phase)
        self.times.append(time.process_time() - start)
        return decision

"""Alike items, 2 to 50 of them: what questions of more kinds change. People say the noun, and point now and then."""

from __future__ import annotations

import dataclasses

import numpy as np

from asking.speed import VALUES
from fetch_pomdp import Item, Scene
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import Asking, candidates
from fetch_pomdp.core.questions.question import Kind
from fetch_pomdp.core.questions.simulation import simulate_asking
from planning import Record

SIZES = (2, 4, 8, 12, 24, 50)
SETS = {
    "this one?": frozenset({Kind.POINT}),
    "all yes or no": frozenset(Kind) - {Kind.OPEN, Kind.REPEAT},
    "all": frozenset(Kind),
}
SEED = 8100


def rows(people: int) -> list[Record]:
    """Return accuracy, seconds and questions by kind, a number of items and a set of kinds a row."""
    found = []
    for size in SIZES:
        scene = alike(size)
        for name, kinds in SETS.items():
            heard = tuple(dataclasses.replace(item, vocabulary=item.vocabulary[:1]) for item in scene.items)
            problem = Problem(
                dataclasses.replace(scene, items=heard), candidates(scene, Asking(kinds=kinds, misunderstood=0.02))
            )
            played = simulate_asking(problem, FittedValue(), people, SEED + size)
            found.append({
                "items": size, "questions": name, "right": played.accuracy, "seconds": played.mean_seconds,
                "return": played.mean_return, "error": played.standard_error, "asked": played.mean_questions,
                **{kind.value: share for kind, share in played.by_kind.items()},
            })  # fmt: skip
            print(found[-1], flush=True)
    return found


def alike(size: int) -> Scene:
    """Return rows of ten mugs with four attributes drawn evenly."""
    rng = np.random.default_rng((8100, size))
    return Scene(
        items=tuple(
            Item(
                id=f"mug-{k}",
                position=((k % 10 - (min(size, 10) - 1) / 2) * 0.15, 2.2 + 0.2 * (k // 10), 0.75),
                vocabulary=("mug", *(str(rng.choice(values)) for values in VALUES)),
            )
            for k in range(size)
        ),
        head=(0.0, 0.0, 1.6),
    )

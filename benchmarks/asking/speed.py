"""Processor times of solving a scene and of deciding, once everything is compiled."""

from __future__ import annotations

import time

import numpy as np

from fetch_pomdp import Item, Scene
from fetch_pomdp.core.planners.pointbased.ahead import step_ahead
from fetch_pomdp.core.planners.pointbased.planner import solution
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import Asking, candidates
from planning import Record

SIZES = ((6, 4, 30), (12, 4, 60), (50, 4, 200))  # items, attributes, questions at most
VALUES = (("red", "blue", "green"), ("big", "small", "tiny"), ("striped", "plain", "dotted"), ("old", "new", "used"))
DECISIONS = 500


def rows() -> list[Record]:
    """Return medians and 90 % quantiles of beliefs of all sorts, a size a row."""
    decide(*SIZES[0])  # compiles
    return [decide(*size) for size in SIZES]


def decide(items: int, attributes: int, most: int) -> Record:
    """Return the times of one size."""
    rng = np.random.default_rng(items)
    scene = table(items, attributes, rng)
    problem = Problem(scene, candidates(scene, Asking(most=most - items)))
    start = time.process_time()
    plans = solution(problem, 0).plans
    solving = time.process_time() - start
    nothing, taken = np.full(problem.n_questions, -1), []
    for number in range(DECISIONS):
        belief = rng.dirichlet(np.full(items, (0.1, 0.5, 5.0)[number % 3]))
        start = time.process_time()
        step_ahead(belief, -1, nothing, plans)
        taken.append(1e6 * (time.process_time() - start))
    return {
        "items": items,
        "questions": problem.n_questions,
        "answers": len(plans.steps.rows),
        "outcomes": len(plans.steps.outcomes),
        "plans": int(plans.vectors.size[0]),
        "solving_s": solving,
        "median_us": float(np.median(taken)),
        "p90_us": float(np.quantile(taken, 0.9)),
    }


def table(items: int, attributes: int, rng: np.random.Generator) -> Scene:
    """Return rows of six mugs with attributes drawn evenly."""
    return Scene(
        items=tuple(
            Item(
                id=f"mug-{k}",
                position=((k % 6 - 2.5) * 0.15, 2.95 + 0.2 * (k // 6), 0.75),
                vocabulary=("mug", *(str(rng.choice(values)) for values in VALUES[:attributes])),
            )
            for k in range(items)
        ),
        head=(0.0, 0.0, 1.6),
    )

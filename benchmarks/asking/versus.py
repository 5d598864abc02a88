"""The default planner, one step ahead and information gain beside Perseus, on the twelve alike items."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray

from asking import perseus
from asking.twelve import NOBODY_POINTS, RAY_FIRST, Array, Decide, World, play, questions, scene, world
from fetch_pomdp.core.planners.asking import Asked, AskingPlanner
from fetch_pomdp.core.planners.baselines.asking import InformationGainAsking, OneStepAsking
from fetch_pomdp.core.planners.pointbased.planner import PointBased, solution
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.question import Kind
from planning import Record

CELLS = (
    ("points", {Kind.POINT}, -12.5),
    ("and attributes", {Kind.POINT, Kind.ATTRIBUTE}, -12.5),
    ("all but open", set(Kind) - {Kind.OPEN}, -12.5),
    ("all but open", set(Kind) - {Kind.OPEN}, -50.0),
)
SEED = 4


def rows(people: int) -> list[Record]:
    """Return what each earns, kinds and prices a row, with the difference to Perseus and its standard error."""
    return [row for name, kinds, wrong in CELLS for row in cell(name, kinds, wrong, people)]


def cell(name: str, kinds: set[Kind], wrong: float, people: int) -> list[Record]:
    """Return the two rows of a set of kinds and a price of a wrong pick."""
    of = world(Problem(scene(wrong), questions(kinds)))
    start = time.perf_counter()
    solution(of.problem, PointBased().seed)
    solving = time.perf_counter() - start
    vectors = perseus.solved(of, 3)
    found = []
    for ray_first in (NOBODY_POINTS, RAY_FIRST):
        reference = play(of, perseus.ahead(of, vectors), people, np.random.default_rng(SEED), ray_first=ray_first)
        row: Record = {"questions": name, "wrong pick": wrong, "ray first": ray_first, "solving_s": solving,
                       "Perseus": float(reference["earned"].mean())}  # fmt: skip
        for label, planner in (("planner", PointBased()), ("one step", OneStepAsking()),
                               ("information gain", InformationGainAsking())):  # fmt: skip
            played = play(of, of_planner(of, planner), people, np.random.default_rng(SEED), ray_first=ray_first)
            row[label] = summary(played, reference)
        found.append(row)
    return found


def summary(played: dict[str, Array], reference: dict[str, Array]) -> Record:
    """Return means, and the difference to the reference."""
    ahead = played["earned"] - reference["earned"]
    return {
        "return": float(played["earned"].mean()),
        "right": float(played["correct"].mean()),
        "asked": float(played["questions"].mean()),
        "ahead": float(ahead.mean()),
        "error": float(ahead.std()) / math.sqrt(len(ahead)),
    }


def of_planner(of: World, planner: AskingPlanner) -> Decide:
    """Return a planner as a robot of the world; it is told of no answers before, for nothing is shared there."""
    questions_, wait = of.problem.n_questions, of.problem.n_questions

    def decide(beliefs: Array) -> NDArray[np.int64]:
        asked = Asked(np.full(len(beliefs), -1), np.full((len(beliefs), questions_), -1))
        chosen = planner.decide_many_asking(
            of.problem, np.ascontiguousarray(beliefs), asked, rng=np.random.default_rng(0)
        )
        return np.where(chosen == 0, wait, np.where(chosen > questions_, -1, chosen - 1))

    return decide

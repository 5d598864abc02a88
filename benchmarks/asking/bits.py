"""How many questions it takes to be 95 % sure, asking what tells most, and how many it must."""

from __future__ import annotations

import math

import numpy as np

from asking.twelve import TRUTH, N, play, questions, scene, until_sure, world
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.question import Kind
from planning import Record

CONFIDENCE = 0.95
YES_OR_NO = set(Kind) - {Kind.OPEN, Kind.REPEAT}
SETS: tuple[tuple[str, set[Kind], float], ...] = (
    ("points", {Kind.POINT}, 0.75),
    ("and attributes", {Kind.POINT, Kind.ATTRIBUTE}, 0.75),
    ("all yes or no", YES_OR_NO, 0.75),
    ("and open, named with .75", {*YES_OR_NO, Kind.OPEN}, 0.75),
    ("and open, named with .95", {*YES_OR_NO, Kind.OPEN}, 0.95),
)


def rows(people: int) -> list[Record]:
    """Return the questions asked and how often the likeliest item is right, a set of kinds a row."""
    found = []
    for name, kinds, names in SETS:
        of = world(Problem(scene(), questions(kinds, names)))
        row: Record = {"questions": name}
        for label, ray_first in (("nobody points", False), ("ray first", True)):
            played = play(of, until_sure(of, CONFIDENCE), people, np.random.default_rng(1), ray_first=ray_first)
            right = float(played["correct"].mean())
            row[label] = {"asked": float(played["questions"].mean()), "right": right}
            if not ray_first and kinds <= YES_OR_NO:
                row[label]["Fano's bound"] = fano(1.0 - right, of.problem.model.p_l)
        found.append(row)
    return found


def fano(error: float, p_l: float) -> float:
    """Return the fewest yes-or-no questions, on average, that leave so large an error of N items (Fano 1961).

    An answer tells at most 1 - H(TRUTH) bits and comes with p_l; pointing is left out, so that the bound is that of
    people who never point.
    """
    left = entropy(error) + error * math.log2(N - 1)
    return (math.log2(N) - left) / (p_l * (1.0 - entropy(TRUTH)))


def entropy(p: float) -> float:
    """Return the entropy of a yes or no in bits."""
    return 0.0 if p in (0.0, 1.0) else -p * math.log2(p) - (1.0 - p) * math.log2(1.0 - p)

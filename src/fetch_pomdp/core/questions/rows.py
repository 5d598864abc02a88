"""The questions of a problem as arrays, for compiled code: chances of answers, prices, and what asking again shares."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector, compiled, lean
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import points
from fetch_pomdp.core.questions.prices import reward_of
from fetch_pomdp.core.questions.question import Kind

KINDS = tuple(Kind)


class Rows(NamedTuple):
    """k questions over n items; the answers of question q are rows starts[q] to starts[q + 1]."""

    chances: Vector  # (r, n), of each answer given that one comes and the desired item
    starts: Integers  # (k + 1,)
    prices: Vector  # (k,), rewards
    shared: Vector  # (k,), chance that a question asked again is answered as before
    seconds: Vector  # (k,), s
    kinds: Integers  # (k,), places in KINDS


def rows_of(problem: Problem) -> Rows:
    """Return the questions of a problem; the paper's where none are given."""
    questions = problem.questions or points(problem.scene)
    return Rows(
        chances=np.ascontiguousarray(np.concatenate([question.chances for question in questions])),
        starts=np.cumsum([0, *(len(question.answers) for question in questions)]).astype(np.int64),
        prices=np.array([reward_of(question.seconds, problem.rewards) for question in questions]),
        shared=np.array([question.shared for question in questions]),
        seconds=np.array([question.seconds for question in questions]),
        kinds=np.array([KINDS.index(question.kind) for question in questions]),
    )


@lean
def chance_after(row: int, item: int, begin: int, before: int, shared: float, chances: Vector) -> float:
    """Return the chance of the answer of a row where the question was answered before (`Question.after`).

    begin: the question's first row. before: its last answer, or -1.
    """
    chance = chances[row, item]
    if before < 0:
        return float(chance)
    return float((1.0 - shared) * chance + (shared if row == begin + before else 0.0))


@compiled
def chances_after(answers: Integers, rows: Rows) -> Vector:
    """Return the chances of all questions after their last answers, (r, n). answers: (k,), -1 where there is none."""
    chances = rows.chances.copy()
    for question in range(len(answers)):
        if answers[question] >= 0 and rows.shared[question] > 0.0:
            begin = rows.starts[question]
            for row in range(begin, rows.starts[question + 1]):
                for item in range(chances.shape[1]):
                    chances[row, item] = chance_after(
                        row, item, begin, answers[question], rows.shared[question], rows.chances
                    )
    return chances


@lean
def information(question: int, belief: Vector, chances: Vector, starts: Integers) -> float:
    """Return what the answer to a question tells about the item, in nats, if one comes (mutual information)."""
    told = 0.0
    for answer in range(starts[question], starts[question + 1]):
        row, chance = chances[answer], 0.0
        for item in range(len(belief)):
            joint = belief[item] * row[item]
            chance += joint
            if joint > 0.0:
                told += joint * math.log(row[item])
        if chance > 0.0:
            told -= chance * math.log(chance)
    return told

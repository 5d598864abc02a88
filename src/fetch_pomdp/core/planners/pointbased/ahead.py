"""A decision: one exact step ahead of the plans, from what was asked and answered so far."""

from __future__ import annotations

from typing import NamedTuple

from fetch_pomdp.core.compiled import Integers, Vector, compiled
from fetch_pomdp.core.planners.pointbased.backup import (
    Memory,
    Steps,
    Vectors,
    answered,
    followed,
    hear,
    question_value,
    screen,
    waited_out,
)
from fetch_pomdp.core.planners.pointbased.solve import memory_for
from fetch_pomdp.core.questions.rows import Rows, chances_after

REFINED = 4  # questions that are valued by all outcomes, at least


class Solved(NamedTuple):
    """A problem's steps, plans for them, and its questions."""

    steps: Steps
    vectors: Vectors
    rows: Rows


@compiled
def step_ahead(belief: Vector, last: int, answers: Integers, solved: Solved) -> tuple[float, Vector, int]:
    """Return the value of a wait, of each question, (k,), and the number of the best action.

    last: the question asked last, or -1. answers: (k,), each question's last answer, or -1. Equal values go to the
    pick, then the wait, then the first question.
    """
    steps, vectors = solved.steps, solved.vectors
    if (answers >= 0).any():
        steps = Steps(
            chances_after(answers, solved.rows), steps.starts, steps.prices, steps.outcomes,
            steps.answered, steps.again, steps.wait, steps.right, steps.wrong,
        )  # fmt: skip
    memory = memory_for(steps, REFINED)
    hear(belief, steps, memory)
    still = followed(steps, vectors, memory, memory.silent)
    wait = steps.wait + still
    if last >= 0 and steps.again > 0.0:
        wait = steps.wait + pending(last, still, steps, vectors, memory)
    screen(belief, steps, vectors, memory)
    ask = memory.rough
    for question in memory.best:
        if question >= 0:
            then = answered(question, steps, vectors, memory)
            ask[question] = question_value(steps.prices[question], then, still, steps)
    first, question = int(belief.argmax()), int(memory.best[0])
    for other in memory.best:
        if other >= 0 and ask[other] > ask[question]:
            question = int(other)
    best, action = steps.wrong + (steps.right - steps.wrong) * belief[first], 1 + len(ask) + first
    if wait > best:
        best, action = wait, 0
    if ask[question] > best:
        action = 1 + question
    return wait, ask, action


@compiled
def pending(last: int, still: float, steps: Steps, vectors: Vectors, memory: Memory) -> float:
    """Return what follows a wait in which the last question may be answered."""
    then = answered(last, steps, vectors, memory)
    return float(steps.again * then + (1.0 - steps.again) * max(still, waited_out(steps) + then))


@compiled
def step_ahead_many(beliefs: Vector, last: Integers, answers: Integers, solved: Solved, actions: Integers) -> None:
    """Fill in the number of the best action for every belief, (m,). answers: (m, k)."""
    for index in range(len(beliefs)):
        actions[index] = step_ahead(beliefs[index], last[index], answers[index], solved)[2]

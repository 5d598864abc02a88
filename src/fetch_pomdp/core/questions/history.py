"""What was asked and answered so far: the part of the state beside the desired item, and it is known.

The paper's i_r, the last item asked about (Section III-B), is the last question here. Beside it stands each question's
last answer, for the same question asked again shares its error (`Question.after`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.question import Question
from fetch_pomdp.errors import BeliefError, ModelError

UNANSWERED = -1


@dataclass(frozen=True, slots=True)
class History:
    """The last question and, of each question, how often it was asked and the last answer. Immutable."""

    answers: tuple[int, ...]  # of each question, the number of its last answer, or UNANSWERED
    times: tuple[int, ...]  # how often each was asked
    last: int | None = None  # i_r: the question asked last

    @classmethod
    def none(cls, problem: Problem) -> History:
        """Return the history an interaction starts with."""
        count = problem.n_questions
        return cls((UNANSWERED,) * count, (0,) * count)

    def asked(self, question: int) -> History:
        """Return the history after a question, before its answer."""
        times = _changed(self.times, question, self.times[question] + 1)
        return dataclasses.replace(self, times=times, last=question)

    def answered(self, answer: int) -> History:
        """Return the history after an answer to the last question. Raises ModelError where none was asked."""
        if self.last is None:
            raise ModelError("found an answer, expected none before a question", field="answer")
        return dataclasses.replace(self, answers=_changed(self.answers, self.last, answer))

    def before(self, question: int) -> int | None:
        """Return the last answer to a question, or None."""
        return None if self.answers[question] == UNANSWERED else self.answers[question]


def _changed(numbers: tuple[int, ...], place: int, value: int) -> tuple[int, ...]:
    return (*numbers[:place], value, *numbers[place + 1 :])


def likelihood(question: Question, before: int | None, heard: Vector) -> Vector:
    """Return the likelihood of what was heard as an answer, (n_items,), given the desired item.

    before: the same question's answer before, if any. heard: (n_answers,), chance of what was heard given each answer:
    1 for the one that is certain, a column of a recogniser's confusions, or the weights of its alternatives.
    """
    return np.asarray(heard @ question.after(before))


def certainly(answer: int, question: Question) -> Vector:
    """Return what is heard of an answer that is certain, (n_answers,). Raises ModelError for a number out of range."""
    if not 0 <= answer < len(question.answers):
        found = f"found {answer}, expected 0 to {len(question.answers) - 1} for {question.said!r}"
        raise ModelError(found, field="answer")
    return np.asarray(np.eye(len(question.answers))[answer])


def belief_after(belief: Belief, chances: Sequence[float] | Vector) -> Belief:
    """Return the belief after evidence of a likelihood (Bayes' rule). chances: (n_items,), up to a factor.

    Raises BeliefError if it is impossible for every item that the belief allows.
    """
    with np.errstate(divide="ignore"):
        logs = belief.log_probabilities + np.log(np.asarray(chances, dtype=np.float64))
    if not (logs > -np.inf).any():
        raise BeliefError("found an answer that no item allows, expected one with a chance above 0", field="answer")
    return Belief.of_logs(logs)

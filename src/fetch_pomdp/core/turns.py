"""Turn-taking: how likely people speak, answer and point in a step, by where the talk stands.

The paper's people speak and point at constant chances (p_l, p_g; Eq. 4, 6, 7). Real people say a thing once and wait.
Where the talk stands is observed by both sides: whether a request has been heard, for how long it has been quiet, and
whether a question is open. So it is no belief but a part of the state that is known, a phase, and the chances of the
next step depend on it (mixed observability: Ong et al. 2010).

A phase is a talk times QUESTIONS plus a question, two numbers of which each says one thing:

- talk: UNBEGUN; POINTED, since the step before; DUE, pointed for longer, so that words are due; HEARD + k, k quiet steps
  after words, where k = patience stands for all that is longer.
- question: NO_QUESTION; DENIED, answered by "no" in the step before; OPEN for one step; OPEN_LONG.

The paper's model has the phase 0 alone.

Choice: people answer sooner if the item asked about is the desired one: "yes" is short, and a "no" is thought over and
explained. So silence after a question tells something too.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.errors import ModelError

UNBEGUN, POINTED, DUE, HEARD = range(4)
NO_QUESTION, DENIED, OPEN, OPEN_LONG = range(4)
QUESTIONS = 4
SILENT, YES, NO = range(3)  # answers
WORDS, POINTS, DESIRED, OTHER = range(4)  # columns of `Phases.chances`
MOST_PATIENCE = 50  # steps

Chances = tuple[float, float]  # in a step after a wait, and in the step of a question
Ages = tuple[float, float, float]  # in the step of a question, in the next step, and in each later one


@dataclass(frozen=True, slots=True, kw_only=True)
class Turns:
    """Chances in a step of a live person. Raises ModelError for one out of its range.

    The defaults are those of our simulated people (`study.people`) on the clock of a live interaction, fitted by
    `fetch-pomdp calibrate --turns`.
    """

    words_unbegun: Chances = (0.2, 0.6)
    words_pointed: Chances = (0.2, 0.8)
    words_due: Chances = (0.5, 0.85)
    words_heard: Chances = (0.05, 0.05)
    words_silent: Chances = (0.15, 0.3)
    words_denied: Chances = (0.1, 0.3)
    points_unbegun: Chances = (0.6, 0.8)
    points_pointed: Chances = (0.95, 0.95)
    points_due: Chances = (0.8, 0.8)
    points_heard: Chances = (0.3, 0.5)
    points_silent: Chances = (0.3, 0.4)
    points_denied: Chances = (0.6, 0.7)
    answers_desired: Ages = (0.6, 0.6, 0.3)  # of an answer if the item asked about is the desired one
    answers_other: Ages = (0.3, 0.5, 0.5)  # and if it is not
    answers_settled: float = 0.01  # of another answer where no question is open
    patience: int = 6  # quiet steps after which people say it again
    question: int = 3  # quiet steps that the step of a question counts for

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.name in {"patience", "question"}:
                _whole(value, field.name)
            elif field.name == "answers_settled":
                object.__setattr__(self, field.name, _chance(value, field.name))
            else:
                count = 3 if field.name.startswith("answers") else 2
                object.__setattr__(self, field.name, _chances(value, count, field.name))

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return these chances with some changed. Raises ModelError for an unknown name."""
        checks.known(changes, [field.name for field in dataclasses.fields(self)], "chance", ModelError)
        return dataclasses.replace(self, **changes)


def _whole(value: object, field: str) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= MOST_PATIENCE:
        expected = f"a whole number of steps from 1 to {MOST_PATIENCE}"
        raise ModelError(f"found {checks.shown(value)}, expected {expected}", field=field)


def _chance(value: object, field: str) -> float:
    return checks.within(value, 0.0, 1 - 1e-9, field, "a probability from 0 to below 1", ModelError)


def _chances(value: object, count: int, field: str) -> tuple[float, ...]:
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != count:
        raise ModelError(f"found {checks.shown(value)}, expected a list of {count} probabilities", field=field)
    return tuple(_chance(part, field) for part in value)


class Phases(NamedTuple):
    """What compiled code reads of turn-taking; the kinds of step are 0, after a wait, and 1, that of a question."""

    chances: Vector  # (phases, 2 kinds of step, 4): WORDS, POINTS; an answer if the item is DESIRED, or an OTHER
    following: Integers  # (phases, 2 kinds of step, 2 words heard, 2 pointing seen, 3 answers), the next phase
    alike: Integers  # (phases,), number of the group of phases that a fitted value takes for one


def constant_phases(p_l: float, p_again: float, p_g: float) -> Phases:
    """Return the paper's one phase. p_again: chance of an answer in a step after a wait."""
    chances = np.array([[[p_l, p_g, p_again, p_again], [p_l, p_g, p_l, p_l]]])
    return Phases(chances, np.zeros((1, 2, 2, 2, 3), dtype=np.int64), np.zeros(1, dtype=np.int64))


def phases_of(turns: Turns) -> Phases:
    """Return the phases of live people.

    Choice: a fitted value takes the phases between the words of a request and people's patience for one.
    """
    silent = HEARD + turns.patience
    count = (silent + 1) * QUESTIONS
    chances, alike = np.empty((count, 2, 4)), np.empty(count, dtype=np.int64)
    following = np.empty((count, 2, 2, 2, 3), dtype=np.int64)
    for phase in range(count):
        talk, question = divmod(phase, QUESTIONS)
        alike[phase] = (min(talk, HEARD) + (talk == silent)) * QUESTIONS + question
        name = "denied" if question == DENIED else _talk_name(talk, silent)
        for asked in (0, 1):
            words, points = getattr(turns, f"words_{name}")[asked], getattr(turns, f"points_{name}")[asked]
            chances[phase, asked] = words, points, *_answer_chances(turns, question, asked)
            for words_heard, seen, answer in np.ndindex(2, 2, 3):
                talk_after = _talk_after(talk, asked * (turns.question - 1) + 1, words_heard, seen, silent)
                following[phase, asked, words_heard, seen, answer] = (
                    talk_after * QUESTIONS + _question_after(question, asked, answer)
                )
    return Phases(chances, following, alike)


def _talk_name(talk: int, silent: int) -> str:
    return "silent" if talk == silent else ("unbegun", "pointed", "due", "heard")[min(talk, HEARD)]


def _answer_chances(turns: Turns, question: int, asked: int) -> tuple[float, float]:
    if not asked and question in (NO_QUESTION, DENIED):
        return turns.answers_settled, turns.answers_settled
    age = 0 if asked else 1 if question == OPEN else 2
    return turns.answers_desired[age], turns.answers_other[age]


def _talk_after(talk: int, quiet: int, words: int, seen: int, silent: int) -> int:
    """Return the talk after a step. quiet: steps that it counts for if nothing is said in it.

    Choice: who points after a long silence says it all again, so words are due.
    """
    if words:
        return HEARD
    if talk >= HEARD:
        return DUE if talk == silent and seen else min(talk + quiet, silent)
    if talk == UNBEGUN:
        return POINTED if seen else UNBEGUN
    return DUE


def _question_after(question: int, asked: int, answer: int) -> int:
    if answer != SILENT:
        return DENIED if answer == NO else NO_QUESTION
    if asked:
        return OPEN
    return OPEN_LONG if question in (OPEN, OPEN_LONG) else NO_QUESTION

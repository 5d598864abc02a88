"""Turn-taking: how likely people speak, answer and point in a step, by where the talk stands.

The paper's people speak and point at constant chances (p_l, p_g; Eq. 4, 6, 7). Real people say a thing once and wait.
Where the talk stands is observed by both sides: whether a request has been heard, for how long it has been quiet, and
whether a question is open. So it is no belief but a part of the state that is known, a phase, and the chances of the
next step depend on it (mixed observability: Ong et al. 2010).

A phase is a talk times QUESTIONS plus a question, two numbers of which each says one thing:

- talk: UNBEGUN; POINTED, since the step before; DUE, pointed for longer, so that words are due; HEARD + k, k quiet
  steps after the words of somebody who has pointed, where k = patience stands for all that is longer; and as many for
  somebody who has not pointed.
- question: NO_QUESTION; DENIED, answered by "no" in the step before; OPEN for one step; OPEN_LONG.

The paper's model has the phase 0 alone.

Choice: people answer sooner if the item asked about is the desired one: "yes" is short, and a "no" is thought over and
explained. So silence after a question tells something too.
"""

from __future__ import annotations

import dataclasses
import functools
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
GROUPS = ("unbegun", "pointed", "due", "heard", "said", "silent")
SILENT, YES, NO = range(3)  # answers
WORDS, POINTS, DESIRED, OTHER = range(4)  # columns of `Phases.chances`
MOST_PATIENCE = 50  # steps
LEAST = 1e-6  # so that nothing that is heard is impossible

Chances = tuple[float, float]  # in a step after a wait, and in the step of a question
# In the step of a question, in that of one asked while another was open, in the step after, and in each later one.
Ages = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Turns:
    """Chances in a step of a live person. Raises ModelError for one out of its range.

    The defaults are those of our simulated people (`study.people`) on the clock of a live interaction, counted as
    `fetch-pomdp calibrate --turns` counts, but for two.

    Choice: who points is about to speak, with a chance of 0.4 a step, in a step of the robot's question too: counted
    chances would have it ask at the first sight of an arm, in the middle of what people want to say.

    Choice: an answer that has not come in two steps still comes with a chance of 0.4 a step, where our simulated people
    have long answered: who thinks for five seconds is not to be handed a guess.
    """

    words_unbegun: Chances = (0.033, 0.6)
    words_pointed: Chances = (0.4, 0.5)
    words_due: Chances = (0.4, 0.5)
    words_said: Chances = (0.031, 0.002)
    words_heard: Chances = (0.046, 0.015)
    words_silent: Chances = (0.015, 0.292)
    words_denied: Chances = (0.003, 0.214)
    points_unbegun: Chances = (0.504, 0.8)
    points_pointed: Chances = (0.997, 0.998)
    points_due: Chances = (0.259, 0.619)
    points_said: Chances = (0.112, 0.051)
    points_heard: Chances = (0.172, 0.344)
    points_silent: Chances = (0.093, 0.377)
    points_denied: Chances = (0.462, 0.626)
    answers_desired: Ages = (0.308, 0.129, 0.635, 0.4)  # of an answer if the item asked about is the desired one
    answers_other: Ages = (0.162, 0.367, 0.459, 0.4)  # and if it is not
    answers_settled: tuple[float] = (0.064,)  # of another answer where no question is open
    patience: int = 6  # quiet steps after which people say it again
    question: int = 3  # quiet steps that the step of a question counts for

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.type == "int":
                _whole(value, field.name)
            else:
                object.__setattr__(self, field.name, _chances(value, len(field.default), field.name))  # type: ignore[arg-type]

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return these chances with some changed. Raises ModelError for an unknown name."""
        checks.known(changes, [field.name for field in dataclasses.fields(self)], "chance", ModelError)
        return dataclasses.replace(self, **changes)


def _whole(value: object, field: str) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= MOST_PATIENCE:
        expected = f"a whole number of steps from 1 to {MOST_PATIENCE}"
        raise ModelError(f"found {checks.shown(value)}, expected {expected}", field=field)


def _chances(value: object, count: int, field: str) -> tuple[float, ...]:
    expected = f"a list of {count} {'probability' if count == 1 else 'probabilities'} above 0 and below 1"
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != count:
        raise ModelError(f"found {checks.shown(value)}, expected {expected}", field=field)
    return tuple(checks.within(part, LEAST, 1.0 - LEAST, field, expected, ModelError) for part in value)


class StepChances(NamedTuple):
    """Chances of base words, of pointing, and of an answer by whether the item asked about is the desired one."""

    words: float
    points: float
    desired: float
    other: float


class Phases(NamedTuple):
    """What compiled code reads of turn-taking; the kinds of step are 0, after a wait, and 1, that of a question."""

    chances: Vector  # (phases, 2 kinds of step, 4): WORDS, POINTS; an answer if the item is DESIRED, or an OTHER
    following: Integers  # (phases, 2 kinds of step, 2 words heard, 2 pointing seen, 3 answers), the next phase
    alike: Integers  # (phases,), number of the group of phases that a fitted value takes for one
    begun: Integers  # (phases,), 0 where nobody has spoken or pointed yet, so that there is nothing to decide
    awaited: Integers  # (phases,), 1 where an answer may still come


def constant_chances(p_l: float, p_g: float) -> StepChances:
    """Return the paper's chances of a step, in which whether somebody answers tells nothing."""
    return StepChances(p_l, p_g, p_l, p_l)


def constant_phases(p_l: float, p_again: float, p_g: float) -> Phases:
    """Return the paper's one phase. p_again: chance of an answer in a step after a wait."""
    chances = np.array([[[p_l, p_g, p_again, p_again], [p_l, p_g, p_l, p_l]]])
    none, one = np.zeros(1, dtype=np.int64), np.ones(1, dtype=np.int64)
    return Phases(chances, np.zeros((1, 2, 2, 2, 3), dtype=np.int64), none, one, one)


@functools.lru_cache(maxsize=32)
def phases_of(turns: Turns) -> Phases:
    """Return the phases of live people; kept, for a study builds a problem for every trial. Not to be changed in place.

    Choice: a fitted value takes the phases between the words of a request and people's patience for one.
    """
    talks = HEARD + 2 * (turns.patience + 1)
    count = talks * QUESTIONS
    chances, following = np.empty((count, 2, 4)), np.empty((count, 2, 2, 2, 3), dtype=np.int64)
    for phase, asked in np.ndindex(count, 2):
        talk, question = divmod(phase, QUESTIONS)
        chances[phase, asked] = [getattr(turns, name)[index] for name, index in places_of(phase, asked, turns.patience)]
        for words, seen, answer in np.ndindex(2, 2, 3):
            after = _talk_after(talk, turns.question if asked else 1, words, seen, turns.patience)
            following[phase, asked, words, seen, answer] = after * QUESTIONS + _question_after(question, asked, answer)
    groups = {name: number for number, name in enumerate(GROUPS)}
    alike = [
        groups[_name(phase // QUESTIONS, turns.patience)] * QUESTIONS + phase % QUESTIONS for phase in range(count)
    ]
    begun, still_open = np.arange(count) // QUESTIONS != UNBEGUN, np.arange(count) % QUESTIONS >= OPEN
    return Phases(chances, following, np.array(alike), begun.astype(np.int64), still_open.astype(np.int64))


def places_of(phase: int, asked: int, patience: int) -> tuple[tuple[str, int], ...]:
    """Return where `Turns` has the chances of a step: fields and indices, in the order of StepChances.

    asked: 0 for a step after a wait, 1 for that of a question.
    """
    talk, question = divmod(phase, QUESTIONS)
    name = "denied" if question == DENIED else _name(talk, patience)
    if not asked and question in (NO_QUESTION, DENIED):
        return (f"words_{name}", 0), (f"points_{name}", 0), ("answers_settled", 0), ("answers_settled", 0)
    age = int(question >= OPEN) if asked else 2 if question == OPEN else 3
    return (f"words_{name}", asked), (f"points_{name}", asked), ("answers_desired", age), ("answers_other", age)


def _name(talk: int, patience: int) -> str:
    """Return what the chances of a talk are called."""
    if talk < HEARD:
        return GROUPS[talk]
    unpointed, quiet = divmod(talk - HEARD, patience + 1)
    return "silent" if quiet == patience else "said" if unpointed else "heard"


def _talk_after(talk: int, quiet: int, words: int, seen: int, patience: int) -> int:
    """Return the talk after a step. quiet: steps that it counts for if nothing is said in it.

    Choice: who points after a long silence says it all again, so words are due.
    """
    unpointed = HEARD + patience + 1  # the first talk of those who have not pointed
    pointed = seen or talk in (POINTED, DUE) or HEARD <= talk < unpointed
    if words:
        return HEARD if pointed else unpointed
    if talk < HEARD:
        return DUE if talk != UNBEGUN else POINTED if seen else UNBEGUN
    before = (talk - HEARD) % (patience + 1)
    if before == patience and seen:
        return DUE
    return (HEARD if pointed else unpointed) + min(before + quiet, patience)


def _question_after(question: int, asked: int, answer: int) -> int:
    if answer != SILENT:
        return DENIED if answer == NO else NO_QUESTION
    if asked:
        return OPEN
    return OPEN_LONG if question in (OPEN, OPEN_LONG) else NO_QUESTION

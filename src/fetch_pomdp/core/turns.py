"""Turn-taking: how likely people speak, answer and point in a step, by where the talk stands.

The paper's people speak and point at constant chances (p_l, p_g; Eq. 4, 6, 7). Real people say a thing once and wait.
Where the talk stands is observed by both sides: whether a request has been heard, for how long it has been quiet, and
whether a question is open. So it is no belief but a part of the state that is known, a phase, and the chances of the
next step depend on it (mixed observability: Ong et al. 2010).

A phase is a `Talk` and a `QuestionState`; the paper's model has the phase 0 alone.

Choice: people answer sooner if the item asked about is the desired one: "yes" is short, and a "no" is thought over and
explained. So silence after a question tells something too.

Choice: a question that has been open for `hesitation` quiet steps is late: it was not heard, or not understood. It may
be asked again, and then once more in other words (`interaction`); who answers none of these will answer no other, so
that the robot does what is best without. "I don't know", and nothing else, comes to the same at once; "what?" makes a
question late.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Self, TypeAlias

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.errors import ModelError

SILENT, YES, NO, UNSURE, REPEAT = range(5)  # answers; the model's people give the first three
WORDS, POINTS, DESIRED, OTHER, WIDTH = range(5)  # columns of `Phases.chances`
MOST_ASKED = 3  # times a question is asked that nobody answers
MOST_STEPS = 50
WIDEST = 10.0
LEAST = 1e-6  # so that nothing that is heard is impossible

Chances: TypeAlias = tuple[float, float]  # in a step after a wait, and in the step of a question
# In the step of a question, in that of one asked while another was open, in the step after, and in each later one.
Ages: TypeAlias = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Turns:
    """Chances in a step of a live person. Raises ModelError for one out of its range.

    The defaults are those of our simulated people (`study.people`) on the clock of a live interaction, counted as
    `fetch-pomdp calibrate --turns` counts, but for these.

    Choice: who points is about to speak, with a chance of 0.4 a step, in a step of the robot's question too: counted
    chances would have it ask at the first sight of an arm, in the middle of what people want to say. After `gesturing`
    steps they have said it with their arm.

    Choice: an answer that has not come in two steps still comes with a chance of 0.3 or more a step, where our
    simulated people have long answered: who thinks for five seconds is not to be handed a guess. Then it is likelier a
    "no", so that what silence has told until then is taken back: who has still not answered has not heard the question.

    Choice: an arm that is held says little more in each step, for it errs each time to the same side. Its rays are read
    as if spread by `held` times sigma, in the step after the first and later: so the first few rays say together what
    they do of an arm with a constant bias and a tremble of 0.8 of it.
    """

    words_unbegun: Chances = (0.033, 0.6)
    words_pointed: Chances = (0.4, 0.5)
    words_due: Chances = (0.4, 0.5)
    words_mute: Chances = (0.05, 0.2)
    words_said: Chances = (0.031, 0.002)
    words_heard: Chances = (0.046, 0.015)
    words_silent: Chances = (0.015, 0.292)
    words_denied: Chances = (0.003, 0.214)
    points_unbegun: Chances = (0.504, 0.8)
    points_pointed: Chances = (0.997, 0.998)
    points_due: Chances = (0.259, 0.619)
    points_mute: Chances = (0.259, 0.619)
    points_said: Chances = (0.112, 0.051)
    points_heard: Chances = (0.172, 0.344)
    points_silent: Chances = (0.093, 0.377)
    points_denied: Chances = (0.462, 0.626)
    answers_desired: Ages = (0.308, 0.129, 0.635, 0.3)  # of an answer if the item asked about is the desired one
    answers_other: Ages = (0.162, 0.367, 0.459, 0.45)  # and if it is not
    answers_again: tuple[float, float, float] = (0.5, 0.3, 0.02)  # to a late question: again, in other words, again
    answers_late: tuple[float] = (0.03,)  # in each step in which a question is late
    answers_settled: tuple[float] = (0.064,)  # of another answer where no question is open
    held: tuple[float, float] = (2.0, 4.0)
    gesturing: int = 3  # steps of pointing or of none, after the first two, in which words are due
    patience: int = 6  # quiet steps after which people say it again
    hesitation: int = 5  # quiet steps after which an open question is late
    question: int = 3  # quiet steps that the step of a question counts for

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.type == "int":
                _whole(value, field.name)
            elif field.name == "held":
                object.__setattr__(self, field.name, _widths(value, field.name))
            else:
                object.__setattr__(self, field.name, _chances(value, len(field.default), field.name))  # type: ignore[arg-type]

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return these chances with some changed. Raises ModelError for an unknown name."""
        checks.known(changes, [field.name for field in dataclasses.fields(self)], "chance", ModelError)
        return dataclasses.replace(self, **changes)


def _whole(value: object, field: str) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= MOST_STEPS:
        expected = f"a whole number of steps from 1 to {MOST_STEPS}"
        raise ModelError(f"found {checks.shown(value)}, expected {expected}", field=field)


def _chances(value: object, count: int, field: str) -> tuple[float, ...]:
    expected = f"a list of {count} {'probability' if count == 1 else 'probabilities'} above 0 and below 1"
    return _numbers(value, (LEAST, 1.0 - LEAST), expected, (count, field))


def _widths(value: object, field: str) -> tuple[float, ...]:
    return _numbers(value, (1.0, WIDEST), f"a list of 2 factors from 1 to {WIDEST:g}", (2, field))


def _numbers(value: object, limits: Chances, expected: str, place: tuple[int, str]) -> tuple[float, ...]:
    count, field = place
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != count:
        raise ModelError(f"found {checks.shown(value)}, expected {expected}", field=field)
    return tuple(checks.within(part, *limits, field, expected, ModelError) for part in value)


class Talk(NamedTuple):
    """Where the request stands.

    `UNBEGUN`; `POINTED` in the step before; `DUE`, for `quiet` steps more, so that words are due; `MUTE`, for too long
    for words to come; `HEARD`, `quiet` steps ago, from somebody who has `pointed` or has not.
    """

    kind: Literal["unbegun", "pointed", "due", "mute", "heard"]
    quiet: int = 0
    pointed: bool = True

    def name(self, patience: int) -> str:
        """Return what its chances are called in `Turns`."""
        if self.kind != "heard":
            return self.kind
        return "silent" if self.quiet == patience else "heard" if self.pointed else "said"


class QuestionState(NamedTuple):
    """Where the last question stands: none is open; `denied`, answered by "no" in the step before; or `open`.

    asked: how often it was asked in vain, and once more; quiet: steps without an answer since then.
    """

    kind: Literal["none", "denied", "open"]
    asked: int = 0
    quiet: int = 0


UNBEGUN, POINTED, MUTE = Talk("unbegun"), Talk("pointed"), Talk("mute")
SETTLED, DENIED = QuestionState("none"), QuestionState("denied")


def talks_of(turns: Turns) -> list[Talk]:
    """Return every talk, in the order of the phases' numbers."""
    due = [Talk("due", quiet) for quiet in range(turns.gesturing)]
    heard = [Talk("heard", quiet, pointed) for pointed in (True, False) for quiet in range(turns.patience + 1)]
    return [UNBEGUN, POINTED, *due, MUTE, *heard]


def questions_of(turns: Turns) -> list[QuestionState]:
    """Return every question, in the order of the phases' numbers: a phase is a talk times as many plus a question."""
    times = range(1, MOST_ASKED + 1)
    opened = [QuestionState("open", asked, quiet) for asked in times for quiet in range(turns.hesitation + 1)]
    return [SETTLED, DENIED, *opened]


class StepChances(NamedTuple):
    """Chances of base words, of pointing, and of an answer by whether the item asked about is the desired one.

    width: what sigma is multiplied by where a ray of the step is read.
    """

    words: float
    points: float
    desired: float
    other: float
    width: float = 1.0


class Phases(NamedTuple):
    """What compiled code reads of turn-taking; the kinds of step are 0, after a wait, and 1, that of a question."""

    chances: Vector  # (phases, 2 kinds of step, 5): WORDS, POINTS; an answer if DESIRED, or OTHER; WIDTH of a ray
    following: Integers  # (phases, 2 kinds of step, 2 words heard, 2 pointing seen, 5 answers), the next phase
    alike: Integers  # (phases,), number of the group of phases that a fitted value takes for one
    begun: Integers  # (phases,), 0 where nobody has spoken or pointed yet, so that there is nothing to decide
    awaited: Integers  # (phases,), 1 where an answer is to be expected
    late: Integers  # (phases,), how often the question was asked that nobody has answered; 0 where none is late


def constant_chances(p_l: float, p_g: float) -> StepChances:
    """Return the paper's chances of a step, in which whether somebody answers tells nothing."""
    return StepChances(p_l, p_g, p_l, p_l)


def constant_phases(p_l: float, p_again: float, p_g: float) -> Phases:
    """Return the paper's one phase. p_again: chance of an answer in a step after a wait."""
    chances = np.array([[[p_l, p_g, p_again, p_again, 1.0], [p_l, p_g, p_l, p_l, 1.0]]])
    none, one = np.zeros(1, dtype=np.int64), np.ones(1, dtype=np.int64)
    return Phases(chances, np.zeros((1, 2, 2, 2, 5), dtype=np.int64), none, one, one, none)


@functools.lru_cache(maxsize=32)
def phases_of(turns: Turns) -> Phases:
    """Return the phases of live people; kept, for a study builds a problem for every trial. Not to be changed in place.

    Choice: a fitted value takes the phases between the words of a request and people's patience for one, and those in
    which a question is open that is not late, but for the first.
    """
    talks, questions = talks_of(turns), questions_of(turns)
    states = [(talk, question) for talk in talks for question in questions]
    talk_number = {talk: index for index, talk in enumerate(talks)}
    question_number = {question: index for index, question in enumerate(questions)}
    chances, following = np.empty((len(states), 2, 5)), np.empty((len(states), 2, 2, 2, 5), dtype=np.int64)
    for phase, (talk, question) in enumerate(states):
        chances[phase, :, WIDTH] = _width(talk, question, turns)
        for asked in range(2):
            places = _places(talk, question, asked, turns)
            chances[phase, asked, :WIDTH] = [getattr(turns, name)[index] for name, index in places]
            for words, seen, answer in np.ndindex(2, 2, 5):
                after = talk_number[_talk_after(talk, turns.question if asked else 1, words, seen, turns)]
                then = question_number[_question_after(question, asked, words, answer, turns.hesitation)]
                following[phase, asked, words, seen, answer] = after * len(questions) + then
    names = [_group(talk, question, turns) for talk, question in states]
    groups = {name: number for number, name in enumerate(dict.fromkeys(names))}
    late = [question.asked if _is_late(question, turns) else 0 for _, question in states]
    return Phases(
        chances,
        following,
        np.array([groups[name] for name in names]),
        np.array([int(talk is not UNBEGUN) for talk, _ in states]),
        np.array([int(question.kind == "open" and not _is_late(question, turns)) for _, question in states]),
        np.array(late),
    )


@functools.lru_cache(maxsize=32)
def answered_at_all(turns: Turns) -> Vector:
    """Return the chances that the open question, and that one asked now, is answered before it is late, (phases, 2).

    The first is 0 where none is open. Each holds if nothing else is said or shown meanwhile, and is the mean over
    whether the item asked about is the desired one.
    """
    known = phases_of(turns)
    silence = 1.0 - known.chances[:, :, DESIRED:WIDTH]  # (phases, 2 kinds of step, 2)
    quiet, at = np.ones((len(known.late), 2)), np.arange(len(known.late))
    for _ in range(turns.hesitation):  # after as many steps no question is open that is not late
        quiet *= np.where(known.awaited[at, None] == 1, silence[at, 0], 1.0)
        at = known.following[at, 0, 0, 0, SILENT]
    after_asking = silence[:, 1] * quiet[known.following[:, 1, 0, 0, SILENT]]
    return np.asarray(1.0 - np.stack([quiet, after_asking], axis=1).mean(axis=2))


def places_of(phase: int, asked: int, turns: Turns) -> tuple[tuple[str, int], ...]:
    """Return where `Turns` has the chances of a step: fields and indices, in the order of StepChances.

    asked: 0 for a step after a wait, 1 for that of a question.
    """
    questions = questions_of(turns)
    talk, question = divmod(phase, len(questions))
    return _places(talks_of(turns)[talk], questions[question], asked, turns)


def _places(talk: Talk, question: QuestionState, asked: int, turns: Turns) -> tuple[tuple[str, int], ...]:
    name = "denied" if question is DENIED else talk.name(turns.patience)
    talking = (f"words_{name}", asked), (f"points_{name}", asked)
    if _is_late(question, turns):
        place = ("answers_again", question.asked - 1) if asked else ("answers_late", 0)
        return *talking, place, place
    if not asked and question.kind != "open":
        return *talking, ("answers_settled", 0), ("answers_settled", 0)
    age = int(question.kind == "open") if asked else 2 if question.quiet == 0 else 3
    return *talking, ("answers_desired", age), ("answers_other", age)


def _is_late(question: QuestionState, turns: Turns) -> bool:
    return question.kind == "open" and question.quiet == turns.hesitation


def _width(talk: Talk, question: QuestionState, turns: Turns) -> float:
    """Return how much wider than sigma a ray is read: as much as it goes on with a pointing.

    Choice: who denies points anew, and so does who has been silent.
    """
    if talk is UNBEGUN or question is DENIED or talk.name(turns.patience) in ("said", "silent"):
        return 1.0
    return turns.held[0] if talk is POINTED else turns.held[1]


def _group(talk: Talk, question: QuestionState, turns: Turns) -> tuple[object, ...]:
    late = _is_late(question, turns)
    return talk.name(turns.patience), question.kind, question.asked, late, question.asked > 1 or min(question.quiet, 1)


def _talk_after(talk: Talk, quiet: int, words: int, seen: int, turns: Turns) -> Talk:
    """Return the talk after a step. quiet: steps that it counts for if nothing is said in it.

    Choice: who points after a long silence says it all again, so words are due.
    """
    pointed = bool(seen) or (talk is not UNBEGUN and talk.pointed)
    if words:
        return Talk("heard", 0, pointed)
    if talk.kind == "heard":
        if talk.quiet == turns.patience and seen:
            return Talk("due")
        return Talk("heard", min(talk.quiet + quiet, turns.patience), pointed)
    if talk is UNBEGUN:
        return POINTED if seen else UNBEGUN
    ago = quiet if talk is POINTED else talk.quiet + quiet + 1
    return MUTE if talk is MUTE or ago > turns.gesturing else Talk("due", ago - 1)


def _question_after(question: QuestionState, asked: int, words: int, answer: int, hesitation: int) -> QuestionState:
    """Return the question after a step.

    Choice: who says something else while a question is late has answered it in their way.
    """
    is_open = question.kind == "open"
    late = is_open and question.quiet == hesitation
    after = SETTLED
    if asked and late and question.asked == MOST_ASKED:
        after = question
    elif asked:
        after = QuestionState("open", question.asked if is_open and not late else question.asked + 1)
    elif is_open and not (late and words):
        after = QuestionState("open", question.asked, min(question.quiet + 1, hesitation))
    if answer == SILENT or (answer in (UNSURE, REPEAT) and after is SETTLED):
        return after
    if answer in (YES, NO):
        return DENIED if answer == NO else SETTLED
    return QuestionState("open", MOST_ASKED if answer == UNSURE and not words else after.asked, hesitation)

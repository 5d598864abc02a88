"""What the robot perceives in one step: language and gesture, o = (l, g) (Eq. 1-3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp.checks import shown
from fetch_pomdp.core import gesture
from fetch_pomdp.core.action import Action, Wait
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.meaning import Meaning
from fetch_pomdp.core.language.words import POSITIVE
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.turns import NO, REPEAT, SILENT, UNSURE, YES, StepChances
from fetch_pomdp.errors import ObservationError

EVASIONS: Mapping[Meaning | None, int] = {Meaning.UNSURE: UNSURE, Meaning.REPEAT: REPEAT}


@dataclass(frozen=True, slots=True)
class Observation:
    """The words heard in a step, as `words.tokenize` gives them, and the pointing ray seen, if any.

    Raises ObservationError for anything else, such as a text in place of its words.
    """

    words: tuple[str, ...] = ()
    ray: Ray | None = None

    def __post_init__(self) -> None:
        if type(self.words) is not tuple:
            object.__setattr__(self, "words", _in_a_tuple(self.words))
        for index, word in enumerate(self.words):
            if type(word) is not str and not isinstance(word, str):
                raise ObservationError(f"found {shown(word)}, expected a word", field=f"words[{index}]")
        if self.ray is not None and not isinstance(self.ray, Ray):
            raise ObservationError(f"found {shown(self.ray)}, expected a Ray or None", field="ray")


def _in_a_tuple(words: object) -> tuple[str, ...]:
    if not isinstance(words, list | tuple):
        expected = "a tuple of words, such as tokenize(text) or ('green', 'marker')"
        raise ObservationError(f"found {shown(words)}, expected {expected}", field="words")
    return tuple(words)


class Parts(NamedTuple):
    """The three factors of Eq. 3 as logarithms, each (n_items,): a fresh array that the caller may keep."""

    words: Vector  # log p(l_b | i_d)
    answers: Vector  # log p(l_r | i_d, i_r)
    pointing: Vector  # log p(g | i_d)

    def together(self) -> Vector:
        """Return their sum, log p(o | i_d, i_r), (n_items,)."""
        result = self.words + self.answers
        result += self.pointing
        return result


def log_likelihoods(observation: Observation, asked: int | None, problem: Problem, chances: StepChances) -> Parts:
    """Log p(o | i_d, i_r) for each item as the desired one (Eq. 1-3), part by part: given the state they are
    independent.

    Choice: "I don't know" is neither an answer nor silence, and tells nothing.

    asked: index of i_r, or None. chances: of the step, see `Problem.step_chances`.
    """
    utterance = unigram.split(observation.words, problem)
    answers = np.zeros(problem.n_items)
    if utterance.response or utterance.meaning not in EVASIONS:
        answers = unigram.response_log_likelihood(utterance.response, asked, problem, chances)
    return Parts(
        unigram.base_log_likelihood(utterance.base, problem),
        answers,
        gesture.log_likelihood(observation.ray, problem, chances.width),
    )


def sample(desired: int, asked: int | None, problem: Problem, chances: StepChances, rng: Generator) -> Observation:
    """Draw an observation o ~ p(o | i_d, i_r). chances: of the step, see `Problem.step_chances`."""
    base = unigram.sample_base(desired, problem, chances.words, rng)
    response = unigram.sample_response(desired, asked, problem, chances, rng)
    return Observation(base + response, gesture.sample(desired, problem, chances, rng))


def phase_after(
    observation: Observation, action: Action, problem: Problem, phase: int = 0, *, asked: int | None
) -> int:
    """Return the phase (`turns`) that a step leads to which began with an action.

    asked: i_r in the step, for words that answer nothing change nothing. Of several responses the last counts. The
    paper's one phase stays.
    """
    if problem.model.turns is None:
        return phase
    utterance = unigram.split(observation.words, problem)
    answer = SILENT
    if asked is not None and utterance.response:
        answer = YES if utterance.response[-1] in POSITIVE else NO
    elif asked is not None:
        answer = EVASIONS.get(utterance.meaning, SILENT)
    seen = observation.ray is not None and gesture.is_pointing(observation.ray, problem)
    following = problem.tables.following[phase, int(not isinstance(action, Wait)), int(bool(utterance.base)), int(seen)]
    return int(following[answer])

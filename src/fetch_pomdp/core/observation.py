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
from fetch_pomdp.core.alternatives import Alternative, together
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.unigram import Utterance
from fetch_pomdp.core.language.words import POSITIVE, Meaning
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.turns import NO, REPEAT, SILENT, UNSURE, YES, StepChances
from fetch_pomdp.errors import ObservationError

EVASIONS: Mapping[Meaning | None, int] = {Meaning.UNSURE: UNSURE, Meaning.REPEAT: REPEAT}


@dataclass(frozen=True, slots=True)
class Observation:
    """The words heard in a step, as `words.tokenize` gives them, and the pointing ray seen, if any.

    alternatives: every reading of the words with its probability, these words among them; none where one is certain.
    Raises ObservationError for anything else, such as a text in place of its words.
    """

    words: tuple[str, ...] = ()
    ray: Ray | None = None
    alternatives: tuple[Alternative, ...] = ()

    def __post_init__(self) -> None:
        if type(self.words) is not tuple:
            object.__setattr__(self, "words", _in_a_tuple(self.words))
        for index, word in enumerate(self.words):
            if type(word) is not str and not isinstance(word, str):
                raise ObservationError(f"found {shown(word)}, expected a word", field=f"words[{index}]")
        if self.ray is not None and not isinstance(self.ray, Ray):
            raise ObservationError(f"found {shown(self.ray)}, expected a Ray or None", field="ray")
        if self.alternatives:
            _check(self.alternatives, self.words)


def _check(alternatives: tuple[Alternative, ...], words: tuple[str, ...]) -> None:
    """Raise ObservationError for alternatives that are no distribution over readings, or leave out the words."""
    total = sum(each.weight for each in alternatives)
    if abs(total - 1.0) > 1e-6:
        raise ObservationError(f"found weights that sum to {total:.6g}, expected 1", field="alternatives")
    if words not in [each.words for each in alternatives]:
        raise ObservationError(f"found none with {shown(words)}, expected the words among them", field="alternatives")


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

    asked: index of i_r, or None. chances: of the step, see `Problem.step_chances`. Alternatives are taken together as
    `alternatives` says.
    """
    readings = [each.words for each in observation.alternatives] or [observation.words]
    utterances = [unigram.split(words, problem) for words in readings]
    words = [unigram.base_log_likelihood(utterance.base, problem) for utterance in utterances]
    answers = [_answer_log_likelihood(utterance, asked, problem, chances) for utterance in utterances]
    pointing = gesture.log_likelihood(observation.ray, problem, chances.width)
    if len(readings) == 1:
        return Parts(words[0], answers[0], pointing)
    return Parts(*together([each.weight for each in observation.alternatives], words, answers, asked), pointing)


def _answer_log_likelihood(utterance: Utterance, asked: int | None, problem: Problem, chances: StepChances) -> Vector:
    if utterance.meaning in EVASIONS and not utterance.response:
        return np.zeros(problem.n_items)
    return unigram.response_log_likelihood(utterance.response, asked, problem, chances)


def sample(desired: int, asked: int | None, problem: Problem, chances: StepChances, rng: Generator) -> Observation:
    """Draw an observation o ~ p(o | i_d, i_r). chances: of the step, see `Problem.step_chances`."""
    base = unigram.sample_base(desired, problem, chances.words, rng)
    response = unigram.sample_response(desired, asked, problem, chances, rng)
    return Observation(base + response, gesture.sample(desired, problem, chances, rng))


class Meant(NamedTuple):
    """What was most likely said, of all readings together."""

    words: bool  # whether words about the item
    answer: int  # see `turns`


def meant(observation: Observation, problem: Problem) -> Meant:
    """Return what was most likely said: of ten readings with the item's word, each may be less likely than one without.

    Of several responses in a reading the last counts.
    """
    words, answers = 0.0, [0.0] * 5
    for reading in observation.alternatives or (Alternative(observation.words, 1.0),):
        utterance = unigram.split(reading.words, problem)
        answer = EVASIONS.get(utterance.meaning, SILENT)
        if utterance.response:
            answer = YES if utterance.response[-1] in POSITIVE else NO
        answers[answer] += reading.weight
        words += reading.weight * bool(utterance.base)
    return Meant(words > 0.5, answers.index(max(answers)))


def phase_after(
    observation: Observation, action: Action, problem: Problem, phase: int = 0, *, asked: int | None
) -> int:
    """Return the phase (`turns`) that a step leads to which began with an action.

    asked: i_r in the step, for words that answer nothing change nothing. The paper's one phase stays.
    """
    if problem.model.turns is None:
        return phase
    heard = meant(observation, problem)
    seen = observation.ray is not None and gesture.is_pointing(observation.ray, problem)
    following = problem.tables.following[phase, int(not isinstance(action, Wait)), int(heard.words), int(seen)]
    return int(following[SILENT if asked is None else heard.answer])

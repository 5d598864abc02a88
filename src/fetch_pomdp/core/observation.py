"""What the robot perceives in one step: language and gesture, o = (l, g) (Eq. 1-3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
from fetch_pomdp.core.language.reading.reader import Heard
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


@dataclass(frozen=True, slots=True, eq=False)
class Said:
    """An utterance that was read: what kind of words there are, and what those about the item say of each.

    words: (n_items,), log p(l_b | i_d) up to a constant. heard: what a reader made of them, if one read them.
    """

    utterance: Utterance
    words: Vector
    heard: Heard | None = None


def said_in(words: tuple[str, ...], problem: Problem) -> Said:
    """Read an utterance as the paper does, word by word (Section III-C, Eq. 4, 5)."""
    utterance = unigram.split(words, problem)
    return Said(utterance, unigram.base_log_likelihood(utterance.base, problem))


def log_likelihoods(observation: Observation, asked: int | None, problem: Problem, chances: StepChances) -> Parts:
    """Log p(o | i_d, i_r) for each item as the desired one (Eq. 1-3), part by part: given the state they are
    independent.

    asked: index of i_r, or None. chances: of the step, see `Problem.step_chances`.
    """
    said = [said_in(each.words, problem) for each in readings(observation)]
    return parts_of(observation, said, asked, problem, chances)


def readings(observation: Observation) -> tuple[Alternative, ...]:
    """Return every reading of the words; the words themselves where they are certain."""
    return observation.alternatives or (Alternative(observation.words, 1.0),)


def parts_of(
    observation: Observation, said: Sequence[Said], asked: int | None, problem: Problem, chances: StepChances
) -> Parts:
    """Return the three factors of an observation from what each of its `readings` says.

    Choice: "I don't know" is neither an answer nor silence, and tells nothing.

    Alternatives are taken together as `alternatives` says.
    """
    answers = [_answer_log_likelihood(each.utterance, asked, problem, chances) for each in said]
    pointing = gesture.log_likelihood(observation.ray, problem, chances.width)
    if len(said) == 1:
        return Parts(said[0].words, answers[0], pointing)
    weights = [each.weight for each in readings(observation)]
    return Parts(*together(weights, [each.words for each in said], answers, asked), pointing)


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


def meant(observation: Observation, said: Sequence[Said]) -> Meant:
    """Return what was most likely said: of ten readings with the item's word, each may be less likely than one without.

    said: what each of its `readings` says. Of several responses in a reading the last counts.
    """
    words, answers = 0.0, [0.0] * 5
    for reading, each in zip(readings(observation), said, strict=True):
        utterance = each.utterance
        answer = EVASIONS.get(utterance.meaning, SILENT)
        if utterance.response:
            answer = YES if utterance.response[-1] in POSITIVE else NO
        answers[answer] += reading.weight
        words += reading.weight * bool(utterance.base)
    return Meant(words > 0.5, answers.index(max(answers)))


def phase_following(
    heard: Meant, ray: Ray | None, action: Action, problem: Problem, phase: int = 0, *, asked: int | None
) -> int:
    """Return the phase (`turns`) that a step leads to which began with an action.

    heard, ray: what was said and seen in it. asked: i_r in the step, for words that answer nothing change nothing. The
    paper's one phase stays.
    """
    if problem.model.turns is None:
        return phase
    seen = ray is not None and gesture.is_pointing(ray, problem)
    following = problem.tables.following[phase, int(not isinstance(action, Wait)), int(heard.words), int(seen)]
    return int(following[SILENT if asked is None else heard.answer])


def phase_after(
    observation: Observation, action: Action, problem: Problem, phase: int = 0, *, asked: int | None
) -> int:
    """Return `phase_following` of an observation whose words are read as in the paper."""
    if problem.model.turns is None:
        return phase
    heard = meant(observation, [said_in(each.words, problem) for each in readings(observation)])
    return phase_following(heard, observation.ray, action, problem, phase, asked=asked)

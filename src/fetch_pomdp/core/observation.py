"""What the robot perceives in one step: language and gesture, o = (l, g) (Eq. 1-3)."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core import gesture, language
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.problem import Problem


@dataclass(frozen=True, slots=True)
class Observation:
    """The words heard in a step, as `words.tokenize` gives them, and the pointing ray seen, if any."""

    words: tuple[str, ...] = ()
    ray: Ray | None = None


def log_likelihood(observation: Observation, asked: int | None, problem: Problem, rate: float) -> Vector:
    """Log p(o | i_d, i_r) for each item as the desired one (Eq. 1-3): its three parts are independent given the state.

    asked: index of i_r, or None. rate: chance of a response, see `language.answer_rate`. Returns (n_items,).
    """
    utterance = language.split(observation.words, problem)
    result = language.base_log_likelihood(utterance.base, problem)
    result += language.response_log_likelihood(utterance.response, asked, problem, rate)
    result += gesture.log_likelihood(observation.ray, problem)
    return result


def sample(desired: int, asked: int | None, problem: Problem, rate: float, rng: Generator) -> Observation:
    """Draw an observation o ~ p(o | i_d, i_r). rate: chance of a response, see `language.answer_rate`."""
    base = language.sample_base(desired, problem, rng)
    response = language.sample_response(desired, asked, problem, rate, rng)
    return Observation(base + response, gesture.sample(desired, problem, rng))

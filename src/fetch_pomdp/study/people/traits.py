"""One simulated person: what is constant over the person's trials, and what is constant within a trial."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from numpy.random import Generator

if TYPE_CHECKING:
    from fetch_pomdp.study.people.parameters import People

VOICES = 1 << 16  # a voice is a number below it


@dataclass(frozen=True, slots=True, kw_only=True)
class Traits:
    """What sets a person apart; all else is that of the population."""

    people: People
    word_time: float  # s
    patience: float  # s
    answer_delay: float  # s
    bias: tuple[float, float]  # rad, to the right and up
    p_place: float
    p_point: float
    p_answer: float
    p_flip: float
    p_miss: float  # at 1 m
    p_lost: float  # at 1 m
    voice: int  # which of the voices of a channel that speaks


@dataclass(frozen=True, slots=True, kw_only=True)
class Mood:
    """What is constant within a trial of a person, so that errors come back when the robot asks again."""

    p_flip: float
    p_miss: float  # at 1 m
    p_lost: float  # at 1 m
    reading: tuple[float, float]  # rad, to the right and up: how far off the robot's arm is always read


def draw(people: People, rng: Generator) -> Traits:
    """Draw a person of a population."""
    spread = people.rate_spread
    return Traits(
        people=people,
        word_time=people.word_time * log_normal(people.word_time_spread, rng),
        patience=people.patience * log_normal(people.patience_spread, rng),
        answer_delay=people.answer_delay * log_normal(people.answer_delay_spread, rng),
        bias=(people.bias * rng.standard_normal(), people.bias * rng.standard_normal()),
        p_place=shifted(people.p_place, spread * rng.standard_normal()),
        p_point=shifted(people.p_point, spread * rng.standard_normal()),
        p_answer=shifted(people.p_answer, spread * rng.standard_normal()),
        p_flip=shifted(people.p_flip, spread * rng.standard_normal()),
        p_miss=shifted(people.p_miss, spread * rng.standard_normal()),
        p_lost=shifted(people.p_lost, spread * rng.standard_normal()),
        voice=int(rng.integers(VOICES)),
    )


def draw_mood(traits: Traits, rng: Generator) -> Mood:
    """Draw a trial of a person."""
    people = traits.people
    size = people.reading * math.sqrt(people.reading_correlation)
    return Mood(
        p_flip=correlated(traits.p_flip, people.flip_correlation, rng),
        p_miss=correlated(traits.p_miss, people.miss_correlation, rng),
        p_lost=correlated(traits.p_lost, people.lost_correlation, rng),
        reading=(size * rng.standard_normal(), size * rng.standard_normal()),
    )


def log_normal(spread: float, rng: Generator) -> float:
    """Draw a factor with median 1 whose logarithm has standard deviation `spread`."""
    return math.exp(spread * rng.standard_normal())


def shifted(rate: float, shift: float) -> float:
    """Return a probability moved by `shift` on the scale of its logit; 0 and 1 stay."""
    if not 0.0 < rate < 1.0:
        return rate
    odds = rate / (1.0 - rate) * math.exp(shift)
    return odds / (1.0 + odds)


def correlated(rate: float, correlation: float, rng: Generator) -> float:
    """Draw a probability with mean `rate` such that two events of that probability have this correlation.

    A beta distribution: a + b = 1 / correlation - 1, so that its variance is correlation * rate * (1 - rate).
    """
    if correlation == 0.0 or not 0.0 < rate < 1.0:
        return rate
    if correlation == 1.0:
        return float(rng.random() < rate)
    size = 1.0 / correlation - 1.0
    return float(rng.beta(rate * size, (1.0 - rate) * size))

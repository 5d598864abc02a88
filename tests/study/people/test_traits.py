from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.people.traits import VOICES, correlated, draw_mood, shifted

from .plain import share, still, traits, within

COUNT = 4000
EVERYBODY = [People().traits(rng) for rng in [default_rng(5)] for _ in range(COUNT)]
RATES = ("p_place", "p_point", "p_answer", "p_flip", "p_miss", "p_lost")


@pytest.mark.parametrize("name", ["word_time", "patience", "answer_delay"])
def test_times_of_persons_are_log_normal_around_the_median(name: str) -> None:
    found = np.log([getattr(person, name) / getattr(People(), name) for person in EVERYBODY])
    spread = getattr(People(), f"{name}_spread")
    assert within(found.mean(), 0.0, spread, COUNT)
    assert within(np.square(found).mean(), spread**2, spread**2 * math.sqrt(2.0), COUNT)


@pytest.mark.parametrize("name", RATES)
def test_rates_of_persons_are_normal_on_the_scale_of_the_logit(name: str) -> None:
    rates = np.array([getattr(person, name) for person in EVERYBODY])
    middle, spread = getattr(People(), name), People().rate_spread
    found = np.log(rates / (1 - rates)) - math.log(middle / (1 - middle))
    assert within(found.mean(), 0.0, spread, COUNT)
    assert within(np.square(found).mean(), spread**2, spread**2 * math.sqrt(2.0), COUNT)


def test_biases_are_normal_in_each_axis_and_not_related() -> None:
    biases, size = np.array([person.bias for person in EVERYBODY]), People().bias
    for axis in (0, 1):
        assert within(biases[:, axis].mean(), 0.0, size, COUNT)
        assert within(np.square(biases[:, axis]).mean(), size**2, size**2 * math.sqrt(2.0), COUNT)
    assert within((biases[:, 0] * biases[:, 1]).mean(), 0.0, size**2, COUNT)


def test_voices_are_spread_over_all() -> None:
    assert within(float(np.mean([person.voice for person in EVERYBODY])), VOICES / 2, VOICES / math.sqrt(12), COUNT)


def test_without_spread_all_are_the_same() -> None:
    people = still(p_flip=0.1)
    one, other = people.traits(default_rng(1)), people.traits(default_rng(2))
    assert (one.word_time, one.patience, one.bias, one.p_flip) == (0.35, 7.0, (0.0, 0.0), 0.1)
    assert (other.word_time, other.patience, other.bias, other.p_flip) == (0.35, 7.0, (0.0, 0.0), 0.1)


def test_a_shift_by_the_logit_of_a_rate_makes_it_a_half() -> None:
    assert shifted(0.2, math.log(4.0)) == pytest.approx(0.5)
    assert shifted(0.5, math.log(3.0)) == pytest.approx(0.75)


@given(st.floats(0, 1), st.floats(-20, 20))
def test_a_shifted_rate_is_a_rate_and_moves_with_the_shift(rate: float, shift: float) -> None:
    assert 0.0 <= shifted(rate, shift) <= 1.0
    assert (shifted(rate, shift) - rate) * shift >= -1e-12


@pytest.mark.parametrize("correlation", [0.1, 0.6, 1.0])
def test_events_of_a_correlated_rate_have_its_mean_and_correlation(correlation: float) -> None:
    rng, rate, count = default_rng(3), 0.2, 20_000
    pairs = [rng.random(2) < correlated(rate, correlation, rng) for _ in range(count)]
    both = rate**2 + correlation * rate * (1 - rate)  # chance of two in a row
    assert share(float(np.mean([pair[0] for pair in pairs])), rate, count)
    assert share(float(np.mean([pair.all() for pair in pairs])), both, count)


@given(st.sampled_from([0.0, 0.3, 1.0]), st.floats(0, 1))
def test_no_correlation_or_certainty_leaves_a_rate(rate: float, correlation: float) -> None:
    assert correlated(rate, 0.0, default_rng(0)) == rate
    if rate != 0.3:
        assert correlated(rate, correlation, default_rng(0)) == rate


def test_the_common_part_of_misreading_has_its_share_of_the_variance() -> None:
    person, rng, count = traits(reading=0.02, reading_correlation=0.25), default_rng(6), 4000
    parts = np.array([draw_mood(person, rng).reading for _ in range(count)]).ravel()
    assert within(np.square(parts).mean(), 0.25 * 0.02**2, 0.25 * 0.02**2 * math.sqrt(2), 2 * count)

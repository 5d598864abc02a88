"""The model with finitely many observations: chances against hand-worked numbers, the sampler and rays drawn freely."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.discrete import ROLLS, Discrete, all_actions
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import StepChances
from fetch_pomdp.errors import ModelError, ObservationError, SceneError
from tests.oracles import rays
from tests.tables import live, table

CUPS = [["cup", "red", "mug"], ["cup", "blue"]]


def test_words_of_the_same_owners_are_one_class() -> None:
    model = Discrete(table(CUPS, p_g=0.0))
    assert model.word_classes == ((), ("blue",), ("cup",), ("mug", "red"))
    # 4 words in all: an own word has chance 0.95 * 1.2 / (3 + 0.8) for the first item, 0.95 * 1.2 / (2 + 0.8) for the
    # second, another's 0.95 * 0.2 over the same.
    assert model.words == pytest.approx(
        np.array([[0.05, 0.05, 0.3, 0.6], [0.05, 0.95 * 1.2 / 2.8, 0.95 * 1.2 / 2.8, 0.95 * 0.4 / 2.8]])
    )
    assert model.gestures.tolist() == [[1.0], [1.0]]


def test_answers_are_those_of_table_one() -> None:
    model = Discrete(table(CUPS, p_g=0.0, p_answer_again=0.5))
    assert model.responses(None, Point(0)) == pytest.approx(np.array([[0.05, 0.475, 0.475]] * 2))
    assert model.responses(0, Point(0)) == pytest.approx(np.array([[0.05, 0.9405, 0.0095], [0.05, 0.0095, 0.9405]]))
    assert model.responses(0, Wait()) == pytest.approx(np.array([[0.525, 0.47025, 0.00475], [0.525, 0.00475, 0.47025]]))
    assert model.likelihood(0, Wait()).shape == (2, 4, 3, 1)
    assert model.likelihood(0, Wait()).sum(axis=(1, 2, 3)) == pytest.approx(1.0)


def test_a_ray_around_the_only_item_misses_it_beyond_the_threshold() -> None:
    model = Discrete(table([["cup"]], p_g=0.4, sigma=0.2, gesture_threshold=0.3), rings=2)
    within = [math.erf(edge / 0.2 / math.sqrt(2)) for edge in (0.15, 0.3)]
    expected = [0.6 + 0.4 * (1 - within[1]), 0.4 * within[0], 0.4 * (within[1] - within[0])]
    assert model.gestures[0] == pytest.approx(expected, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.02, 0.15, 0.6])
@pytest.mark.parametrize("scene", ["ambiguous", "unambiguous"])
def test_gestures_against_rays_drawn_one_by_one(scene: str, sigma: float) -> None:
    data = Scene.load(scene)
    problem = Problem(Scene(items=data.items, head=data.head, model=data.model.with_changes({"sigma": sigma})))
    model, rng, draws = Discrete(problem, rings=2), np.random.default_rng(2), 100_000
    towards = rays.directions(data.head, [item.position for item in data.items])
    for item in (0, 3):
        angles = rays.angles(rays.draw(towards[item], sigma, draws, rng), towards)
        nearest, angle = angles.argmin(axis=1), angles.min(axis=1)
        classes = np.where(angle > 0.3, 0, 1 + 2 * nearest + (angle > 0.15))
        expected = 0.1 * np.bincount(classes, minlength=13) / draws
        expected[0] += 0.9
        error = 0.1 * np.sqrt(model.gestures[item] / draws) + 0.1 / ROLLS
        assert (np.abs(model.gestures[item] - expected) <= 4 * error).all()
        assert model.gestures[item].sum() == pytest.approx(1.0)


@pytest.mark.slow
def test_the_sampler_counted_in_classes() -> None:
    model: dict[str, Any] = {"p_g": 0.5, "p_truth": 0.8, "p_answer_again": 0.5}
    discrete = Discrete(table(CUPS, **model), rings=2)
    rng, draws = np.random.default_rng(3), 20_000
    counts, after_a_wait = np.zeros(discrete.n_classes), StepChances(0.95, 0.5, 0.95 * 0.5, 0.95 * 0.5)
    for _ in range(draws):
        counts[discrete.classify(observations.sample(1, 0, discrete.problem, after_a_wait, rng))] += 1
    chances = discrete.likelihood(0, Wait())[1]
    assert (np.abs(counts / draws - chances) <= 4 * np.sqrt(chances * (1 - chances) / draws) + 1e-3).all()


def test_what_is_classified() -> None:
    model = Discrete(table(CUPS, p_g=0.0))
    assert model.classify(Observation()) == (0, 0, 0)
    assert model.classify(Observation(("please", "red", "yup"))) == (3, 1, 0)
    assert model.classify(Observation(("nope",), Ray((0.0, 0.0, 1.6), (0.0, 1.0, 1.2)))) == (0, 2, 0)
    with pytest.raises(ObservationError, match=r"words: found .*'red', 'cup'.* expected at most one"):
        model.classify(Observation(("red", "cup")))
    with pytest.raises(ObservationError, match=r"responses: found .* expected at most one"):
        model.classify(Observation(("no", "other")))


@pytest.mark.parametrize("rings", [0, 17, 1.5, True])
def test_a_number_of_rings_that_is_none(rings: Any) -> None:
    with pytest.raises(ModelError, match=r"rings: found .*, expected a whole number from 1 to 16"):
        Discrete(table(CUPS, p_g=0.0), rings)


def test_live_people_are_refused() -> None:
    with pytest.raises(
        ModelError, match=r"^turns: found live people, expected none: the enumerated model knows [^\n]*$"
    ):
        Discrete(live(table(CUPS)))


def test_too_many_items() -> None:
    with pytest.raises(SceneError, match="items: found 201 items, expected at most 200"):
        Discrete(table([["cup"]] * 201))


def test_the_numbers_of_actions() -> None:
    assert all_actions(2) == (Wait(), Point(0), Point(1), Pick(0), Pick(1))

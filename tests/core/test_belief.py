"""The exact Bayes update (Eq. 1-3)."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import constant_chances
from fetch_pomdp.errors import BeliefError
from tests.oracles import model as oracle
from tests.tables import table, world_of

AMBIGUOUS = Problem(Scene.load("ambiguous"))
UNEQUAL = table([["cup"], ["cup", "mug", "tea"], ["pot", "tea"], ["pot"]])
EXACT = table([["cup"], ["cup", "mug", "tea"], ["pot", "tea"], ["pot"]], gesture_likelihood="exact")
WORDS = [*UNEQUAL.words, *oracle.YES_WORDS, *oracle.NO_WORDS, "please", "left"]

places = st.sampled_from([(0.5, 2.0, 0.75), (-0.6, 1.9, 0.8), (0.0, 2.0, 0.4), (0.0, -1.0, 2.0)])
rays = st.none() | places.map(lambda place: Ray((0.0, 0.0, 1.6), place))
observed = st.builds(Observation, st.lists(st.sampled_from(WORDS), max_size=4).map(tuple), rays)
asked_items = st.sampled_from([None, 0, 1, 2, 3])


def priors(count: int) -> st.SearchStrategy[list[float]]:
    """Distributions, some of whose items are impossible."""
    weights = st.lists(st.just(0.0) | st.floats(1e-6, 1.0), min_size=count, max_size=count)
    return weights.filter(lambda found: sum(found) > 0).map(lambda found: [x / sum(found) for x in found])


def test_hand_worked_update_from_a_word() -> None:
    # marker: 0.1875 against 0.03125, six to one: 6 / (6 + 6 + 4) for each marker, 1 / 16 for each other item.
    belief = Belief.uniform(6).updated(Observation(("marker",)), None, AMBIGUOUS)
    assert belief.probabilities == pytest.approx([1 / 16, 1 / 16, 6 / 16, 6 / 16, 1 / 16, 1 / 16], rel=1e-12)


def test_hand_worked_update_from_an_answer() -> None:
    # "no" about item 2: 0.01 against 0.99.
    belief = Belief([1 / 16, 1 / 16, 6 / 16, 6 / 16, 1 / 16, 1 / 16]).updated(Observation(("no",)), 2, AMBIGUOUS)
    total = 10 * 0.99 + 6 * 0.01
    assert belief.probabilities[2] == pytest.approx(6 * 0.01 / total, rel=1e-9)
    assert belief.probabilities[3] == pytest.approx(6 * 0.99 / total, rel=1e-9)


@given(prior=priors(4), observation=observed, asked=asked_items)
def test_against_the_oracle(prior: list[float], observation: Observation, asked: int | None) -> None:
    ray = None if observation.ray is None else (observation.ray.head, observation.ray.wrist)
    expected = oracle.posterior(prior, observation.words, ray, asked, world_of(UNEQUAL))
    found = Belief(prior).updated(observation, asked, UNEQUAL).probabilities
    assert found.tolist() == pytest.approx(expected, rel=1e-7, abs=1e-12)


@pytest.mark.parametrize("problem", [UNEQUAL, EXACT])
@given(seen=st.lists(observed, min_size=2, max_size=5), asked=asked_items, data=st.data())
def test_order_between_questions_does_not_matter(
    problem: Problem, seen: list[Observation], asked: int | None, data: st.DataObject
) -> None:
    first = second = Belief.uniform(4)
    for observation in seen:
        first = first.updated(observation, asked, problem)
    for observation in data.draw(st.permutations(seen)):
        second = second.updated(observation, asked, problem)
    assert first.probabilities == pytest.approx(second.probabilities, abs=1e-9)


@given(prior=priors(4), seen=st.lists(observed, max_size=5), asked=asked_items)
def test_stays_a_distribution_and_what_was_impossible_stays_so(
    prior: list[float], seen: list[Observation], asked: int | None
) -> None:
    belief = Belief(prior)
    for observation in seen:
        belief = belief.updated(observation, asked, EXACT)
    found = belief.probabilities
    assert found.sum() == pytest.approx(1.0, abs=1e-12)
    assert (found >= 0).all()
    assert all(after == 0 for before, after in zip(prior, found, strict=True) if before == 0)


@given(prior=priors(4), seen=st.lists(observed, max_size=4), asked=asked_items, order=st.permutations(range(4)))
def test_permuting_the_items_permutes_the_belief(
    prior: list[float], seen: list[Observation], asked: int | None, order: list[int]
) -> None:
    shuffled = Problem(dataclasses.replace(UNEQUAL.scene, items=tuple(UNEQUAL.scene.items[i] for i in order)))
    there, here = Belief([prior[i] for i in order]), Belief(prior)
    for observation in seen:
        there = there.updated(observation, None if asked is None else order.index(asked), shuffled)
        here = here.updated(observation, asked, UNEQUAL)
    assert there.probabilities == pytest.approx(here.probabilities[order], abs=1e-9)


@given(prior=priors(4), unknown=st.lists(st.sampled_from(["please", "left", "zebra"]), max_size=5))
def test_unknown_words_do_not_move_the_belief(prior: list[float], unknown: list[str]) -> None:
    moved = Belief(prior).updated(Observation(tuple(unknown)), 1, UNEQUAL)
    assert moved.probabilities == pytest.approx(prior, abs=1e-12)
    known = Belief(prior).updated(Observation(("tea",)), 1, UNEQUAL)
    mixed = Belief(prior).updated(Observation((*unknown, "tea", *unknown)), 1, UNEQUAL)
    assert mixed.probabilities == pytest.approx(known.probabilities, abs=1e-12)


@given(prior=priors(4), words=st.lists(st.sampled_from(oracle.YES_WORDS + oracle.NO_WORDS), max_size=4))
def test_answers_to_no_question_do_not_move_the_belief(prior: list[float], words: list[str]) -> None:
    assert Belief(prior).updated(Observation(tuple(words)), None, UNEQUAL).probabilities == pytest.approx(
        prior, abs=1e-12
    )


def test_silence_says_nothing_with_equation_seven() -> None:
    belief = Belief([0.1, 0.2, 0.3, 0.4])
    assert belief.updated(Observation(), 2, UNEQUAL).probabilities == pytest.approx([0.1, 0.2, 0.3, 0.4], abs=1e-12)


def test_a_thousand_contradictory_observations() -> None:
    belief = Belief.uniform(6)
    for step in range(1_000):
        word = ("marker", "bowl", "spoon")[step % 3]
        ray = Ray((0.0, 0.0, 1.6), AMBIGUOUS.scene.items[step % 6].position)
        belief = belief.updated(Observation((word, word, "yes", "no", "no"), ray), step % 6, AMBIGUOUS)
        assert belief.probabilities.sum() == pytest.approx(1.0, abs=1e-12)
    for _ in range(1_000):
        belief = belief.updated(Observation(("yes",) * 5), 0, AMBIGUOUS)
    assert belief.probabilities[0] == pytest.approx(1.0)
    for _ in range(2_000):
        belief = belief.updated(Observation(("yes",) * 5), 1, AMBIGUOUS)
    assert belief.probabilities[1] == pytest.approx(1.0), "evidence that outweighs what came before is heard"
    assert np.isfinite(belief.log_probabilities).all()


def test_an_observation_of_almost_no_chance_is_weighed_all_the_same() -> None:
    # 2,000 words have a chance of about exp(-4,000), far below the smallest float.
    found = Belief.uniform(6).updated(Observation(("marker", "bowl") * 1_000 + ("no",) * 500), 2, AMBIGUOUS)
    assert found.probabilities == pytest.approx([1 / 3, 1 / 3, 0.0, 1 / 3, 0.0, 0.0], abs=1e-9)
    narrow = table([["cup"], ["mug"]], sigma=0.001)
    ray = Ray((0.0, 0.0, 1.6), (0.0, 2.0, 0.75))  # halfway between the two
    assert Belief.uniform(2).updated(Observation((), ray), None, narrow).probabilities == pytest.approx(
        [0.5, 0.5], abs=1e-6
    )


def test_rate_of_answers_after_a_wait_does_not_change_how_words_are_read() -> None:
    again = table([["cup"], ["mug"]], p_answer_again=0.0)
    literal = table([["cup"], ["mug"]])
    for words in [("yes",), (), ("no", "cup")]:
        found = Belief([0.3, 0.7]).updated(Observation(words), 0, again).probabilities
        assert found == pytest.approx(Belief([0.3, 0.7]).updated(Observation(words), 0, literal).probabilities)


def test_impossible_evidence_names_the_observation_and_the_question() -> None:
    honest = table([["cup"], ["mug"]], p_truth=1.0)
    with pytest.raises(BeliefError, match=r"observation: found .*'yes'.* after a question about 'item-0', expected"):
        Belief([0.0, 1.0]).updated(Observation(("yes",)), 0, honest)
    with pytest.raises(BeliefError, match="'no'"):
        Belief([1.0, 0.0]).updated(Observation(("no",)), 0, honest)
    with pytest.raises(BeliefError, match="'yes', 'no'"):
        Belief.uniform(2).updated(Observation(("yes", "no")), 0, honest)


def test_a_belief_does_not_change() -> None:
    belief = Belief([0.25, 0.75])
    belief.updated(Observation(("cup",)), None, table([["cup"], ["mug"]]))
    assert belief.probabilities == pytest.approx([0.25, 0.75])
    with pytest.raises(ValueError, match="read-only"):
        belief.log_probabilities[0] = 0.0
    handed_out = belief.probabilities
    handed_out[0] = 9.0
    assert belief.probabilities == pytest.approx([0.25, 0.75])


@pytest.mark.parametrize(
    "prior",
    [
        [],
        [0.5, 0.6],
        [0.5, 0.4],
        [-0.1, 1.1],
        [math.nan, 1.0],
        [math.inf, 0.0],
        [[0.5, 0.5]],
        "ab",
        None,
        [None, 1],
        1.0,
        ["a"],
    ],
)
def test_priors_that_are_none(prior: Any) -> None:
    with pytest.raises(BeliefError, match=r"^belief: found"):
        Belief(prior)


def test_a_prior_is_normalised_within_its_tolerance() -> None:
    assert Belief([0.5, 0.5 + 5e-7]).probabilities.sum() == pytest.approx(1.0, abs=1e-15)
    with pytest.raises(BeliefError, match="expected 1"):
        Belief([0.5, 0.5 + 2e-6])


@pytest.mark.parametrize("asked", [None, 1])
def test_parts_of_an_observation_are_independent(asked: int | None) -> None:
    ray = Ray((0.0, 0.0, 1.6), (0.5, 2.0, 0.75))
    seen, chances = Observation(("tea", "no"), ray), constant_chances(0.4, 0.1)
    found = observations.log_likelihoods(seen, asked, UNEQUAL, chances).together()
    world = world_of(UNEQUAL)
    for item in range(4):
        expected = oracle.base_chance(["tea"], item, world) * oracle.response_chance(["no"], item, asked, world, 0.4)
        expected *= oracle.gesture_density(ray.head, ray.wrist, item, world)
        assert math.exp(found[item]) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("items", [0, -1, True, 2.0, "six", None])
def test_a_uniform_belief_has_an_item_or_more(items: Any) -> None:
    with pytest.raises(BeliefError, match=f"^n_items: found {items!r}, expected a whole number from 1 to "):
        Belief.uniform(items)


@pytest.mark.parametrize(
    "prior",
    [
        [0.5, 0.5],
        (0.5, 0.5),
        np.array([0.5, 0.5]),
        np.array([0.5, 0.5], dtype=np.float32),
        [np.float32(0.5), np.float64(0.5)],
    ],
)
def test_a_prior_is_a_list_or_an_array(prior: Any) -> None:
    assert Belief(prior).probabilities.tolist() == [0.5, 0.5]
    assert Belief(np.array([0, 1])).probabilities.tolist() == [0.0, 1.0]
    assert Belief.uniform(np.int64(2)).probabilities.tolist() == [0.5, 0.5]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "prior",
    [
        np.array([0.5 + 0j, 0.5]),
        [0.5 + 0.5j, 0.5],
        [True, False],
        [np.True_, 0.0],
        np.array([True, False]),
        ["0.5", "0.5"],
        [[0.5], [0.5, 0.1]],
        None,
        "half",
        {0.5: 0.5},
    ],
)
def test_a_prior_of_no_real_numbers_is_refused(prior: Any) -> None:
    with pytest.raises(BeliefError, match=r"^belief: found .+, expected a list of probabilities, one an item$"):
        Belief(prior)

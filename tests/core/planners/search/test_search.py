"""Both searches, and the leaf of ours, against exact enumeration."""

from __future__ import annotations

import dataclasses
import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Decision, Planner
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling, default_width
from fetch_pomdp.core.problem import Problem
from tests.oracles import asking
from tests.oracles.value import Values, action_values, after, pick_leaf, value
from tests.tables import table, twins, world_of

BELIEFS = [
    [1 / 3, 1 / 3, 1 / 3],
    [0.7, 0.2, 0.1],
    [0.05, 0.5, 0.45],
    [0.0, 0.5, 0.5],
    [0.0, 0.0, 1.0],
    [0.9, 0.05, 0.05],
]


def decided(planner: Planner, problem: Problem, belief: list[float], asked: int | None, seed: int = 0) -> Decision:
    return planner.decide(problem, Belief(belief), asked, rng=np.random.default_rng(seed))


def assert_equal(found: Decision, expected: Values) -> None:
    assert found.wait == pytest.approx(expected.wait, abs=1e-9)
    assert found.point.tolist() == pytest.approx(expected.point, abs=1e-9)
    assert found.pick.tolist() == pytest.approx(expected.pick, abs=1e-9)
    assert found.value == pytest.approx(expected.best, abs=1e-9)


# Three twins and nobody who points: one sample of words is as good as all, so width 1 must be exact.


@pytest.mark.parametrize("depth", [2, 3, 4])
@pytest.mark.parametrize("again", [1.0, 0.5, 0.0])
@pytest.mark.parametrize("asked", [None, 0, 1, 2])
def test_exact_answers_equals_enumeration(depth: int, again: float, asked: int | None) -> None:
    problem = twins(3, p_answer_again=again)
    for belief in BELIEFS if depth < 4 else BELIEFS[1:3]:
        found = decided(ExactAnswers(depth=depth, width=1, leaf="pick"), problem, belief, asked)
        assert_equal(found, action_values(belief, asked, depth, world_of(problem)))


@pytest.mark.parametrize("depth", [2, 3])
@pytest.mark.parametrize("again", [1.0, 0.5, 0.0])
@pytest.mark.parametrize("asked", [None, 0, 1, 2])
@pytest.mark.parametrize("person", [{"p_l": 0.95, "p_truth": 0.99}, {"p_l": 0.6, "p_truth": 0.9}])
def test_exact_answers_with_leaf_question_equals_enumeration(
    depth: int, again: float, asked: int | None, person: dict[str, float]
) -> None:
    problem = twins(3, p_answer_again=again, **person)
    for belief in BELIEFS if depth < 3 else BELIEFS[1:3]:
        found = decided(ExactAnswers(depth=depth, width=1, leaf="question"), problem, belief, asked)
        assert_equal(found, action_values(belief, asked, depth, world_of(problem), asking.question_leaf))


@pytest.mark.parametrize(
    "planner", [ExactAnswers(depth=1, leaf="pick"), SparseSampling(depth=1), PaperNeverAsk(depth=1)]
)
@pytest.mark.parametrize("asked", [None, 0])
def test_one_action_is_the_best_pick_or_a_wait(planner: Planner, asked: int | None) -> None:
    for belief in BELIEFS:
        found = decided(planner, twins(3), belief, asked)
        assert found.value == pytest.approx(pick_leaf(belief, asked, world_of(twins(3))), abs=1e-12)
        assert found.wait == -1.0


@pytest.mark.parametrize("width", [1, 3, 10])
def test_width_changes_nothing_where_nothing_is_sampled(width: int) -> None:
    found = decided(ExactAnswers(depth=3, width=width, leaf="pick"), twins(3), [0.5, 0.3, 0.2], 1)
    assert_equal(found, action_values([0.5, 0.3, 0.2], 1, 3, world_of(twins(3))))
    assert found.wait_error == pytest.approx(0.0, abs=1e-6)


ANCHOR = [-1.0, -2.0, -0.9030170833333, -0.4792829583333, -0.4437128364583]  # depths 1 to 5


def test_anchor() -> None:
    """Exact values of three twins at the uniform belief, published in the docs.

    Depth 1: a pick is worth 10 / 3 - 12.5 * 2 / 3 = -5 and a wait -1, so -1.
    Depth 2: a wait, then -1: -2. (A question is worth less: -6 + 0.95 * (0.3367 * 9.5545 - 0.6633) - 0.05 = -3.6243.)
    """
    uniform = [1 / 3, 1 / 3, 1 / 3]
    world = world_of(twins(3))
    exact = [value(uniform, None, depth, world) for depth in range(1, 6)]
    assert exact == pytest.approx(ANCHOR, abs=1e-9)
    for depth in range(1, 6):
        found = decided(ExactAnswers(depth=depth, width=1, leaf="pick"), twins(3), uniform, None)
        assert found.value == pytest.approx(ANCHOR[depth - 1], abs=1e-9)
    assert action_values(uniform, None, 2, world).point[0] == pytest.approx(-3.62433, abs=1e-5)


@given(
    weights=st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3).filter(lambda found: sum(found) > 0.01),
    asked=st.sampled_from([None, 0, 1, 2]),
    again=st.floats(0.0, 1.0),
    p_truth=st.floats(0.5, 1.0),
)
@settings(max_examples=60)
def test_exact_answers_equals_enumeration_anywhere(
    weights: list[float], asked: int | None, again: float, p_truth: float
) -> None:
    belief = [weight / sum(weights) for weight in weights]
    problem = twins(3, p_answer_again=again, p_truth=p_truth)
    found = decided(ExactAnswers(depth=3, width=1, leaf="pick"), problem, belief, asked)
    expected = action_values(belief, asked, 3, world_of(problem))
    assert found.wait == pytest.approx(expected.wait, abs=1e-8)
    assert found.point.tolist() == pytest.approx(expected.point, abs=1e-8)


PRICES = [
    {"wait": -0.3, "point": -2.0},
    {"wait": 0.0, "point": 0.0},
    {"pick_correct": 3.0, "pick_wrong": -40.0, "point": -1.0},
]


@pytest.mark.parametrize("prices", PRICES)
@pytest.mark.parametrize("asked", [None, 1])
def test_prices_are_those_of_the_scene(prices: dict[str, float], asked: int | None) -> None:
    plain = twins(3, p_answer_again=0.5, p_truth=0.9)
    problem = Problem(dataclasses.replace(plain.scene, rewards=plain.rewards.with_changes(prices)))
    world = world_of(problem)
    for belief in BELIEFS:
        found = decided(ExactAnswers(depth=3, width=1, leaf="pick"), problem, belief, asked)
        assert_equal(found, action_values(belief, asked, 3, world))
        found = decided(ExactAnswers(depth=2, width=1), problem, belief, asked)
        assert_equal(found, action_values(belief, asked, 2, world, asking.question_leaf))
        found = decided(ExactAnswers(depth=1), problem, belief, asked)
        assert found.value == pytest.approx(asking.question_leaf(belief, asked, world), abs=1e-9)
        found = decided(ExactAnswers(depth=1, leaf="pick"), problem, belief, asked)
        assert found.value == pytest.approx(pick_leaf(belief, asked, world), abs=1e-9)
        assert_within_errors(
            decided(SparseSampling(depth=2, width=2_000), problem, belief, asked),
            action_values(belief, asked, 2, world),
        )


# SparseSampling draws answers too: large widths come close.


@pytest.mark.slow
@pytest.mark.parametrize("again", [1.0, 0.5, 0.0])
@pytest.mark.parametrize("asked", [None, 0, 2])
def test_sparse_sampling_of_large_width_nears_enumeration(again: float, asked: int | None) -> None:
    problem = twins(3, p_answer_again=again, p_truth=0.9)
    for belief in BELIEFS[:4]:
        found = decided(SparseSampling(depth=2, width=20_000), problem, belief, asked)
        assert_within_errors(found, action_values(belief, asked, 2, world_of(problem)))


@pytest.mark.slow
@pytest.mark.parametrize("asked", [None, 1])
def test_sparse_sampling_of_three_actions_nears_enumeration(asked: int | None) -> None:
    found = decided(SparseSampling(depth=3, width=500), twins(3, p_answer_again=0.5), [0.5, 0.3, 0.2], asked)
    expected = action_values([0.5, 0.3, 0.2], asked, 3, world_of(twins(3, p_answer_again=0.5)))
    assert found.wait == pytest.approx(expected.wait, abs=0.25)
    assert found.point.tolist() == pytest.approx(expected.point, abs=0.25)


@pytest.mark.parametrize("depth", [2, 3, 4])
@pytest.mark.parametrize("asked", [None, 0, 2])
def test_sparse_sampling_is_exact_where_evenly_spread_draws_are(depth: int, asked: int | None) -> None:
    """Certain and truthful answers depend on the desired item alone, and twelve even draws hold each item's share."""
    problem = twins(3, p_l=1 - 1e-9, p_truth=1.0)
    found = decided(SparseSampling(depth=depth, width=12), problem, [0.5, 0.25, 0.25], asked)
    expected = action_values([0.5, 0.25, 0.25], asked, depth, world_of(problem))
    assert found.wait == pytest.approx(expected.wait, abs=1e-6)
    assert found.point.tolist() == pytest.approx(expected.point, abs=1e-6)


# A problem where words do matter, small enough to enumerate.

WORDY = [
    table([["cup", "red"], ["cup"]], p_g=0.0, alpha=0.3),
    table([["cup"], ["mug"]], p_g=0.0, alpha=1.0, p_l=0.6, p_answer_again=0.4, p_truth=0.8),
]


def assert_within_errors(found: Decision, expected: Values) -> None:
    assert found.point_error is not None
    assert abs(found.wait - expected.wait) <= 4 * found.wait_error + 1e-9
    assert np.all(np.abs(found.point - np.array(expected.point)) <= 4 * found.point_error + 1e-9)
    assert found.wait_error < 0.5
    assert found.pick.tolist() == pytest.approx(expected.pick)


@pytest.mark.slow
@pytest.mark.parametrize("problem", WORDY)
@pytest.mark.parametrize("asked", [None, 0, 1])
@pytest.mark.parametrize("belief", [[0.5, 0.5], [0.75, 0.25], [0.1, 0.9]])
def test_searches_near_enumeration_where_words_matter(problem: Problem, asked: int | None, belief: list[float]) -> None:
    expected = action_values(belief, asked, 2, world_of(problem))
    assert_within_errors(decided(SparseSampling(depth=2, width=20_000), problem, belief, asked), expected)
    assert_within_errors(decided(ExactAnswers(depth=2, width=20_000, leaf="pick"), problem, belief, asked), expected)
    patient = action_values(belief, asked, 2, world_of(problem), asking.question_leaf)
    assert_within_errors(decided(ExactAnswers(depth=2, width=20_000), problem, belief, asked), patient)
    silent = decided(PaperNeverAsk(depth=2, width=20_000), problem, belief, asked)
    assert abs(silent.wait - expected.wait) <= 4 * silent.wait_error + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("problem", WORDY)
def test_searches_of_three_actions_near_enumeration_where_words_matter(problem: Problem) -> None:
    expected = action_values([0.6, 0.4], None, 3, world_of(problem))
    for planner in (SparseSampling(depth=3, width=400), ExactAnswers(depth=3, width=400, leaf="pick")):
        found = decided(planner, problem, [0.6, 0.4], None)
        assert found.wait == pytest.approx(expected.wait, abs=0.3)
        assert found.point.tolist() == pytest.approx(expected.point, abs=0.3)


@pytest.mark.slow
def test_never_ask_is_worth_what_waiting_alone_is() -> None:
    """Without questions, waiting twice and picking: enumerated by pricing questions out of the oracle."""
    problem = WORDY[0]
    world = world_of(problem)

    def waiting(belief: list[float], left: int) -> float:
        best = pick_leaf(belief, None, world)
        return best if left == 1 else max(best, wait_value(belief, left))

    def wait_value(belief: list[float], left: int) -> float:
        return -1 + sum(chance * waiting(following, left - 1) for chance, following in after(belief, None, 0.95, world))

    found = decided(PaperNeverAsk(depth=3, width=700), problem, [0.5, 0.5], None)
    assert found.wait == pytest.approx(wait_value([0.5, 0.5], 3), abs=0.3)
    assert np.isnan(found.point).all()


# Leaf `question` itself.

LEAF_WORLDS = [
    {},
    {"p_answer_again": 0.5},
    {"p_answer_again": 0.0},
    {"p_l": 0.3, "p_truth": 0.8},
    {"p_l": 0.3, "p_truth": 0.8, "p_answer_again": 0.1},
]


@pytest.mark.parametrize("parameters", LEAF_WORLDS)
@pytest.mark.parametrize("asked", [None, 0, 1, 2])
def test_leaf_question_is_the_value_of_its_policies(parameters: dict[str, float], asked: int | None) -> None:
    problem = twins(3, **parameters)
    world = world_of(problem)
    for belief in BELIEFS:
        found = decided(ExactAnswers(depth=1), problem, belief, asked)
        assert found.value == pytest.approx(asking.question_leaf(belief, asked, world), abs=1e-9)
        expected = [asking.asked_now(belief, item, world) for item in range(3)]
        assert found.point.tolist() == pytest.approx(expected, abs=1e-9)
        waited = -1.0 if asked is None else max(-1.0, asking.waited_out(belief, asked, world))
        assert found.wait == pytest.approx(waited, abs=1e-9)


def test_leaf_question_by_the_formula_of_the_issue() -> None:
    # 22.5 * 0.99 * (b1 + b2) - 18.55, with an answer in 1 / 0.95 steps and the first of them paid by the question.
    found = decided(ExactAnswers(depth=1), twins(3), [0.5, 0.4, 0.1], None)
    assert found.point[0] == pytest.approx(22.5 * 0.99 * 0.9 - 18.55, abs=5e-3)


@pytest.mark.parametrize(("again", "patient"), [(1.0, True), (0.5, True), (0.0, False)])
def test_leaf_question_by_playing_its_policy(again: float, patient: bool) -> None:
    problem = twins(3, p_answer_again=again, p_l=0.7, p_truth=0.9)
    belief, draws, rng = [0.5, 0.4, 0.1], 40_000, random.Random(0)
    played = [asking.play_question(belief, 0, patient, world_of(problem), rng) for _ in range(draws)]
    found = decided(ExactAnswers(depth=1), problem, belief, None)
    assert abs(found.point[0] - np.mean(played)) <= 4 * np.std(played) / math.sqrt(draws)


def test_default_width_is_fixed_by_the_number_of_items() -> None:
    assert [default_width(count) for count in (1, 6, 10_000, 20_000, 100_000)] == [80, 80, 50, 25, 5]

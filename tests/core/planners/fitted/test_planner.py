"""The default planner: near the optimum, and honest about its values."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import action_of, code_of, decide_many
from fetch_pomdp.core.planners.fitted.ahead import MOST_ASKED, candidates
from fetch_pomdp.core.planners.fitted.planner import MOST_FITTED, FittedValue, solution
from fetch_pomdp.core.planners.fitted.table import ROWS
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.planners.thresholds import Threshold, tuned
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import simulate
from fetch_pomdp.errors import PlannerError
from tests.core.planners.alone import decided_alone
from tests.tables import table, twins

AMBIGUOUS = Problem(Scene.load("ambiguous"))


def exact_rays(problem: Problem) -> Problem:
    model = problem.model.with_changes({"gesture_likelihood": "exact"})
    return Problem(dataclasses.replace(problem.scene, model=model))


def lattice_value(count: int, p_l: float, p_truth: float) -> float:
    """The value of twins where only answers tell, by value iteration over how often each was confirmed or denied.

    Two twins suffice: the state is the log-odds of the first, in answers, and whether one was asked.
    """
    assert count == 2
    most = 12
    odds = math.log(p_truth / (1 - p_truth))
    chance = {k: 1 / (1 + math.exp(-odds * k)) for k in range(-most, most + 1)}
    value = {(k, asked): 10.0 for k in chance for asked in (False, True)}
    for _ in range(400):
        fresh = {}
        for k, asked in value:
            pick = 22.5 * max(chance[k], 1 - chance[k]) - 12.5
            yes = chance[k] * p_truth + (1 - chance[k]) * (1 - p_truth)
            answer = (1 - p_l) * value[k, True] + p_l * (
                yes * value[min(k + 1, most), True] + (1 - yes) * value[max(k - 1, -most), True]
            )
            fresh[k, asked] = max(pick, -1 + (answer if asked else value[k, False]), -6 + answer)
        value = fresh
    return value[0, False]


@pytest.mark.slow
@pytest.mark.parametrize(("p_l", "p_truth"), [(0.95, 0.99), (0.6, 0.9), (0.8, 0.7)])
def test_the_value_of_two_twins_is_that_of_plain_value_iteration(p_l: float, p_truth: float) -> None:
    problem = twins(2, p_l=p_l, p_truth=p_truth)
    decision = FittedValue().decide(problem, Belief.uniform(2), None, rng=default_rng(0))
    # A quarter of a wait: the table is bilinear between entries.
    assert max(decision.value, decision.pick.max()) == pytest.approx(lattice_value(2, p_l, p_truth), abs=0.25)


@pytest.mark.slow
@pytest.mark.parametrize("problem", [exact_rays(AMBIGUOUS), exact_rays(Problem(Scene.load("unambiguous")))])
def test_the_value_is_that_of_its_own_rollouts(problem: Problem) -> None:
    """The fault of earlier tries: values that over-rate going on, and policies that run to the end."""
    decision = FittedValue().decide(problem, Belief.uniform(6), None, rng=default_rng(0))
    played = simulate(problem, FittedValue(), 30_000, 1)
    assert decision.value == pytest.approx(played.mean_return, abs=0.2 + 3 * played.standard_error)
    assert played.mean_steps < 6


@pytest.mark.slow
def test_it_does_not_wait_for_ever_between_twins() -> None:
    """An answered question about a third item tells nothing of two twins that lead: waiting is worth no more for it."""
    belief = [0.0, 0.0, 0.0, 0.0, 0.62, 0.38]
    decision = FittedValue().decide(AMBIGUOUS, Belief(belief), 0, rng=default_rng(0))
    assert isinstance(decision.action, Point)
    fresh = FittedValue().decide(AMBIGUOUS, Belief(belief), None, rng=default_rng(0))
    assert decision.wait == pytest.approx(fresh.wait, abs=0.5)


@pytest.mark.slow
@pytest.mark.parametrize("asked", [None, 0, 2, 4])
def test_permuting_items_permutes_values(asked: int | None) -> None:
    """Without pointing nothing is sampled, so that values agree to the last digits."""
    vocabularies = [["cup", "red"], ["cup", "blue"], ["pot"], ["pot", "red"], ["mug"]]
    order = [3, 0, 4, 1, 2]
    here = table(vocabularies, p_g=0.0)
    belief = np.array([0.35, 0.3, 0.2, 0.1, 0.05])
    places = [here.scene.items[item].position for item in order]
    there = table([vocabularies[item] for item in order], places, p_g=0.0)
    tables = [solution(problem, FittedValue()).table.values for problem in (here, there)]
    first = FittedValue().decide(here, Belief(belief), asked, rng=default_rng(0))
    second = FittedValue().decide(there, Belief(belief[order]), None if asked is None else order.index(asked),
                                  rng=default_rng(0))  # fmt: skip
    # The fits met other people, drawn in the other order of items.
    noise = 3 * float(np.abs(tables[0] - tables[1])[:, ROWS // 4 :].mean()) + 0.05
    assert second.point == pytest.approx(first.point[order], abs=noise)
    assert second.wait == pytest.approx(first.wait, abs=noise)


def test_permuting_twins_that_stand_together_permutes_values_exactly() -> None:
    problem = twins(3)
    belief, order = np.array([0.5, 0.2, 0.3]), [2, 0, 1]
    first = FittedValue().decide(problem, Belief(belief), 1, rng=default_rng(0))
    second = FittedValue().decide(problem, Belief(belief[order]), order.index(1), rng=default_rng(0))
    assert second.point == pytest.approx(first.point[order], abs=1e-9)
    assert second.wait == pytest.approx(first.wait, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("asked", [None, 1])
@pytest.mark.parametrize("seed", range(3))
def test_information_never_lowers_the_value(asked: int | None, seed: int) -> None:
    """The value of a belief is at most the mean value of what an observation makes of it (exact likelihood)."""
    problem = exact_rays(AMBIGUOUS)
    belief = default_rng(seed).dirichlet(np.ones(6))
    planner = FittedValue(rays=400)

    def value(b: np.ndarray) -> float:
        decision = planner.decide(problem, Belief(b), asked, rng=default_rng(0))
        return float(max(decision.wait, np.nanmax(decision.point), decision.pick.max()))

    now = value(belief)
    wait = planner.decide(problem, Belief(belief), asked, rng=default_rng(0)).wait
    # A wait's value is its price and the mean value of the beliefs after it.
    assert wait - problem.rewards.wait >= now - 0.15


@pytest.mark.slow
@pytest.mark.parametrize("problem", [AMBIGUOUS, exact_rays(AMBIGUOUS), twins(3), table([["cup"]])])
def test_many_decisions_are_those_one_by_one(problem: Problem) -> None:
    count = problem.n_items
    beliefs = default_rng(0).dirichlet(np.full(count, 0.4), 700)
    beliefs = np.exp(np.array([Belief(belief).log_probabilities for belief in beliefs]))
    asked = default_rng(1).integers(-1, count, 700)
    for planner in (FittedValue(), Threshold(), SparseSampling(2, 3), ExactAnswers(2, 3)):
        together = decide_many(planner, problem, beliefs, asked, rng=default_rng(5))
        assert together.tolist() == decided_alone(planner, problem, beliefs, asked, seed=5)
        assert len({*together.tolist()}) > 1 or count == 1


def test_actions_as_numbers() -> None:
    for code, action in [(-1, Wait()), (0, Point(0)), (5, Point(5)), (6, Pick(0)), (11, Pick(5))]:
        assert action_of(code, AMBIGUOUS) == action
        assert code_of(action, AMBIGUOUS) == code


def test_arrays_of_another_table_are_refused() -> None:
    with pytest.raises(PlannerError, match=r"beliefs: found shapes"):
        decide_many(FittedValue(), AMBIGUOUS, np.ones((2, 5)) / 5, np.array([-1, 0]), rng=default_rng(0))
    with pytest.raises(PlannerError, match=r"asked: found -1 to 6, expected -1 to 5"):
        decide_many(FittedValue(), AMBIGUOUS, np.ones((2, 6)) / 6, np.array([-1, 6]), rng=default_rng(0))
    with pytest.raises(PlannerError, match="belief: found a belief over"):
        FittedValue().decide(AMBIGUOUS, Belief.uniform(5), None, rng=default_rng(0))


def test_the_same_scene_is_solved_once_and_alike() -> None:
    planner = FittedValue(beliefs=500)
    one, other = Problem(AMBIGUOUS.scene), Problem(AMBIGUOUS.scene)
    assert solution(one, planner).table is solution(other, planner).table
    assert solution(one, FittedValue(beliefs=500, rays=2)).table is solution(one, planner).table
    again = FittedValue(beliefs=500, seed=1)
    assert not np.array_equal(solution(one, planner).table.values, solution(one, again).table.values)


def test_stated_errors_are_those_found() -> None:
    belief = Belief([0.02, 0.02, 0.55, 0.35, 0.03, 0.03])
    planner = FittedValue()
    decisions = [planner.decide(AMBIGUOUS, belief, 2, rng=default_rng(seed)) for seed in range(400)]
    stated, found = np.mean([d.wait_error for d in decisions]), np.std([d.wait for d in decisions])
    assert 0.3 * stated < found < 1.2 * stated
    exact = planner.decide(twins(3), Belief.uniform(3), None, rng=default_rng(0))
    assert exact.wait_error == 0.0
    assert exact.point_error is not None
    assert not exact.point_error.any()


def test_leading_items_are_asked_about_and_no_others() -> None:
    problem = table([["cup", f"w{index % 4}"] for index in range(12)])
    belief = default_rng(2).dirichlet(np.ones(12))
    decision = FittedValue(beliefs=500).decide(problem, Belief(belief), None, rng=default_rng(0))
    leading = np.argsort(-belief)[:MOST_ASKED]
    assert sorted(np.flatnonzero(np.isfinite(decision.point))) == sorted(leading)
    assert candidates(belief).tolist() == leading.tolist()
    assert candidates(np.array([0.25, 0.5, 0.25])).tolist() == [1, 0, 2]  # of equals the first in the scene


def test_large_tables_are_left_to_the_closed_form() -> None:
    problem = table(
        [[f"w{index}"] for index in range(MOST_FITTED + 1)], [(0.01 * i, 2.0, 0.75) for i in range(MOST_FITTED + 1)]
    )
    belief = Belief.uniform(problem.n_items)
    ours = FittedValue().decide(problem, belief, None, rng=default_rng(3))
    theirs = ExactAnswers().decide(problem, belief, None, rng=default_rng(3))
    assert ours.action == theirs.action
    assert ours.point == pytest.approx(theirs.point)
    FittedValue().prepare(problem)
    beliefs = np.full((2, problem.n_items), 1 / problem.n_items)
    assert decide_many(FittedValue(), problem, beliefs, np.array([-1, 3]), rng=default_rng(0)).shape == (2,)


@pytest.mark.slow
@pytest.mark.long  # what runs always is `test_default_planner_earns_at_least`, on 40,000 people
@pytest.mark.parametrize(
    ("layout", "likelihood", "least"),
    [
        ("ambiguous", "eq7", -0.27),
        ("unambiguous", "eq7", 1.76),
        ("ambiguous", "exact", -0.12),
        ("unambiguous", "exact", 1.87),
    ],
)
def test_returns_on_the_scenes_of_the_study(layout: str, likelihood: str, least: float) -> None:
    scene = Scene.load(layout)
    model = scene.model.with_changes({"gesture_likelihood": likelihood})
    problem = Problem(dataclasses.replace(scene, model=model))
    found = simulate(problem, FittedValue(), 100_000, 11)
    assert found.mean_return >= least - 2 * found.standard_error


@pytest.mark.slow
@pytest.mark.parametrize("p_g", [0.0, 0.3])
def test_never_worse_than_thresholds_the_papers_search_or_picking_at_once(p_g: float) -> None:
    problem = table(
        [["cup", "red"], ["cup", "red"], ["cup", "blue"], ["pot"]], p_g=p_g, p_l=0.7, gesture_likelihood="exact"
    )
    ours = simulate(problem, FittedValue(), 20_000, 3)
    for rival, episodes in ((tuned(problem, 5), 20_000), (SparseSampling(), 4_000), (Threshold(0.0), 1_000)):
        theirs = simulate(problem, rival, episodes, 3)
        assert ours.mean_return >= theirs.mean_return - 3 * math.hypot(ours.standard_error, theirs.standard_error)


def test_more_passes_less_error_and_the_same_whatever_the_calls() -> None:
    belief = Belief([0.02, 0.02, 0.55, 0.35, 0.03, 0.03])
    few, many = (FittedValue(passes=n).decide(AMBIGUOUS, belief, 2, rng=default_rng(0)) for n in (4, 400))
    assert 7 < few.wait_error / many.wait_error < 14  # ten times less
    assert abs(few.wait - many.wait) < 4 * few.wait_error


@pytest.mark.slow
def test_a_budget_refines_where_actions_are_close_and_replays_without_a_clock() -> None:
    close, planner = None, FittedValue(budget_ms=20.0)
    for seed in range(60):
        belief = Belief(default_rng(seed).dirichlet(np.full(6, 0.5)))
        decision = planner.decide(AMBIGUOUS, belief, None, rng=default_rng(seed))
        plain = FittedValue().decide(AMBIGUOUS, belief, None, rng=default_rng(seed))
        assert plain.passes is None
        assert decision.passes is not None
        again = planner.with_passes(decision.passes).decide(AMBIGUOUS, belief, None, rng=default_rng(seed))
        assert again.action == decision.action
        assert (again.wait, again.wait_error) == (decision.wait, decision.wait_error)
        assert np.array_equal(again.point, decision.point, equal_nan=True)
        if decision.passes == 1:
            assert plain.wait == decision.wait
        else:
            close = decision
            assert decision.wait_error < plain.wait_error
    assert close is not None


def test_a_budget_leaves_at_least_one_pass() -> None:
    planner = FittedValue(budget_ms=0.0)
    planner.prepare(twins(3))
    decision = planner.decide(twins(3), Belief([0.5, 0.3, 0.2]), None, rng=default_rng(0))
    assert decision.passes == 1
    assert decision.wait == FittedValue().decide(twins(3), Belief([0.5, 0.3, 0.2]), None, rng=default_rng(0)).wait
    assert planner.with_passes(3) == FittedValue(passes=3)


@pytest.mark.parametrize("planner", [FittedValue(), Threshold(), SparseSampling(2, 2)])
def test_a_few_decisions_at_once(planner: FittedValue | Threshold | SparseSampling) -> None:
    problem, beliefs = twins(3), np.array([[0.9, 0.05, 0.05], [0.5, 0.25, 0.25]])
    together = decide_many(planner, problem, beliefs, np.array([-1, 0]), rng=default_rng(2))
    rng = default_rng(2)
    alone = [
        planner.decide(problem, Belief(b), about, rng=rng).action for b, about in zip(beliefs, (None, 0), strict=True)
    ]
    assert [action_of(code, problem) for code in together.tolist()] == alone

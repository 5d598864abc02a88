"""The upper bound on the optimal return."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import fetch_pomdp
from fetch_pomdp.core import compiled
from fetch_pomdp.core.bounding.bounds import Bound, clairvoyant_returns, closed_form_bound, upper_bound
from fetch_pomdp.core.bounding.oracle import CELLS, ceiling, oracle_of
from fetch_pomdp.core.bounding.relaxation import drawn_scenario
from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.fitted.table import (
    ASK_FIRST,
    ASK_SECOND,
    COLUMNS,
    FIRST,
    KINDS,
    ROWS,
    SECOND,
    UNASKED,
    ValueTable,
)
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import MOST_STEPS, simulate
from fetch_pomdp.errors import ModelError, PlannerError
from tests.oracles.clairvoyant import Clairvoyant, Foresight, share_of, twin_values
from tests.oracles.value import after, picks
from tests.tables import live, table, twins, world_of


def priced(problem: Problem, **rewards: float) -> Problem:
    return Problem(dataclasses.replace(problem.scene, rewards=Rewards(**rewards)))


def constant(value: float) -> ValueTable:
    return ValueTable(np.full((1, ROWS, COLUMNS, KINDS), value), np.empty(0))


# Cheap questions and answers that are often wrong: the optimal policy asks again and again, and now and then waits.
UNSURE = priced(twins(2, p_truth=0.75, p_l=0.8, p_answer_again=0.9), point=-1.3)
VALUES = twin_values(world_of(UNSURE))


def optimal() -> ValueTable:
    """The optimal value as a table: only beliefs of 1/2, 3/4 and 9/10 are met where a pick is not best."""
    assert all(VALUES.best[net, True] == max(picks([s := share_of(net, world_of(UNSURE)), 1 - s], world_of(UNSURE)))
               for net in range(3, 9))  # fmt: skip
    values = np.full((1, ROWS, COLUMNS, KINDS), -50.0)
    for net, rows in ((0, [16]), (1, [24]), (2, [28, 29])):  # a belief lies at row 32 b, or between two rows
        for kind in (ASK_FIRST, ASK_SECOND):
            values[0, rows, :, kind] = VALUES.ask[net]
        values[0, rows, :, UNASKED] = VALUES.wait[net, False]
        for kind in (FIRST, SECOND):
            values[0, rows, :, kind] = VALUES.wait[net, True]
    return ValueTable(values, np.empty(0))


def test_the_optimal_policy_of_the_twins_asks_and_waits() -> None:
    assert VALUES.best[0, False] == pytest.approx(-1.3 + VALUES.ask[0])
    assert VALUES.best[0, True] == pytest.approx(-1.0 + VALUES.wait[0, True])
    assert VALUES.best[0, False] > max(picks([0.5, 0.5], world_of(UNSURE))) + 1.0


@pytest.mark.parametrize("scenarios", [3, pytest.param(300, marks=pytest.mark.slow)])
def test_with_the_optimal_value_as_control_every_scenario_gives_it(scenarios: int) -> None:
    found = clairvoyant_returns(UNSURE, optimal(), scenarios, 1, tau=-4.0)
    assert found == pytest.approx(np.full(scenarios, VALUES.best[0, False]), abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("value", [-50.0, 2.0, 6.0])
@pytest.mark.parametrize("tau", [-1.0, 0.5])
def test_with_a_wrong_control_it_is_still_a_bound(value: float, tau: float) -> None:
    found = clairvoyant_returns(UNSURE, constant(value), 2_000, 2, tau=tau)
    error = float(found.std()) / math.sqrt(len(found))
    assert found.mean() > VALUES.best[0, False] - 3 * error
    assert found.mean() > VALUES.best[0, False] + 0.1, "a wrong control costs something"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("vocabularies", "model"),
    [
        ([["cup"], ["cup"]], {"p_truth": 0.8}),
        ([["cup"], ["mug", "red"]], {"p_answer_again": 0.3}),
        ([["cup"], ["cup"], ["mug", "red"]], {"p_truth": 0.9, "p_l": 0.6}),
    ],
)
def test_the_clairvoyant_finds_the_best_of_all_sequences(vocabularies: list[list[str]], model: dict[str, Any]) -> None:
    problem = table(vocabularies, p_g=0.0, **model)
    world, oracle, count = world_of(problem), oracle_of(problem), problem.n_items
    tau = 0.2

    def control(belief: Sequence[float], asked: int | None) -> float:
        del asked
        return max(*picks(belief, world), world.wait + 1.5)

    def most(belief: Sequence[float], asked: int | None) -> float:
        return ceiling(np.array(belief), -1 if asked is None else asked, oracle, problem.tables)

    plain = Clairvoyant(world, control, most, tau, MOST_STEPS)
    seeds = np.random.default_rng((7, 2)).integers(2**53, size=25, dtype=np.uint64)
    expected = []
    for seed in seeds:
        drawn = drawn_scenario(seed, problem.tables)
        seen = Foresight(drawn.desired, drawn.evidence.tolist(), drawn.speaks.tolist(), drawn.means.tolist())
        expected.append(control([1 / count] * count, None) + plain.best(seen, [1 / count] * count, None))
    found = clairvoyant_returns(problem, constant(1.5), 25, 7, tau=tau)
    assert found == pytest.approx(expected, abs=1e-9)
    assert found.std() > 0.0


def random_problem(rng: np.random.Generator) -> Problem:
    words = ["cup", "red", "mug", "big"]
    count = int(rng.integers(2, 5))
    vocabularies = [rng.choice(words, size=int(rng.integers(1, 4)), replace=False).tolist() for _ in range(count)]
    places = [(float(x), float(y), 0.75) for x, y in rng.uniform((-0.8, 1.0), (0.8, 2.5), size=(count, 2))]
    problem = table(
        vocabularies, places,
        p_g=float(rng.choice([0.0, 0.1, 0.5])), p_l=float(rng.uniform(0.5, 0.95)),
        p_truth=float(rng.uniform(0.7, 1.0)), alpha=float(rng.choice([0.05, 0.2, 1.0])),
        p_answer_again=float(rng.choice([0.0, 0.5, 1.0])), sigma=float(rng.choice([0.05, 0.15, 0.4])),
        gesture_likelihood=str(rng.choice(["eq7", "exact"])),
    )  # fmt: skip
    return priced(problem, point=-float(rng.uniform(1.0, 6.0)), wait=-float(rng.uniform(0.2, 1.0)))


@pytest.mark.slow
@pytest.mark.parametrize(
    "number", [0, 1, 6, *(pytest.param(n, marks=pytest.mark.long) for n in range(20) if n not in {0, 1, 6})]
)
def test_no_planner_earns_more(number: int) -> None:
    problem = random_problem(np.random.default_rng((20, number)))
    bound = upper_bound(problem, 200, number)
    assert bound.mean <= closed_form_bound(problem)
    planners: list[Planner] = [FittedValue(), SparseSampling(), ExactAnswers()]
    for planner in planners:
        played = simulate(problem, planner, 4_000, number)
        error = math.hypot(bound.standard_error, played.standard_error)
        assert bound.mean > played.mean_return - 3 * error, planner
    best = simulate(problem, FittedValue(), 20_000, number)
    assert bound.mean < best.mean_return + 2.0, "no use if far away"


@pytest.mark.slow
@pytest.mark.parametrize("number", range(12))
def test_the_ceiling_is_a_supersolution(number: int) -> None:
    rng = np.random.default_rng((30, number))
    drawn = random_problem(rng)
    problem = Problem(dataclasses.replace(drawn.scene, model=drawn.model.with_changes({"p_g": 0.0})))
    world, oracle, count = world_of(problem), oracle_of(problem), problem.n_items

    def most(belief: Sequence[float], asked: int | None) -> float:
        return ceiling(np.array(belief), -1 if asked is None else asked, oracle, problem.tables)

    for sparse in (0.3, 1.0, 3.0):
        for belief in rng.dirichlet([sparse] * count, size=12).tolist():
            for asked in (None, *range(count)):
                values = [world.ask + sum(p * most(b, item) for p, b in after(belief, item, world.p_l, world))
                          for item in range(count)]  # fmt: skip
                waited = after(belief, asked, world.p_l * world.again, world)
                wait = world.wait + sum(p * most(b, asked) for p, b in waited)
                assert most(belief, asked) >= max(*values, wait, *picks(belief, world)) - 1e-6


def test_the_ceiling_is_tight_where_two_twins_are_all_there_is() -> None:
    problem = twins(2)
    exact = twin_values(world_of(problem)).best[0, False]
    assert exact <= closed_form_bound(problem) < exact + 0.02  # but for the grid


def test_pointing_raises_the_ceiling_and_an_item_left_over_is_revealed() -> None:
    less, more = twins(2), table([["thing"]] * 2, p_g=0.6)
    assert closed_form_bound(more) > closed_form_bound(less) + 0.5
    oracle = oracle_of(twins(3))
    assert sorted([*oracle.first.tolist(), *oracle.second.tolist()]) == [-1, 0, 1, 2]
    assert oracle.values.shape == (1, 2, CELLS + 1)
    flat = np.full(3, 1 / 3)
    alone = closed_form_bound(twins(2))
    assert ceiling(flat, -1, oracle, twins(3).tables) == pytest.approx(2 / 3 * alone + 1 / 3 * 10.0)


@pytest.mark.slow
def test_scenarios_are_the_same_whatever_is_drawn_beside_them(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem(Scene.load("unambiguous"))
    few = clairvoyant_returns(problem, constant(1.0), 10, 3, tau=1.0)
    monkeypatch.setattr(compiled, "_SHARE", 7)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    assert clairvoyant_returns(problem, constant(1.0), 24, 3, tau=1.0)[:10].tolist() == few.tolist()
    assert clairvoyant_returns(problem, constant(1.0), 10, 4, tau=1.0).tolist() != few.tolist()


def test_a_large_table_gets_the_closed_form() -> None:
    problem = table([[f"kind-{index // 2}"] for index in range(80)], [(index / 50, 2.0, 0.75) for index in range(80)])
    bound = upper_bound(problem, 100)
    assert bound == Bound(closed_form_bound(problem), 0.0, 0, "oracle")
    assert -12.5 < bound.mean < 10.0


def test_more_items_than_can_be_matched_by_closeness() -> None:
    count = 1_201
    places = [(index / 500, 2.0, 0.75) for index in range(count)]
    problem = table([[f"kind-{index % 600}"] for index in range(count)], places)
    oracle = oracle_of(problem)
    assert sorted([*oracle.first.tolist(), *oracle.second.tolist()]) == [-1, *range(count)]


@pytest.mark.parametrize(("scenarios", "seed", "field"), [(1, 0, "scenarios"), (2.5, 0, "scenarios"), (10, -1, "seed")])
def test_bad_numbers_are_refused(scenarios: int, seed: int, field: str) -> None:
    with pytest.raises(PlannerError, match=f"{field}: found"):
        fetch_pomdp.upper_bound(Problem(Scene.load("ambiguous")), scenarios, seed)


def test_live_people_are_refused() -> None:
    with pytest.raises(ModelError, match=r"^turns: found live people, expected none: the upper bound knows [^\n]*$"):
        upper_bound(live(twins(2)), 2, 0)


def test_bounds_of_twins_and_of_many_items() -> None:
    """The whole way on a table where picking at once is worth 10 with one item, and -5 with a third of them."""
    bound = upper_bound(twins(2), 2, 0)
    assert -1.25 < bound.mean < 10.0
    many = upper_bound(twins(61), 2, 0)
    assert (many.kind, many.scenarios, many.standard_error) == ("oracle", 0, 0.0)
    assert many.mean < 10.0

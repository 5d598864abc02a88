"""What every planner promises."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import MOST_DEPTH, MOST_WIDTH, Decision, Planner, best_action, decide_many
from fetch_pomdp.core.planners.baselines.paradigms import AlwaysAsk, NeverAsk
from fetch_pomdp.core.planners.baselines.rules import ChaiRule, InformationGain, OneShot, PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import DoshiRoy, PaperNeverAsk, WilliamsYoung
from fetch_pomdp.core.planners.catalogue import DEFAULT, PLANNERS, planner_named
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import PlannerError
from tests.tables import table, twins

AMBIGUOUS = Problem(Scene.load("ambiguous"))
EXACT_RAYS = Problem(
    dataclasses.replace(AMBIGUOUS.scene, model=AMBIGUOUS.model.with_changes({"gesture_likelihood": "exact"}))
)
LEADING = [0.02, 0.02, 0.55, 0.35, 0.03, 0.03]
UNEVEN = [0.05, 0.1, 0.35, 0.4, 0.06, 0.04]

SEARCHES: list[Callable[..., Planner]] = [ExactAnswers, SparseSampling, PaperNeverAsk]
# Planners that follow a rule and value picks alone; planners that ask first whatever they believe.
RULED = (PaperAlwaysAsk, Threshold, ChaiRule, InformationGain, OneShot)
OPENS = (AlwaysAsk, PaperAlwaysAsk, WilliamsYoung)


@pytest.fixture(params=sorted(PLANNERS))
def planner(request: pytest.FixtureRequest) -> Planner:
    return PLANNERS[request.param]()


def decide(
    planner: Planner, problem: Problem, belief: list[float], asked: int | None = None, seed: int = 0
) -> Decision:
    return planner.decide(problem, Belief(belief), asked, rng=np.random.default_rng(seed))


def plain(decision: Decision) -> tuple[object, ...]:
    """A decision as data that compares equal, NaN included."""
    error = decision.point_error
    arrays = [decision.point, decision.pick, np.zeros(0) if error is None else error]
    return (decision.action, str(decision.wait), str(decision.wait_error), *(str(array.tolist()) for array in arrays))


@pytest.mark.parametrize("asked", [None, 2])
def test_same_seed_same_decision_and_no_state(planner: Planner, asked: int | None) -> None:
    first = decide(planner, AMBIGUOUS, UNEVEN, asked)
    decide(planner, EXACT_RAYS, [1 / 6] * 6, 4, seed=9)
    assert plain(decide(planner, AMBIGUOUS, UNEVEN, asked)) == plain(first)
    fresh = type(planner)()
    assert plain(decide(fresh, AMBIGUOUS, UNEVEN, asked)) == plain(first)


def test_belief_is_untouched(planner: Planner) -> None:
    belief = Belief(UNEVEN)
    planner.decide(AMBIGUOUS, belief, 1, rng=np.random.default_rng(0))
    assert belief.probabilities == pytest.approx(UNEVEN, abs=1e-15)


@pytest.mark.parametrize("problem", [AMBIGUOUS, EXACT_RAYS])
@pytest.mark.parametrize("asked", [None, 0, 5])
@pytest.mark.parametrize("belief", [[1 / 6] * 6, UNEVEN, [0.0, 0.0, 0.5, 0.5, 0.0, 0.0], [0.97, *[0.006] * 5]])
def test_decisions_are_sound(planner: Planner, problem: Problem, asked: int | None, belief: list[float]) -> None:
    decision = decide(planner, problem, belief, asked)
    assert_sound(decision, 6)
    assert decision.pick == pytest.approx(22.5 * np.array(belief) - 12.5, abs=1e-9)
    if not isinstance(planner, RULED + OPENS):
        values = [decision.wait, *decision.point, *decision.pick]
        assert decision.value == np.nanmax(values)


def assert_sound(decision: Decision, count: int) -> None:
    assert decision.point.shape == decision.pick.shape == (count,)
    assert isinstance(decision.action, Wait | Point | Pick)
    if not isinstance(decision.action, Wait):
        assert 0 <= decision.action.item < count
    assert np.isfinite(decision.pick).all()
    assert decision.wait_error >= 0
    if decision.point_error is not None:
        assert decision.point_error.shape == (count,)
        assert (decision.point_error >= 0).all()


@pytest.mark.parametrize("asked", [None, 0])
def test_a_table_with_one_item(planner: Planner, asked: int | None) -> None:
    decision = decide(planner, table([["cup"]]), [1.0], asked)
    assert_sound(decision, 1)
    assert decision.pick[0] == pytest.approx(10.0)
    if not isinstance(planner, OPENS):
        assert decision.action == Pick(0)


@pytest.mark.parametrize("asked", [None, 0, 1])
@pytest.mark.parametrize("belief", [[0.5, 0.5], [0.0, 1.0], [1.0, 0.0], [1e-300, 1.0]])
def test_two_items(planner: Planner, asked: int | None, belief: list[float]) -> None:
    decision = decide(planner, table([["cup"], ["mug"]]), belief, asked)
    assert_sound(decision, 2)
    if not isinstance(planner, (NeverAsk, PaperNeverAsk, *RULED, *OPENS)):
        assert np.isfinite([decision.wait, *decision.point]).all()
        assert max(decision.wait + 1, *(decision.point + 6)) <= 10 + 1e-9


@pytest.mark.parametrize("item", range(6))
def test_an_item_that_is_certain_is_picked(planner: Planner, item: int) -> None:
    decision = decide(planner, AMBIGUOUS, [float(other == item) for other in range(6)], item)
    assert decision.action == Pick(item)


@pytest.mark.parametrize("order", [[2, 0, 1], [1, 0, 2], [2, 1, 0]])
@pytest.mark.parametrize(
    "planner",
    [
        ExactAnswers(depth=1),
        ExactAnswers(depth=2),
        ExactAnswers(depth=3, width=2),
        ExactAnswers(depth=3, width=1, leaf="pick"),
        SparseSampling(depth=1),
        PaperNeverAsk(depth=3),
        PaperAlwaysAsk(),
        FittedValue(),
        Threshold(),
        ChaiRule(),
        WilliamsYoung(),
        DoshiRoy(),
        InformationGain(),
        OneShot(),
    ],
)
def test_permuting_twins_permutes_values(planner: Planner, order: list[int]) -> None:
    belief = [0.5, 0.2, 0.3]
    here = decide(planner, twins(3), belief, 1)
    there = decide(planner, twins(3), [belief[item] for item in order], order.index(1))
    assert there.point == pytest.approx(here.point[order], abs=1e-9, nan_ok=True)
    assert there.pick == pytest.approx(here.pick[order], abs=1e-9)
    assert there.wait == pytest.approx(here.wait, abs=1e-9, nan_ok=True)
    if not isinstance(here.action, Wait) and not isinstance(there.action, Wait):
        assert order[there.action.item] == here.action.item
    assert type(there.action) is type(here.action)


def test_other_seeds_sample_otherwise() -> None:
    for make in SEARCHES:
        found = {decide(make(), AMBIGUOUS, UNEVEN, 2, seed).wait for seed in range(5)}
        assert len(found) > 1, make


@pytest.mark.parametrize("make", SEARCHES)
def test_more_samples_less_error(make: Callable[..., Planner]) -> None:
    few = decide(make(depth=2, width=50), AMBIGUOUS, LEADING)
    many = decide(make(depth=2, width=5_000), AMBIGUOUS, LEADING)
    assert 5 < few.wait_error / many.wait_error < 20  # ten times less


@pytest.mark.slow
@pytest.mark.parametrize("make", SEARCHES)
@pytest.mark.parametrize(("depth", "width", "seeds"), [(2, 40, 400), (3, 15, 300)])
def test_stated_errors_are_those_found(make: Callable[..., Planner], depth: int, width: int, seeds: int) -> None:
    """Draws are spread evenly over the belief: the true error may be smaller than the one stated, never much larger."""
    decisions = [decide(make(depth=depth, width=width), AMBIGUOUS, LEADING, 2, seed) for seed in range(seeds)]
    stated = float(np.mean([decision.wait_error for decision in decisions]))
    found = float(np.std([decision.wait for decision in decisions]))
    assert 0.3 * stated < found < 1.15 * stated
    if make is not PaperNeverAsk:
        points = np.array([decision.point for decision in decisions])
        errors = np.array([decision.point_error for decision in decisions])
        assert (points.std(axis=0) < 1.15 * errors.mean(axis=0)).all()


@pytest.mark.parametrize("make", SEARCHES)
@pytest.mark.parametrize(
    ("belief", "asked"), [([0.5, 0.5], None), ([1 / 6] * 6, 6), ([1 / 6] * 6, -2), ([1 / 9] * 9, 0)]
)
def test_a_belief_over_other_items_is_refused(
    make: Callable[..., Planner], belief: list[float], asked: int | None
) -> None:
    with pytest.raises(PlannerError, match="belief: found a belief over"):
        decide(make(depth=2, width=1), AMBIGUOUS, belief, asked)


extremes = {
    "alpha": st.sampled_from([1e-9, 0.2, 1e9]),
    "p_l": st.sampled_from([1e-9, 0.5, 0.95, 1 - 1e-9]),
    "p_g": st.sampled_from([0.0, 0.1, 1 - 1e-9]),
    "sigma": st.sampled_from([1e-6, 0.001, 0.15, 0.7]),
    "p_truth": st.sampled_from([0.5, 0.99, 1.0]),
    "gesture_threshold": st.sampled_from([1e-6, 0.3, math.pi]),
    "gesture_likelihood": st.sampled_from(["eq7", "exact"]),
    "p_answer_again": st.sampled_from([0.0, 1e-9, 0.5, 1.0]),
}


@given(
    parameters=st.fixed_dictionaries(extremes),
    weights=st.lists(st.sampled_from([0.0, 1e-300, 1e-12, 0.3, 1.0]), min_size=4, max_size=4).filter(
        lambda w: max(w) > 0.1
    ),
    asked=st.sampled_from([None, 0, 3]),
    depth=st.integers(1, 3),
    make=st.sampled_from(SEARCHES),
)
@settings(max_examples=150)
def test_values_are_finite_and_possible_in_any_model(
    parameters: dict[str, Any], weights: list[float], asked: int | None, depth: int, make: Callable[..., Planner]
) -> None:
    vocabularies = [["cup"], ["cup", "mug"], ["pot", "tea", "red"], ["tea"]]
    problem = table(vocabularies, **parameters)
    decision = decide(make(depth=depth, width=3), problem, [w / sum(weights) for w in weights], asked)
    assert_sound(decision, 4)
    values = (
        [decision.wait, *decision.pick] if make is PaperNeverAsk else [decision.wait, *decision.point, *decision.pick]
    )
    assert np.isfinite(values).all()
    assert min(decision.pick) >= -12.5 - 1e-9
    assert max(values) <= 10 + 1e-9
    assert min(values) >= -6 * depth - 12.5


@pytest.mark.parametrize("name", ["fitted", "exact", "sparse", "never", "always", "doshi-roy"])
def test_a_phase_of_another_model_is_refused(name: str) -> None:
    """Compiled code would read beside its tables."""
    with pytest.raises(PlannerError, match="phase: found 4, expected 0 to 0"):
        PLANNERS[name]().decide(AMBIGUOUS, Belief(UNEVEN), None, rng=np.random.default_rng(0), phase=4)
    phases = np.array([0, 4])
    with pytest.raises(PlannerError, match="phases: found 0 to 4, expected"):
        decide_many(
            PLANNERS[name](), AMBIGUOUS, np.array([UNEVEN] * 2), np.array([-1, -1]), rng=np.random.default_rng(0),
            phases=phases,
        )  # fmt: skip


# Choosing among values.


@pytest.mark.parametrize(
    ("wait", "point", "pick", "expected"),
    [
        (0.0, [1.0, 2.0], [1.0, 1.5], Point(1)),
        (3.0, [1.0, 2.0], [1.0, 1.5], Wait()),
        (0.0, [1.0, 1.0], [1.0, 1.5], Pick(1)),
        (1.0, [1.0, 1.0], [1.0, 1.0], Pick(0)),
        (1.0, [1.0, 1.0], [0.0, 0.0], Wait()),
        (0.0, [2.0, 2.0], [0.0, 0.0], Point(0)),
        (1.0, [math.nan, math.nan], [0.0, 0.0], Wait()),
    ],
)
def test_best_action_and_its_ties(wait: float, point: list[float], pick: list[float], expected: Action) -> None:
    assert best_action(wait, np.array(point), np.array(pick)) == expected


def test_value_is_that_of_the_action() -> None:
    values = (1.0, np.array([2.0, 3.0]), np.array([4.0, 5.0]))
    assert [Decision(action, *values).value for action in (Wait(), Point(1), Pick(0))] == [1.0, 3.0, 4.0]


# Names and parameters.


def test_the_default_planner_is_ours() -> None:
    assert planner_named(DEFAULT) == FittedValue()
    assert planner_named("sparse", depth=None, width=3) == SparseSampling(width=3)


@pytest.mark.parametrize(
    ("name", "parameters", "message"),
    [
        ("exakt", {}, "planner: found 'exakt', expected one of fitted, exact, sparse, threshold, never, always"),
        (
            "exact",
            {"dept": 2},
            "dept: unknown parameter of planner 'exact', expected one of depth, width, leaf, did you mean",
        ),
        (
            "paper-always",
            {"depth": 2},
            "depth: unknown parameter of planner 'paper-always', expected one of confidence",
        ),
        ("exact", {"depth": 0}, f"depth: found 0, expected a whole number from 1 to {MOST_DEPTH}"),
        ("exact", {"depth": MOST_DEPTH + 1}, "depth: found 21"),
        ("exact", {"width": -1}, "width: found -1"),
        ("exact", {"width": MOST_WIDTH + 1}, "width: found 1000001"),
        ("exact", {"leaf": "oak"}, "leaf: found 'oak', expected 'pick' or 'question'"),
        ("sparse", {"width": 0}, "width: found 0, expected a whole number from 1"),
        ("sparse", {"depth": True}, "depth: found True"),
        ("paper-never", {"depth": 1.5}, "depth: found 1.5"),
        ("paper-never", {"width": "10"}, "width: found '10'"),
        ("paper-always", {"confidence": 0}, "confidence: found 0, expected a probability above 0 and at most 1"),
        ("fitted", {"beliefs": 99}, "beliefs: found 99, expected a whole number from 100"),
        ("fitted", {"rays": 0}, "rays: found 0"),
        (
            "fitted",
            {"depth": 2},
            "depth: unknown parameter of planner 'fitted', expected one of beliefs, rays, seed, passes, budget_ms",
        ),
        ("fitted", {"budget_ms": -1}, "budget_ms: found -1, expected a time from 0 to 1e6 ms, or none"),
        ("threshold", {"pick": -0.1}, "pick: found -0.1, expected a belief from 0, or a limit to 2"),
        ("paper-always", {"confidence": math.nan}, "confidence: found nan"),
        ("chai", {"ratio": 0}, "ratio: found 0, expected a share of the largest belief, above 0 and at most 1"),
        ("williams-young", {"depth": 0}, f"depth: found 0, expected a whole number from 1 to {MOST_DEPTH}"),
        ("doshi-roy", {"depth": 1}, f"depth: found 1, expected a whole number from 2 to {MOST_DEPTH}"),
        ("information-gain", {"worth": -1}, "worth: found -1, expected a number from 0 to 1000"),
        ("one-shot", {"confidence": 2}, "confidence: found 2, expected a probability from 0 to 1"),
    ],
)
def test_bad_names_and_parameters(name: str, parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(PlannerError) as caught:
        planner_named(name, **parameters)
    assert str(caught.value).startswith(message)

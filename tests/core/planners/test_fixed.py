"""The baselines of Section IV, by their rule."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.fixed import AlwaysAsk, NeverAsk
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from tests.tables import table

PROBLEM = Problem(Scene.load("ambiguous"))


def always(belief: list[float], asked: int | None, confidence: float = 0.95) -> Action:
    planner = AlwaysAsk(confidence)
    return planner.decide(PROBLEM, Belief(belief), asked, rng=np.random.default_rng(0)).action


@pytest.mark.parametrize("asked", [None, 3])
def test_always_ask_waits_while_the_belief_is_uniform(asked: int | None) -> None:
    assert always([1 / 6] * 6, asked) == Wait()


@pytest.mark.parametrize("asked", [None, 0, 3])
def test_always_ask_asks_about_the_likeliest(asked: int | None) -> None:
    assert always([0.1, 0.1, 0.1, 0.1, 0.5, 0.1], asked) == Point(4)
    assert always([0.16, 0.16, 0.17, 0.17, 0.17, 0.17], asked) == Point(2)


def test_always_ask_asks_at_least_once() -> None:
    certain = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]
    assert always(certain, None) == Point(1)
    assert always(certain, 1) == Pick(1)
    assert always(certain, 0) == Pick(1), "any question counts"


def test_always_ask_goes_on_until_it_holds_its_confidence() -> None:
    just_below, just_above = [0.9499, *[0.01002] * 5], [0.9501, *[0.00998] * 5]
    assert always(just_below, 0) == Point(0)
    assert always(just_above, 0) == Pick(0)
    assert always(just_below, 0, confidence=0.9) == Pick(0)


def test_always_ask_does_not_wait_for_ever_before_an_item_alone() -> None:
    alone, rng = table([["cup"]]), np.random.default_rng(0)
    assert AlwaysAsk().decide(alone, Belief([1.0]), None, rng=rng).action == Point(0)
    assert AlwaysAsk().decide(alone, Belief([1.0]), 0, rng=rng).action == Pick(0)


def test_never_ask_never_asks_and_does_not_value_it() -> None:
    rng = np.random.default_rng(0)
    for weights in rng.dirichlet([0.3] * 6, size=200):
        for asked in (None, 0):
            decision = NeverAsk().decide(PROBLEM, Belief(weights / weights.sum()), asked, rng=rng)
            assert not isinstance(decision.action, Point)
            assert np.isnan(decision.point).all()
            picked = isinstance(decision.action, Pick)
            assert picked == (22.5 * weights.max() - 12.5 >= decision.wait)
            if isinstance(decision.action, Pick):
                assert decision.action.item == weights.argmax()


def test_never_ask_has_the_paper_s_depth_and_width() -> None:
    assert (NeverAsk().depth, NeverAsk().width) == (2, 10)
    assert AlwaysAsk().confidence == 0.95

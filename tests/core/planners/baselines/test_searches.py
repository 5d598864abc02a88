"""Robots that search with something left out, by what their sources say and by numbers worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.observation import Observation, phase_after
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import DoshiRoy, PaperNeverAsk, WilliamsYoung
from fetch_pomdp.core.planners.search.planner import ExactAnswers
from fetch_pomdp.core.turns import Turns
from tests.core.planners.baselines.acting import AMBIGUOUS, act, decision
from tests.core.planners.test_contract import plain
from tests.tables import twins


def test_never_ask_never_asks_and_does_not_value_it() -> None:
    rng = np.random.default_rng(0)
    for weights in rng.dirichlet([0.3] * 6, size=200):
        for asked in (None, 0):
            found = PaperNeverAsk().decide(AMBIGUOUS, Belief(weights / weights.sum()), asked, rng=rng)
            assert not isinstance(found.action, Point)
            assert np.isnan(found.point).all()
            picked = isinstance(found.action, Pick)
            assert picked == (22.5 * weights.max() - 12.5 >= found.wait)
            if isinstance(found.action, Pick):
                assert found.action.item == weights.argmax()


def test_never_ask_has_the_paper_s_depth_and_width() -> None:
    assert (PaperNeverAsk().depth, PaperNeverAsk().width) == (2, 10)
    assert PaperAlwaysAsk().confidence == 0.95


@pytest.mark.parametrize("belief", [[1.0, 0.0, 0.0], [0.0, 0.98, 0.02], [0.34, 0.33, 0.33]])
def test_williams_and_young_open_with_a_question_whatever_they_believe(belief: list[float]) -> None:
    found = decision(WilliamsYoung(), belief)
    assert isinstance(found.action, Point)
    assert found.action.item == found.point.argmax()
    assert math.isnan(found.wait)


def test_williams_and_young_never_wait_once_they_have_asked() -> None:
    waits = 0
    for belief in default_rng(0).dirichlet([1.0] * 6, size=150):
        patient = act(ExactAnswers(), belief.tolist(), 2, AMBIGUOUS)
        waits += patient == Wait()
        found = decision(WilliamsYoung(), belief.tolist(), 2, AMBIGUOUS)
        assert found.value == max(*found.point, *found.pick)
        if patient != Wait():
            assert found.action == patient, "the plan's own choice"
    assert waits > 20


def test_williams_and_young_ask_about_what_the_plan_chooses() -> None:
    """Between two that are alike either question tells the same; one about the third tells nothing of them."""
    assert act(WilliamsYoung(), [0.02, 0.49, 0.49]) in (Point(1), Point(2))


@given(
    weights=st.lists(st.sampled_from([0.01, 0.2, 0.5, 1.0]), min_size=6, max_size=6),
    asked=st.sampled_from([0, 3, 5]),
)
def test_doshi_and_roy_decide_as_if_they_had_not_asked(weights: list[float], asked: int) -> None:
    belief = [weight / sum(weights) for weight in weights]
    here = plain(decision(DoshiRoy(), belief, asked, AMBIGUOUS))
    assert here == plain(decision(DoshiRoy(), belief, None, AMBIGUOUS))


def test_doshi_and_roy_ask_again_where_others_wait_for_the_answer() -> None:
    """Twins, b = (.5, .5, 0), an answer to item 0 out. To wait it out costs 1, to ask again 6; both settle it."""
    assert act(ExactAnswers(width=1), [0.5, 0.5, 0.0], 0) == Wait()
    assert act(DoshiRoy(width=1), [0.5, 0.5, 0.0], 0) == Point(0)


def test_doshi_and_roy_s_question_is_worth_one_answer() -> None:
    """At depth 2 with twins of .5 each: the answer comes with .95 at once and is true with .99, or never.

    After it, a pick: 22.5 * .99 - 12.5 = 9.775; after silence a last question of leaf `question`, of the same kind.
    """
    settled = 22.5 * 0.99 - 12.5
    after_silence = -6 + 0.95 * settled + 0.05 * (-1.25)  # then the best pick, at .5
    found = decision(DoshiRoy(width=1), [0.5, 0.5, 0.0], 0)
    assert found.point[0] == pytest.approx(-6 + 0.95 * settled + 0.05 * after_silence, abs=1e-9)
    assert found.wait == pytest.approx(-1 + after_silence, abs=1e-9), "a wait brings no answer"


def test_doshi_and_roy_are_the_search_itself_where_people_answer_once() -> None:

    problem = twins(4, p_answer_again=0.0)
    for belief in default_rng(0).dirichlet([1.0] * 4, size=20):
        forgetful, keeping = (decision(one, belief.tolist(), None, problem) for one in (DoshiRoy(), ExactAnswers()))
        assert plain(forgetful) == plain(keeping)
    kept = decision(ExactAnswers(), [0.5, 0.5, 0.0, 0.0], 0, twins(4))
    assert plain(decision(DoshiRoy(), [0.5, 0.5, 0.0, 0.0], 0, twins(4))) != plain(kept)


def test_doshi_and_roy_count_an_answer_at_all_before_live_people() -> None:
    """Twins, b = (.5, .5, 0), a person who never points and has been heard: an answer, true with .99, then a pick.

    It comes with .939 if the item is desired and with .959 if not: in the question's step, or the five after it.
    """
    turns = Turns()
    at_all = np.mean([
        1 - math.prod(1 - chances[age] for age in (0, 2, 3, 3, 3, 3))
        for chances in (turns.answers_desired, turns.answers_other)
    ])  # fmt: skip
    problem = twins(3, turns=turns)
    heard = phase_after(Observation(("thing",)), Wait(), problem, asked=None)
    found = DoshiRoy(width=1).decide(problem, Belief([0.5, 0.5, 0.0]), None, rng=default_rng(0), phase=heard)
    settled = 22.5 * 0.99 - 12.5
    after_silence = -6 + at_all * settled + (1 - at_all) * (-1.25)
    assert found.point[0] == pytest.approx(-6 + at_all * settled + (1 - at_all) * after_silence, abs=1e-9)
    assert found.wait == pytest.approx(-1 + after_silence, abs=1e-9), "a wait brings no answer"
    assert isinstance(found.action, Point)

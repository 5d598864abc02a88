"""Other people's robots, by what their sources say and by numbers worked out by hand.

Seven items make a belief of 1/7 that is no round number; three twins make answers all there is to learn.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Decision, Planner
from fetch_pomdp.core.planners.baselines.chai import ChaiRule
from fetch_pomdp.core.planners.baselines.doshi_roy import DoshiRoy
from fetch_pomdp.core.planners.baselines.information_gain import InformationGain, answer_information
from fetch_pomdp.core.planners.baselines.one_shot import OneShot
from fetch_pomdp.core.planners.baselines.williams_young import WilliamsYoung
from fetch_pomdp.core.planners.batch import code_of, decide_many
from fetch_pomdp.core.planners.exact import ExactAnswers
from fetch_pomdp.core.planners.kernels import YES, answered
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import simulate
from fetch_pomdp.errors import PlannerError
from tests.core.planners.test_contract import plain
from tests.tables import table, twins

AMBIGUOUS = Problem(Scene.load("ambiguous"))
TWINS = twins(3)
BASELINES: list[Planner] = [ChaiRule(), WilliamsYoung(), DoshiRoy(), InformationGain(), OneShot()]


def decision(
    planner: Planner, belief: list[float], asked: int | None = None, problem: Problem = TWINS, seed: int = 0
) -> Decision:
    return planner.decide(problem, Belief(belief), asked, rng=default_rng(seed))


def act(planner: Planner, belief: list[float], asked: int | None = None, problem: Problem = TWINS) -> Action:
    return decision(planner, belief, asked, problem).action


@pytest.mark.parametrize("planner", BASELINES, ids=lambda planner: type(planner).__name__)
@pytest.mark.parametrize("count", [6, 7])
def test_all_let_the_person_speak_first(planner: Planner, count: int) -> None:
    problem = table([["thing"]] * count)
    assert act(planner, [1 / count] * count, problem=problem) == Wait()


@pytest.mark.parametrize("planner", BASELINES, ids=lambda planner: type(planner).__name__)
def test_a_belief_of_another_table_is_refused(planner: Planner) -> None:
    with pytest.raises(PlannerError, match="belief: found a belief over 2 items"):
        act(planner, [0.5, 0.5])
    with pytest.raises(PlannerError, match="a question about item 3"):
        act(planner, [0.5, 0.3, 0.2], 3)


@pytest.mark.parametrize("planner", [ChaiRule(), InformationGain(), OneShot(), OneShot(0.6)], ids=repr)
def test_many_decisions_are_those_one_by_one(planner: Planner) -> None:
    beliefs = np.vstack([default_rng(0).dirichlet([0.4] * 6, size=300), np.full((1, 6), 1 / 6)])
    asked = default_rng(1).integers(-1, 6, size=len(beliefs))
    many = decide_many(planner, AMBIGUOUS, beliefs, asked, rng=default_rng(0))
    one_by_one = [
        code_of(act(planner, belief.tolist(), None if about < 0 else int(about), AMBIGUOUS), AMBIGUOUS)
        for belief, about in zip(beliefs, asked, strict=True)
    ]
    assert many.tolist() == one_by_one
    assert len(set(many.tolist())) > 6


# Chai et al.


@pytest.mark.parametrize(
    ("belief", "expected"),
    [
        ([0.55, 0.4, 0.05], Point(0)),
        ([0.1, 0.45, 0.45], Point(1)),
        ([0.83, 0.16, 0.01], Pick(0)),  # 0.16 is less than a fifth of 0.83
        ([0.82, 0.17, 0.01], Point(0)),  # 0.17 is more
        ([0.0, 0.0, 1.0], Pick(2)),
    ],
)
def test_chai_asks_while_there_is_more_than_one_candidate(belief: list[float], expected: Action) -> None:
    for asked in (None, 0):
        assert act(ChaiRule(), belief, asked) == expected


def test_chai_s_ratio_tells_who_is_a_candidate() -> None:
    assert act(ChaiRule(ratio=0.5), [0.6, 0.29, 0.11]) == Pick(0)
    assert act(ChaiRule(ratio=0.45), [0.6, 0.29, 0.11]) == Point(0)


def test_one_word_leaves_chai_the_items_it_names() -> None:
    """With the paper's alpha a word leaves other items 0.2 / 1.2 of the belief of those that have it."""
    alone = table([["cup"], ["pot"], ["jug"]])
    assert act(ChaiRule(), [0.75, 0.125, 0.125], problem=alone) == Pick(0)
    two = table([["cup"], ["cup"], ["jug"]])
    assert act(ChaiRule(), [6 / 13, 6 / 13, 1 / 13], problem=two) == Point(0)


# Williams and Young.


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


# Doshi and Roy.


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


# Information gain.


def entropy(belief: np.ndarray) -> float:
    return -sum(float(p) * math.log2(p) for p in belief if p > 0)


@given(
    weights=st.lists(st.sampled_from([0.0, 0.01, 0.3, 1.0]), min_size=2, max_size=6).filter(lambda w: sum(w) > 0),
    p_truth=st.sampled_from([0.5, 0.8, 0.99, 1.0]),
    p_l=st.sampled_from([0.3, 0.95]),
)
def test_information_is_the_entropy_that_answers_take(weights: list[float], p_truth: float, p_l: float) -> None:
    problem = twins(len(weights), p_truth=p_truth, p_l=p_l)
    belief = np.array(weights) / sum(weights)
    for item, found in enumerate(answer_information(belief, problem)):
        left = 1.0 - p_l  # chance of silence
        kept = left * entropy(belief)
        for answer in (YES, YES + 1):
            after = np.empty(len(belief))
            chance = answered(belief, item, answer, p_l, after, problem.tables)
            kept += chance * entropy(after) if chance > 0 else 0.0
        assert found == pytest.approx(entropy(belief) - kept, abs=1e-9)


def test_information_of_a_question_between_two() -> None:
    """Even chances: p_l (1 - H(.99)), and H(.99) = .0808 bits."""
    assert answer_information(np.array([0.5, 0.5]), twins(2)) == pytest.approx([0.95 * (1 - 0.080793)] * 2, abs=1e-5)


@pytest.mark.parametrize(
    ("belief", "expected"),
    [
        ([0.5, 0.5, 0.0], Point(0)),  # .873 bits of 11.25 points each: 9.8 against a price of 5
        ([0.2, 0.45, 0.35], Point(1)),  # nearest to an even chance
        ([0.70, 0.15, 0.15], Point(0)),
        ([0.87, 0.12, 0.01], Point(0)),  # .468 bits: 5.26 points
        ([0.90, 0.09, 0.01], Pick(0)),  # .394 bits: 4.43 points
    ],
)
def test_a_question_is_asked_while_it_is_worth_its_price(belief: list[float], expected: Action) -> None:
    for asked in (None, 1):
        assert act(InformationGain(), belief, asked) == expected


def test_what_no_question_is_worth_is_picked_or_waited_for() -> None:
    """Without worth a pick against a wait: 22.5 b - 12.5 reaches -1 at b = .5111."""
    assert act(InformationGain(worth=0.0), [0.52, 0.28, 0.2]) == Pick(0)
    assert act(InformationGain(worth=0.0), [0.50, 0.30, 0.2]) == Wait()


# One shot.


def test_one_shot_picks_at_the_first_sign() -> None:
    assert act(OneShot(), [0.33, 0.34, 0.33]) == Pick(1)
    assert act(OneShot(), [1 / 3] * 3, 1) == Wait()


def test_one_shot_with_a_confidence_waits_until_it_holds_it() -> None:
    assert act(OneShot(0.8), [0.79, 0.11, 0.1]) == Wait()
    assert act(OneShot(0.8), [0.81, 0.1, 0.09]) == Pick(0)


def test_one_shot_s_accuracy_is_that_of_one_word() -> None:
    """Two items of one word each: the word heard is right with (1 + .2) / (1 + .2 * 2), silence waits for another."""
    played = simulate(table([["cup"], ["pot"]], p_g=0.0), OneShot(), 4_000, 0)
    right = 1.2 / 1.4
    assert played.accuracy == pytest.approx(right, abs=4 * math.sqrt(right * (1 - right) / 4_000))
    assert played.mean_questions == 0
    assert played.mean_steps == pytest.approx(1 / 0.95, abs=4 * math.sqrt(0.05 / 0.95**2 / 4_000))

"""Robots that follow a rule, by what their sources say and by numbers worked out by hand.

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
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation, phase_after
from fetch_pomdp.core.planners.base import Planner, code_of, decide_many
from fetch_pomdp.core.planners.baselines.rules import (
    ChaiRule,
    InformationGain,
    OneShot,
    PaperAlwaysAsk,
    answer_information,
)
from fetch_pomdp.core.planners.baselines.searches import DoshiRoy, WilliamsYoung
from fetch_pomdp.core.planners.kernels import ASKED, Turn, answered
from fetch_pomdp.core.simulation import simulate
from fetch_pomdp.core.turns import YES, Turns
from fetch_pomdp.errors import PlannerError
from tests.core.planners.alone import decided_alone
from tests.core.planners.baselines.acting import AMBIGUOUS, act
from tests.tables import live, table, twins

BASELINES: list[Planner] = [ChaiRule(), WilliamsYoung(), DoshiRoy(), InformationGain(), OneShot()]


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
    assert many.tolist() == decided_alone(planner, AMBIGUOUS, beliefs, asked, seed=0)
    assert len(set(many.tolist())) > 6


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
            chance = answered(belief, Turn(item, 0, ASKED), answer, after, problem.tables)
            kept += chance * entropy(after) if chance > 0 else 0.0
        assert p_l * found == pytest.approx(entropy(belief) - kept, abs=1e-9)


def test_information_of_a_question_between_two() -> None:
    """Even chances: 1 - H(.99), and H(.99) = .0808 bits."""
    assert answer_information(np.array([0.5, 0.5]), twins(2)) == pytest.approx([1 - 0.080793] * 2, abs=1e-5)


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


LIVE = live(table([["thing"]] * 3))


def after(*steps: tuple[Action, Observation]) -> int:
    """The phase of live people after actions and what was perceived in their steps; item 0 is asked about."""
    phase = 0
    for action, seen in steps:
        phase = phase_after(seen, action, LIVE, phase, asked=0)
    return phase


REQUEST = (Wait(), Observation(("thing",)))
QUIET, ASKED_OF_NOBODY = (Wait(), Observation()), (Point(0), Observation())
LATE = (ASKED_OF_NOBODY, *[QUIET] * Turns().hesitation)


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        ((REQUEST,), Point(0)),
        ((REQUEST, *[QUIET] * 20), Point(0)),  # an even chance: words that do not come are not waited for
        ((REQUEST, ASKED_OF_NOBODY), Wait()),  # the answer comes after a wait, too
        ((REQUEST, ASKED_OF_NOBODY, QUIET, QUIET), Wait()),
        ((REQUEST, *LATE), Point(0)),  # it was not heard
        ((REQUEST, *LATE, *LATE, *LATE), Pick(0)),  # nobody answers: what is best without
    ],
)
def test_live_people_are_asked_once_and_waited_for(
    steps: tuple[tuple[Action, Observation], ...], expected: Action
) -> None:
    belief, phase = Belief([0.5, 0.5, 0.0]), after(*steps)
    asked = 0 if len(steps) > 1 and steps[1] == ASKED_OF_NOBODY else None
    found = InformationGain().decide(LIVE, belief, asked, rng=default_rng(0), phase=phase)
    assert found.action == expected
    many = decide_many(
        InformationGain(), LIVE, belief.probabilities[None], np.array([-1 if asked is None else asked]),
        rng=default_rng(0), phases=np.array([phase]),
    )  # fmt: skip
    assert many.tolist() == [code_of(expected, LIVE)]


def test_a_wait_for_live_people_costs_as_many_as_it_takes() -> None:
    """Without worth, a belief of .4: a pick earns -3.5, and a wait for what comes in one of five costs about 5."""
    cheap, belief = InformationGain(worth=0.0), Belief([0.4, 0.35, 0.25])
    pointed = after((Wait(), Observation((), Ray((0.0, 0.0, 1.6), (0.0, 0.5, 1.4)))))
    assert cheap.decide(LIVE, belief, None, rng=default_rng(0), phase=after(REQUEST)).action == Pick(0)
    assert cheap.decide(LIVE, belief, None, rng=default_rng(0), phase=pointed).action == Wait(), "words are due"


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


def always(belief: list[float], asked: int | None, confidence: float = 0.95) -> Action:
    planner = PaperAlwaysAsk(confidence)
    return planner.decide(AMBIGUOUS, Belief(belief), asked, rng=np.random.default_rng(0)).action


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
    assert PaperAlwaysAsk().decide(alone, Belief([1.0]), None, rng=rng).action == Point(0)
    assert PaperAlwaysAsk().decide(alone, Belief([1.0]), 0, rng=rng).action == Pick(0)

"""The default before a person who does not answer: asks again, asks in other words, and then does what is best without.

At the live model's prices, between two markers; phases are 20 a talk: a question is late at 7, once asked again at 13,
in other words at 19.
"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.live.person import LIVE_MODEL, live_scene
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.planners.catalogue import planner_named
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import Interactions, played_out

pytestmark = pytest.mark.slow

EVEN = np.array([0.01, 0.01, 0.48, 0.48, 0.01, 0.01])
LEANING = np.array([0.01, 0.01, 0.27, 0.69, 0.01, 0.01])
ASKED = 2
HEARD, SILENT, MUTE = 120, 240, 100
ONCE, AGAIN, THIRD = 7, 13, 19


@functools.cache
def ambiguous() -> Problem:
    problem = Problem(live_scene("ambiguous"))
    assert problem.model == LIVE_MODEL
    return problem


def decided(belief: np.ndarray, phase: int) -> Decision:
    return FittedValue().decide(ambiguous(), Belief(belief), ASKED, rng=default_rng(0), phase=phase)


def test_the_phases_are_late() -> None:
    for talk in (HEARD, SILENT, MUTE):
        found = ambiguous().tables.late[[talk, talk + 6, talk + ONCE, talk + AGAIN, talk + THIRD]]
        assert found.tolist() == [0, 0, 1, 2, 3]


@pytest.mark.parametrize("talk", [HEARD, SILENT, MUTE])
def test_it_asks_twice_more_and_then_picks(talk: int) -> None:
    for late in (ONCE, AGAIN):
        assert isinstance(decided(EVEN, talk + late).action, Point)
    assert decided(EVEN, talk + THIRD).action == Pick(2)


@pytest.mark.parametrize("late", [ONCE, AGAIN, THIRD])
def test_it_picks_what_is_likely_enough_however_often_it_asked(late: int) -> None:
    """22.5 * .69 - 12.5 = 3.025, and asking costs 6 for an answer that comes half the time, or less."""
    found = decided(LEANING, SILENT + late)
    assert found.action == Pick(3)
    assert found.value == pytest.approx(3.025)


@pytest.mark.parametrize("talk", [HEARD, MUTE])
def test_another_question_is_worth_what_two_answers_in_a_hundred_are(talk: int) -> None:
    """By hand, with a pick after it: -6, and a "yes" or a "no", true in 95 of 100, to about every fiftieth."""
    found = decided(EVEN, talk + THIRD)
    for item in (2, 3):
        told = 0.48 * 0.95 + 0.52 * 0.05, 0.48 * 0.95 + 0.02 * 0.95  # chances of "yes" and, for the other, of "no"
        right = 0.48 * 0.95 / told[0], 0.48 * 0.95 / (1 - told[0])
        answered = sum(
            chance * (22.5 * share - 12.5) for chance, share in zip((told[0], 1 - told[0]), right, strict=True)
        )
        unanswered = 22.5 * 0.48 - 12.5
        assert found.point[item] == pytest.approx(-6 + 0.02 * answered + 0.98 * unanswered, abs=0.3)


@pytest.mark.parametrize("phase", [talk + late for talk in (HEARD, SILENT) for late in (ONCE, AGAIN, THIRD)])
def test_its_values_are_those_of_its_own_rollouts_where_nobody_answers(phase: int) -> None:
    """Few people come there by themselves: a value that is fitted on them alone knows nothing of it."""
    count, rng = 20_000, default_rng(phase)
    desired = rng.choice(6, size=count, p=EVEN)
    begun = Interactions.begin(desired, rng.integers(2**63, size=count, dtype=np.uint64), 6)
    begun.beliefs[:], begun.asked[:], begun.phases[:] = EVEN, ASKED, phase
    earned = played_out(ambiguous(), FittedValue(), begun, default_rng(0)).earned
    assert decided(EVEN, phase).value == pytest.approx(earned.mean(), abs=0.3 + 3 * earned.std() / math.sqrt(count))


def test_it_is_asked_about_again_unless_another_is_worth_more() -> None:
    """A question about another item has to be worth a tenth of a point more than the one that nobody answered."""
    rng, again, likelier, other = default_rng(5), 0, 0, 0
    for _ in range(600):
        share = rng.uniform(0.42, 0.58)
        belief = np.array([0.01, 0.01, 0.96 * share, 0.96 * (1 - share), 0.01, 0.01])
        found = decided(belief, HEARD + ONCE)
        assert isinstance(found.action, Point)
        if found.action.item == ASKED:
            again += 1
            likelier += belief[3] > belief[2]
            assert found.point[3] <= found.point[2] + 0.1
        else:
            other += 1
            assert found.point[3] > found.point[2] + 0.1
    assert again > 300
    assert likelier > 100, "also where the other marker is the likelier one"
    assert other > 0


def test_a_person_who_only_says_what_is_asked_three_times() -> None:
    """Each "what?" makes the question late at once and tells nothing of the item; the third is in other words."""
    agent = Agent(live_scene("ambiguous"))
    agent.observe("the marker")
    asked, unanswered = list[object](), list[int]()
    for _ in range(3):
        unanswered.append(agent.unanswered)
        asked.append(agent.act())
        assert isinstance(asked[-1], Point)
        agent.observe("what?")
    assert unanswered == [0, 1, 2]
    assert agent.unanswered == 3
    assert isinstance(agent.decide().action, Pick)


@pytest.mark.parametrize("name", ["exact", "threshold", "sparse", "always"])
def test_no_planner_that_asks_leaves_somebody_waiting_who_does_not_answer(name: str) -> None:
    """Steps until it asks again, and until it picks: a question is late after five quiet ones."""
    agent = Agent(live_scene("ambiguous"), planner_named(name))
    agent.observe("hand me the marker")
    done = []
    for step in range(30):
        action = agent.act()
        if not isinstance(action, Wait):
            done.append((type(action), step))
        if isinstance(action, Pick):
            break
        agent.observe("")
    assert done[0] == (Point, 0)
    assert done[-1][0] is Pick
    assert 5 <= done[1][1] <= 7
    assert len(done) <= 4

"""Interactions with a person sampled from the model."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.random import Generator

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Decision, Planner, pick_values, unvalued
from fetch_pomdp.core.planners.catalogue import PLANNERS
from fetch_pomdp.core.planners.exact import ExactAnswers
from fetch_pomdp.core.planners.fixed import AlwaysAsk, NeverAsk
from fetch_pomdp.core.planners.sparse import SparseSampling
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import MOST_STEPS, run_episode, simulate
from fetch_pomdp.errors import PlannerError
from tests.tables import twins

PROBLEMS = {name: Problem(Scene.load(name)) for name in ("ambiguous", "unambiguous")}


class Scripted:
    """A planner that follows a rule, and notes what it is told."""

    def __init__(self, rule: Callable[[int], Action]) -> None:
        self.rule, self.asked, self.beliefs = rule, list[int | None](), list[Belief]()

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        del rng
        action = self.rule(len(self.asked))
        self.asked.append(asked)
        self.beliefs.append(belief)
        return Decision(action, 0.0, unvalued(problem), pick_values(belief.probabilities, problem))


def test_rewards_add_up_to_the_return() -> None:
    script: list[Action] = [Wait(), Point(1), Wait(), Point(0), Pick(2)]
    for desired, last in [(2, 10.0), (0, -12.5)]:
        planner = Scripted(lambda step: script[step])
        episode = run_episode(
            PROBLEMS["ambiguous"], planner, desired, np.random.default_rng(0), np.random.default_rng(0)
        )
        assert episode.earned == pytest.approx(-1 - 6 - 1 - 6 + last)
        assert episode.correct == (desired == 2)
        assert (episode.steps, episode.questions) == (4, 2)
        assert planner.asked == [None, None, 1, 1, 0]


def test_an_episode_starts_at_the_uniform_prior_and_listens_after_each_action() -> None:
    planner = Scripted(lambda step: Wait() if step < 5 else Pick(0))
    run_episode(PROBLEMS["ambiguous"], planner, 3, np.random.default_rng(1), np.random.default_rng(0))
    assert planner.beliefs[0].probabilities == pytest.approx([1 / 6] * 6)
    assert planner.beliefs[-1].probabilities[2:4].sum() > 0.9


def test_thirty_waits_and_questions_and_then_no_more() -> None:
    episode = run_episode(
        PROBLEMS["ambiguous"], Scripted(lambda _: Wait()), 0, np.random.default_rng(0), np.random.default_rng(0)
    )
    assert (episode.earned, episode.correct, episode.steps) == (-30.0, False, 30)
    questions = run_episode(
        PROBLEMS["ambiguous"], Scripted(lambda _: Point(0)), 0, np.random.default_rng(0), np.random.default_rng(0)
    )
    assert (questions.earned, questions.questions) == (-180.0, 30)
    assert MOST_STEPS == 30


@pytest.mark.parametrize(("waits", "earned", "correct"), [(29, -19.0, True), (30, -30.0, False)])
def test_after_thirty_steps_no_pick_is_made(waits: int, earned: float, correct: bool) -> None:
    planner = Scripted(lambda step: Wait() if step < waits else Pick(0))
    episode = run_episode(PROBLEMS["ambiguous"], planner, 0, np.random.default_rng(0), np.random.default_rng(0))
    assert (episode.earned, episode.correct, episode.steps) == (earned, correct, waits)


def test_a_number_of_episodes_or_a_seed_that_is_none() -> None:
    for episodes, seed in ((0, 0), (1, -1)):
        with pytest.raises(PlannerError):
            simulate(PROBLEMS["ambiguous"], PLANNERS["always"](), episodes, seed)


@pytest.mark.parametrize("name", sorted(PLANNERS))
def test_same_seed_same_result(name: str) -> None:
    first, second = (simulate(PROBLEMS["ambiguous"], PLANNERS[name](), 20, 3) for _ in range(2))
    assert first == second
    assert simulate(PROBLEMS["ambiguous"], PLANNERS[name](), 20, 4) != first


@pytest.mark.parametrize("name", sorted(PLANNERS))
@pytest.mark.parametrize("layout", sorted(PROBLEMS))
def test_means_satisfy_the_identity_of_the_return(name: str, layout: str) -> None:
    found = simulate(PROBLEMS[layout], PLANNERS[name](), 60, 0)
    waits = found.mean_steps - found.mean_questions
    # With these seeds every episode ends with a pick.
    expected = 10 * found.accuracy - 12.5 * (1 - found.accuracy) - waits - 6 * found.mean_questions
    assert found.mean_return == pytest.approx(expected, abs=1e-9)


def test_every_item_is_desired_equally_often() -> None:
    found = simulate(twins(3), Scripted(lambda _: Pick(1)), 30, 0)
    assert found.accuracy == pytest.approx(1 / 3)
    assert found.mean_return == pytest.approx(-5.0)
    assert found.standard_error == pytest.approx(22.5 * math.sqrt(2 / 9 * 30 / 29) / math.sqrt(30))
    assert simulate(twins(3), Scripted(lambda _: Pick(1)), 1, 0).standard_error == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "layout", "expected", "known_within"),
    [
        # `known_within`: 95 % of the number measured before.
        (lambda: SparseSampling(depth=2, width=10), "ambiguous", -0.75, 0.07),
        (lambda: SparseSampling(depth=2, width=10), "unambiguous", 0.72, 0.06),
        (lambda: ExactAnswers(depth=2, width=10, leaf="pick"), "ambiguous", -0.75, 0.07),
        (lambda: ExactAnswers(depth=2, width=10, leaf="pick"), "unambiguous", 0.72, 0.06),
        (NeverAsk, "ambiguous", -4.3, 0.1),
        (NeverAsk, "unambiguous", -1.3, 0.1),
        (AlwaysAsk, "ambiguous", -3.6, 0.1),
        (AlwaysAsk, "unambiguous", -2.5, 0.1),
    ],
)
def test_mean_returns_measured_before(
    make: Callable[[], Planner], layout: str, expected: float, known_within: float
) -> None:
    found = simulate(PROBLEMS[layout], make(), 4_000, 1)
    assert abs(found.mean_return - expected) <= 4 * found.standard_error + 2 * known_within


@pytest.mark.slow
@pytest.mark.parametrize(("layout", "least", "accuracy"), [("ambiguous", -0.50, 0.96), ("unambiguous", 1.45, 0.97)])
def test_default_planner_earns_at_least(layout: str, least: float, accuracy: float) -> None:
    found = simulate(PROBLEMS[layout], ExactAnswers(), 4_000, 2)
    assert found.mean_return >= least - 3 * found.standard_error
    assert found.accuracy == pytest.approx(accuracy, abs=0.02)

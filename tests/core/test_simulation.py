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
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.catalogue import PLANNERS
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.planners.thresholds import Threshold
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

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
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


def test_thirty_waits_and_questions_and_then_the_likeliest_item() -> None:
    problem = PROBLEMS["ambiguous"]
    for desired in range(2):
        episode = run_episode(
            problem, Scripted(lambda _: Point(0)), desired, np.random.default_rng(0), np.random.default_rng(0)
        )
        # Thirty answers, 99 % of them true, leave no doubt.
        assert (episode.earned, episode.correct, episode.steps, episode.questions) == (-170.0, True, 30, 30)
    assert MOST_STEPS == 30


@pytest.mark.parametrize("waits", [29, 30])
def test_no_planner_is_asked_after_thirty_steps(waits: int) -> None:
    planner = Scripted(lambda step: Wait() if step < waits else Pick(0))
    episode = run_episode(PROBLEMS["ambiguous"], planner, 0, np.random.default_rng(0), np.random.default_rng(0))
    assert (len(planner.asked), episode.steps) == (30, waits)
    assert episode.earned == -waits + (10 if episode.correct else -12.5)


def test_simulated_interactions_end_alike() -> None:
    """On three twins answers alone tell, so thirty questions about the first end with it, or with another."""
    found = simulate(twins(3), Scripted(lambda _: Point(0)), 300, 0)
    assert (found.mean_steps, found.mean_questions) == (30.0, 30.0)
    assert found.accuracy == pytest.approx(2 / 3, abs=0.01)  # the first, or the second of two that stay equal


def test_a_number_of_episodes_or_a_seed_that_is_none() -> None:
    for episodes, seed in ((0, 0), (1, -1)):
        with pytest.raises(PlannerError):
            simulate(PROBLEMS["ambiguous"], PLANNERS["paper-always"](), episodes, seed)


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
        (PaperNeverAsk, "ambiguous", -4.3, 0.1),
        (PaperNeverAsk, "unambiguous", -1.3, 0.1),
        (PaperAlwaysAsk, "ambiguous", -3.6, 0.1),
        (PaperAlwaysAsk, "unambiguous", -2.5, 0.1),
    ],
)
def test_mean_returns_measured_before(
    make: Callable[[], Planner], layout: str, expected: float, known_within: float
) -> None:
    found = simulate(PROBLEMS[layout], make(), 4_000, 1)
    assert abs(found.mean_return - expected) <= 4 * found.standard_error + 2 * known_within


@pytest.mark.slow
@pytest.mark.parametrize(("layout", "least", "accuracy"), [("ambiguous", -0.27, 0.97), ("unambiguous", 1.76, 0.98)])
def test_default_planner_earns_at_least(layout: str, least: float, accuracy: float) -> None:
    found = simulate(PROBLEMS[layout], FittedValue(), 40_000, 2)
    assert found.mean_return >= least - 3 * found.standard_error
    assert found.accuracy == pytest.approx(accuracy, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("layout", sorted(PROBLEMS))
def test_episodes_side_by_side_are_those_of_the_plain_loop(layout: str) -> None:
    """`simulate` draws people with compiled samplers, `run_episode` with those of the model: the same distribution."""
    problem, planner = PROBLEMS[layout], Threshold()
    fast = simulate(problem, planner, 100_000, 0)
    episodes = [
        run_episode(problem, planner, k % problem.n_items, np.random.default_rng((9, k)), np.random.default_rng(k))
        for k in range(6_000)
    ]
    for found, expected in (
        ([episode.earned for episode in episodes], fast.mean_return),
        ([episode.steps for episode in episodes], fast.mean_steps),
        ([episode.questions for episode in episodes], fast.mean_questions),
        ([episode.correct for episode in episodes], fast.accuracy),
    ):
        assert abs(np.mean(found) - expected) < 4.2 * np.std(found) / math.sqrt(len(found))


def test_an_episode_is_the_same_in_whatever_company() -> None:
    """The first people of a seed are the same in a short run and a long one."""
    few, many = (simulate(PROBLEMS["ambiguous"], Threshold(), episodes, 5) for episodes in (600, 601))
    last = 601 * many.mean_return - 600 * few.mean_return
    assert last == pytest.approx(round(2 * last) / 2, abs=1e-6)  # rewards are multiples of a half
    assert -250 < last <= 10

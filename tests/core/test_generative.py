"""The model as a generative function: rewards, transitions, observations."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.generative import State, asked_after, reward, step
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from tests.oracles.model import NO_WORDS, YES_WORDS
from tests.tables import table, twins

PROBLEM = Problem(Scene.load("ambiguous"))


@pytest.mark.parametrize(
    ("action", "expected"),
    [(Pick(2), 10.0), (Pick(1), -12.5), (Point(2), -6.0), (Point(0), -6.0), (Wait(), -1.0)],
)
def test_rewards_of_the_table(action: Action, expected: float) -> None:
    assert reward(State(2), action, PROBLEM) == expected
    assert step(PROBLEM, State(2, 5), action, np.random.default_rng(0))[2] == expected


@pytest.mark.parametrize("asked", [None, 1, 4])
def test_transition_is_deterministic(asked: int | None) -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        assert step(PROBLEM, State(3, asked), Wait(), rng)[0] == State(3, asked)
        assert step(PROBLEM, State(3, asked), Point(5), rng)[0] == State(3, 5)
    assert asked_after(Wait(), asked) == asked
    assert asked_after(Pick(0), asked) == asked
    assert asked_after(Point(0), asked) == 0


def test_a_pick_ends_without_observation() -> None:
    state, seen, _ = step(PROBLEM, State(3, 1), Pick(0), np.random.default_rng(0))
    assert state == State(3, 1)
    assert seen is None


@pytest.mark.parametrize(
    ("again", "action", "asked", "p_yes", "p_no"),
    [
        (1.0, Point(0), None, 0.95 * 0.9, 0.95 * 0.1),  # answers the question of this very step
        (1.0, Point(1), 0, 0.95 * 0.1, 0.95 * 0.9),
        (1.0, Wait(), 0, 0.95 * 0.9, 0.95 * 0.1),  # to the letter: again at every step
        (0.4, Wait(), 0, 0.38 * 0.9, 0.38 * 0.1),
        (0.4, Point(0), 0, 0.95 * 0.9, 0.95 * 0.1),
        (0.0, Wait(), 0, 0.0, 0.0),
        (1.0, Wait(), None, 0.475, 0.475),
    ],
)
def test_answers_come_at_their_rate(again: float, action: Action, asked: int | None, p_yes: float, p_no: float) -> None:
    problem, draws = twins(2, p_truth=0.9, p_answer_again=again), 4_000
    rng = np.random.default_rng(1)
    counts: Counter[str] = Counter()
    for _ in range(draws):
        seen = step(problem, State(0, asked), action, rng)[1]
        assert seen is not None
        counts["yes"] += any(word in YES_WORDS for word in seen.words)
        counts["no"] += any(word in NO_WORDS for word in seen.words)
    for answer, chance in (("yes", p_yes), ("no", p_no)):
        assert abs(counts[answer] / draws - chance) <= 4 * math.sqrt(chance * (1 - chance) / draws)


def test_at_most_one_base_word_and_one_answer_a_step() -> None:
    problem, rng = table([["cup", "mug"], ["pot"]]), np.random.default_rng(2)
    for _ in range(500):
        seen = step(problem, State(0, 1), Wait(), rng)[1]
        assert seen is not None
        answers = [word for word in seen.words if word in YES_WORDS + NO_WORDS]
        assert len(answers) <= 1
        assert len(seen.words) - len(answers) <= 1


def test_same_generator_same_step() -> None:
    first, second = (step(PROBLEM, State(0), Point(1), np.random.default_rng(9)) for _ in range(2))
    assert first == second

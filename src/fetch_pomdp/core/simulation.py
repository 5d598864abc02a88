"""Interactions with a person sampled from the model itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.planners.base import Planner, whole_number
from fetch_pomdp.core.problem import Problem

MOST_STEPS = 30  # waits and questions; an episode that has not picked by then ends


@dataclass(frozen=True, slots=True)
class Episode:
    """One interaction: its return, whether the right item was picked, and its waits and questions."""

    earned: float
    correct: bool
    steps: int
    questions: int


@dataclass(frozen=True, slots=True)
class Summary:
    """Means over episodes; `standard_error` is that of the mean return, steps count waits and questions."""

    episodes: int
    mean_return: float
    standard_error: float
    accuracy: float
    mean_steps: float
    mean_questions: float


def run_episode(problem: Problem, planner: Planner, desired: int, person: Generator, robot: Generator) -> Episode:
    """Play one interaction from the uniform belief; the person and the planner draw from generators of their own.

    Choice: the paper states no end; ours comes after 30 waits and questions without a pick, and earns nothing more.
    """
    state, belief = State(desired), Belief.uniform(problem.n_items)
    total, questions = 0.0, 0
    for steps in range(MOST_STEPS):
        action = planner.decide(problem, belief, state.asked, rng=robot).action
        state, observation, earned = step(problem, state, action, person)
        total += earned
        if observation is None:
            return Episode(total, action == Pick(state.desired), steps, questions)
        questions += isinstance(action, Point)
        belief = belief.updated(observation, state.asked, problem)
    return Episode(total, False, MOST_STEPS, questions)


def simulate(problem: Problem, planner: Planner, episodes: int, seed: int) -> Summary:
    """Play `episodes` interactions, each item being the desired one equally often; same seed, same result.

    Raises PlannerError for a number of episodes, or a seed, that is none.

    The person of an episode draws from a stream of the seed and the episode's number alone, so that planners are
    compared on the same people.
    """
    whole_number(episodes, 1, 10**9, "episodes")
    robot = np.random.default_rng(whole_number(seed, 0, 2**63 - 1, "seed"))
    played = [
        run_episode(problem, planner, episode % problem.n_items, np.random.default_rng((seed, episode)), robot)
        for episode in range(episodes)
    ]
    returns = np.array([episode.earned for episode in played])
    return Summary(
        episodes=episodes,
        mean_return=float(returns.mean()),
        standard_error=float(returns.std(ddof=1) / np.sqrt(episodes)) if episodes > 1 else 0.0,
        accuracy=float(np.mean([episode.correct for episode in played])),
        mean_steps=float(np.mean([episode.steps for episode in played])),
        mean_questions=float(np.mean([episode.questions for episode in played])),
    )

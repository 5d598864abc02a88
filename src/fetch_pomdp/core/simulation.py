"""Interactions with people sampled from the model itself: one in plain Python, or many side by side, compiled.

Side by side they go in step: all robots decide, then all people answer. A person draws from a stream of their own, so
an interaction is the same whatever goes on beside it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, on_all_cores
from fetch_pomdp.core.generative import State, reward, step
from fetch_pomdp.core.planners.base import Planner, decide_many, whole_number
from fetch_pomdp.core.planners.kernels import NOBODY, live_step, turn_of
from fetch_pomdp.core.problem import Problem, Tables, points_only

MOST_STEPS = 30  # waits and questions, after which the robot picks whatever it holds likeliest
MOST_SIDE_BY_SIDE = 16_384  # episodes
MOST_BELIEFS = 8_000_000  # numbers in the beliefs of episodes side by side

Decide = Callable[[Integers], Integers]


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

    Choice: the paper states no end; ours comes after 30 waits and questions, with a pick of the likeliest item. An end
    that earns nothing would reward robots that never pick where any pick is a loss.
    """
    state, belief = State(desired), Belief.uniform(problem.n_items)
    total, questions = 0.0, 0
    for steps in range(MOST_STEPS):
        action = planner.decide(problem, belief, state.asked, rng=robot, phase=state.phase).action
        chances = problem.step_chances(action, state.phase) if problem.model.turns else None
        state, observation, earned = step(problem, state, action, person)
        total += earned
        if observation is None:
            return Episode(total, action == Pick(state.desired), steps, questions)
        questions += isinstance(action, Point)
        belief = belief.updated(observation, state.asked, problem, chances=chances)
    last = Pick(int(belief.log_probabilities.argmax()))
    return Episode(total + reward(state, last, problem), last.item == desired, MOST_STEPS, questions)


class Interactions(NamedTuple):
    """k interactions: what each person wants, what each robot believes, and what it earned so far; changed in place."""

    desired: Integers  # (k,)
    people: RandomState  # (k,), states of `compiled.uniform`
    beliefs: Vector  # (k, n_items)
    asked: Integers  # (k,), i_r or -1
    phases: Integers  # (k,), see `turns`
    earned: Vector  # (k,)
    correct: Integers  # (k,), 1 where the right item was picked
    steps: Integers  # (k,), waits and questions
    questions: Integers  # (k,)
    over: Integers  # (k,), 1 after a pick

    @classmethod
    def begin(cls, desired: Integers, people: RandomState, n_items: int) -> Interactions:
        """Return interactions before their first action, with uniform beliefs."""
        count = len(desired)
        phases, *numbers = (np.zeros(count, dtype=np.int64) for _ in range(5))
        beliefs, asked = np.full((count, n_items), 1.0 / n_items), np.full(count, NOBODY)
        return cls(desired, people, beliefs, asked, phases, np.zeros(count), *numbers)

    def advance(self, active: Integers, actions: Integers, problem: Problem) -> None:
        """Do actions, (m,) as in `planners.base`, in the active interactions, (m,); people then speak and point."""

        def share(begin: int, end: int) -> None:
            _advance(active[begin:end], actions[begin:end], self, problem.tables)

        on_all_cores(share, len(active))

    def play_out(self, decide: Decide, problem: Problem) -> None:
        """Play on to the end of all; `decide` returns the actions, (m,), of the interactions that go on, (m,)."""
        active = np.arange(len(self.desired))
        for _ in range(MOST_STEPS):
            self.advance(active, decide(active), problem)
            active = active[self.over[active] == 0]
            if not len(active):
                return
        self.advance(active, problem.n_items + self.beliefs[active].argmax(axis=1), problem)


@compiled
def _advance(active: Integers, actions: Integers, interactions: Interactions, tables: Tables) -> None:
    desired, people, beliefs, asked, phases, earned, correct, steps, questions, over = interactions
    count = len(tables.smoothing)
    heard = np.empty(count)
    for index in range(len(active)):
        k, action = active[index], actions[index]
        if action >= count:
            correct[k] = 1 if action - count == desired[k] else 0
            earned[k] += tables.pick_correct if correct[k] else tables.pick_wrong
            over[k] = 1
            continue
        steps[k] += 1
        questions[k] += 0 if action == NOBODY else 1
        earned[k] += tables.wait if action == NOBODY else tables.point
        turn = turn_of(asked[k], phases[k], action)
        asked[k] = turn.about
        phases[k] = live_step(beliefs[k], turn, desired[k], heard, people[k : k + 1], tables)


def simulate(problem: Problem, planner: Planner, episodes: int, seed: int) -> Summary:
    """Play `episodes` interactions, each item being the desired one equally often; same seed, same result.

    Raises PlannerError for a number of episodes, or a seed, out of range.

    The person of an episode draws from a stream of the seed and the episode's number alone, so that planners are
    compared on the same people. Episodes are played side by side, on all cores where the planner decides in batches;
    the result does not depend on their number. Words and pointing are drawn by the planner's compiled samplers, which
    is why `run_episode`, in plain Python, plays other episodes of the same distribution.
    """
    whole_number(episodes, 1, 10**9, "episodes")
    points_only(problem, "`simulate`, unlike `simulate_asking`,")
    robot = np.random.default_rng(whole_number(seed, 0, 2**63 - 1, "seed"))
    people = np.random.default_rng((seed, 1))
    side = max(1, min(MOST_SIDE_BY_SIDE, MOST_BELIEFS // problem.n_items))
    totals = np.zeros(5)
    for begin in range(0, episodes, side):
        numbers = np.arange(begin, min(begin + side, episodes))
        streams = people.integers(2**63, size=len(numbers), dtype=np.uint64)
        begun = Interactions.begin(numbers % problem.n_items, streams, problem.n_items)
        played = played_out(problem, planner, begun, robot)
        totals += [
            played.earned.sum(),
            (played.earned**2).sum(),
            played.correct.sum(),
            played.steps.sum(),
            played.questions.sum(),
        ]
    mean, square, accuracy, steps, questions = (totals / episodes).tolist()
    spread = max(square - mean * mean, 0.0)
    return Summary(
        episodes=episodes,
        mean_return=mean,
        standard_error=math.sqrt(spread / (episodes - 1)) if episodes > 1 else 0.0,
        accuracy=accuracy,
        mean_steps=steps,
        mean_questions=questions,
    )


def played_out(problem: Problem, planner: Planner, interactions: Interactions, robot: Generator) -> Interactions:
    """Let a planner play interactions to their ends, and return them."""

    def decide(active: Integers) -> Integers:
        asked, phases = interactions.asked[active], interactions.phases[active]
        return decide_many(planner, problem, interactions.beliefs[active], asked, rng=robot, phases=phases)

    interactions.play_out(decide, problem)
    return interactions

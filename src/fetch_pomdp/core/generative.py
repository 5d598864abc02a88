"""The model as a plain generative function, for any sampling planner."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.action import Action, Pick, Point
from fetch_pomdp.core.language.unigram import answer_rate
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem


@dataclass(frozen=True, slots=True)
class State:
    """The state of Section III-B: the desired item, hidden, and the last item asked about, observed."""

    desired: int  # i_d
    asked: int | None = None  # i_r


def reward(state: State, action: Action, problem: Problem) -> float:
    """Return R(s, a) (Section III-B)."""
    rewards = problem.rewards
    if isinstance(action, Pick):
        return rewards.pick_correct if action.item == state.desired else rewards.pick_wrong
    return rewards.point if isinstance(action, Point) else rewards.wait


def asked_after(action: Action, asked: int | None) -> int | None:
    """Return i_r after an action: a question sets it, and it stays.

    Choice: the paper says that i_r changes "from null to i"; a second question replaces the first.
    """
    return action.item if isinstance(action, Point) else asked


def step(problem: Problem, state: State, action: Action, rng: Generator) -> tuple[State, Observation | None, float]:
    """Return the next state, the observation and the reward of an action; after a pick the observation is None."""
    earned = reward(state, action, problem)
    if isinstance(action, Pick):
        return state, None, earned
    following = State(state.desired, asked_after(action, state.asked))
    seen = observations.sample(state.desired, following.asked, problem, answer_rate(action, problem), rng)
    return following, seen, earned

"""The model as a plain generative function, for any sampling planner."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.action import Action, Pick, Point
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem


@dataclass(frozen=True, slots=True)
class State:
    """The state of Section III-B: the desired item, hidden, and the last item asked about, observed.

    The phase (`turns`) is observed too, and 0 under the paper's constant chances.
    """

    desired: int  # i_d
    asked: int | None = None  # i_r
    phase: int = 0


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
    """Return the next state, the observation and the reward of an action; after a pick the observation is None.

    Choice: live people answer only what was asked; the paper's may say "yes" or "no" to nothing (Table I, i_r null).
    """
    earned = reward(state, action, problem)
    if isinstance(action, Pick):
        return state, None, earned
    asked, chances = asked_after(action, state.asked), problem.step_chances(action, state.phase)
    if asked is None and problem.model.turns:
        chances = chances._replace(desired=0.0, other=0.0)
    seen = observations.sample(state.desired, asked, problem, chances, rng)
    phase = observations.phase_after(seen, action, problem, state.phase, asked=asked)
    return State(state.desired, asked, phase), seen, earned

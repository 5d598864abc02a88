"""Sparse sampling in plain NumPy, straight from Section III-D: what a lab would write first, and our yardstick.

It shares no code with the package's planners: every state-action node draws `width` observations of its own (one base
word, one response, a ray), each is answered by Bayes' rule, and with one action left a node is worth its best pick or
the reward of a wait. Actions are numbers here: 0 waits, i + 1 asks about item i.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.random import Generator

from fetch_pomdp import Action, Belief, Decision, Pick, Point, Problem, Wait

Vector = npt.NDArray[np.float64]
SILENCE, YES, NO = 0, 1, 2


class World:
    """The model of Section III as plain arrays."""

    def __init__(self, problem: Problem) -> None:
        items, self.model, self.rewards = problem.scene.items, problem.model, problem.rewards
        vocabulary = np.array([[word in item.vocabulary for word in problem.words] for item in items], dtype=float)
        smoothed = vocabulary + self.model.alpha
        self.words: Vector = smoothed / smoothed.sum(axis=1, keepdims=True)  # (n_items, n_words), Eq. 5
        rays = problem.positions - np.array(problem.scene.head)
        self.directions: Vector = rays / np.linalg.norm(rays, axis=1, keepdims=True)  # (n_items, 3)
        self.n_items = len(items)

    def heard(self, belief: Vector, desired: int, rng: Generator) -> Vector:
        """Return the belief, not normalised, after a base word and a gesture drawn for the desired item."""
        likelihood = belief
        if rng.random() < self.model.p_l:
            likelihood = likelihood * self.words[:, rng.choice(self.words.shape[1], p=self.words[desired])]
        if rng.random() < self.model.p_g:
            angles = self.angles(desired, rng)
            if angles.min() <= self.model.gesture_threshold:
                likelihood = likelihood * np.exp(-0.5 * (angles / self.model.sigma) ** 2)
        return likelihood

    def angles(self, desired: int, rng: Generator) -> Vector:
        """Return the angles (rad), (n_items,), of a ray drawn around the desired item to every item."""
        axis = self.directions[desired]
        across = np.cross(axis, rng.normal(size=3))
        across /= np.linalg.norm(across)
        angle = abs(rng.normal(0.0, self.model.sigma))
        ray = math.cos(angle) * axis + math.sin(angle) * across
        return np.asarray(np.arccos(np.clip(self.directions @ ray, -1.0, 1.0)))

    def answered(self, belief: Vector, desired: int, asked: int, rate: float, rng: Generator) -> Vector:
        """Return the belief, not normalised, after an answer drawn for the desired item (Eq. 6, Table I)."""
        if asked < 0 or rng.random() >= rate:
            return belief
        truthful = rng.random() < self.model.p_truth
        yes = truthful == (asked == desired)
        about = np.arange(self.n_items) == asked
        return np.where(about == yes, self.model.p_truth, 1.0 - self.model.p_truth) * belief

    def next_belief(self, belief: Vector, asked: int, rate: float, rng: Generator) -> Vector:
        """Return the belief after one observation drawn from it."""
        desired = int(rng.choice(self.n_items, p=belief))
        after = self.answered(self.heard(belief, desired, rng), desired, asked, rate, rng)
        return np.asarray(after / after.sum())


def pick_value(belief: Vector, world: World) -> float:
    """Return the expected reward of the best pick."""
    best = float(belief.max())
    return world.rewards.pick_correct * best + world.rewards.pick_wrong * (1.0 - best)


def node_value(belief: Vector, asked: int, depth: int, world: World, search: Search) -> float:
    """Return the value of a belief with `depth` actions left."""
    best_pick = pick_value(belief, world)
    if depth == 1:
        return max(best_pick, world.rewards.wait)
    return max(best_pick, float(action_values(belief, asked, depth, world, search).max()))


def action_values(belief: Vector, asked: int, depth: int, world: World, search: Search) -> Vector:
    """Return the value of a wait and of each question, (1 + n_items,)."""
    values = np.empty(1 + world.n_items)
    for action in range(1 + world.n_items):
        waits = action == 0
        about = asked if waits else action - 1
        rate = world.model.p_l * (world.model.p_answer_again if waits else 1.0)
        total = 0.0
        for _ in range(search.width):
            total += node_value(world.next_belief(belief, about, rate, search.rng), about, depth - 1, world, search)
        values[action] = (world.rewards.wait if waits else world.rewards.point) + total / search.width
    return values


@dataclass(frozen=True, slots=True)
class Search:
    """Observations a state-action node, and where their random numbers come from."""

    width: int
    rng: Generator


@dataclass(frozen=True, slots=True)
class PlainSparse:
    """The search as a Planner, for one problem, whose arrays it was built with."""

    world: World
    depth: int = 2
    width: int = 10

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest sampled value."""
        weights = belief.probabilities
        weights = weights / weights.sum()
        values = action_values(weights, -1 if asked is None else asked, self.depth, self.world, Search(self.width, rng))
        rewards = self.world.rewards
        pick = rewards.pick_wrong + (rewards.pick_correct - rewards.pick_wrong) * weights
        action: Action = Pick(int(pick.argmax()))
        if values.max() > pick.max():
            best = int(values.argmax())
            action = Wait() if best == 0 else Point(best - 1)
        return Decision(action, float(values[0]), values[1:], pick)

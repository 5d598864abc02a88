"""Perseus (Spaan and Vlassis 2005) on a world of `twelve`: the reference that the package's planner is held against."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from asking.twelve import Array, Decide, World, told

BELIEFS, SWEEPS = 500, 40


def solved(of: World, seed: int, beliefs: int = BELIEFS, sweeps: int = SWEEPS) -> Array:
    """Return the vectors, (k, n), of a world."""
    rng = np.random.default_rng(seed)
    points, vectors = collected(of, beliefs, rng), picks(of)
    values = (points @ vectors.T).max(axis=1)
    for _ in range(sweeps):
        todo, new, reached = np.arange(len(points)), [], np.full(len(points), -np.inf)
        while len(todo):
            belief = points[rng.choice(todo)]
            plan, value = backup(of, belief, vectors)
            before = vectors[(vectors @ belief).argmax()]
            new.append(plan if value >= before @ belief - 1e-9 else before)
            reached = np.maximum(reached, points @ new[-1])
            todo = np.flatnonzero(reached < values - 1e-9)
        vectors = np.array(new)
        values = (points @ vectors.T).max(axis=1)
    return vectors


def picks(of: World) -> Array:
    """Return the vectors of picking each item."""
    rewards = of.problem.rewards
    return np.where(np.eye(of.n) > 0, rewards.pick_correct, rewards.pick_wrong)


def stacked(of: World) -> Array:
    """Return all actions' observations as one array, (actions, n, most observations)."""
    most = max(o.shape[1] for o in of.o)
    return np.stack([np.pad(o, ((0, 0), (0, most - o.shape[1]))) for o in of.o])


def backup(of: World, belief: Array, vectors: Array) -> tuple[Array, float]:
    """Return the best plan for a belief, and its value."""
    best = picks(of)[belief.argmax()]
    value = float(best @ belief)
    for action, o in enumerate(of.o):
        scores = vectors @ (belief[:, None] * o)
        chosen = scores.argmax(axis=0)
        earned = of.costs[action] + scores[chosen, np.arange(len(chosen))].sum()
        if earned > value + 1e-12:
            value, best = earned, of.costs[action] + (o * vectors[chosen].T).sum(axis=1)
    return best, float(value)


def collected(of: World, count: int, rng: Generator) -> Array:
    """Return beliefs that interactions meet, with questions that tell most, and others."""
    found: list[Array] = []
    while len(found) < count:
        desired, belief = int(rng.integers(of.n)), np.full(of.n, 1.0 / of.n)
        if rng.random() < 0.5:
            chances = of.rays[desired, 1:] / of.rays[desired, 1:].sum()
            belief = belief * of.rays[:, 1 + rng.choice(of.n, p=chances)]
            belief /= belief.sum()
        found.append(belief)
        for _ in range(9):
            action = int(rng.integers(len(of.o)))
            if rng.random() < 0.7:
                action = int(told(of, belief[None]).argmax())
            o = of.o[action]
            belief = belief * o[:, rng.choice(o.shape[1], p=o[desired])]
            belief /= belief.sum()
            found.append(belief)
            if belief.max() > 0.999:
                break
    return np.array(found[:count])


def ahead(of: World, vectors: Array) -> Decide:
    """Return the robot that looks one step ahead of vectors."""
    o = stacked(of)
    rewards = of.problem.rewards

    def decide(beliefs: Array) -> NDArray[np.int64]:
        chosen = np.empty(len(beliefs), dtype=np.int64)
        for index, belief in enumerate(beliefs):
            joint = (belief[None, :, None] * o).transpose(1, 0, 2).reshape(of.n, -1)
            values = of.costs + (vectors @ joint).max(axis=0).reshape(len(of.o), -1).sum(axis=1)
            pick = rewards.pick_wrong + (rewards.pick_correct - rewards.pick_wrong) * belief.max()
            chosen[index] = values.argmax() if values.max() > pick + 1e-9 else -1
        return chosen

    return decide

"""Interactions with the same people for every planner, one by one in the results.

The same as `fetch_pomdp.simulate`, which returns the means alone: with the return of every episode, the difference
between two planners has an error of its own, well below that of either.
"""

from __future__ import annotations

import numpy as np

from fetch_pomdp import Planner, Problem
from fetch_pomdp.core.simulation import Interactions, played_out


def met(problem: Problem, planner: Planner, episodes: int, seed: int) -> Interactions:
    """Return the interactions at their ends; episode k meets the same person whatever the planner."""
    robot, people = np.random.default_rng(seed), np.random.default_rng((seed, 1))
    streams = people.integers(2**63, size=episodes, dtype=np.uint64)
    begun = Interactions.begin(np.arange(episodes) % problem.n_items, streams, problem.n_items)
    return played_out(problem, planner, begun, robot)

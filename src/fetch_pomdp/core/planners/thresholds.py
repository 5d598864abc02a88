"""Threshold: a policy of three numbers, and their tuning by simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector, compiled, lean, on_all_cores
from fetch_pomdp.core.planners.base import Decision, action_of, checked_asked, pick_values, unvalued
from fetch_pomdp.core.planners.kernels import NOBODY, leading
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import simulate
from fetch_pomdp.core.turns import MOST_ASKED
from fetch_pomdp.errors import PlannerError

Limits: TypeAlias = tuple[float, float, float]

PICKS = (0.0, 0.2, 0.3, 0.4, 0.45, *(0.5 + 0.02 * step for step in range(25)))
PAIRS = (*(0.4 + 0.03 * step for step in range(20)), 1.1)
HOLDS = (0.2, 1.1)
# Episodes, settings kept, and how far from them new ones are drawn.
HALVINGS = ((400, 60, 0.01), (2_000, 16, 0.01), (8_000, 6, 0.01), (20_000, 1, 0.0))


@dataclass(frozen=True, slots=True)
class Threshold:
    """Picks the likeliest item from belief `pick` on; else waits while the answer to a question about an item of belief
    above `hold` is out; else asks about the likeliest from a belief of the leading two of `pair` on; else waits. Before
    live people, what nobody has answered for long is out no more; after three such questions it picks.

    The defaults are one setting for both scenes of the study; `tuned` finds better ones. A limit above 1 is never
    reached. It values picks alone. Raises PlannerError for a limit that is no number from 0 to 2.
    """

    pick: float = 0.763
    pair: float = 0.870
    hold: float = 0.2

    def __post_init__(self) -> None:
        for name in ("pick", "pair", "hold"):
            value = checks.within(getattr(self, name), 0.0, 2.0, name, "a belief from 0, or a limit to 2", PlannerError)
            object.__setattr__(self, name, value)

    def decide(
        self,
        problem: Problem,
        belief: Belief,
        asked: int | None,
        *,
        rng: Generator,
        phase: int = 0,
    ) -> Decision:
        """Choose by rule."""
        probabilities = belief.probabilities
        limits, late = (self.pick, self.pair, self.hold), int(problem.tables.late[phase])
        action = ruled(probabilities, checked_asked(probabilities, asked, problem, phase), limits, late)
        return Decision(action_of(action, problem), np.nan, unvalued(problem), pick_values(probabilities, problem))

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief, on all cores; see `base.decide_many`."""
        actions = np.empty(len(beliefs), dtype=np.int64)
        late = problem.tables.late[np.zeros(len(beliefs), dtype=np.int64) if phases is None else phases]

        def share(begin: int, end: int) -> None:
            part = slice(begin, end)
            limits = (self.pick, self.pair, self.hold)
            _ruled_many(beliefs[part], asked[part], limits, late[part], actions[part])

        on_all_cores(share, len(beliefs))
        return actions


def tuned(problem: Problem, seed: int) -> Threshold:
    """Return the best thresholds of a grid, and of random settings near its best, by simulated return.

    Successive halving: settings that earn least on a few episodes are dropped before the others play more. All play
    with the same people.
    """
    rng = np.random.default_rng(seed)
    settings = [(pick, pair, hold) for pick in PICKS for pair in PAIRS for hold in HOLDS]
    for episodes, kept, spread in HALVINGS:
        earned = [simulate(problem, Threshold(*setting), episodes, seed).mean_return for setting in settings]
        settings = [settings[index] for index in np.argsort(-np.array(earned), kind="stable")[:kept]]
        if spread > 0.0:
            near = rng.normal(0.0, spread, (2, len(settings), 2))
            settings += [
                (float(np.clip(pick + a, 0, 2)), float(np.clip(pair + b, 0, 2)), hold)
                for moves in near
                for (pick, pair, hold), (a, b) in zip(settings[:kept], moves, strict=True)
            ]
    return Threshold(*settings[0])


@lean
def ruled(belief: Vector, asked: int, limits: Limits, late: int) -> int:
    """Return the action of three limits, as in `planners.base`. late: questions that nobody has answered for long."""
    pick, pair, hold = limits
    top = leading(belief)
    if top.b1 >= pick or late >= MOST_ASKED:
        return len(belief) + top.first
    if asked != NOBODY and belief[asked] > hold and late == 0:
        return NOBODY
    return top.first if top.b1 + top.b2 >= pair else NOBODY


@compiled
def _ruled_many(beliefs: Vector, asked: Integers, limits: Limits, late: Integers, actions: Integers) -> None:
    for index in range(len(beliefs)):
        actions[index] = ruled(beliefs[index], asked[index], limits, late[index])

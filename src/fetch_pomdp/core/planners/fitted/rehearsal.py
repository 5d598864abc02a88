"""What becomes of a table's policy with people: interactions that it plays before it is used.

They show what the table itself does not know: how often an interaction is cut short after LONGEST steps, and how far
the filter's beliefs are from being probabilities. Eq. 7 is not the density of the rays that are sampled (`gesture`), so
that beliefs under it hold too little: an item of belief 0.9 is the desired one more often than nine times of ten. The
power of a belief that is most likely given what was desired mends that (temperature scaling: Guo et al. 2017).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, inlined
from fetch_pomdp.core.planners.fitted.table import ValueTable, table_action
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, leading, live_step, smoothed_mass
from fetch_pomdp.core.problem import Tables

LONGEST = 30  # steps of an interaction, after which the robot has to pick
MOST_NOTED, NUMBERS_NOTED = 20_000, 200_000  # beliefs, and their entries in all
NOTED_EVERY = 4  # steps
MOST_ENDS = 0.02
WEAKEST, STRONGEST = 0.25, 4.0  # powers


class Rehearsal(NamedTuple):
    """k interactions, and m of the beliefs that were met in them."""

    earned: Vector  # (k,)
    steps: Integers  # (k,)
    beliefs: Vector  # (m, n_items), the filter's
    desired: Integers  # (m,)

    @property
    def ends(self) -> float:
        """A chance for a step to be the last one, the same for all steps, that plans well for one end at LONGEST.

        Choice: twice the share of steps that were the last one allowed, at most MOST_ENDS: of what was tried (once,
        twice, and fixed shares) this earned most on random scenes.
        """
        return min(2.0 * float((self.steps == LONGEST).sum() / max(1, self.steps.sum())), MOST_ENDS)

    @property
    def power(self) -> float:
        """The power of the beliefs, scaled to a sum of 1, under which the items desired were most likely."""
        return likeliest_power(self.beliefs, self.desired)


def rehearse(table: ValueTable, power: float, count: int, seed: int, plan: Tables, tables: Tables) -> Rehearsal:
    """Play `count` interactions of a table's policy that reads a power of the filter's beliefs.

    plan: what the table was fitted to; tables: of the filter and the people.
    """
    people = np.random.default_rng(seed).integers(2**63, size=count, dtype=np.uint64)
    earned, steps, n_items = np.zeros(count), np.zeros(count, dtype=np.int64), len(tables.smoothing)
    most = min(MOST_NOTED, NUMBERS_NOTED // n_items)
    beliefs, desired = np.empty((most, n_items)), np.empty(most, dtype=np.int64)
    noted = _play(table, power, people, earned, steps, beliefs, desired, plan, tables)
    return Rehearsal(earned, steps, beliefs[:noted], desired[:noted])


@compiled
def _play(
    table: ValueTable, power: float, people: RandomState, earned: Vector, steps: Integers,
    beliefs: Vector, desired: Integers, plan: Tables, tables: Tables,
) -> int:  # fmt: skip
    count, noted = len(tables.smoothing), 0
    belief, read, work = np.empty(count), np.empty(count), np.empty(count)
    for k in range(len(people)):
        state, wanted, asked, phase = people[k : k + 1], k % count, NOBODY, 0
        belief[:] = 1.0 / count
        while True:
            if (k + steps[k]) % NOTED_EVERY == 0 and noted < len(beliefs):
                beliefs[noted], desired[noted] = belief, wanted
                noted += 1
            sharpen(belief, power, read)
            top = leading(read)
            action = table_action(read, asked, phase, top, table, plan)
            if action >= count or steps[k] == LONGEST:
                earned[k] += tables.pick_correct if top.first == wanted else tables.pick_wrong
                break
            steps[k] += 1
            earned[k] += tables.wait if action == NOBODY else tables.point
            kind = WAITED if action == NOBODY else ASKED
            asked = asked if action == NOBODY else action
            phase = live_step(belief, smoothed_mass(belief, tables), wanted, asked, phase, kind, work, state, tables)
    return noted


@inlined
def sharpen(belief: Vector, power: float, result: Vector) -> None:
    """Fill in a power of a belief, scaled to a sum of 1."""
    if power == 1.0:
        for item in range(len(belief)):
            result[item] = belief[item]
        return
    total = 0.0
    for item in range(len(belief)):
        result[item] = belief[item] ** power
        total += result[item]
    for item in range(len(belief)):
        result[item] /= total


@compiled
def sharpened(belief: Vector, power: float) -> Vector:
    """Return a power of a belief, scaled to a sum of 1."""
    result = np.empty(len(belief))
    sharpen(belief, power, result)
    return result


def likeliest_power(beliefs: Vector, desired: Integers) -> float:
    """Return the power of (m, n_items) beliefs under which the items desired, (m,), were most likely.

    The likelihood is concave in the power, so Newton's steps find it; from WEAKEST to STRONGEST, and 1 where no belief
    tells anything.
    """
    logs = np.log(np.maximum(beliefs, 1e-300))
    power = 1.0
    for _ in range(20):
        weights = np.exp(power * (logs - logs.max(axis=1, keepdims=True)))
        weights /= weights.sum(axis=1, keepdims=True)
        mean = (weights * logs).sum(axis=1)
        slope = (logs[np.arange(len(logs)), desired] - mean).sum()
        bend = (weights * (logs - mean[:, None]) ** 2).sum()
        if bend <= 1e-9 * max(1, len(logs)):
            break
        before, power = power, float(np.clip(power + slope / bend, WEAKEST, STRONGEST))
        if abs(power - before) < 1e-4:
            break
    return power

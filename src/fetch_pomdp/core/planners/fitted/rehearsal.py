"""What becomes of a table's policy with people: interactions that it plays before it is used.

They show what the table itself does not know: how often an interaction is cut short after MOST_STEPS steps, and how far
the filter's beliefs are from being probabilities. Eq. 7 is not the density of the rays that are sampled (`gesture`), so
that beliefs under it hold too little: an item of belief 0.9 is the desired one more often than nine times of ten. The
power of a belief that is most likely given what was desired mends that (temperature scaling: Guo et al. 2017).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector, compiled, inlined
from fetch_pomdp.core.planners.fitted.table import ValueTable, table_action
from fetch_pomdp.core.planners.kernels import leading
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.simulation import MOST_STEPS, Interactions

MOST_NOTED, NUMBERS_NOTED = 20_000, 200_000  # beliefs, and their entries in all
NOTED_EVERY = 4  # steps
MOST_ENDS = 0.02
WEAKEST, STRONGEST = 0.25, 4.0  # powers


class Policy(NamedTuple):
    """A table, the power of a belief that it reads, and what it was fitted to."""

    table: ValueTable
    power: float
    plan: Tables


class Rehearsal(NamedTuple):
    """k interactions, and m of the beliefs that were met in them."""

    earned: Vector  # (k,)
    steps: Integers  # (k,)
    beliefs: Vector  # (m, n_items), the filter's
    desired: Integers  # (m,)

    @property
    def ends(self) -> float:
        """A chance for a step to be the last one, the same for all steps, that plans well for one end at MOST_STEPS.

        Choice: twice the share of steps that were the last one allowed, at most MOST_ENDS: of what was tried (once,
        twice, and fixed shares) this earned most on random scenes.
        """
        return min(2.0 * float((self.steps == MOST_STEPS).sum() / max(1, self.steps.sum())), MOST_ENDS)

    @property
    def power(self) -> float:
        """The power of the beliefs, scaled to a sum of 1, under which the items desired were most likely."""
        return likeliest_power(self.beliefs, self.desired)


def rehearse(policy: Policy, count: int, seed: int, problem: Problem) -> Rehearsal:
    """Play `count` interactions of a policy with a problem's people; it reads its power of the filter's beliefs."""
    n_items = problem.n_items
    people = np.random.default_rng(seed).integers(2**63, size=count, dtype=np.uint64)
    played = Interactions.begin(np.arange(count) % n_items, people, n_items)
    places, beliefs = list[Integers](), list[Vector]()

    def note(those: Integers) -> None:
        noted = those[(those + played.steps[those]) % NOTED_EVERY == 0]
        places.append(noted * (MOST_STEPS + 1) + played.steps[noted])
        beliefs.append(played.beliefs[noted])

    def decide(active: Integers) -> Integers:
        note(active)
        actions = np.empty(len(active), dtype=np.int64)
        policy_actions(played.beliefs[active], played.asked[active], played.phases[active], policy, actions)
        return actions

    played.play_out(decide, problem)
    note(np.flatnonzero(played.steps == MOST_STEPS))
    place = np.concatenate(places)
    first = place.argsort()[: min(MOST_NOTED, NUMBERS_NOTED // n_items)]  # one interaction after the other
    desired = played.desired[place[first] // (MOST_STEPS + 1)]
    return Rehearsal(played.earned, played.steps, np.concatenate(beliefs)[first], desired)


@compiled
def policy_actions(beliefs: Vector, asked: Integers, phases: Integers, policy: Policy, actions: Integers) -> None:
    """Fill in the action of a policy for every belief, (k,), as in `planners.base`."""
    read = np.empty(beliefs.shape[1])
    for index in range(len(beliefs)):
        sharpen(beliefs[index], policy.power, read)
        actions[index] = table_action(read, asked[index], phases[index], leading(read), policy.table, policy.plan)


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

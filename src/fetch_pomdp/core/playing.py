"""Interactions with people drawn from the model, many side by side, compiled.

They go in step: all robots decide, then all people answer. A person draws from a stream of their own, so an interaction
is the same whatever goes on beside it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled
from fetch_pomdp.core.planners.batch import on_all_cores
from fetch_pomdp.core.planners.kernels import NOBODY, live_step
from fetch_pomdp.core.planners.outlook import smoothed_mass
from fetch_pomdp.core.problem import Problem, Tables


@dataclass(slots=True, eq=False)
class Interactions:
    """k interactions: what each person wants, what each robot believes, and what it earned so far."""

    desired: Integers  # (k,)
    people: RandomState  # (k,), states of `compiled.uniform`
    beliefs: Vector  # (k, n_items)
    asked: Integers  # (k,), i_r or -1
    earned: Vector  # (k,)
    correct: Integers  # (k,), 1 where the right item was picked
    steps: Integers  # (k,), waits and questions
    questions: Integers  # (k,)
    over: Integers  # (k,), 1 after a pick

    @classmethod
    def begin(cls, desired: Integers, people: RandomState, n_items: int) -> Interactions:
        """Return interactions before their first action, with uniform beliefs."""
        count = len(desired)
        numbers = [np.zeros(count, dtype=np.int64) for _ in range(4)]
        beliefs, asked = np.full((count, n_items), 1.0 / n_items), np.full(count, NOBODY)
        return cls(desired, people, beliefs, asked, np.zeros(count), *numbers)

    def advance(self, active: Integers, actions: Integers, problem: Problem) -> None:
        """Do actions, (m,) as in `planners.batch`, in the active interactions, (m,); people then speak and point."""

        def share(begin: int, end: int) -> None:
            _advance(
                active[begin:end], actions[begin:end], self.desired, self.people, self.beliefs, self.asked,
                self.earned, self.correct, self.steps, self.questions, self.over, problem.tables,
            )  # fmt: skip

        on_all_cores(share, len(active))


@compiled
def _advance(
    active: Integers, actions: Integers, desired: Integers, people: RandomState, beliefs: Vector, asked: Integers,
    earned: Vector, correct: Integers, steps: Integers, questions: Integers, over: Integers, tables: Tables,
) -> None:  # fmt: skip
    count = len(tables.smoothing)
    work = np.empty(count)
    for index in range(len(active)):
        k, action = active[index], actions[index]
        if action >= count:
            correct[k] = 1 if action - count == desired[k] else 0
            earned[k] += tables.pick_correct if correct[k] else tables.pick_wrong
            over[k] = 1
            continue
        steps[k] += 1
        rate = tables.p_again
        earned[k] += tables.wait if action == NOBODY else tables.point
        if action != NOBODY:
            questions[k] += 1
            asked[k], rate = action, tables.p_l
        smoothed = smoothed_mass(beliefs[k], tables)
        live_step(beliefs[k], smoothed, desired[k], asked[k], rate, work, people[k : k + 1], tables)

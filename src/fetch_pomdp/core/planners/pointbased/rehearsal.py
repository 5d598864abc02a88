"""How far the filter's beliefs are from probabilities, found by playing with people from the model.

Eq. 7 is no density of the rays that are sampled, so that beliefs under it hold too little. The power of a belief under
which the items desired were likeliest mends that, as it does in `fitted.rehearsal`.
"""

from __future__ import annotations

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.asking import Asked
from fetch_pomdp.core.planners.fitted.rehearsal import likeliest_power
from fetch_pomdp.core.planners.pointbased.ahead import Solved, step_ahead_many
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.simulation import AskingInteractions, played_out

PEOPLE = 400
LEAST = 1.05  # power, below which a belief is read as it is


def power_of(known: Solved, problem: Problem, seed: int) -> float:
    """Return the power of a belief to read; 1 where the filter is exact.

    Choice: the power itself, where `fitted.selection` tries parts of it too: plans foresee what people's own rays tell
    (`steps.outcomes_of`), and not what the filter makes of them.
    """
    if problem.tables.exact or problem.tables.p_g == 0.0:
        return 1.0
    people = np.random.default_rng(seed).integers(2**63, size=PEOPLE, dtype=np.uint64)
    begun = AskingInteractions.begin(np.arange(PEOPLE) % problem.n_items, people, problem)
    beliefs, desired = list[Vector](), list[Integers]()

    def decide(active: Integers, asked: Asked) -> Integers:
        beliefs.append(begun.beliefs[active])
        desired.append(begun.desired[active])
        actions = np.empty(len(active), dtype=np.int64)
        step_ahead_many(begun.beliefs[active], asked.last, asked.answers, known, actions)
        return actions

    played_out(problem, begun, decide)
    power = likeliest_power(np.concatenate(beliefs), np.concatenate(desired))
    return power if power >= LEAST else 1.0

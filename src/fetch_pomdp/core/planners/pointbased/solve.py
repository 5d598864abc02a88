"""Point-based value iteration (Pineau et al. 2003) on the beliefs that interactions meet.

Those are met with questions that tell most for their price, with actions drawn at random and, from the second round on,
with the plans found so far. Half of the interactions begin with a word or a pointing, as requests do. A sweep looks one
step ahead from every belief, and keeps of the plans found so many that none is worth much more anywhere than those.

Choice: not Perseus (Spaan and Vlassis 2005), which keeps what it found where a step ahead finds nothing better. Its
plans then begin well and go on with plans that are no longer there: one step ahead of them, robots waited for a value
that they could not reach.
"""

from __future__ import annotations

import numpy as np

from fetch_pomdp.core.compiled import RandomState, Vector, compiled, lean, random_state, uniform
from fetch_pomdp.core.planners.kernels import normalise
from fetch_pomdp.core.planners.pointbased.backup import Memory, Steps, Vectors, backup
from fetch_pomdp.core.questions.rows import information

CAPACITY = 256  # plans
REFINED = 4  # questions that are valued by all outcomes
SWEEPS = (4, 6, 14)  # of each round; the last as many as robots wait in a row where that is cheap
BELIEFS = 320  # a round
LONGEST = 14  # steps of an interaction that beliefs are collected in
SURE = 0.999
SLACK = 0.05  # points


@compiled
def memory_for(steps: Steps, refined: int) -> Memory:
    """Return what a step ahead works in."""
    questions, items = len(steps.prices), steps.rows.shape[1]
    return Memory(
        np.empty(items), np.empty((len(steps.outcomes), items)), np.empty(items),
        np.empty(CAPACITY, dtype=np.float32), np.empty(items + 3, dtype=np.int64), np.empty(questions),
        np.full(min(refined, questions), -1), np.empty(items), np.empty(items), np.empty(items),
    )  # fmt: skip


def solved(steps: Steps, seed: int) -> Vectors:
    """Return plans for a set of questions; same seed, same plans."""
    vectors = no_vectors(steps)
    memory, state = memory_for(steps, REFINED), random_state(seed)
    beliefs = np.empty((0, steps.rows.shape[1]))
    for number, sweeps in enumerate(SWEEPS):
        more = np.empty((BELIEFS, steps.rows.shape[1]))
        collect(steps, vectors, memory, state, number, more)
        beliefs = np.concatenate([beliefs, more])[-2 * BELIEFS :]
        for _ in range(sweeps):
            sweep(beliefs, SLACK, steps, vectors, memory, state)
    return vectors


@compiled
def no_vectors(steps: Steps) -> Vectors:
    """Return the plans to start from: the pick of each item."""
    items = steps.rows.shape[1]
    values = np.full((items, CAPACITY), steps.wrong, dtype=np.float32)
    for item in range(items):
        values[item, item] = steps.right
    return Vectors(values, np.array([items]))


@compiled
def sweep(beliefs: Vector, slack: float, steps: Steps, vectors: Vectors, memory: Memory, state: RandomState) -> None:
    """Replace the plans by those of all beliefs one step ahead of them, but for plans that others nearly match.

    Every belief keeps the value of its step ahead, within `slack` points.
    """
    count, items = beliefs.shape
    values, plans, order = np.empty(count), np.empty((count, items)), np.arange(count)
    for index in range(count):
        values[index], _ = backup(beliefs[index], steps, vectors, memory)
        plans[index] = memory.plan
    for index in range(count - 1, 0, -1):
        place = int(uniform(state) * (index + 1))
        order[index], order[place] = order[place], order[index]
    reached = np.full(count, -np.inf)
    vectors.size[0] = 0
    for one in order:
        index = int(one)
        if reached[index] >= values[index] - slack or vectors.size[0] == CAPACITY:
            continue
        vectors.values[:, vectors.size[0]] = plans[index]
        vectors.size[0] += 1
        for other in range(count):
            total = 0.0
            for item in range(items):
                total += beliefs[other, item] * plans[index, item]
            reached[other] = max(reached[other], total)


@compiled
def collect(steps: Steps, vectors: Vectors, memory: Memory, state: RandomState, number: int, beliefs: Vector) -> None:
    """Fill in beliefs that interactions meet, (count, n_items)."""
    items, filled = beliefs.shape[1], 0
    belief = np.empty(items)
    questions = len(steps.prices)
    while filled < len(beliefs):
        desired = int(uniform(state) * items)
        for item in range(items):
            belief[item] = 1.0 / items
        if uniform(state) < 0.5:
            begin_with_a_sign(belief, desired, steps, state)
        greedy = uniform(state)
        if number > 0 and uniform(state) < 0.5:
            greedy = -1.0
        for _ in range(LONGEST):
            beliefs[filled] = belief
            filled += 1
            if filled == len(beliefs) or belief.max() > SURE:
                break
            drawn = uniform(state)
            if greedy < 0.0 and drawn >= 0.15:
                _, action = backup(belief, steps, vectors, memory)
                if action > questions:
                    break
            elif drawn < 0.3 + 0.4 * greedy:
                action = 1 + most_telling(belief, steps)
            else:
                action = int(uniform(state) * (questions + 3))
                action = 0 if action > questions else action
            happen(belief, desired, action, steps, state)


@lean
def begin_with_a_sign(belief: Vector, desired: int, steps: Steps, state: RandomState) -> None:
    """Update by an outcome other than the first, silence, of a person who wants an item: requests begin with one."""
    rest = 1.0 - steps.outcomes[0, desired]
    if rest <= 0.0:
        return
    number = steps.outcomes[0, desired] + rest * uniform(state)
    outcome = steps.outcomes[drawn_row(steps.outcomes, desired, number)]
    for item in range(len(belief)):
        belief[item] *= outcome[item]
    normalise(belief)


@lean
def happen(belief: Vector, desired: int, action: int, steps: Steps, state: RandomState) -> None:
    """Replace a belief by that after a step of a person who wants an item."""
    outcome = steps.outcomes[drawn_row(steps.outcomes, desired, uniform(state))]
    for item in range(len(belief)):
        belief[item] *= outcome[item]
    if action > 0 and uniform(state) < steps.answered:
        question = action - 1
        begin, end = steps.starts[question], steps.starts[question + 1]
        answer = begin + drawn_row(steps.rows[begin:end], desired, uniform(state))
        for item in range(len(belief)):
            belief[item] *= steps.rows[answer, item]
    normalise(belief)


@lean
def drawn_row(chances: Vector, item: int, number: float) -> int:
    """Return the row that a uniform number in [0, 1) selects from a column of chances."""
    reached = 0.0
    for row in range(len(chances) - 1):
        reached += chances[row, item]
        if number < reached:
            return row
    return len(chances) - 1


@lean
def most_telling(belief: Vector, steps: Steps) -> int:
    """Return the question that tells most, in bits, for its price."""
    best, found = -1.0, 0
    for question in range(len(steps.prices)):
        told = information(question, belief, steps.rows, steps.starts) / max(-steps.prices[question], 1e-9)
        if told > best:
            best, found = told, question
    return found

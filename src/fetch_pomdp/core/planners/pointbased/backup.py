"""One exact step ahead of a value that is a maximum of linear functions of the belief (Sondik 1971).

A vector holds, for each desired item, the expected return of a plan that can be followed; so the maximum over vectors
is a lower bound of the optimum, and what one step ahead of it earns is no less. A step is an action, what is heard and
seen in it (an outcome of words and pointing), and an answer.

A question that nobody answers in its own step may still be answered in the next: plans wait for that (at the price of a
wait over the chance of an answer) or drop it, whichever is worth more.

All questions are valued as if nothing else were heard in their step; the best few, and a wait, by all outcomes: what
is heard beside an answer moves all questions alike.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector, inlined, lean

NOTHING = 1e-6  # of a belief, which changes no choice
MANY = 12  # answers
RARE = 0.002  # chance of an answer and what is heard with it
WAIT = 0  # number of the action; question q is 1 + q, the pick of item i is 1 + n_questions + i


class Steps(NamedTuple):
    """What may happen in a step; n items, k questions, m outcomes of words and pointing."""

    rows: Vector  # (r, n), chance of each answer of each question given that one comes and the desired item
    starts: Integers  # (k + 1,), the rows of question q are from starts[q] to starts[q + 1]
    prices: Vector  # (k,), below 0
    outcomes: Vector  # (m, n), chance of each outcome given the desired item; columns sum to 1
    answered: float  # chance of an answer in a question's own step
    again: float  # chance of one in the step after a wait
    wait: float
    right: float
    wrong: float


class Vectors(NamedTuple):
    """Plans: column j of `values`, (n, capacity), is one; the first `size[0]` hold."""

    values: Any  # of float32, which is twice as fast
    size: Integers  # (1,)


class Memory(NamedTuple):
    """What a step ahead works in."""

    belief: Vector  # (n,)
    heard: Vector  # (m, n), it times each outcome
    weights: Vector  # (n,)
    scores: Any  # (capacity,) of float32
    places: Integers  # (n + 3,)
    rough: Vector  # (k,), values of questions as if nothing else were heard
    best: Integers  # (refined,), the questions to value by all outcomes
    after: Vector  # (n,), what follows an answer, given each desired item
    silent: Vector  # (n,), what follows a step without one
    plan: Vector  # (n,), the best plan found


@lean
def best_vector(weights: Vector, vectors: Vectors, memory: Memory) -> int:
    """Fill in what each plan is worth to a belief that need not sum to 1, and return the best one's number.

    Four items at a time, so that a score is loaded and stored once for four products.
    """
    values, size, scores, places = vectors.values, vectors.size[0], memory.scores, memory.places
    count = 0
    for item in range(len(weights)):
        if weights[item] > 0.0:
            places[count] = item
            count += 1
    while count % 4 > 0:
        places[count] = -1
        count += 1
    for j in range(size):
        scores[j] = 0.0
    for first in range(0, count, 4):
        a, b, c, d = places[first], places[first + 1], places[first + 2], places[first + 3]
        u, v = np.float32(weights[a]), np.float32(weights[b] if b >= 0 else 0.0)
        w, x = np.float32(weights[c] if c >= 0 else 0.0), np.float32(weights[d] if d >= 0 else 0.0)
        p, q, r, s = values[a], values[max(b, 0)], values[max(c, 0)], values[max(d, 0)]
        for j in range(size):
            scores[j] += u * p[j] + v * q[j] + w * r[j] + x * s[j]
    highest = scores[0]
    for j in range(1, size):
        highest = max(highest, scores[j])
    for j in range(size):
        if scores[j] == highest:
            return j
    return 0


@lean
def worth(weights: Vector, plan: int, vectors: Vectors) -> float:
    """Return what a plan is worth to a belief that need not sum to 1."""
    total = 0.0
    for item in range(len(weights)):
        total += weights[item] * vectors.values[item, plan]
    return total


@lean
def hear(belief: Vector, steps: Steps, memory: Memory) -> None:
    """Fill in the belief, and it times each outcome; what is next to nothing of it counts as nothing."""
    outcomes, heard = steps.outcomes, memory.heard
    for item in range(len(belief)):
        memory.belief[item] = belief[item]
    for index in range(len(outcomes)):
        for item in range(len(belief)):
            value = belief[item] * outcomes[index, item]
            heard[index, item] = value if value > NOTHING else 0.0


@lean
def followed(steps: Steps, vectors: Vectors, memory: Memory, result: Vector) -> float:
    """Fill in what follows a step without an answer, given each desired item; return its value to the belief."""
    total, outcomes = 0.0, steps.outcomes
    for item in range(len(result)):
        result[item] = 0.0
    for index in range(len(outcomes)):
        best = best_vector(memory.heard[index], vectors, memory)
        total += memory.scores[best]
        for item in range(len(result)):
            result[item] += outcomes[index, item] * vectors.values[item, best]
    return total


@lean
def screen(belief: Vector, steps: Steps, vectors: Vectors, memory: Memory) -> None:
    """Fill in the value of every question as if nothing else were heard in its step, and the best few's numbers."""
    weights, rough, chosen = memory.weights, memory.rough, memory.best
    for slot in range(len(chosen)):
        chosen[slot] = -1
    for question in range(len(rough)):
        total = 0.0
        for answer in range(steps.starts[question], steps.starts[question + 1]):
            if weigh(belief, steps.rows[answer], weights) > 0.0:
                total += memory.scores[best_vector(weights, vectors, memory)]
        rough[question] = steps.prices[question] + total
        place = len(chosen)
        while place > 0 and (chosen[place - 1] < 0 or rough[question] > rough[chosen[place - 1]]):
            place -= 1
            if place + 1 < len(chosen):
                chosen[place + 1] = chosen[place]
        if place < len(chosen):
            chosen[place] = question


@lean
def answered(question: int, steps: Steps, vectors: Vectors, memory: Memory) -> float:
    """Fill in what follows the answers to a question, given each desired item; return its value to the belief.

    An answer is followed by the best plan for it, whatever is heard beside it, where the two together are RARE, or the
    answers MANY.
    """
    total, outcomes, after, weights = 0.0, steps.outcomes, memory.after, memory.weights
    for item in range(len(after)):
        after[item] = 0.0
    begin, end = steps.starts[question], steps.starts[question + 1]
    for answer in range(begin, end):
        row, plan = steps.rows[answer], 0
        if end - begin > MANY:
            weigh(memory.belief, row, weights)
            plan = best_vector(weights, vectors, memory)
            total += memory.scores[plan]
            for item in range(len(after)):
                after[item] += row[item] * vectors.values[item, plan]
            continue
        for index in range(len(outcomes)):
            mass = weigh(memory.heard[index], row, weights)
            if index > 0 and mass < RARE:
                total += worth(weights, plan, vectors)
                best = plan
            else:
                best = best_vector(weights, vectors, memory)
                total += memory.scores[best]
            plan = best if index == 0 else plan
            for item in range(len(after)):
                after[item] += outcomes[index, item] * row[item] * vectors.values[item, best]
    return total


@lean
def weigh(belief: Vector, row: Vector, weights: Vector) -> float:
    """Fill in a belief times an answer's chances, with what is next to nothing as nothing; return the sum."""
    mass = 0.0
    for item in range(len(belief)):
        value = belief[item] * row[item]
        weights[item] = value if value > NOTHING else 0.0
        mass += weights[item]
    return mass


@inlined
def waited_out(steps: Steps) -> float:
    """Return the price of waiting for an answer that has not come; minus infinity where none ever will."""
    return steps.wait / steps.again if steps.again > 0.0 else -np.inf


@inlined
def question_value(price: float, after: float, silent: float, steps: Steps) -> float:
    """Return a question's value by what follows an answer and what follows none."""
    return price + steps.answered * after + (1.0 - steps.answered) * max(silent, waited_out(steps) + after)


@lean
def backup(belief: Vector, steps: Steps, vectors: Vectors, memory: Memory) -> tuple[float, int]:
    """Fill in `memory.plan` with the best plan for a belief; return its value and its first action."""
    plan, after, silent = memory.plan, memory.after, memory.silent
    first = 0
    for item in range(1, len(belief)):
        if belief[item] > belief[first]:
            first = item
    best, action = steps.wrong + (steps.right - steps.wrong) * belief[first], 1 + len(steps.prices) + first
    for item in range(len(plan)):
        plan[item] = steps.wrong
    plan[first] = steps.right
    if best >= steps.right + max(steps.wait, steps.prices.max()):  # nothing that costs so much can lead to more
        return best, action
    hear(belief, steps, memory)
    still = followed(steps, vectors, memory, silent)
    if steps.wait + still > best:
        best, action = steps.wait + still, WAIT
        for item in range(len(plan)):
            plan[item] = steps.wait + silent[item]
    screen(belief, steps, vectors, memory)
    for question in memory.best:
        if question < 0:
            break
        then = answered(question, steps, vectors, memory)
        value = question_value(steps.prices[question], then, still, steps)
        if value > best:
            best, action = value, 1 + question
            drops = still >= waited_out(steps) + then
            for item in range(len(plan)):
                late = silent[item] if drops else waited_out(steps) + after[item]
                plan[item] = steps.prices[question] + steps.answered * after[item] + (1.0 - steps.answered) * late
    return best, action

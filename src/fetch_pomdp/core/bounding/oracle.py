"""A supersolution in closed form and two-item problems: a value C with C >= T C, T the Bellman operator.

T C(b, i_r) = max(pick of the first, wait + E C, point + max over items of E C). Such a C lies above the optimal value:
T is monotone, so C >= T C >= T T C ..., which falls to the value of ever longer plans. Three facts give ours.

1. T of a supersolution is one (apply T to C >= T C). The constant pick_correct is one, since no step earns more than 0;
   T of it is max(pick of the first, wait + pick_correct), as a question costs no less than a wait.
2. The minimum of two is one: T min(C, D) <= min(T C, T D) <= min(C, D).
3. An oracle's value is one. Match the items into pairs and imagine somebody tells at the start which pair holds the
   desired item. With beliefs b_i, b_j of a pair, m = b_i + b_j and x = b_i / m,

       C(b, i_r) = sum over pairs of m * U(x, whether i_r is in the pair).

   A step multiplies beliefs by likelihoods, and m U(x) is homogeneous in (b_i, b_j), so E C(b') is the sum over pairs
   of m * E[U(x')] in the pair's own problem. So it is enough that U >= pick and U >= reward + E U there, for every
   action. An answer about an item of another pair says nothing here, so such a question is a dearer wait. Asking about
   the one and about the other are the same experiment, with "yes" and "no" exchanged, so it is enough to know whether
   one of them is i_r. An item left over is revealed: its U is pick_correct.

   Words fall into three classes: those only one of the two has, and the rest, whose likelihood ratio is that of the
   smoothing (Eq. 5). In place of pointing more is told: a step in which the person points, by chance p_g, reveals the
   item, and one without says nothing. What the robot really sees is a garbled form of that, and U is convex in x, so
   by Jensen E U under what is seen is no more (Blackwell 1953). For the same reason this C does not depend on
   how rays are judged.

U is found on a grid by value iteration down from the constant pick_correct, with linear interpolation (Lovejoy 1991).
T keeps convexity: E[U(x')] is a sum of perspectives of a convex function. A convex function lies below its linear
interpolation, which is again convex. So U1 = interpolation of T U0 is convex, and U1 <= U0 since U0 is the largest
value there is; both operators are monotone, so U(n+1) <= Un for all n, hence Un >= U(n+1) >= T Un: every iterate is a
convex supersolution, whenever one stops. By the same induction U with i_r in the pair is no less than U without, so
that turning to another pair, which loses i_r, is no better than a wait.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector, compiled, inlined, lean
from fetch_pomdp.core.planners.fitted.table import closeness
from fetch_pomdp.core.planners.kernels import NOBODY, pick_value
from fetch_pomdp.core.problem import Problem, Tables

CELLS = 240  # of the grid over x
MOST_ITERATIONS, SETTLED = 400, 1e-7  # points: a change too small to go on for
MOST_MATCHED = 1_000  # items whose pairs are chosen by closeness: quadratic in their number
CLASSES = 3


class Oracle(NamedTuple):
    """The pairs, and the values of their problems."""

    first: Integers  # (pairs,), an item
    second: Integers  # (pairs,), an item or NOBODY
    solved: Integers  # (pairs,), which solution is the pair's
    values: Vector  # (solutions, 2, CELLS + 1): i_r outside and in the pair; over x, the first's share


def oracle_of(problem: Problem) -> Oracle:
    """Return the pair oracle of a problem; pairs that hear the same share a solution."""
    tables = problem.tables
    first, second = _pairs(problem)
    keys: dict[tuple[float, ...], int] = {}
    solutions: list[Vector] = []
    solved = np.zeros(len(first), dtype=np.int64)
    for pair in range(len(first)):
        if second[pair] == NOBODY:
            continue
        chances = _word_chances(int(first[pair]), int(second[pair]), tables)
        key = tuple(np.round(chances, 15).ravel().tolist())
        if key not in keys:
            keys[key] = len(solutions)
            solutions.append(solve_pair(chances, tables))
        solved[pair] = keys[key]
    values = np.array(solutions) if solutions else np.full((1, 2, CELLS + 1), tables.pick_correct)
    return Oracle(first, second, solved, values)


def _pairs(problem: Problem) -> tuple[Integers, Integers]:
    """Return a matching of the items, the most alike first; large tables in the order of their vocabularies."""
    tables, count = problem.tables, problem.n_items
    if count > MOST_MATCHED:
        vocabularies = [item.vocabulary for item in problem.scene.items]
        order = np.array(sorted(range(count), key=lambda item: tuple(sorted(vocabularies[item]))), dtype=np.int64)
        if count % 2:
            order = np.append(order, NOBODY)
        return order[::2].copy(), order[1::2].copy()
    partner = matched(_closest(tables), count)
    first = np.array([item for item in range(count) if partner[item] == NOBODY or item < partner[item]])
    return first, partner[first]


@compiled
def _closest(tables: Tables) -> Integers:
    """Return all pairs, as one * n + other with one < other, the most alike first."""
    count = len(tables.smoothing)
    size = count * (count - 1) // 2
    apart, codes, index = np.empty(size), np.empty(size, dtype=np.int64), 0
    for one in range(count):
        for other in range(one + 1, count):
            apart[index], codes[index] = -closeness(one, other, tables), one * count + other
            index += 1
    return codes[np.argsort(apart, kind="mergesort")]


@compiled
def matched(codes: Integers, count: int) -> Integers:
    """Return each item's partner, (n,), or NOBODY: pairs in their order, where both are free."""
    partner = np.full(count, NOBODY)
    for code in codes:
        one, other = code // count, code % count
        if partner[one] == NOBODY and partner[other] == NOBODY:
            partner[one], partner[other] = other, one
    return partner


def _word_chances(one: int, other: int, tables: Tables) -> Vector:
    """Return the chance of each class of words under the one and the other item, (2, CLASSES), if a word is said."""
    starts, words, alpha = tables.item_starts, tables.item_words, tables.alpha
    mine = set(words[starts[one] : starts[one + 1]].tolist())
    others = set(words[starts[other] : starts[other + 1]].tolist())
    sizes = np.array([len(mine - others), len(others - mine)])
    smoothing = np.array([tables.smoothing[one], tables.smoothing[other]])
    said = smoothing[:, None] * sizes * (alpha + np.eye(2))
    return np.column_stack([said, np.maximum(1.0 - said.sum(axis=1), 0.0)])


@compiled
def solve_pair(chances: Vector, tables: Tables) -> Vector:
    """Return U of a pair's problem, (2, CELLS + 1), from the chances of its classes of words, (2, CLASSES)."""
    values, after = np.full((2, CELLS + 1), tables.pick_correct), np.empty((2, CELLS + 1))
    for _ in range(MOST_ITERATIONS):
        change = 0.0
        for point in range(CELLS + 1):
            x = point / CELLS
            pick = pick_value(max(x, 1.0 - x), tables)
            question = tables.point + heard_value(x, 1, tables.p_l, chances, values, tables)
            for held in range(2):
                wait = tables.wait + heard_value(x, held, held * tables.p_again, chances, values, tables)
                after[held, point] = max(pick, question, wait)
                change = max(change, values[held, point] - after[held, point])
        values[:] = after
        if change < SETTLED:
            break
    return values


@lean
def heard_value(x: float, held: int, rate: float, chances: Vector, values: Vector, tables: Tables) -> float:
    """Return E[U(x')] after a step in which an answer comes at `rate`; held: 1 with i_r in the pair, else 0."""
    total = (1.0 - tables.p_l) * answered_pair(x, 1.0 - x, held, rate, values, tables)
    for word in range(CLASSES):
        one, other = x * chances[0, word], (1.0 - x) * chances[1, word]
        total += tables.p_l * answered_pair(one, other, held, rate, values, tables)
    return tables.p_g * tables.pick_correct + (1.0 - tables.p_g) * total


@inlined
def answered_pair(one: float, other: float, held: int, rate: float, values: Vector, tables: Tables) -> float:
    """Return the sum over answers of mass times U; one, other: beliefs times the likelihood of what was heard."""
    true, false = tables.p_truth, 1.0 - tables.p_truth
    total = (1.0 - rate) * massed(one, other, values[held])
    total += rate * massed(one * true, other * false, values[held])
    total += rate * massed(one * false, other * true, values[held])
    return float(total)


@inlined
def massed(one: float, other: float, values: Vector) -> float:
    """Return (one + other) * U(one / (one + other)), linear between points of the grid."""
    mass = one + other
    if mass <= 0.0:
        return 0.0
    x = one / mass * CELLS
    cell = min(int(x), CELLS - 1)
    return float(mass * (values[cell] + (x - cell) * (values[cell + 1] - values[cell])))


@lean
def ceiling(belief: Vector, asked: int, oracle: Oracle, tables: Tables) -> float:
    """Return C(b, i_r): the lesser of the oracle's value and of the value one wait before knowing."""
    told, largest = 0.0, 0.0
    for pair in range(len(oracle.first)):
        one, other = oracle.first[pair], oracle.second[pair]
        largest = max(largest, belief[one])
        if other == NOBODY:
            told += belief[one] * tables.pick_correct
            continue
        largest = max(largest, belief[other])
        held = 1 if asked in (one, other) else 0
        told += massed(belief[one], belief[other], oracle.values[oracle.solved[pair], held])
    pick = pick_value(largest, tables)
    return float(min(told, max(pick, tables.wait + tables.pick_correct)))

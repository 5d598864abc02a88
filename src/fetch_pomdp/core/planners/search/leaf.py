"""What the searches put at the end of the actions they look ahead, in closed form.

Choice: the paper names no leaf. Leaf `pick` is the value with one action left: the best pick or the reward of a wait.

Choice: leaf `question` is also the value of asking about one of the two leading items, or of the question already
asked, and waiting its answer out.

With b1, b2 the two leading beliefs, D = pick_correct - pick_wrong, a person who answers with chance p_l at once and
p_again = p_l * p_answer_again in each later step, and a pick of the first after "yes" and of the second after "no":

    settled  = D p_truth (b1 + b2) + pick_wrong
    question = point + p_l settled + (1 - p_l) max(settled + wait / p_again, best pick)

that is about 22.5 p_truth (b1 + b2) - 18.55 with the paper's numbers. It ignores what else is heard while the robot
waits, so it is the value of a policy that can be followed: a lower bound. With p_again = 0 nothing is waited for.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector, inlined
from fetch_pomdp.core.planners.base import Decision, best_action, pick_values
from fetch_pomdp.core.planners.kernels import Leading, Turn, leading
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.turns import DESIRED, OTHER


class Leaf(NamedTuple):
    """Prices of a leaf, all that its value depends on besides the belief."""

    asks: bool  # leaf `question` instead of `pick`
    gain: float  # D, what a right pick earns over a wrong one
    wrong: float
    wait: float
    point: float
    p_answer: float  # of an answer in the step of a question
    p_truth: float
    until_answer: float  # expected reward of the waits until an answer comes


@inlined
def leaf_of(asks: bool, tables: Tables) -> Leaf:
    """Return the prices of a leaf under a problem."""
    until_answer = tables.wait / tables.p_again if tables.p_again > 0.0 else -1e300
    gain = tables.pick_correct - tables.pick_wrong
    return Leaf(asks, gain, tables.pick_wrong, tables.wait, tables.point, tables.p_answer, tables.p_truth, until_answer)


@inlined
def leaf_value(mass: float, b1: float, b2: float, held: float, leaf: Leaf) -> float:
    """Return the leaf's value times `mass`, for leading beliefs that sum with the rest to `mass`.

    held: belief in the item last asked about and the best other together, or below 0 if nothing was asked.
    """
    pick = leaf.gain * b1 + leaf.wrong * mass
    best = max(pick, leaf.wait * mass)
    if leaf.asks:
        settled = leaf.gain * leaf.p_truth * (b1 + b2) + leaf.wrong * mass
        later = max(settled + leaf.until_answer * mass, pick)
        best = max(best, leaf.point * mass + leaf.p_answer * settled + (1.0 - leaf.p_answer) * later)
        if held >= 0.0:
            best = max(best, leaf.gain * leaf.p_truth * held + (leaf.wrong + leaf.until_answer) * mass)
    return best


@inlined
def answered_leaf(belief: Vector, turn: Turn, still_open: bool, top: Leading, leaf: Leaf, tables: Tables) -> float:
    """Return the expected leaf value after an answer, or silence, about an item (Eq. 6, Table I).

    still_open: whether an answer may still come after silence. An answer scales the belief in the item asked about
    against all others alike, so the leaders decide.
    """
    about = turn.about
    if about < 0:
        return leaf_value(1.0, top.b1, top.b2, -1.0, leaf)
    own = belief[about]
    o1, o2 = top.b1, top.b2
    if about == top.first:
        o1, o2 = top.b2, top.b3
    elif about == top.second:
        o2 = top.b3
    rate, if_desired = tables.chances[turn.phase, turn.kind, OTHER], tables.chances[turn.phase, turn.kind, DESIRED]
    true, false, quiet, rest = rate * leaf.p_truth, rate * (1.0 - leaf.p_truth), 1.0 - rate, 1.0 - own
    yes, no, none = if_desired * leaf.p_truth, if_desired * (1.0 - leaf.p_truth), 1.0 - if_desired
    known = tables.awaited[0] == 1  # under constant chances, what was answered may be answered again
    return (
        scaled_leaf(own * yes, o1 * false, o2 * false, rest * false, known, leaf)
        + scaled_leaf(own * no, o1 * true, o2 * true, rest * true, known, leaf)
        + scaled_leaf(own * none, o1 * quiet, o2 * quiet, rest * quiet, still_open, leaf)
    )


@inlined
def scaled_leaf(own: float, o1: float, o2: float, others: float, is_open: bool, leaf: Leaf) -> float:
    """Return the leaf's value for the item asked about (`own`), the best two others and the sum of all others.

    is_open: whether an answer about it may still come.
    """
    b1 = max(own, o1)
    b2 = max(min(own, o1), o2)
    return leaf_value(own + others, b1, b2, own + o1 if is_open else -1.0, leaf)


def last_action(problem: Problem, belief: Belief) -> Decision:
    """Return the decision with one action left: the best pick, or a wait where even that is better (leaf `pick`)."""
    pick = pick_values(belief.probabilities, problem)
    wait, point = problem.rewards.wait, np.full(problem.n_items, problem.rewards.point)
    return Decision(best_action(wait, point, pick), wait, point, pick)


def last_question(problem: Problem, belief: Belief, asked: int | None) -> Decision:
    """Return the decision of leaf `question` itself: ask and wait the answer out, wait out the one asked for, or
    pick.
    """
    tables, probabilities = problem.tables, belief.probabilities
    leaf, top = leaf_of(True, tables), leading(probabilities)
    pick = pick_values(probabilities, problem)
    pairs = probabilities + np.where(np.arange(problem.n_items) == top.first, top.b2, top.b1)
    settled = leaf.gain * leaf.p_truth * pairs + leaf.wrong
    later = np.maximum(settled + leaf.until_answer, pick.max())
    point = leaf.point + leaf.p_answer * settled + (1.0 - leaf.p_answer) * later
    wait = leaf.wait if asked is None else max(leaf.wait, float(settled[asked]) + leaf.until_answer)
    return Decision(best_action(wait, point, pick), wait, point, pick)

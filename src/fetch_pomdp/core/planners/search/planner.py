"""The planners that search: SparseSampling, the paper's, and ExactAnswers, which solves nothing ahead."""

from __future__ import annotations

import functools
import logging
from dataclasses import dataclass
from typing import Literal, get_args

from numpy.random import Generator

from fetch_pomdp.checks import shown
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector, compiled
from fetch_pomdp.core.planners.base import (
    MOST_DEPTH,
    MOST_WIDTH,
    Decision,
    best_action,
    checked_asked,
    unvalued,
    whole_number,
)
from fetch_pomdp.core.planners.search.exact import add_answer, last_two_answered, next_answer
from fetch_pomdp.core.planners.search.leaf import last_action, last_question
from fetch_pomdp.core.planners.search.sparse import add_observation, last_two_sampled, next_observation
from fetch_pomdp.core.planners.search.tree import RootValues, Search, best_of, enter, root_values, workspace
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.errors import PlannerError

LeafName = Literal["pick", "question"]

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class SparseSampling:
    """Sparse sampling on the belief MDP: `width` observations for each action at every node, `depth` actions ahead.

    One base word and one response word a step (Section III-D-1).

    Choice: depth counts actions, so depth 2 is act, observe, act.

    Choice: live people answer in the step after a question as often as in its own, so that two actions see too few of
    the answers to ask. Before them a question and its answer count for one, and the search goes one action deeper.

    Choice: the paper does not say how the observations of a node are drawn; here the actions share their random
    numbers, and desired items and answers are spread evenly over their distributions. Drawn independently for each
    action, ten observations cost 0.3 (ambiguous) to 0.6 points a fetch.

    Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 10

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 1, MOST_WIDTH, "width")

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest sampled value."""
        if self.depth == 1:
            return last_action(problem, belief)
        depth = self.depth if problem.model.turns is None else self.depth + 1
        search = Search(depth, self.width, problem.n_items, exact=False, leaf_asks=False)
        return searched(problem, belief, asked, search, rng=rng, phase=phase)


@dataclass(frozen=True, slots=True)
class ExactAnswers:
    """Search that samples words and pointing once for all actions of a node, and sums the answers exactly.

    Words and pointing do not depend on the action, so one sample serves all questions and differences between actions
    carry little noise. What follows the last action looked at is closed by a leaf (see `search.leaf`): `pick`, or
    `question`. Width 0 stands for a number of samples by the number of items: 80 a node for small tables, 5 for
    100,000 items. Raises PlannerError for a depth or width that is no whole number in range, or an unknown leaf.
    """

    depth: int = 2
    width: int = 0
    leaf: LeafName = "question"

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")
        if self.leaf not in get_args(LeafName):
            raise PlannerError(f"found {shown(self.leaf)}, expected 'pick' or 'question'", field="leaf")

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest value."""
        leaf_asks = self.leaf == "question"
        if self.depth == 1:
            return last_question(problem, belief, asked) if leaf_asks else last_action(problem, belief)
        width = self.width or default_width(problem.n_items)
        search = Search(self.depth, width, problem.n_items, exact=True, leaf_asks=leaf_asks)
        return searched(problem, belief, asked, search, rng=rng, phase=phase)


def default_width(n_items: int) -> int:
    """Return how many samples keep a decision of depth 2 under about 5 ms."""
    return max(5, min(80, 500_000 // n_items))


@compiled
def plan(belief: Vector, asked: int, phase: int, search: Search, seed: int, tables: Tables) -> RootValues:
    """Search two actions or more ahead, depth first; answers are summed exactly or sampled, as the search says."""
    work = workspace(belief, asked, phase, search.depth, seed, tables)
    level, last = 0, search.depth - 2
    while True:
        if level < last and (
            next_answer(level, search, work, tables) if search.exact else next_observation(level, search, work, tables)
        ):
            level += 1
            enter(level, work.cursor["asked"][level], work.cursor["phase"][level], work, tables)
            continue
        if level == last:
            if search.exact:
                last_two_answered(level, search, work, tables)
            else:
                last_two_sampled(level, search, work, tables)
        if level == 0:
            return root_values(search, work, tables)
        level -= 1
        value = best_of(level + 1, search, work, tables)
        if search.exact:
            add_answer(level, value, work)
        else:
            add_observation(level, value, search, work)


def searched(
    problem: Problem,
    belief: Belief,
    asked: int | None,
    search: Search,
    *,
    rng: Generator,
    phase: int = 0,
    tables: Tables | None = None,
) -> Decision:
    """Return the decision of a search; questions that it may not ask are worth NaN.

    tables: what the plan foresees, if not the problem. Raises PlannerError for a belief or i_r of another problem.
    """
    _announce_loading()
    probabilities = belief.probabilities
    about = checked_asked(probabilities, asked, problem, phase)
    seed = int(rng.random() * 2.0**53)
    found = plan(probabilities, about, phase, search, seed, tables or problem.tables)
    wait, point, pick, wait_error, point_errors = found
    if search.questions == 0:
        point = unvalued(problem)
        return Decision(best_action(wait, point, pick), wait, point, pick, wait_error)
    return Decision(best_action(wait, point, pick), wait, point, pick, wait_error, point_errors)


@functools.cache
def _announce_loading() -> None:
    """Tell the user once in a process why the first decision takes long."""
    _log.info("loading the compiled planner; the first time after installation it is compiled, for some seconds")

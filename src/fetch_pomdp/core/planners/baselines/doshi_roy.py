"""DoshiRoy: plans when to ask and when to act, but does not keep what it asked about."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.planners.base import MOST_DEPTH, MOST_WIDTH, Decision, whole_number
from fetch_pomdp.core.planners.exact import default_width, plan_exact
from fetch_pomdp.core.planners.kernels import NOBODY, RootValues, Search
from fetch_pomdp.core.planners.root import searched
from fetch_pomdp.core.problem import Problem, Tables


@dataclass(frozen=True, slots=True)
class DoshiRoy:
    """Asks, waits or picks by plan, without i_r: what was asked is forgotten when the step is over.

    A yes or no right after a question is understood, for their observations depend on the action; a bare "no" later
    says nothing about which item. So the plan expects nothing from waiting an answer out: it asks again. Source: Doshi
    and Roy [6], who balance "question-asking for ambiguity clarification with action-taking" but whose "state
    factorization does not include a representation of the human's belief's" (Section II); the work is taken to be
    "Spoken language interaction with model uncertainty", Connection Science 2008. The plan is the search of
    `ExactAnswers`. Left out: learning the rewards and the observation model from the user, and open questions.

    Choice: only the plan forgets. The belief that it is handed has read late answers with i_r, as all planners' have.

    Choice: the answer in the question's own step counts. If it did not, no question would be worth its price, and this
    were one more robot that never asks.

    Raises PlannerError for a depth or width that is no whole number in range; it looks two actions ahead or more.
    """

    depth: int = 2
    width: int = 0

    def __post_init__(self) -> None:
        whole_number(self.depth, 2, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        """Choose the action with the highest value."""
        width = self.width or default_width(problem.n_items)
        search = Search(self.depth, width, problem.n_items, patient=True)
        return searched(plan_forgetful, problem, belief, asked, search, rng)


def plan_forgetful(belief: Vector, asked: int, search: Search, seed: int, tables: Tables) -> RootValues:  # noqa: ARG001
    """Search like `plan_exact` where nothing was asked before, and no answer comes after a wait."""
    return plan_exact(belief, NOBODY, search, seed, tables._replace(p_again=0.0))

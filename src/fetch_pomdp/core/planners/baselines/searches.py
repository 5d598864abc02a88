"""Robots that search ahead with something left out: Section IV's that never asks, and two after earlier work.

What is said of those after earlier work in `baselines.rules` holds here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Action, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import (
    MOST_DEPTH,
    MOST_WIDTH,
    Decision,
    best_action,
    checked_asked,
    is_uniform,
    unvalued,
    whole_number,
)
from fetch_pomdp.core.planners.kernels import ASKED, WAITED
from fetch_pomdp.core.planners.search.leaf import last_action
from fetch_pomdp.core.planners.search.planner import ExactAnswers, default_width, searched
from fetch_pomdp.core.planners.search.tree import Search
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.turns import DESIRED, OTHER, answered_at_all


@dataclass(frozen=True, slots=True)
class PaperNeverAsk:
    """Paradigm one as the paper has it: the search of its depth and width without questions; it waits or picks.

    Two steps see no end of the waits that would pay: a robot that never asks can do better (`NeverAsk`).

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
        """Choose to wait, or the likeliest item."""
        if self.depth == 1:
            return last_action(problem, belief)
        search = Search(self.depth, self.width, questions=0, exact=True, leaf_asks=False)
        return searched(problem, belief, asked, search, rng=rng, phase=phase)


@dataclass(frozen=True, slots=True)
class WilliamsYoung:
    """Opens with a question whatever it believes, then asks or picks; the plan chooses about what, and when to end.

    Source: Williams and Young [24], who "always ask questions, regardless of context, and use the POMDP to have a
    policy on which questions to ask" (Section II); the work is taken to be "Partially observable Markov decision
    processes for spoken dialog systems", Computer Speech and Language 2007. Their machine speaks and listens in turns:
    it asks or submits, and never waits. The plan is the search of `ExactAnswers`. Left out: slots, their record of
    what was grounded, confidence scores, and the fixed routine of the questions themselves.

    Choice: where the belief is uniform it waits: their opening, "how may I help you?", is about no item, and who makes
    a request has answered it.

    Choice: looking ahead, the search allows waits, as that of `ExactAnswers` does; the action taken is never one.

    Waits are worth NaN. Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 0

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the best question, or from the second decision on the best pick if that is better."""
        found = ExactAnswers(self.depth, self.width).decide(problem, belief, asked, rng=rng, phase=phase)
        probabilities = belief.probabilities
        if is_uniform(probabilities):
            return Decision(Wait(), np.nan, unvalued(problem), found.pick)
        action: Action = Point(int(found.point.argmax()))
        if asked is not None:
            action = best_action(np.nan, found.point, found.pick)
        return Decision(action, np.nan, found.point, found.pick, point_error=found.point_error)


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
    were one more robot that never asks. Live people answer in the next step as often as in the question's own, so that
    before them an answer that comes at all, before the question is late, counts there.

    Raises PlannerError for a depth or width that is no whole number in range; it looks two actions ahead or more.
    """

    depth: int = 2
    width: int = 0

    def __post_init__(self) -> None:
        whole_number(self.depth, 2, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest value."""
        width = self.width or default_width(problem.n_items)
        search = Search(self.depth, width, problem.n_items, exact=True, leaf_asks=True)
        checked_asked(belief.probabilities, asked, problem, phase)
        return searched(problem, belief, None, search, rng=rng, phase=phase, tables=_forgetful(problem, phase))


def _forgetful(problem: Problem, phase: int) -> Tables:
    """Return tables by which nothing was asked before a step, and no answer comes after a wait.

    phase: where the search begins; its leaf, which knows no phases, expects an answer as of a question asked there.
    """
    tables, turns, p_answer = problem.tables, problem.model.turns, problem.tables.p_answer
    chances = tables.chances.copy()
    chances[:, WAITED, [DESIRED, OTHER]] = 0.0
    if turns:
        at_all = answered_at_all(turns)[:, ASKED]
        chances[:, ASKED, [DESIRED, OTHER]] = at_all[:, np.newaxis]
        p_answer = float(at_all[phase])
    return tables._replace(p_answer=p_answer, p_again=0.0, chances=chances)

"""What the tests of baselines decide with: three twins make answers all there is to learn."""

from __future__ import annotations

from numpy.random import default_rng

from fetch_pomdp.core.action import Action
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Decision, Planner
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from tests.tables import twins

AMBIGUOUS = Problem(Scene.load("ambiguous"))
TWINS = twins(3)


def decision(
    planner: Planner, belief: list[float], asked: int | None = None, problem: Problem = TWINS, seed: int = 0
) -> Decision:
    return planner.decide(problem, Belief(belief), asked, rng=default_rng(seed))


def act(planner: Planner, belief: list[float], asked: int | None = None, problem: Problem = TWINS) -> Action:
    return decision(planner, belief, asked, problem).action

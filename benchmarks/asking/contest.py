"""Planners of questions before the same people of a problem."""

from __future__ import annotations

import math
import time
from typing import Any

from fetch_pomdp.core.planners.asking import AskingPlanner
from fetch_pomdp.core.planners.baselines.asking import InformationGainAsking, OneStepAsking, tuned
from fetch_pomdp.core.planners.pointbased.planner import PointBased, solution
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.simulation import AskingSummary, simulate_asking

TUNED_ON = 500_000  # seed, far from those of any contest


def contest(problem: Problem, episodes: int, seed: int) -> dict[str, Any]:
    """Return what the planner and three others earn, and the differences with their standard errors."""
    start = time.perf_counter()
    solution(problem, PointBased().seed)
    seconds = time.perf_counter() - start
    planner = simulate_asking(problem, PointBased(), episodes, seed)
    others: dict[str, AskingPlanner] = {
        "one step ahead": OneStepAsking(),
        "thresholds": tuned(problem, TUNED_ON + seed),
        "information gain": InformationGainAsking(),
    }
    found: dict[str, Any] = {
        "items": problem.n_items,
        "questions": problem.n_questions,
        "solving_s": seconds,
        "planner": row(planner),
    }
    for name, other in others.items():
        played = simulate_asking(problem, other, episodes, seed)
        ahead = planner.earned - played.earned
        found[name] = {
            **row(played),
            "ahead": float(ahead.mean()),
            "error": float(ahead.std(ddof=1)) / math.sqrt(episodes),
        }
    return found


def row(played: AskingSummary) -> dict[str, float]:
    """Return a table's row."""
    return {
        "return": played.mean_return,
        "right": played.accuracy,
        "questions": played.mean_questions,
        "steps": played.mean_steps,
    }

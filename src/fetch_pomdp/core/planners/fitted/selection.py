"""Which policy a problem gets: plans are fitted, rehearsed with people, and the one that earns most is kept."""

from __future__ import annotations

from fetch_pomdp.core.planners.fitted.fit import fitted
from fetch_pomdp.core.planners.fitted.outlook import distinct_words, rays_of
from fetch_pomdp.core.planners.fitted.rehearsal import Policy, rehearse
from fetch_pomdp.core.planners.fitted.table import ValueTable
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import LARGEST_EXACT

FIT_RAYS = 4  # rays of an outlook while fitting
LEARNT = (0.5, 1.0, 2.0)  # of the logarithm of the likeliest power
LEAST_POWER = 1.05  # below it is what chance makes of 1
MOST_REHEARSED, NUMBERS_REHEARSED = 8_000, 100_000  # interactions, and beliefs' entries in one step of all


def selected(problem: Problem, beliefs: int, seed: int) -> Policy:
    """Return the policy of a problem, fitted on `beliefs` beliefs a round in all; same seed, same policy.

    Choice: where rays are judged by Eq. 7 and drawn by another density, two plans are tried: one that foresees beliefs
    under Eq. 7, and one under the density of the rays. The first thinks too little of pointing, and on some tables
    picks at once where listening pays; the second thinks too much of it. Both read beliefs sharpened to the power that
    people show to be right, or to a part of it (LEARNT): a plan does not foresee that later beliefs are sharpened too.
    """
    if problem.tables.exact or problem.tables.p_g == 0.0 or problem.model.turns:
        return Policy(planned(problem, beliefs, seed), 1.0, problem.tables)
    plans = [problem] if problem.n_items > LARGEST_EXACT else [problem, problem.with_exact_rays()]
    tried = [
        found for plan in plans for found in _rehearsed(planned(plan, beliefs // len(plans), seed), plan, problem, seed)
    ]
    return max(tried, key=lambda found: found[1])[0]


def planned(problem: Problem, beliefs: int, seed: int) -> ValueTable:
    """Return the value table of a problem."""
    return fitted(problem, distinct_words(problem, rays_of(problem, FIT_RAYS)), beliefs, seed)


def _rehearsed(table: ValueTable, plan: Problem, problem: Problem, seed: int) -> list[tuple[Policy, float]]:
    """Return a plan's policies, one a power, and what they earn."""
    count = min(MOST_REHEARSED, NUMBERS_REHEARSED // problem.n_items)
    likeliest = rehearse(Policy(table, 1.0, plan.tables), max(1, count // 4), seed, problem).power
    powers = [likeliest**share for share in LEARNT] if likeliest >= LEAST_POWER else [1.0]
    policies = [Policy(table, power, plan.tables) for power in powers]
    return [(policy, float(rehearse(policy, count, seed + 1, problem).earned.mean())) for policy in policies]

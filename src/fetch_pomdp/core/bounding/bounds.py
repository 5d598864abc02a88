"""An upper bound on the return of every policy: information relaxation with a martingale penalty (Brown, Smith and Sun
2010; Brown and Haugh 2017).

Let V^ be any function of a node (b, i_r), the control, and for an action a of a node

    delta(b, a) = r(a) + E[V^(b') | b, a] - V^(b),    and for the pick of the likeliest item  pick(b) - V^(b).

Along a policy's nodes the deltas sum to its rewards, less V^ at the start, plus terms E[V^(b') | b, a] - V^(b') that
have mean 0 given all that came before: they are a martingale's. So V^(b0) + E[sum of deltas] is the policy's return. A
clairvoyant who knows the whole scenario - the desired item, the words and the pointing of each step, and whether each
answer comes and is true - and maximises the sum over all sequences of actions does no worse in any scenario. Hence

    return of any policy <= V^(b0) + E[max over sequences of the sum of deltas],

with equality on every scenario where V^ is the optimal value. Here V^ is FittedValue's (`fitted.table`).

Estimates. E[V^(b')] sums words and answers, and samples pointing apart from the scenario. Given the node an estimate is
unbiased, so each policy's mean stays as it was, and its noise can only raise the maximum's mean.

Closing. Let C be a supersolution (`bounding.oracle`). At a node the control may be changed from V^ to C for all that
follows, which adds C(b) - V^(b) to S, the sum of deltas so far: the argument holds for every control that depends on
the history of the node alone. Under C no delta is above 0, so nothing is won by going on, and the node is closed at

    S + C(b) - V^(b).

Which nodes are closed may depend on the history of the node alone (b, i_r, S and the step): not on the best sum found
elsewhere, nor on a count of nodes. A node is closed where that number is at most a fixed tau, where C(b) is the best
pick's value, and at step 30. The clairvoyant's sum is taken as no less than tau, which can only raise it. With that, of
two sequences that lead to the same node only the larger S counts: whatever the other reaches, above tau, this one
reaches with more. tau is chosen on pilot scenarios, drawn from other streams than those of the bound.

Equals. Where two items have the same words, direction and belief, and neither is i_r, exchanging them changes nothing,
so a best policy need not ask about the second, and the bound is taken over policies that do not.

Choice: the bound judges rays by the exact likelihood whatever the model says. A policy earns its reward among the
people of the sampler. Under "eq7" the robot's belief is not their posterior, and a bound computed with it would not
hold; under "exact" it is, so the bound holds for every policy on those people, whatever its own filter. (Up to rays
within 0.001 rad of an item, whose density is cut off, and a quadrature: too little to see in any digit.)

The bound is on returns without a limit of steps, and so holds where an episode must end in a pick.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fetch_pomdp.core.bounding.oracle import ceiling, oracle_of
from fetch_pomdp.core.bounding.relaxation import Relaxation, control, relaxed
from fetch_pomdp.core.compiled import Integers, Vector, on_all_cores
from fetch_pomdp.core.planners.base import whole_number
from fetch_pomdp.core.planners.fitted.ahead import Lookahead
from fetch_pomdp.core.planners.fitted.outlook import distinct_words
from fetch_pomdp.core.planners.fitted.planner import FittedValue, solution
from fetch_pomdp.core.planners.fitted.table import ValueTable
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem, constant_only

Kind = Literal["relaxation", "oracle"]

MOST_ITEMS = 60  # beyond which a clairvoyant's questions are too many to try
MOST_SCENARIOS = 10_000_000
RAYS = 64  # of an outlook
TAUS = (-0.5, -0.2, 0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4)  # points, tried in turn
PILOTS, GIVEN_UP = 32, 5  # scenarios; how many times the nodes wanted are expanded before one is left
MOST_WORK = 150_000  # beliefs looked at for a scenario, on average

_PILOT_STREAM, _STREAM = 3, 2  # of the seed; people of `simulate` have another


@dataclass(frozen=True, slots=True)
class Bound:
    """An upper bound on the mean return of every policy.

    kind: "relaxation", a mean over scenarios, or "oracle", the closed form, looser and without error.
    """

    mean: float  # points
    standard_error: float  # points
    scenarios: int
    kind: Kind


def upper_bound(problem: Problem, scenarios: int = 1_000, seed: int = 0) -> Bound:
    """Return an upper bound on the return of every policy on simulated people; same seed, same bound.

    The argument is this module's. Tables of more than MOST_ITEMS items, and those where the closed form is the lesser,
    get kind "oracle". Raises PlannerError for a number of scenarios, or a seed, out of range, and
    ModelError for live people (`turns`), for whom it does not hold.
    """
    constant_only(problem, "the upper bound")
    whole_number(scenarios, 2, MOST_SCENARIOS, "scenarios")
    whole_number(seed, 0, 2**63 - 1, "seed")
    told = closed_form_bound(problem)
    if problem.n_items > MOST_ITEMS:
        return Bound(told, 0.0, 0, "oracle")
    exact = problem.with_exact_rays()
    table = solution(exact, FittedValue()).table
    values = clairvoyant_returns(exact, table, scenarios, seed, tau=chosen_tau(exact, table, seed))
    mean, error = float(values.mean()), float(values.std(ddof=1)) / math.sqrt(scenarios)
    return Bound(mean, error, scenarios, "relaxation") if mean < told else Bound(told, 0.0, 0, "oracle")


def closed_form_bound(problem: Problem) -> float:
    """Return the supersolution C at the start, in points."""
    flat = np.full(problem.n_items, 1.0 / problem.n_items)
    return float(ceiling(flat, NOBODY, oracle_of(problem), problem.tables))


def clairvoyant_returns(problem: Problem, table: ValueTable, scenarios: int, seed: int, *, tau: float) -> Vector:
    """Return V^(b0) plus the clairvoyant's largest sum of deltas in each scenario, (scenarios,), in points.

    table: the control, any table of values for this problem; its mean is a bound for every one. tau: points. The
    problem's own likelihood of rays is taken as that of the people.
    """
    return _searched(problem, _relaxation(problem, table, tau, 0), scenarios, (seed, _STREAM))[0]


def chosen_tau(problem: Problem, table: ValueTable, seed: int) -> float:
    """Return the least tau of TAUS that keeps pilot scenarios within MOST_WORK, or the largest."""
    distinct = distinct_words(problem, RAYS)
    work = (len(distinct.words) + RAYS) * (problem.n_items + 1)
    most = max(MOST_WORK // work, 1)
    for tau in TAUS:
        nodes = _searched(problem, _relaxation(problem, table, tau, GIVEN_UP * most), PILOTS, (seed, _PILOT_STREAM))[1]
        if nodes.mean() <= most:
            return tau
    return TAUS[-1]


def _relaxation(problem: Problem, table: ValueTable, tau: float, most_nodes: int) -> Relaxation:
    ahead = Lookahead(table, distinct_words(problem, RAYS), problem.tables)
    return Relaxation(ahead, oracle_of(problem), _alike(problem), tau, most_nodes)


def _searched(problem: Problem, fixed: Relaxation, scenarios: int, streams: tuple[int, int]) -> tuple[Vector, Integers]:
    """Return V^(b0) plus the largest sums, and the nodes expanded, each (scenarios,); a stream for each scenario."""
    seeds = np.random.default_rng(streams).integers(2**53, size=scenarios, dtype=np.uint64)
    results, nodes = np.empty(scenarios), np.empty(scenarios, dtype=np.int64)

    def share(begin: int, end: int) -> None:
        relaxed(seeds[begin:end], fixed, results[begin:end], nodes[begin:end])

    on_all_cores(share, scenarios)
    flat = np.full(problem.n_items, 1.0 / problem.n_items)
    return results + control(flat, NOBODY, fixed.ahead.table, problem.tables), nodes


def _alike(problem: Problem) -> Integers:
    """Return for each item the first one with the same words, and the same direction if anybody points, (n,)."""
    first: dict[tuple[frozenset[str], bytes], int] = {}
    result = []
    for index, item in enumerate(problem.scene.items):
        direction = problem.tables.directions[index].tobytes() if problem.tables.p_g > 0.0 else b""
        result.append(first.setdefault((frozenset(item.vocabulary), direction), index))
    return np.array(result, dtype=np.int64)

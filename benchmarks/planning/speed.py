"""Time of a decision against items, depth and width: the compiled kernel alone, and `decide` of the whole planner.

Every decision is the first of an interaction: the belief is uniform and nothing was asked. Contestants take turns, and
the best of several turns counts. The time is the processor's, on one core: the wall's on an idle machine, and much the
same on a busy one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from fetch_pomdp import Agent, Belief, ExactAnswers, FittedValue, PaperNeverAsk, Planner, Problem, SparseSampling
from fetch_pomdp.core.compiled import Vector, compiled
from fetch_pomdp.core.planners.fitted.ahead import Lookahead, step_ahead
from fetch_pomdp.core.planners.fitted.planner import MOST_FITTED, solution
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.planners.search.planner import default_width, plan
from fetch_pomdp.core.planners.search.tree import Search
from fetch_pomdp.core.problem import Tables
from planning import DEFAULT, Record
from planning.scenes import problem_of

ITEMS = (6, 20, 100, 1_000, 10_000, 100_000)
DEPTHS, WIDTHS = (2, 3, 4), (10, 40, 100)
TURN = 0.01  # s, least time of one turn
BUDGET = 1.5  # s, after which a case takes no more turns

Loop = Callable[[int, Vector, Search, int, Tables], float]


@compiled
def search_loop(times: int, belief: Vector, search: Search, seed: int, tables: Tables) -> float:
    """Decide `times` times from compiled code, so that Python's calls stay out of the measurement."""
    total = 0.0
    for call in range(times):
        total += plan(belief, NOBODY, 0, search, seed + call, tables)[0]
    return total


@compiled
def fitted_loop(times: int, belief: Vector, ahead: Lookahead, seed: int) -> float:
    """Decide `times` times from compiled code, like `search_loop`."""
    total = 0.0
    for call in range(times):
        total += step_ahead(belief, NOBODY, 0, ahead.table, ahead.distinct, seed + call, 1, ahead.tables)[0]
    return total


@dataclass(slots=True)
class Case:
    """One contestant at one size, and its times so far (s a decision)."""

    name: str
    n_items: int
    depth: int
    width: int
    planner: Planner
    loop: Loop
    search: Search
    kernel: list[float] = field(default_factory=list)
    decide: list[float] = field(default_factory=list)

    def expected(self) -> float:
        """Return roughly how long a decision takes (s): whether to measure it at all."""
        asks = self.search.questions > 0
        sparse = not self.search.exact
        last = self.width * self.n_items * (2e-9 * self.n_items if sparse else 5e-9 if asks else 2e-9) + 1e-6
        branches = self.width * ((1 if sparse else 3) * self.n_items + 1 if asks else 1)
        return float(last * branches ** (self.depth - 2))

    def record(self) -> Record:
        """Return the case and its best times (s)."""
        return {
            "planner": self.name,
            "items": self.n_items,
            "depth": self.depth,
            "width": self.width,
            "kernel_s": min(self.kernel),
            "decide_s": min(self.decide),
            "kernel_median_s": float(np.median(self.kernel)),
            "decide_median_s": float(np.median(self.decide)),
            "turns": len(self.decide),
        }


def cases(n_items: int, limit: float) -> Iterator[Case]:
    """Yield what is worth measuring at a size: all that takes less than `limit` s a decision."""
    for depth in DEPTHS:
        for width in WIDTHS:
            asks = Search(depth, width, n_items, exact=True, leaf_asks=False)
            silent, question, sampled = (
                asks._replace(questions=0),
                asks._replace(leaf_asks=True),
                asks._replace(exact=False),
            )
            for name, planner, search in (
                ("ExactAnswers, leaf question", ExactAnswers(depth, width), question),
                ("ExactAnswers, leaf pick", ExactAnswers(depth, width, "pick"), asks),
                ("SparseSampling", SparseSampling(depth, width), sampled),
                ("PaperNeverAsk", PaperNeverAsk(depth, width), silent),
            ):
                case = Case(name, n_items, depth, width, planner, search_loop, search)
                if case.expected() < limit:
                    yield case
    width = default_width(n_items)
    search = Search(2, width, n_items, exact=True, leaf_asks=True)
    yield Case("ExactAnswers, default", n_items, 2, width, ExactAnswers(), search_loop, search)


def fitted_case(problem: Problem) -> Case:
    """Return the default planner, once it has solved the problem."""
    planner = FittedValue()
    known = solution(problem, planner)

    def loop(times: int, belief: Vector, search: Search, seed: int, tables: Tables) -> float:  # noqa: ARG001
        return fitted_loop(times, belief, known.ahead, seed)

    return Case(
        DEFAULT,
        problem.n_items,
        2,
        planner.rays,
        planner,
        loop,
        Search(2, planner.rays, 0, exact=True, leaf_asks=False),
    )


def timed(call: Callable[[int], object], once: float) -> float:
    """Return the time (s) of one of as many calls as fill a turn; `once` is a guess at it."""
    times = max(1, round(TURN / max(once, 1e-7)))
    start = time.process_time()
    call(times)
    return (time.process_time() - start) / times


def take_turn(case: Case, problem: Problem, belief: Belief, seed: int) -> None:
    """Measure a case once more."""
    weights, rng = belief.probabilities, np.random.default_rng(seed)

    def decide(times: int) -> None:
        for _ in range(times):
            case.planner.decide(problem, belief, None, rng=rng)

    def kernel(times: int) -> None:
        case.loop(times, weights, case.search, seed, problem.tables)

    guess = min(case.kernel, default=case.expected())
    case.kernel.append(timed(kernel, guess))
    case.decide.append(timed(decide, guess + 1e-5))


def decision_times(turns: int, limit: float, say: Callable[[str], None]) -> list[Record]:
    """Measure every affordable case. limit: s, the longest decision that is measured."""
    records = []
    for n_items in ITEMS:
        start = time.process_time()
        problem = problem_of(n_items)
        built = time.process_time() - start
        belief, field_ = Belief.uniform(n_items), list(cases(n_items, limit))
        if n_items <= MOST_FITTED:  # larger ones are ExactAnswers
            field_.append(fitted_case(problem))
            field_[-1].loop(1, belief.probabilities, field_[-1].search, 0, problem.tables)
        for case in field_[:4]:  # compiled and loaded before the clock starts
            case.loop(1, belief.probabilities, case.search._replace(width=1), 0, problem.tables)
        spent = dict.fromkeys(range(len(field_)), 0.0)
        for turn in range(turns):
            for number, case in enumerate(field_):
                if spent[number] < BUDGET:
                    start = time.process_time()
                    take_turn(case, problem, belief, turn)
                    spent[number] += time.process_time() - start
        records += [case.record() for case in field_]
        say(f"  {n_items} items: {len(field_)} cases (scene built in {built:.2f} s)")
    return records


def observe_times(turns: int) -> dict[str, float]:
    """Return the time (s) of `Agent.observe` at 6 items, without and with a pointing arm."""
    agent = Agent("ambiguous")
    head, wrist = (0.0, 0.0, 1.6), (0.1, 0.6, 1.4)
    calls: dict[str, Callable[[], object]] = {
        "words": lambda: agent.observe("the green marker"),
        "words and answer": lambda: agent.observe("no the green marker"),
        "words and pointing": lambda: agent.observe("the green marker", head=head, wrist=wrist),
    }
    agent.act()
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(turns):
        for name, call in calls.items():
            times[name].append(timed(lambda n, call=call: [call() for _ in range(n)], 2e-5))  # type: ignore[misc]
    return {name: min(found) for name, found in times.items()}

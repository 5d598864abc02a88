"""Decisions by a deadline: `python benchmarks/deadlines.py [--quick] [--docs FILE]`.

- How long a decision takes on the wall with a budget, on 6 to 100,000 items, while a process keeps one other core busy:
  median, 99th percentile and the longest.
- What more time earns: budgets and numbers of passes on the same people, ambiguous scene, differences to one pass.

It prints Markdown; `--docs FILE` writes it between the markers of a Markdown document.
"""

from __future__ import annotations

import argparse
import math
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # for a run as `python -m`

from fetch_pomdp import Belief, FittedValue, Planner, Problem, Scene  # noqa: E402
from fetch_pomdp.core.simulation import run_episode  # noqa: E402
from planning.people import met  # noqa: E402
from planning.report import short, table  # noqa: E402
from planning.scenes import problem_of  # noqa: E402

BUDGETS = ((6, 1.0), (50, 2.0), (1_000, 20.0), (10_000, 20.0), (100_000, 20.0))  # items, ms
DECISIONS, QUICK_DECISIONS = 2_000, 200
PEOPLE, QUICK_PEOPLE = 40_000, 4_000
PASSES = (1, 4, 16, 64)
TIMED_PEOPLE = 20  # of them one meets a budget


@contextmanager
def other_core_busy() -> Iterator[None]:
    """Keep one other core busy meanwhile."""
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        yield
    finally:
        busy.kill()
        busy.wait()


def times(problem: Problem, planner: FittedValue, decisions: int) -> list[float]:
    """Return the time (s, on the wall) of decisions at random beliefs, from sharp to flat."""
    rng, taken = np.random.default_rng(7), []
    planner.prepare(problem)
    for number in range(decisions):
        belief = Belief(rng.dirichlet(np.full(problem.n_items, (0.02, 0.1, 0.5)[number % 3])) + 1e-12)
        asked = int(belief.probabilities.argmax()) if number % 2 else None
        start = time.perf_counter()
        planner.decide(problem, belief, asked, rng=rng)
        taken.append(time.perf_counter() - start)
    return taken


def deadlines(decisions: int) -> str:
    """Return the table of times."""
    rows = []
    with other_core_busy():
        for n_items, budget in BUDGETS:
            taken = times(problem_of(n_items), FittedValue(budget_ms=budget), max(50, decisions // math.isqrt(n_items)))
            p99 = float(np.quantile(taken, 0.99))
            within = "yes" if p99 <= budget / 1e3 else "no"
            rows.append((f"{n_items:,}", f"{budget:g} ms", f"{len(taken):,}", short(float(np.median(taken))),
                         short(p99), short(max(taken)), within))  # fmt: skip
    return table(("items", "budget", "decisions", "median", "99%", "longest", "99% within it"), rows)


def earned_one_by_one(problem: Problem, planner: Planner, people: int) -> np.ndarray:
    """Return what a planner under the clock earns, (people,)."""
    return np.array([
        run_episode(
            problem, planner, k % problem.n_items, np.random.default_rng((3, k)), np.random.default_rng(k)
        ).earned
        for k in range(people)
    ])  # fmt: skip


def more_time(people: int) -> str:
    """Return the table of returns."""
    problem, rows = Problem(Scene.load("ambiguous")), []
    few = people // TIMED_PEOPLE
    for planners, earned in (
        ([FittedValue(passes=passes) for passes in PASSES], lambda one: met(problem, one, people, 3).earned),
        ([FittedValue(), *(FittedValue(budget_ms=budget) for budget in (0.2, 1.0, 5.0))],
         lambda one: earned_one_by_one(problem, one, few)),
    ):  # fmt: skip
        first = None
        for planner in planners:
            found = earned(planner)
            first = found if first is None else first
            ahead = found - first
            error = float(ahead.std(ddof=1)) / math.sqrt(len(ahead))
            setting = f"passes={planner.passes}" if planner.budget_ms is None else f"budget_ms={planner.budget_ms:g}"
            rows.append((setting, f"{len(found):,}", f"{found.mean():+.3f}", f"{ahead.mean():+.4f} ± {error:.4f}"))
    return table(("setting", "people", "return", "to 1 pass, the same people"), rows)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a check")
    parser.add_argument("--docs", type=Path, metavar="FILE", help="Markdown document whose tables to write anew")
    options = parser.parse_args()
    decisions, people = (QUICK_DECISIONS, QUICK_PEOPLE) if options.quick else (DECISIONS, PEOPLE)
    report = f"{deadlines(decisions)}\n\n{more_time(people)}"
    print(report)
    if options.docs:
        text = options.docs.read_text(encoding="utf-8")
        place = re.compile(r"(<!-- deadlines -->\n).*?(<!-- end -->)", re.DOTALL)
        options.docs.write_text(place.sub(lambda found: f"{found[1]}\n{report}\n\n{found[2]}", text), encoding="utf-8")


if __name__ == "__main__":
    main()

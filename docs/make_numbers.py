"""Measure the table of returns in README.md and docs/planners.md, between its markers.

python docs/make_numbers.py
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from fetch_pomdp import (
    AlwaysAsk,
    Belief,
    ExactAnswers,
    FittedValue,
    NeverAsk,
    Planner,
    Problem,
    Scene,
    SparseSampling,
    Threshold,
    simulate,
)

ROOT = Path(__file__).parent.parent
PAGES = (ROOT / "README.md", ROOT / "docs" / "planners.md")
BEGIN, END = "<!-- numbers -->\n", "<!-- end of numbers -->\n"
EPISODES = 50_000
PLANNERS: dict[str, Planner] = {
    "`FittedValue()`, the default": FittedValue(),
    "`ExactAnswers()`": ExactAnswers(),
    "`Threshold()`, three numbers": Threshold(),
    "`SparseSampling(2, 10)`, the paper's": SparseSampling(2, 10),
    "`AlwaysAsk()`, paradigm two": AlwaysAsk(),
    "`NeverAsk()`, paradigm one": NeverAsk(),
}


def decision_time(problem: Problem, planner: Planner) -> float:
    """Return the median time (us) of a decision at the uniform belief."""
    belief, rng = Belief.uniform(problem.n_items), np.random.default_rng(0)
    times = []
    for _ in range(3000):
        start = time.perf_counter()
        planner.decide(problem, belief, None, rng=rng)
        times.append(time.perf_counter() - start)
    return 1e6 * float(np.median(times))


def table() -> str:
    """Return the table as Markdown."""
    problems = [Problem(Scene.load(name)) for name in ("ambiguous", "unambiguous")]
    lines = [
        "| planner | return, ambiguous | right | questions | return, unambiguous | right | questions | a decision |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, planner in PLANNERS.items():
        cells = []
        for problem in problems:
            summary = simulate(problem, planner, EPISODES, seed=0)
            cells += [f"{summary.mean_return:.2f} ± {1.96 * summary.standard_error:.2f}"]
            cells += [f"{summary.accuracy:.1%}", f"{summary.mean_questions:.2f}"]
        lines.append(f"| {name} | {' | '.join(cells)} | {decision_time(problems[0], planner):.0f} µs |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure, and write the pages."""
    measured = table()
    for page in PAGES:
        before, rest = page.read_text().split(BEGIN)
        page.write_text(before + BEGIN + measured + END + rest.split(END)[1])


if __name__ == "__main__":
    main()

"""Measure the tables of numbers in README.md and docs/, between their markers.

    python docs/make_numbers.py [returns] [others] [gap] [robocup]     (all without a name; `make numbers`)

Every table is that of the command line or of `simulate` for 50,000 people and seed 0, so that what two pages say of one
planner is one measurement. tests/test_numbers.py measures the cheapest rows anew and compares the pages.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from fetch_pomdp import (
    AlwaysAsk,
    ExactAnswers,
    FittedValue,
    NeverAsk,
    PaperAlwaysAsk,
    PaperNeverAsk,
    Planner,
    Problem,
    Scene,
    SparseSampling,
    Threshold,
    simulate,
)
from fetch_pomdp.core.planners.catalogue import planner_named

ROOT = Path(__file__).parent.parent
LAYOUTS = ("ambiguous", "unambiguous")
EPISODES = 50_000
PLANNERS: Mapping[str, Planner] = {
    "`FittedValue()`, the default": FittedValue(),
    "`ExactAnswers()`": ExactAnswers(),
    "`Threshold()`, three numbers": Threshold(),
    "`SparseSampling(2, 10)`, the paper's": SparseSampling(2, 10),
    "`AlwaysAsk()`, paradigm two at its best": AlwaysAsk(),
    "`PaperAlwaysAsk()`, paradigm two": PaperAlwaysAsk(),
    "`NeverAsk()`, paradigm one at its best": NeverAsk(),
    "`PaperNeverAsk()`, paradigm one": PaperNeverAsk(),
}
OTHERS = ("chai", "williams-young", "doshi-roy", "information-gain", "one-shot")
SCORED = ("fitted", "exact", "sparse", "threshold", "paper-never", "paper-always", *OTHERS)
GAMES = 1_000
TABLE_OF: Mapping[str, tuple[str, ...]] = {
    "returns": ("README.md", "docs/planners.md"),
    "others": ("docs/planners.md",),
    "gap": ("docs/gap.md",),
    "robocup": ("docs/robocup.md",),
}


def problems() -> list[Problem]:
    """Return the problems of the study's layouts."""
    return [Problem(Scene.load(name)) for name in LAYOUTS]


def row(name: str, planner: Planner) -> str:
    """Return a planner's row up to its time, as Markdown."""
    cells = []
    for problem in problems():
        summary = simulate(problem, planner, EPISODES, seed=0)
        cells += [f"{summary.mean_return:.2f} ± {1.96 * summary.standard_error:.2f}"]
        cells += [f"{summary.accuracy:.1%}", f"{summary.mean_questions:.2f}"]
    return f"| {name} | {' | '.join(cells)} |"


HEAD = ("planner", "return, ambiguous", "right", "questions", "return, unambiguous", "right", "questions")


def markdown(head: Iterable[str], rows: Iterable[str]) -> str:
    """Return a Markdown table of rows that are ready."""
    names = list(head)
    return "\n".join([f"| {' | '.join(names)} |", "|" + "---|" * len(names), *rows]) + "\n"


def returns() -> str:
    """Return the table of the planners."""
    return markdown(HEAD, (row(name, one) for name, one in PLANNERS.items()))


def others() -> str:
    """Return the table of other people's robots."""
    return markdown(HEAD, (row(f"`{name}`", planner_named(name)) for name in OTHERS))


def gap() -> str:
    """Return what `gap` finds for both layouts; errors are standard errors."""
    found = [json.loads(printed("gap", name, "--json")) for name in LAYOUTS]
    return "\n".join(map(gap_table, found))


def gap_table(found: Mapping[str, Any]) -> str:
    """Return the gaps of a scene's planners to its upper bound."""
    bound = found["bound"]
    told = f"{bound['mean']:.3f} ± {bound['standard_error']:.3f}, {bound['kind']}, {bound['scenarios']:,} scenarios"
    rows = [
        f"| `{one['planner']}` | {one['mean_return']:.3f} ± {one['standard_error']:.3f} | {one['accuracy']:.1%} | "
        f"{one['gap']:.3f} ± {one['gap_error']:.3f} |"
        for one in found["planners"]
    ]
    return f"`{found['scene']}`: upper bound {told}.\n\n" + markdown(("planner", "return", "right", "gap"), rows)


def robocup() -> str:
    """Return the scores of "Hand Me That", the best first."""
    chosen = [word for name in SCORED for word in ("--planner", name)]
    found = json.loads(printed("robocup", "--games", str(GAMES), "--seed", "1", "--json", *chosen))["planners"]
    rows = [
        f"| `{one['planner']}` | {one['mean_score']:.0f} ± {one['standard_error']:.0f} | {one['right']:.1%} | "
        f"{one['first']:.1%} | {one['questions']:.2f} | {one['waits']:.1f} |"
        for one in sorted(found, key=lambda one: -float(one["mean_score"]))
    ]
    head = ("planner", "score", "right by the fourth guess", "at the first", "questions a group", "waits a group")
    return markdown(head, rows)


def printed(*arguments: str) -> str:
    """Return what a command prints."""
    command = [sys.executable, "-m", "fetch_pomdp", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


TABLES = {"returns": returns, "others": others, "gap": gap, "robocup": robocup}


def marked(page: str, name: str) -> str:
    """Return what stands between a page's markers of a name."""
    return page.split(f"<!-- {name} -->\n")[1].split(f"<!-- end of {name} -->\n", maxsplit=1)[0]


def main() -> None:
    """Measure, and write the pages."""
    for name in sys.argv[1:] or list(TABLES):
        measured = TABLES[name]()
        print(measured, flush=True)
        for place in TABLE_OF[name]:
            page = (ROOT / place).read_text(encoding="utf-8")
            (ROOT / place).write_text(page.replace(marked(page, name), measured), encoding="utf-8")


if __name__ == "__main__":
    main()

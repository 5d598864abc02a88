"""What questions of more kinds are worth: `python benchmarks/questions.py twelve | bits | scenes | speed | alike`.

- twelve: twelve alike items with three attributes; the default planner, one step ahead and information gain beside
  Perseus, a point-based solver of its own, before the same people (`asking/twelve.py`).
- bits: how many questions it takes to be 95 % sure, beside what Fano's inequality says that it must.
- scenes: random scenes of 3 to 15 items; `--held-out` opens those that nothing was looked at on.
- speed: times of solving and of deciding.
- alike: 2 to 50 alike items, kinds of question on and off.

Results are printed as Markdown and saved as JSON.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # for a run as `python -m`

from asking import alike, bits, contest, speed, versus  # noqa: E402
from asking.scenes import HELD_OUT, LOOKED_AT, random_problem  # noqa: E402
from planning import Record  # noqa: E402

PEOPLE = 20_000


def main() -> None:
    """Measure, print and save."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["twelve", "bits", "scenes", "speed", "alike"])
    parser.add_argument("--people", type=int, default=PEOPLE, metavar="N", help="interactions each (%(default)s)")
    parser.add_argument("--held-out", action="store_true", help="the scenes that nothing was looked at on")
    parser.add_argument("--count", type=int, metavar="N", help="scenes (all)")
    parser.add_argument("--out", type=Path, default=HERE / "results", metavar="DIR", help="where to save (%(default)s)")
    options = parser.parse_args()
    measures: dict[str, Callable[[], list[Record]]] = {
        "twelve": lambda: versus.rows(options.people),
        "bits": lambda: bits.rows(options.people),
        "scenes": lambda: scenes(options.people, options.count, held_out=options.held_out),
        "speed": speed.rows,
        "alike": lambda: alike.rows(options.people),
    }
    found = measures[options.what]()
    options.out.mkdir(parents=True, exist_ok=True)
    saved = options.out / f"questions-{options.what}{'-held-out' if options.held_out else ''}.json"
    saved.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(table(found))


def scenes(people: int, count: int | None, *, held_out: bool) -> list[Record]:
    """Return the results of random scenes, one a row."""
    found = []
    for seed in list(HELD_OUT if held_out else LOOKED_AT)[:count]:
        start = time.perf_counter()
        found.append({"seed": seed, **contest.contest(random_problem(seed), people, seed)})
        print(f"{seed}: {found[-1]} {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
    return found


def table(rows: list[Record]) -> str:
    """Return rows as Markdown."""
    flat = [{name: shown for key, value in row.items() for name, shown in cells(key, value)} for row in rows]
    names = list(flat[0])
    lines = ["| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
    return "\n".join(lines + ["| " + " | ".join(row.get(name, "") for name in names) + " |" for row in flat])


def cells(name: str, value: object) -> list[tuple[str, str]]:
    """Return the cells of a value, one for each part of a nested one."""
    if isinstance(value, dict):
        return [(f"{name}: {part}", shown) for key, each in value.items() for part, shown in cells(key, each)]
    return [(name, f"{value:.3g}" if isinstance(value, float) and abs(value) < 1 else
             f"{value:.2f}" if isinstance(value, float) else str(value))]  # fmt: skip


if __name__ == "__main__":
    main()

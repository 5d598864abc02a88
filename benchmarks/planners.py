"""How fast and how good the planners are: `python benchmarks/planners.py [--quick] [--json] [--out DIR]`.

One run measures, within 15 minutes of processor time (2 with --quick): compile and import times; decision times against
items, depth and width; return and decision time on both study scenes, beside a plain NumPy sparse sampler, and POUCT
and POMCP of pomdp_py, a process a scene. It prints the tables, and saves planners.json and planners.png. `--docs FILE`
also writes the tables between the markers of a Markdown document; with `--from DIR` it does that with the results of an
earlier run.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import json
import os
import platform
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # for a run as `python -m`

NEEDED = {"pomdp_py": "pomdp-py", "matplotlib": "matplotlib"}
SEED = 7
Say = Callable[[str], None]


def main() -> None:
    """Measure, print and save."""
    options = arguments()
    needed = ("matplotlib",) if options.earlier else NEEDED
    missing = [NEEDED[module] for module in needed if importlib.util.find_spec(module) is None]
    if missing:
        sys.exit(f"This benchmark needs {' and '.join(missing)}: pip install {' '.join(missing)}")
    from planning import plot, report

    if options.earlier:
        results = json.loads((options.earlier / "planners.json").read_text(encoding="utf-8"))
    else:
        results = measured(quick=options.quick, say=say)
        options.out.mkdir(parents=True, exist_ok=True)
        (options.out / "planners.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    beside = options.docs.parent if options.docs else options.earlier or options.out
    plot.draw(results, beside / "planners.png")
    if options.docs:
        report.refresh(options.docs, results)
    if options.json:
        print(json.dumps(results))
    else:
        for name, content in report.tables(results).items():
            print(f"\n{name}\n\n{content}")


def say(line: str) -> None:
    """Tell how far the run is."""
    print(line, file=sys.stderr, flush=True)


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer turns, episodes and simulations: a check")
    parser.add_argument("--json", action="store_true", help="print all results as JSON instead of tables")
    parser.add_argument("--out", type=Path, default=HERE / "results", metavar="DIR", help="where to save (%(default)s)")
    parser.add_argument("--docs", type=Path, metavar="FILE", help="Markdown document whose tables to write anew")
    parser.add_argument("--from", dest="earlier", type=Path, metavar="DIR", help="take the results saved there")
    return parser.parse_args()


def measured(*, quick: bool, say: Say) -> dict[str, object]:
    """Return all results, as they go into the JSON file."""
    from planning import contest, speed, startup

    say("compile and import times")
    starts = startup.startup_times(warm_runs=1 if quick else 5, say=say)
    say("decision times")
    times = speed.decision_times(turns=2 if quick else 9, limit=0.05 if quick else 1.0, say=say)
    observe = speed.observe_times(turns=3 if quick else 15)
    say("returns")
    share = 0.02 if quick else 1.0
    with ProcessPoolExecutor(len(contest.SCENES)) as pool:
        games = [pool.submit(contest.contest, scene, share, SEED, say) for scene in contest.SCENES]
        found = [row for game in games for row in game.result()]
    return {
        "about": about(quick=quick, minutes=sum(os.times()[:4]) / 60),
        "startup": starts,
        "decision_times": times,
        "observe": observe,
        "returns": contest.best_of_each(found),
        "all_returns": found,
    }


def about(*, quick: bool, minutes: float) -> dict[str, object]:
    """Return what the numbers were made with."""
    packages = {name: importlib.metadata.version(name) for name in ("fetch-pomdp", "numpy", "numba", "pomdp-py")}
    machine = f"{platform.system()} {platform.machine()}"
    kind = "quick" if quick else "full"
    return {
        "Python": platform.python_version(),
        **packages,
        "machine": machine,
        "run": f"{kind}, {minutes:.1f} minutes of processor time",
    }


if __name__ == "__main__":
    main()

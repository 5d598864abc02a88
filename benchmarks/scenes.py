"""The default planner on many scenes: `python benchmarks/scenes.py [--named | --looked-at | --held-out] [--quick]`.

The scenes: eleven that are hard in ways of their own (`planning/named.py`), and random ones (`planning/drawn.py`) of
seeds 0 to 149, looked at while the planner was made, or 150 to 199, opened once. On every scene five play: the default
FittedValue(), the paper's SparseSampling(), thresholds tuned to the scene on other people, a pick at once (exact), and
a longer fit, FittedValue(beliefs=40_000, rays=32). All meet the same people, so differences have errors of their own;
the best known is the one of the five that earned most, which by chance flatters the best and not the default.

It prints Markdown and saves scenes-SET.json and scenes-SET.md. `--docs FILE` also writes counts and the worst ten
between the markers of a Markdown document; with `--from DIR` it does that with the results of an earlier run.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import os
import platform
import re
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # for a run as `python -m`

from planning import Record, scene_contest, scene_report  # noqa: E402
from planning.drawn import HELD_OUT, LOOKED_AT  # noqa: E402
from planning.named import SCENES  # noqa: E402

EPISODES, QUICK = 10_000, 1_000
WORST = 10  # scenes in the docs


def main() -> None:
    """Measure, print and save."""
    options = arguments()
    saved = (options.earlier or options.out) / f"scenes-{options.set}"
    if options.earlier:
        results = json.loads(saved.with_suffix(".json").read_text(encoding="utf-8"))
    else:
        episodes = options.episodes or (QUICK if options.quick else EPISODES)
        results = measured(options.set, names(options.set, quick=options.quick), episodes)
        options.out.mkdir(parents=True, exist_ok=True)
        saved.with_suffix(".json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    report = scene_report.tables(results)
    saved.with_suffix(".md").write_text(report + "\n", encoding="utf-8")
    if options.docs:
        refresh(options.docs, options.set, scene_report.tables(results, WORST))
    print(report)


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    sets = parser.add_mutually_exclusive_group()
    for name in ("named", "looked-at", "held-out"):
        sets.add_argument(f"--{name}", dest="set", action="store_const", const=name, help=f"the {name} scenes")
    parser.set_defaults(set="named")
    parser.add_argument("--episodes", type=int, metavar="N", help=f"people a scene ({EPISODES:,})")
    parser.add_argument("--quick", action="store_true", help=f"a check: five scenes, {QUICK:,} people")
    parser.add_argument("--out", type=Path, default=HERE / "results", metavar="DIR", help="where to save (%(default)s)")
    parser.add_argument("--docs", type=Path, metavar="FILE", help="Markdown document whose tables to write anew")
    parser.add_argument("--from", dest="earlier", type=Path, metavar="DIR", help="take the results saved there")
    return parser.parse_args()


def names(of: str, *, quick: bool) -> list[str]:
    """Return the names of a set's scenes."""
    found = list(SCENES) if of == "named" else [f"seed-{seed}" for seed in (LOOKED_AT, HELD_OUT)[of == "held-out"]]
    return found[:5] if quick else found


def measured(of: str, scenes: list[str], episodes: int) -> Record:
    """Return the results of all scenes, a process a core."""
    start, found = time.perf_counter(), []
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for row in pool.map(one, scenes, [episodes] * len(scenes)):
            found.append(row)
            line = f"  {row['scene']}: {row['items']} items, loss {row['loss']:.3f}, {row['process_s']:.1f} s"
            print(line, file=sys.stderr, flush=True)
    about = {
        "set": of,
        "episodes": episodes,
        "fewer": max(100, round(episodes / scene_contest.FEWER)),
        "fetch-pomdp": importlib.metadata.version("fetch-pomdp"),
        "Python": platform.python_version(),
        "minutes": sum(row["process_s"] for row in found) / 60,
        "minutes_on_the_wall": (time.perf_counter() - start) / 60,
    }
    return {"about": about, "scenes": found}


def one(scene: str, episodes: int) -> Record:
    """Return the results of a scene, and how long they took (s of processor time)."""
    scene_contest.warm_up()
    start = time.process_time()
    found = scene_contest.contest(scene, episodes)
    return {**found, "process_s": time.process_time() - start}


def refresh(document: Path, of: str, content: str) -> None:
    """Write the tables between their markers in a Markdown document."""
    text = document.read_text(encoding="utf-8")
    place = re.compile(rf"(<!-- scenes: {of} -->\n).*?(<!-- end -->)", re.DOTALL)
    document.write_text(place.sub(lambda found: f"{found[1]}\n{content}\n\n{found[2]}", text), encoding="utf-8")


if __name__ == "__main__":
    main()

"""Many studies of the size of the paper's with live people: times, accuracies, and how often H1 and H2 hold.

    python benchmarks/live_people.py [--studies 40] [--seed 7000] [studies/live.toml]

Each study has a seed of its own. A clause counts as shown where the paper's reading of its test, over paired trials,
would conclude it (docs/analysis.md).
"""

from __future__ import annotations

import argparse
import dataclasses
from collections import Counter, defaultdict
from functools import partial

from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.hypotheses import hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import assignments
from fetch_pomdp.study.experiment import play
from fetch_pomdp.study.table import to_frame


def main() -> None:
    """Run the studies and print two tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", nargs="?", default="studies/live.toml")
    parser.add_argument("--studies", type=int, default=40)
    parser.add_argument("--seed", type=int, default=7000)
    given = parser.parse_args()
    shown: Counter[tuple[str, str]] = Counter()
    means: dict[tuple[str, str], list[tuple[float, float]]] = defaultdict(list)
    for number in range(given.studies):
        study = dataclasses.replace(load_study(given.config), seed=given.seed + number)
        trials = [played.trial for played in Crew(workers=0).results(partial(play, study, None), assignments(study))]
        table = checked(to_frame(trials))
        for cell in cells(table, Plan()):
            means[cell.layout, cell.paradigm].append((cell.time, cell.accuracy))
        for hypothesis in hypotheses(table, Plan()):
            for clause in hypothesis.clauses:
                shown[hypothesis.name, clause.claim] += clause.paper is True
    print(f"{given.studies} studies, seeds {given.seed} to {given.seed + given.studies - 1}\n")
    for (layout, paradigm), found in means.items():
        time, accuracy = (sum(values) / len(found) for values in zip(*found, strict=True))
        print(f"{layout:12} {paradigm:8} {time:6.2f} s {100 * accuracy:6.1f} % right")
    print()
    for (name, claim), count in shown.items():
        print(f"{name} {claim}: {count} of {given.studies}")


if __name__ == "__main__":
    main()

"""What it is worth that people say where an item is, to a robot that reads it: studies of the size of the paper's.

    python benchmarks/places.py [--studies 20] [--seed 100] [--grammar reader] [--reader table] [--unknown 0]
        [studies/fitted.toml]

The last robot of a study alone, before people who say a place in some share of their requests (`p_place`): in words of
the published studies (`--grammar study`), or of the reader's own grammar. Means over studies, each with a seed of its
own, of times (s) and of the share of trials in which the item was right, with their standard errors.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections import defaultdict
from functools import partial

import numpy as np

from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import Study, assignments
from fetch_pomdp.study.experiment import play
from live_people import seeded

SHARES = (0.05, 0.8)


def of_people(study: Study, grammar: str, p_place: float, p_unknown: float) -> Study:
    """Return a study of its last robot alone, with people who say places so often."""
    last = list(study.paradigms)[-1]
    people = dataclasses.replace(study.population, grammar=grammar, p_place=p_place, p_unknown=p_unknown)
    return dataclasses.replace(study, population=people, paradigms={last: study.paradigms[last]})


def told(study: Study, seed: int, count: int, crew: Crew) -> None:
    """Play studies and print the means of their layouts."""
    found: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    for each in seeded(study, seed, count):
        trials = [played.trial for played in crew.results(partial(play, each, None), assignments(each))]
        for layout in each.layouts:
            here = [trial for trial in trials if trial.layout == layout]
            means = np.mean([(trial.time, 100 * trial.correct, trial.questions) for trial in here], axis=0)
            found[layout].append(tuple(means.tolist()))
    for layout, rows in found.items():
        (time, right, questions), errors = np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1) / np.sqrt(count)
        cells = f"{time:.2f} ± {errors[0]:.2f} s | {right:.1f} ± {errors[1]:.1f} % | {questions:.2f}"
        print(f"| {study.population.p_place:.2f} | {layout} | {cells} |", flush=True)


def main() -> None:
    """Run the studies and print their table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", nargs="?", default="studies/fitted.toml")
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--seed", type=int, default=100)
    parser.add_argument("--grammar", default="reader")
    parser.add_argument("--reader", default="table")
    parser.add_argument("--unknown", type=float, default=0.0)
    given = parser.parse_args()
    study = dataclasses.replace(load_study(given.config), reader=given.reader)
    print("| p_place | layout | time | right | questions |\n|---|---|---|---|---|", flush=True)
    for share in SHARES:
        people = of_people(study, given.grammar, share, given.unknown)
        told(people, given.seed, given.studies, Crew(workers=1))


if __name__ == "__main__":
    main()

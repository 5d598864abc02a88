"""Do the 90 % intervals of `fetch-pomdp calibrate` hold the truth nine times in ten?

    python benchmarks/calibrate.py [--sets N] [--only KIND]  # 25 minutes of one core

Sets of simulated logs are fitted, and it is counted how often each interval holds the true value. A set is of 16
people with 12 interactions each, half of the people at either of the paper's tables, or of one person with 36:

- model: people drawn from the model itself, with parameters drawn anew for each set; those are the true values.
- alone: one such person.
- other: people of `study.people`, who are not the model's story. The true values are those of the model nearest to
  them, which a fit to 800 other people gives.

Saves benchmarks/results/calibrate.json, and the table of docs/calibrate.md between its markers.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.calibrate.calibration import Calibration, calibrate
from fetch_pomdp.study.calibrate.steps import Interaction
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.encounter import encounter, modelled
from fetch_pomdp.study.people.parameters import People

ROOT = Path(__file__).parent.parent
RESULT = ROOT / "benchmarks" / "results" / "calibrate.json"
PAGE = ROOT / "docs" / "calibrate.md"
BEGIN, END = "<!-- coverage -->\n", "<!-- end of coverage -->\n"
SCENES = (Scene.load("ambiguous"), Scene.load("unambiguous"))
ROBOT = Threshold()
PEOPLE, TRIALS, ALONE, MANY = 16, 12, 36, 800
KINDS = {"model": "model's people, 16 x 12", "alone": "one of the model's people, 36", "other": "other people, 16 x 12"}

Truth = Mapping[str, float]


def drawn_truth(rng: Generator) -> dict[str, float]:
    """Draw a model that people may follow."""
    return {
        "sigma": math.exp(rng.uniform(math.log(0.05), math.log(0.2))),
        "p_g": rng.uniform(0.05, 0.6),
        "p_l": rng.uniform(0.3, 0.97),
        "p_answer_again": rng.uniform(0.1, 1.0),
        "alpha": math.exp(rng.uniform(math.log(0.02), math.log(0.5))),
        "p_truth": rng.uniform(0.85, 0.995),
    }


def of_the_model(truth: Truth, people: int, trials: int, rng: Generator) -> Iterator[Interaction]:
    """Yield interactions with people who follow a model; their robot goes by the paper's."""
    for person in range(people):
        scene = SCENES[person % 2]
        problem = Problem(dataclasses.replace(scene, model=scene.model.with_changes(truth)))
        for trial in range(trials):
            desired = trial % problem.n_items
            events = modelled(Agent(scene, ROBOT, seed=trial), problem, desired, rng)
            yield Interaction(scene, desired, str(person), lean(events))


def of_others(people: int, trials: int, rng: Generator) -> Iterator[Interaction]:
    """Yield interactions with people who do not follow the model."""
    population, clock = People(), Durations()
    for person in range(people):
        scene, traits = SCENES[person % 2], population.traits(rng)
        for trial in range(trials):
            desired = trial % len(scene.items)
            met = encounter(Agent(scene, ROBOT, seed=trial), desired, traits, clock, rng)
            yield Interaction(scene, desired, str(person), lean(met.events))


def lean(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """Return events without the reasons of decisions."""
    return tuple(dataclasses.replace(event, decision=None) if isinstance(event, Acted) else event for event in events)


def intervals(found: Calibration, truth: Truth) -> dict[str, dict[str, Any]]:
    """Return each parameter's estimate, interval and true value."""
    limits = {one.name: (one.value, one.low, one.high) for one in found.estimates}
    limits |= {one.name: (one.value, one.low, one.high) for one in found.bias}
    known = {one.name: one.known for one in found.estimates}
    return {
        name: {
            "value": value,
            "low": low,
            "high": high,
            "truth": truth[name],
            "held": low <= truth[name] <= high,
            "known": known.get(name, "both"),
        }
        for name, (value, low, high) in limits.items()
    }


def measured(kind: str, sets: int, seed: int) -> list[dict[str, dict[str, Any]]]:
    """Return the intervals of each set of a kind; the same seed gives the same."""
    nearest: Truth = {}
    if kind == "other":
        found = calibrate(list(of_others(MANY, TRIALS, np.random.default_rng((seed, 9)))))
        nearest = {one.name: one.value for one in found.estimates} | {one.name: one.value for one in found.bias}
        print("other people: nearest model", nearest, flush=True)
    results = []
    for number in range(sets):
        rng = np.random.default_rng((seed, list(KINDS).index(kind), number))
        truth = nearest if kind == "other" else {**drawn_truth(rng), "bias_right": 0.0, "bias_up": 0.0}
        if kind == "other":
            logs = list(of_others(PEOPLE, TRIALS, rng))
        else:
            people, trials = (PEOPLE, TRIALS) if kind == "model" else (1, ALONE)
            model = {name: value for name, value in truth.items() if not name.startswith("bias")}
            logs = list(of_the_model(model, people, trials, rng))
        results.append(intervals(calibrate(logs), truth))
        if (number + 1) % 20 == 0:
            print(f"{kind}: {number + 1} sets", flush=True)
    return results


def summary(sets: list[dict[str, dict[str, Any]]]) -> dict[str, dict[str, float]]:
    """Return how often the intervals of each parameter held the truth, and how often only one limit was known."""
    names = dict.fromkeys(name for one in sets for name in one)
    table = {}
    for name in names:
        rows = [one[name] for one in sets if name in one]
        table[name] = {
            "sets": len(rows),
            "covered": sum(row["held"] for row in rows) / len(rows),
            "bounded": sum(row["known"] == "both" for row in rows) / len(rows),
            "width": float(np.median([row["high"] - row["low"] for row in rows])),
            "truth": float(np.mean([row["truth"] for row in rows])),
            "mean": float(np.mean([row["value"] for row in rows])),
        }
    return table


def page(results: Mapping[str, Mapping[str, Mapping[str, float]]]) -> str:
    """Return the table as Markdown."""
    lines = [
        "| people | parameter | sets | covered | bounded on both sides | median width | mean truth | mean estimate |"
    ]
    lines += ["|---|---|---|---|---|---|---|---|"]
    for kind, table in results.items():
        for name, row in table.items():
            lines.append(
                f"| {KINDS[kind]} | `{name}` | {row['sets']} | {row['covered']:.1%} | {row['bounded']:.0%} "
                f"| {row['width']:.3g} | {row['truth']:.3g} | {row['mean']:.3g} |"
            )
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure, and write the result and the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--sets", type=int, default=200)
    parser.add_argument("--only", choices=list(KINDS))
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    results = json.loads(RESULT.read_text()) if RESULT.exists() else {}
    for kind in [arguments.only] if arguments.only else list(KINDS):
        results[kind] = summary(measured(kind, arguments.sets, arguments.seed))
    ordered = {kind: results[kind] for kind in KINDS if kind in results}
    RESULT.write_text(json.dumps(ordered, indent=1) + "\n")
    before, rest = PAGE.read_text().split(BEGIN)
    PAGE.write_text(before + BEGIN + page(ordered) + END + rest.split(END)[1])


if __name__ == "__main__":
    main()

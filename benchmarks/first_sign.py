"""Where the time goes after the first sign of a request: the default with live people, in studies like the paper's.

    python benchmarks/first_sign.py [--studies 40] [--seed 100] [studies/live.toml]

No robot picks before the first word or pointing; this tells what the last robot of a study does between that and its
pick, in seconds a trial, and what would become of it if it picked the likeliest item at the first sign from some belief
on. How a trial goes on is known from the study, so that both are about the same people.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.design import PERSON, WORLD, Study, assignments, stream
from fetch_pomdp.study.encounter import encounter
from fetch_pomdp.study.trial import Assignment, scored
from live_people import seeded

LIMITS = (0.9, 0.7, 0.5, 0.45)  # beliefs from which on to pick at the first sign


@dataclass(frozen=True, slots=True)
class Course:
    """How a trial went: its time (s), what of it followed the first sign, and the belief at that."""

    layout: str
    time: float
    correct: bool
    parts: Mapping[str, float]  # s
    belief: Vector  # (n_items,)
    guess: bool  # whether the likeliest item was the right one

    @property
    def after(self) -> float:
        """How long (s) after the first sign the robot picked."""
        return sum(self.parts.values())


def course(study: Study, assignment: Assignment) -> Course:
    """Return how an assigned trial goes."""
    header, last = study.header(assignment), ""
    traits = study.population.traits(stream(study, PERSON, assignment.person))
    world = stream(study, WORLD, assignment.person, assignment.order)
    desired = header.scene.index(assignment.desired)
    met = encounter(header.agent(), desired, traits, study.clock, world)
    trial = scored(assignment, met.events, header.scene, met.begun - study.clock.overhead)
    mind, parts, sign, questions = header.agent(), defaultdict[str, float](float), False, 0
    belief, before = mind.belief, 0.0
    for event in met.events:
        mind.take(event)
        if isinstance(event, Acted):
            asks = isinstance(event.action, Point)
            questions += asks and sign
            last = f"question {questions}" if asks else f"waits after question {questions}"
        elif event.time is not None:
            if sign:
                parts[last] += event.time - before
            elif event.words or event.observation.ray:
                sign, belief = True, mind.belief
            before = event.time
    guess = int(belief.argmax()) == desired
    return Course(assignment.layout, trial.time, trial.correct, parts, belief, guess)


def courses(study: Study) -> Iterator[Course]:
    """Yield the trials of a study's last robot."""
    last = list(study.paradigms)[-1]
    return (course(study, one) for one in assignments(study) if one.paradigm == last)


def told(layout: str, found: list[Course]) -> None:
    """Print what became of the trials of a layout."""
    count, times = len(found), np.array([one.time for one in found])
    correct, late = np.array([one.correct for one in found]), np.array([one.after > 1e-9 for one in found])
    spent = defaultdict[str, float](float)
    for one in found:
        for name, seconds in one.parts.items():
            spent[name] += seconds
    print(f"{layout}: {count} trials, {times.mean():.3f} s, {correct.mean():.2%} right")
    print(f"  {1 - late.mean():.1%} picked at the first sign; after it {sum(spent.values()) / count:.3f} s a trial:")
    for name, seconds in sorted(spent.items(), key=lambda part: -part[1])[:6]:
        print(f"    {name:24} {seconds / count:.4f} s")
    for limit in LIMITS:
        picks = late & np.array([one.belief.max() >= limit for one in found])
        right = np.where(picks, [one.guess for one in found], correct).mean()
        time = times.mean() - sum(one.after for one, now in zip(found, picks, strict=True) if now) / count
        print(
            f"  picked at the first sign from a belief of {limit}: {picks.mean():.1%} more, {time:.3f} s, {right:.2%}"
        )


def main() -> None:
    """Run the studies and print where the time goes in each layout."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", nargs="?", default="studies/live.toml")
    parser.add_argument("--studies", type=int, default=40)
    parser.add_argument("--seed", type=int, default=100)
    given = parser.parse_args()
    study = load_study(given.config)
    found = [one for each in seeded(study, given.seed, given.studies) for one in courses(each)]
    for layout in study.layouts:
        told(layout, [one for one in found if one.layout == layout])


if __name__ == "__main__":
    main()

"""Many studies of the size of the paper's with live people: times, accuracies, and how often H1 and H2 hold.

    python benchmarks/live_people.py [--studies 40] [--seed 7000] [--others] [studies/live.toml]

Each study has a seed of its own. A clause counts as shown where the paper's reading of its test, over paired trials,
would conclude it (docs/analysis.md). Two bounds on the time stand beside the robots: one has known the item all along
and picks it in the first step that ends after the request has, or after the first word or pointing.

--others: the same robots before people that their models were not made for.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.hypotheses import hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import PERSON, WORLD, Study, assignments, stream
from fetch_pomdp.study.encounter import encounter
from fetch_pomdp.study.experiment import play
from fetch_pomdp.study.table import to_frame
from fetch_pomdp.study.trial import Assignment, Trial

BREATH = 1.5  # s of silence that end an utterance
OTHERS: Mapping[str, Mapping[str, Any]] = {
    "slower": {"begin_delay": 1.0, "word_time": 0.5, "point_delay": 0.6, "answer_delay": 1.2, "late_delay": 2.5},
    "silent": {"descriptors": (0.3, 0.5, 0.15, 0.05), "p_elaborate": 0.1, "p_answer": 0.9, "patience": 8.0},
    "talkative": {"descriptors": (0.0, 0.1, 0.4, 0.5), "p_place": 0.3, "p_elaborate": 0.9, "word_time": 0.3},
    "repeating": {"patience": 2.0, "p_repeat_answer": 0.9, "p_reword": 0.8},
    "pointing less": {"p_point": 0.6, "p_point_again": 0.4},
}


class Listening:
    """A planner that waits for ever."""

    def decide(
        self,
        problem: Problem,
        belief: Belief,  # noqa: ARG002
        asked: int | None,  # noqa: ARG002
        *,
        rng: Generator,  # noqa: ARG002
        phase: int = 0,  # noqa: ARG002
    ) -> Decision:
        """Wait."""
        nothing = np.full(problem.n_items, np.nan)
        return Decision(Wait(), 0.0, nothing, nothing)


class Bound(NamedTuple):
    """Times (s) of a robot that knows the item and picks at the request's end, or at the first word or pointing."""

    request: float
    sign: float


def bound(study: Study, assignment: Assignment) -> Bound:
    """Return the times that no robot beats that waits for the request, or for a sign of one."""
    traits = study.population.traits(stream(study, PERSON, assignment.person))
    world = stream(study, WORLD, assignment.person, assignment.order)
    scene = study.header(assignment).scene
    desired = scene.index(assignment.desired)
    met = encounter(Agent(scene, Listening()), desired, traits, study.clock, world)
    begun = met.begun - study.clock.overhead
    steps = [event for event in met.events if isinstance(event, Observed) and event.time is not None]
    signs = (step.time for step in steps if step.words or step.observation.ray)
    end = request_end(steps)
    requests = (step.time for step in steps if step.time and step.time >= end)
    return Bound(_first(requests) - begun, _first(signs) - begun)


def request_end(steps: Iterable[Observed]) -> float:
    """Return when (s) the first utterance ended that was heard."""
    end: float | None = None
    for word in (word for step in steps for word in step.words):
        if end is not None and word.start > end + BREATH:
            break
        end = word.end
    return float("inf") if end is None else end


def _first(times: Iterable[float | None]) -> float:
    return next((time for time in times if time is not None), float("nan"))


def trials_of(study: Study) -> list[Trial]:
    """Play a study."""
    return [played.trial for played in Crew(workers=0).results(partial(play, study, None), assignments(study))]


def table_of(studies: Iterable[Study], title: str) -> None:
    """Play studies and print the means of their cells, and how often each hypothesis comes out."""
    shown: Counter[tuple[str, str]] = Counter()
    means: dict[tuple[str, str], list[tuple[float, float]]] = defaultdict(list)
    bounds: dict[str, list[Bound]] = defaultdict(list)
    count = 0
    for study in studies:
        count += 1
        table = checked(to_frame(trials_of(study)))
        for cell in cells(table, Plan()):
            means[cell.layout, cell.paradigm].append((cell.time, cell.accuracy))
        for hypothesis in hypotheses(table, Plan()):
            for clause in hypothesis.clauses:
                shown[hypothesis.name, clause.claim] += clause.paper is True
        last = list(study.paradigms)[-1]
        for assignment in assignments(study):
            if assignment.paradigm == last:
                bounds[assignment.layout].append(bound(study, assignment))
    print(f"{title}: {count} studies\n")
    for (layout, paradigm), found in means.items():
        time, accuracy = (sum(values) / len(found) for values in zip(*found, strict=True))
        print(f"{layout:12} {paradigm:8} {time:6.2f} s {100 * accuracy:6.1f} % right")
    for layout, times in bounds.items():
        request, sign = np.nanmean(np.array(times), axis=0)
        print(f"{layout:12} known at the request's end {request:6.2f} s, at the first sign {sign:6.2f} s")
    print()
    for (name, claim), times_shown in shown.items():
        print(f"{name} {claim}: {times_shown} of {count}")
    print(flush=True)


def seeded(study: Study, seed: int, count: int) -> Iterator[Study]:
    """Yield a study with each of some seeds."""
    return (dataclasses.replace(study, seed=seed + number) for number in range(count))


def main() -> None:
    """Run the studies and print their tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", nargs="?", default="studies/live.toml")
    parser.add_argument("--studies", type=int, default=40)
    parser.add_argument("--seed", type=int, default=7000)
    parser.add_argument("--others", action="store_true")
    given = parser.parse_args()
    study = load_study(given.config)
    if not given.others:
        table_of(seeded(study, given.seed, given.studies), f"seeds from {given.seed}")
    for name, changes in OTHERS.items() if given.others else ():
        people = dataclasses.replace(study.population, **changes)
        other = dataclasses.replace(study, population=people)
        table_of(seeded(other, given.seed, given.studies), f"people who are {name}, seeds from {given.seed}")


if __name__ == "__main__":
    main()

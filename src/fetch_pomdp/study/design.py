"""The design of a study: who meets which robot before which table, how often and in which order."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from numpy.random import Generator, SeedSequence, default_rng

from fetch_pomdp import checks
from fetch_pomdp.core.language.reading.catalogue import WORDS, own_reader
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.planners.catalogue import planner_named
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import InputError, StudyError
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.models import changed
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.trial import Assignment

MOST = 10**9  # people, trials
PERSON, ORDER, WORLD, ROBOT, PRACTICE = range(5)  # what a stream of random numbers is for


@dataclass(frozen=True, slots=True, kw_only=True)
class Paradigm:
    """How a robot decides: a planner, and what it believes and wants that others of the study do not.

    Raises PlannerError for a planner that does not exist or would decide by the clock, ModelError for a change of a
    parameter that does not exist.
    """

    planner: str  # a name of `planners.catalogue.PLANNERS`
    parameters: Mapping[str, Any] = field(default_factory=dict)  # of the planner
    model: Mapping[str, Any] = field(default_factory=dict)  # changes of the model
    rewards: Mapping[str, Any] = field(default_factory=dict)  # changes of the rewards

    def __post_init__(self) -> None:
        planner_named(self.planner, **self.parameters)
        if self.parameters.get("budget_ms") is not None:
            found = f"found {self.parameters['budget_ms']!r}, expected passes: a budget of time gives other results"
            raise StudyError(f"{found} on another computer", field="budget_ms")


PAPER = {
    "never": Paradigm(planner="paper-never"),
    "always": Paradigm(planner="paper-always"),
    "fetch": Paradigm(planner="sparse"),
}


# Those of studies/people.toml and studies/fitted.toml, which says why.
PAPERS_PEOPLE = People(patience=4.011, p_answer=0.99, p_miss=0.02814, p_lost=0.005, latency=0.0506)
PAPERS_CLOCK = Durations(wait=0.5815, arm=0.6, speak=0.5, overhead=3.224)


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """A study, wholly: the same study gives the same trials. The defaults are the paper's (Section IV).

    Paradigms are compared within persons: each meets every paradigm, and wants every item `trials` times from it, in an
    order of their own. Layouts are compared between persons.

    Choice: layouts take turns over the persons, so that their numbers differ by one at most whatever `people` is.

    Choice: all three robots are the paper's: "fetch" is SparseSampling at its depth and width, "never" the same search
    without questions, "always" its rule. Our default planner, and the best robots that never or always ask, are offered
    by names of their own: what asking buys is told with those.

    Choice: people and clock are those that come nearest to the paper's twelve cells of all that a search has tried.

    Raises StudyError, or what a wrong part raises, with the field.
    """

    people: int = 16
    trials: int = 3  # of each item with each paradigm, a person
    seed: int = 0
    layouts: Mapping[str, Scene] = field(default_factory=lambda: {name: Scene.load(name) for name in LAYOUTS})
    paradigms: Mapping[str, Paradigm] = field(default_factory=lambda: dict(PAPER))
    population: People = PAPERS_PEOPLE
    clock: Durations = PAPERS_CLOCK
    reader: str = WORDS  # of all robots: what reads what people say, by its name (`reading.catalogue`)
    logs: bool = False  # whether every interaction is kept, event by event
    real_speech: bool = False  # whether words go through a voice and a recogniser, in place of the population's rates

    def __post_init__(self) -> None:
        for name, least, most in (("people", 1, MOST), ("trials", 1, MOST), ("seed", 0, 2**63 - 1)):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
                found = f"found {checks.shown(value)}, expected a whole number from {least} to {most}"
                raise StudyError(found, field=name)
        own_reader(self.reader)
        for name in ("logs", "real_speech"):
            if not isinstance(getattr(self, name), bool):
                raise StudyError(f"found {checks.shown(getattr(self, name))}, expected true or false", field=name)
        try:
            self.clock.timing()
        except InputError as error:
            raise error.within("clock") from None
        for name in ("layouts", "paradigms"):
            if not getattr(self, name):
                raise StudyError("found none, expected one or more", field=name)
        for layout in self.layouts:
            for paradigm in self.paradigms:
                self.scene(layout, paradigm)

    def scene(self, layout: str, paradigm: str) -> Scene:
        """Return the table of a layout, with the model and rewards of a paradigm."""
        table, robot = self.layouts[layout], self.paradigms[paradigm]
        try:
            return changed(table, {"model": robot.model, "rewards": robot.rewards}, StudyError)
        except InputError as error:
            raise error.within(f"paradigms.{paradigm}") from None

    def header(self, assignment: Assignment) -> Header:
        """Return what an assigned interaction is about, as its log says it."""
        name, robot = assignment.layout, self.paradigms[assignment.paradigm]
        return Header(
            scene=self.scene(name, assignment.paradigm),
            scene_name=name if name in LAYOUTS and self.layouts[name].to_mapping() == _built_in(name) else None,
            planner=robot.planner,
            reader=self.reader,
            parameters=robot.parameters,
            seed=int(stream(self, ROBOT, assignment.person, assignment.order).integers(2**63)),
            target=assignment.desired,
            person=assignment.person,
            layout=name,
            paradigm=assignment.paradigm,
            order=assignment.order,
        )

    def layout_of(self, person: int) -> str:
        """Return the layout that a person has before them."""
        return list(self.layouts)[person % len(self.layouts)]

    @property
    def size(self) -> int:
        """How many trials there are."""
        each = [len(scene.items) * len(self.paradigms) * self.trials for scene in self.layouts.values()]
        rounds, more = divmod(self.people, len(each))
        return rounds * sum(each) + sum(each[:more])


@functools.lru_cache
def _built_in(name: str) -> dict[str, Any]:
    return Scene.load(name).to_mapping()


def stream(study: Study, use: int, *place: int) -> Generator:
    """Return the random numbers for a use at a place (a person, or a person and an order), and for nothing else."""
    return default_rng(SeedSequence(study.seed, spawn_key=(use, *place)))


def assignments(study: Study) -> Iterator[Assignment]:
    """Yield the trials of a study, person by person, each person's in their own shuffled order."""
    for person in range(study.people):
        yield from assignments_of(study, person)


def assignments_of(study: Study, person: int) -> Iterator[Assignment]:
    """Yield the trials of one person, in their own shuffled order."""
    layout = study.layout_of(person)
    rows = [
        (paradigm, item.id)
        for paradigm in study.paradigms
        for item in study.layouts[layout].items
        for _ in range(study.trials)
    ]
    shuffled = stream(study, ORDER, person).permutation(len(rows)).tolist()
    for order, row in enumerate(shuffled):
        paradigm, desired = rows[row]
        yield Assignment(person, layout, paradigm, desired, order)

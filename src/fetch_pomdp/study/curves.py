"""Robustness: what time and accuracy become as speech, pointing or the table get worse, and the model gets wrong.

A curve varies one thing of a study; at each of its values the study is played under each condition, a way in which the
model of the robots may be wrong. Every point is a study of its own, in a folder of its own.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from fetch_pomdp.core.model import LARGEST_SIGMA
from fetch_pomdp.core.planners.catalogue import DEFAULT
from fetch_pomdp.errors import StudyError
from fetch_pomdp.extras import load
from fetch_pomdp.study.alike import alike
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import Table, checked
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import PAPER, Paradigm, Study
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.table import read_table

RUNS = "runs"
FEWEST_PEOPLE = 8  # a layout: fewer make intervals that say little
OFF = math.radians(5.0)  # rad
WORD_ERRORS = ("p_substitute", "p_delete", "p_insert")
SPREADS = ("bias", "bias_episode", "jitter")

Change = Callable[[Study], Study]


def with_word_errors(people: People, rate: float) -> People:
    """Return people whose words go wrong at a rate: substituted, deleted and inserted words for each one said.

    The three, and the table of confusions, keep their proportions. Utterances that are missed as a whole are another
    matter, and stay. Raises StudyError for people who are never misheard, or a rate at which some chance exceeds 1.
    """
    now = math.fsum(getattr(people, name) for name in WORD_ERRORS)
    if now == 0.0:
        raise StudyError("found people whose words are never misheard, expected errors to scale", field="population")
    factor = rate / now
    confusions = {
        said: {heard: factor * chance for heard, chance in row.items()} for said, row in people.confusions.items()
    }
    rates = {name: factor * getattr(people, name) for name in WORD_ERRORS}
    return dataclasses.replace(people, confusions=confusions, **rates)


def with_spread(people: People, sigma: float) -> People:
    """Return people whose pointing is off by `sigma` (rad, standard deviation of each axis).

    The parts that are constant of a person, constant of a pointing, and jitter keep their proportions. The tracker's
    noise comes on top.
    """
    now = math.hypot(*(getattr(people, name) for name in SPREADS))
    if now == 0.0:
        raise StudyError("found people who point without error, expected a spread to scale", field="population")
    return dataclasses.replace(people, **{name: sigma / now * getattr(people, name) for name in SPREADS})


def with_population(change: Callable[[People], People], study: Study) -> Study:
    """Return a study with other people."""
    return dataclasses.replace(study, population=change(study.population))


def with_sigma_times(factor: float, study: Study) -> Study:
    """Return a study whose robots believe in so many times the spread of pointing, at most the largest there can be."""
    layouts = {
        name: dataclasses.replace(
            scene, model=scene.model.with_changes({"sigma": min(factor * scene.model.sigma, LARGEST_SIGMA)})
        )
        for name, scene in study.layouts.items()
    }
    return dataclasses.replace(study, layouts=layouts)


def _answering_wrong(people: People, share: float) -> People:
    return dataclasses.replace(people, p_flip=share)


def _pointing_off(people: People, angle: float) -> People:
    """Return people who point off by a constant of each, with root mean square `angle` (rad) over people."""
    return dataclasses.replace(people, bias=math.hypot(people.bias, angle / math.sqrt(2.0)))


CONDITIONS: Mapping[str, Change] = {
    "as it is": lambda study: study,
    "sigma doubled": partial(with_sigma_times, 2.0),
    "sigma halved": partial(with_sigma_times, 0.5),
    "answers true 80 %": partial(with_population, partial(_answering_wrong, share=0.2)),
    "pointing off by 5 degrees": partial(with_population, partial(_pointing_off, angle=OFF)),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """What is varied: its name, unit, values, and the study at a value."""

    name: str
    label: str
    values: tuple[float, ...]
    at: Callable[[Study, float], Study]


def _misheard(study: Study, rate: float) -> Study:
    return with_population(partial(with_word_errors, rate=rate), study)


def _spread(study: Study, sigma: float) -> Study:
    return with_population(partial(with_spread, sigma=sigma), study)


def _crowded(study: Study, count: float) -> Study:
    """Return a study before a table of alike items, with the model and rewards of its first layout."""
    first = next(iter(study.layouts.values()))
    table = dataclasses.replace(alike(int(count)), model=first.model, rewards=first.rewards)
    return dataclasses.replace(study, layouts={"alike": table})


CURVES: Mapping[str, Curve] = {
    curve.name: curve
    for curve in (
        Curve(
            name="speech", label="word error rate", values=(0.0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6), at=_misheard
        ),
        Curve(
            name="sigma", label="spread of pointing (rad)", values=(0.02, 0.05, 0.1, 0.15, 0.2, 0.3), at=_spread
        ),
        Curve(name="items", label="alike items", values=(2, 3, 5, 10, 20, 35, 50), at=_crowded),
    )
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Point:
    """A value of a curve under a condition, and the study that is played there."""

    curve: Curve
    condition: str
    value: float
    study: Study

    @property
    def folder(self) -> Path:
        """Where its trials are, below the folder of all curves."""
        return Path(RUNS, self.curve.name, self.condition.replace(" ", "-").replace("%", "percent"), f"{self.value:g}")


def with_default(study: Study) -> Study:
    """Return a study with our default planner beside the paper's paradigms; one with others stays as it is."""
    if dict(study.paradigms) != PAPER:
        return study
    return dataclasses.replace(study, paradigms={**PAPER, DEFAULT: Paradigm(planner=DEFAULT)})


def sized(study: Study, trials: int) -> Study:
    """Return a study of at least so many trials a paradigm and layout.

    Choice: as many people as that takes when each wants every item once, at least eight a layout; what people differ
    in is averaged best so.
    """
    fewest = min(len(scene.items) for scene in study.layouts.values())
    people = len(study.layouts) * max(FEWEST_PEOPLE, math.ceil(trials / fewest))
    return dataclasses.replace(study, people=people, trials=1)


def points(study: Study, names: Sequence[str], trials: int) -> Iterator[Point]:
    """Yield the points of curves; all have the same people, but for what is varied.

    Raises StudyError for a curve that does not exist.
    """
    for name in names:
        if name not in CURVES:
            raise StudyError(f"found {name!r}, expected one of {', '.join(CURVES)}", field="curve")
        curve = CURVES[name]
        for condition, change in CONDITIONS.items():
            for value in curve.values:
                yield Point(curve, condition, value, sized(change(curve.at(study, value)), trials))


def trace(chosen: Sequence[Point], folder: Path, crew: Crew, told: Callable[[int], None] = lambda _: None) -> Table:
    """Play what is missing of points, and return their cells as a DataFrame: a row a point, layout and paradigm.

    told: called with the number of trials on disk. Raises StudyError if the folder holds other studies.
    """
    rows: list[dict[str, Any]] = []
    done = 0
    for point in chosen:
        run(point.study, folder / point.folder, crew, told=lambda count, before=done: told(before + count))  # type: ignore[misc]
        done += point.study.size
        for cell in cells(checked(read_table(folder / point.folder)), Plan()):
            place = {"curve": point.curve.name, "condition": point.condition, "value": point.value}
            rows.append({**place, **dataclasses.asdict(cell)})
    return load("pandas", "study").DataFrame(rows)

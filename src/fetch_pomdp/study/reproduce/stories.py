"""Stories of errors: which of them makes the always-asking robot as inaccurate as the paper's, and at what price."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import Study
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.reproduce.cells import Simulated, cell, loss, reduced, residuals, simulate
from fetch_pomdp.study.reproduce.free import changed
from fetch_pomdp.study.reproduce.targets import Target, Targets

Changes = Callable[[People, float], Mapping[str, Any]]


@dataclass(frozen=True, slots=True)
class Story:
    """A kind of error, what its strength is, and the strengths that are tried."""

    name: str
    strength: str
    tried: tuple[float, ...]
    changes: Changes


@dataclass(frozen=True, slots=True)
class StoryResult:
    """What a story does at a strength: all cells of the targets, in their order, and the loss of the fitted ones."""

    story: Story
    strength: float
    cells: tuple[Simulated, ...]
    loss: float


def _heard(people: People, word: str, chance: float) -> dict[str, dict[str, float]]:
    """Return the table of confusions with "yes" heard as one word by this chance and as nothing else."""
    return {**{said: dict(row) for said, row in people.confusions.items()}, "yes": {word: chance}}


STORIES = (
    Story(
        "answers flipped, each by itself", "chance of a flip", (0.03, 0.07, 0.12, 0.18),
        lambda _, chance: {"p_flip": chance, "flip_correlation": 0.0},
    ),
    Story(
        "answers flipped, correlated 0.8 within a trial", "chance of a flip", (0.03, 0.07, 0.12, 0.18),
        lambda _, chance: {"p_flip": chance, "flip_correlation": 0.8},
    ),
    Story(
        'a "yes" heard as "hand", a word of no item', "chance", (0.05, 0.2, 0.4),
        lambda people, chance: {"confusions": _heard(people, "hand", chance)},
    ),
    Story(
        'a "yes" heard as "other", for the twin', "chance", (0.05, 0.1, 0.2),
        lambda people, chance: {"confusions": _heard(people, "other", chance)},
    ),
    Story(
        'a "yes" heard as "spoon", a word of two items', "chance", (0.05, 0.2, 0.4),
        lambda people, chance: {"confusions": _heard(people, "spoon", chance)},
    ),
    Story(
        "the robot's arm misread, each time anew", "rad, each axis", (0.01, 0.015, 0.02, 0.03),
        lambda _, angle: {"reading": angle, "reading_correlation": 0.0},
    ),
    Story(
        "the robot's arm misread, the same way in a trial", "rad, each axis", (0.01, 0.015, 0.02, 0.03),
        lambda _, angle: {"reading": angle, "reading_correlation": 1.0},
    ),
    Story(
        "answers that come 1.5 s later than usual", "chance", (0.05, 0.2, 0.4),
        lambda _, chance: {"p_late": chance},
    ),
    Story(
        "a robot that does not listen long before it asks again", "s", (0.9, 0.7, 0.5, 0.3),
        lambda _, listen: {"listen": listen},
    ),
)  # fmt: skip


def tell(targets: Targets, study: Study, people: int, seed: int, crew: Crew | None = None) -> Iterator[StoryResult]:
    """Yield what each story does at each strength to the people of a study, all else left as it is.

    people: a layout. All outcomes are of the same people, drawn with `seed`.
    """
    base = dataclasses.replace(reduced(study, targets.cells, people), seed=seed)
    for story in STORIES:
        for strength in story.tried:
            told = changed(base, story.changes(study.population, strength))
            trials = simulate(told, crew or Crew())
            cells = tuple(cell(trials, target) for target in targets.cells)
            yield StoryResult(story, strength, cells, _loss(cells, targets))


def _loss(cells: tuple[Simulated, ...], targets: Targets) -> float:
    fitted: list[tuple[Simulated, Target]] = [
        (ours, target) for ours, target in zip(cells, targets.cells, strict=True) if target.fitted
    ]
    ours, theirs = zip(*fitted, strict=True)
    return loss(residuals(ours, theirs, targets.time_error, targets.trials))

"""Ours beside the paper's: cells in standard errors, and how often studies of that size confirm H1 and H2."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from fetch_pomdp.study.analysis.hypotheses import Clause, hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import Study
from fetch_pomdp.study.reproduce.cells import Simulated, cell, simulate
from fetch_pomdp.study.reproduce.targets import Target, Targets
from fetch_pomdp.study.table import to_frame
from fetch_pomdp.study.trial import Trial

FAR = 2.0  # standard errors, beyond which a cell does not fit


@dataclass(frozen=True, slots=True)
class Row:
    """A cell of ours beside the paper's; how far off it is, in standard errors of a study of that size."""

    target: Target
    ours: Simulated
    time_off: float
    accuracy_off: float

    @property
    def fits(self) -> bool:
        """Whether neither its time nor its accuracy is far off."""
        return abs(self.time_off) <= FAR and abs(self.accuracy_off) <= FAR


@dataclass(frozen=True, slots=True)
class Held:
    """A clause of a hypothesis in simulated studies of the paper's size."""

    hypothesis: str
    claim: str
    studies: int
    people: int  # of these studies, how many show it by the tests over persons and by margins (docs/analysis.md)
    pairs: int  # how many would confirm it as the paper reads its tests, over paired trials


@dataclass(frozen=True, slots=True)
class Comparison:
    """All cells, and all clauses."""

    rows: tuple[Row, ...]
    clauses: tuple[Held, ...]


def compare(targets: Targets, study: Study, studies: int, seed: int, crew: Crew | None = None) -> Comparison:
    """Play so many studies of the paper's size with fresh people, and set them beside the paper.

    The cells are means over all of them. Standard errors are those of the search: `time_error`, and the binomial one of
    an accuracy at the middle of the paper's range.
    """
    size = targets.people * len(study.layouts)
    together = dataclasses.replace(study, people=size * studies, seed=seed, logs=False)
    trials = simulate(together, crew or Crew())
    rows = tuple(_row(target, cell(trials, target), targets) for target in targets.cells)
    parts = [list(part) for _, part in itertools.groupby(trials, key=lambda trial: trial.person // size)]
    return Comparison(rows, _held(parts))


def _row(target: Target, ours: Simulated, targets: Targets) -> Row:
    time = (ours.time - target.time) / targets.time_error
    return Row(target, ours, time, target.accuracy_off(ours.accuracy) / target.accuracy_error(targets.trials))


def _held(parts: Sequence[Sequence[Trial]]) -> tuple[Held, ...]:
    judged = [
        [clause for hypothesis in hypotheses(checked(to_frame(part)), Plan()) for clause in hypothesis.clauses]
        for part in parts
    ]
    return tuple(
        Held(
            hypothesis=same[0].hypothesis,
            claim=same[0].claim,
            studies=len(same),
            people=sum(clause.verdict == "holds" for clause in same),
            pairs=sum(map(_confirmed, same)),
        )
        for same in zip(*judged, strict=True)
    )


def _confirmed(clause: Clause) -> bool:
    """Whether the paper's reading confirms a clause; where no pair of trials differs there is nothing against "as"."""
    return clause.kind == "no worse" if clause.paper is None else clause.paper

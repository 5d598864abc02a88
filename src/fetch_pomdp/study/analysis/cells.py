"""One cell of a study: a paradigm in a layout."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fetch_pomdp.study.analysis import intervals
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import Table


@dataclass(frozen=True, slots=True)
class Cell:
    """Means over persons of a person's mean, with intervals (None where there can be none)."""

    layout: str
    paradigm: str
    people: int
    trials: int
    time: float  # s
    time_low: float | None
    time_high: float | None
    time_sd: float | None  # s, of trials
    accuracy: float  # share of trials
    accuracy_low: float | None
    accuracy_high: float | None
    questions: float  # a trial
    waits: float  # a trial
    without_pick: int  # trials that ended with none; their time is when they ended


def cells(table: Table, plan: Plan) -> tuple[Cell, ...]:
    """Return the cells of a checked table, by layout and paradigm in the order of their first trials' names."""
    grouped = table.groupby(["layout", "paradigm"], sort=True, observed=True)
    found = {(layout, paradigm): _cell(layout, paradigm, trials, plan) for (layout, paradigm), trials in grouped}
    rank = {plan.never: 0, plan.always: 1, plan.system: 2}
    place = {plan.ambiguous: 0, plan.unambiguous: 1}
    order = sorted(found, key=lambda names: (place.get(names[0], 2), names[0], rank.get(names[1], 3), names[1]))
    return tuple(found[names] for names in order)


def _cell(layout: str, paradigm: str, trials: Table, plan: Plan) -> Cell:
    by = trials.groupby("person")[["time", "correct", "questions", "waits"]].mean()
    time = intervals.of_mean(by["time"].to_numpy(float), plan.level)
    accuracy = intervals.of_share(by["correct"].to_numpy(float), len(trials), plan.level)
    return Cell(
        layout, paradigm, len(by), len(trials),
        time.mean, time.low, time.high, float(np.std(trials["time"], ddof=1)) if len(trials) > 1 else None,
        accuracy.mean, accuracy.low, accuracy.high,
        float(by["questions"].mean()), float(by["waits"].mean()), int(trials["picked"].isna().sum()),
    )  # fmt: skip

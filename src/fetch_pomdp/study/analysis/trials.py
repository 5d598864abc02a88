"""The table of trials, checked, and the pairs and means of persons that tests are made of."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fetch_pomdp.checks import required, shown
from fetch_pomdp.errors import StudyError
from fetch_pomdp.extras import load
from fetch_pomdp.study.trial import Trial

Table: TypeAlias = Any  # a pandas DataFrame; a third-party type cannot be named without importing it
Values: TypeAlias = NDArray[np.float64]

COLUMNS = tuple(field.name for field in fields(Trial))
MEASURES = {"time": "time", "accuracy": "correct"}  # what is compared, and its column
EVERYWHERE = "all layouts"
DIGITS = 9  # differences that agree so far are ties


def checked(table: Table) -> Table:
    """Return the columns of Trial, with `correct` as 0.0 or 1.0, in the order of trials.

    Raises StudyError for a missing column, an empty table, a trial that is there twice, or a value that cannot be.
    """
    required(dict.fromkeys(map(str, table.columns)), COLUMNS, StudyError)
    if table.empty:
        raise StudyError("found a table without trials, expected one trial at least")
    _numbers(table, "time", "seconds, 0 or more")
    for name in ("order", "questions", "waits"):
        _numbers(table, name, "a whole number, 0 or more")
    for name in ("person", "layout", "paradigm", "desired"):
        _refuse(table, name, table[name].isna(), "a name or number")
    _refuse(table, "correct", ~table["correct"].isin([True, False]), "true or false")
    twice = table.duplicated(["person", "layout", "paradigm", "order"])
    _refuse(table, "order", twice, "each trial of a person once")
    kept = table.loc[:, list(COLUMNS)].astype({"correct": bool}).astype({"correct": float, "time": float})
    return kept.sort_values(["person", "order"], kind="stable", ignore_index=True)


def _numbers(table: Table, name: str, expected: str) -> None:
    found = load("pandas", "study").to_numeric(table[name], errors="coerce")
    _refuse(table, name, ~(np.isfinite(found) & (found >= 0)), expected)


def _refuse(table: Table, name: str, bad: Table, expected: str) -> None:
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        raise StudyError(f"found {shown(table[name].iloc[row])}, expected {expected}", field=f"trials[{row}].{name}")


@dataclass(frozen=True, slots=True)
class Differences:
    """One paradigm less another, in the unit of the measure."""

    people: Values  # (n_people,) of the means of each person who did both
    pairs: Values  # (n_pairs,) of the k-th trials of a person with the same item in the same layout
    unpaired: int  # trials that had no partner


def differences(table: Table, system: str, other: str, measure: str) -> Differences:
    """Return the differences system less other of a checked table, by persons and by paired trials.

    Choice: the paper pairs the trials of a person without saying how; ours are the k-th time, in order, that the person
    wanted the same item from either robot, the closest match that a shuffled list allows.
    """
    both = table[table["paradigm"].isin([system, other])]
    same = ["person", "layout", "desired"]
    repeat = both.groupby([*same, "paradigm"], observed=True).cumcount()
    wide = both.assign(repeat=repeat).pivot(index=[*same, "repeat"], columns="paradigm", values=MEASURES[measure])
    wide = wide.reindex(columns=[system, other])
    full = wide.dropna()
    people = means(table, measure).reindex(columns=[system, other]).dropna()
    return Differences(
        (people[system] - people[other]).to_numpy(float),
        (full[system] - full[other]).to_numpy(float),
        len(both) - 2 * len(full),
    )


def means(table: Table, measure: str) -> Table:
    """Return each person's mean of a measure: a row a person, a column a paradigm."""
    return table.pivot_table(index="person", columns="paradigm", values=MEASURES[measure], aggfunc="mean")


def alike(people: Values) -> bool:
    """Return whether persons do not differ, but for rounding."""
    return bool(np.ptp(people) < 10.0**-DIGITS)

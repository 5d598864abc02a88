"""Parameters of people and clock by name: what a search may change, and a study with them changed."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.design import Study
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People

MOST_FREE = 5
OVERHEAD = "overhead"  # solved for, given the others: it moves every mean time by as much
PEOPLE = tuple(field.name for field in dataclasses.fields(People))
CLOCK = tuple(field.name for field in dataclasses.fields(Durations))


@dataclass(frozen=True, slots=True, kw_only=True)
class Free:
    """A parameter that a search may change from `start`, and why. Raises StudyError for an unknown name or no range.

    A search sees it as a coordinate from 0 to 1 between the logarithms of its bounds, so that bounds are above 0.
    """

    name: str
    low: float
    high: float
    start: float
    why: str

    def __post_init__(self) -> None:
        checks.known([self.name], (*PEOPLE, *CLOCK), "parameter", StudyError)
        checks.text(self.why, "why", "a reason", StudyError)
        low = checks.within(self.low, 1e-6, 1e6, "low", "a number above 0", StudyError)
        high = checks.within(self.high, 1e-6, 1e6, "high", "a number above `low`", StudyError)
        if low >= high:
            raise StudyError(f"found {high:g}, expected a number above `low`", field="high")
        checks.within(self.start, low, high, "start", "a number from `low` to `high`", StudyError)

    def value(self, coordinate: float) -> float:
        """Return the value at a coordinate from 0 to 1."""
        return self.low * math.exp(coordinate * math.log(self.high / self.low))

    @property
    def beginning(self) -> float:
        """Return the coordinate of `start`."""
        return math.log(self.start / self.low) / math.log(self.high / self.low)


def changed(study: Study, values: Mapping[str, Any]) -> Study:
    """Return a study with parameters of its people and clock replaced, by name. Raises StudyError for a wrong one."""
    checks.known(values, (*PEOPLE, *CLOCK), "parameter", StudyError)
    people = {name: value for name, value in values.items() if name in PEOPLE}
    clock = {
        name: checks.within(value, 0.0, 1e3, name, "seconds, from 0 to 1000", StudyError)
        for name, value in values.items()
        if name in CLOCK
    }
    return dataclasses.replace(
        study,
        population=dataclasses.replace(study.population, **people),
        clock=dataclasses.replace(study.clock, **clock),
    )

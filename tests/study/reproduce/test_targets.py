from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.reproduce.free import MOST_FREE
from fetch_pomdp.study.reproduce.targets import Target, Targets

PAPER = Path(__file__).parents[3] / "studies" / "paper.toml"
KINDS = ("never", "always", "fetch")

# Section IV-D, sentence by sentence; unknowns are never, always and fetch ambiguous, then unambiguous.
MEANS = [[1 / 3] * 3 + [0.0] * 3, [0.0] * 3 + [1 / 3] * 3]
FETCH_LESS_NEVER = [-1.0, 0.0, 1.0]
FETCH_LESS_ALWAYS = [0.0, -1.0, 1.0]
NOTHING = [0.0, 0.0, 0.0]


def solved(rows: list[list[float]], values: list[float]) -> Mapping[tuple[str, str], float]:
    found, _, rank, _ = np.linalg.lstsq(np.array(rows, float), np.array(values), rcond=None)
    assert rank == 6
    assert np.array(rows) @ found == pytest.approx(values, abs=0.006)
    return dict(zip([(place, kind) for place in ("ambiguous", "unambiguous") for kind in KINDS], found, strict=True))


def halves(row: list[float]) -> list[float]:
    return [part / 2 for part in row * 2]


@pytest.fixture(scope="module")
def targets() -> Targets:
    return Targets.load(PAPER)


def cells(targets: Targets) -> Mapping[tuple[str, str], Target]:
    return {(target.layout, target.paradigm): target for target in targets.cells}


def test_times_follow_from_the_papers_sentences(targets: Targets) -> None:
    rows = [
        *MEANS,
        [*FETCH_LESS_NEVER, *NOTHING],
        [*FETCH_LESS_ALWAYS, *NOTHING],
        [*NOTHING, *FETCH_LESS_ALWAYS],
        halves(FETCH_LESS_NEVER),
        halves(FETCH_LESS_ALWAYS),
    ]
    times = solved(rows, [9.31, 5.86, 0.59, -1.05, -3.28, -0.03, -2.17])
    assert {place: target.time for place, target in cells(targets).items()} == pytest.approx(times, abs=0.01)


def test_accuracies_are_what_the_papers_sentences_leave_open(targets: Targets) -> None:
    """One unknown is left: fetch less always, ambiguous; it is tried from 0 to 10 points."""
    rows = [
        *MEANS,
        [*FETCH_LESS_NEVER, *NOTHING],
        halves(FETCH_LESS_NEVER),
        halves(FETCH_LESS_ALWAYS),
        [*FETCH_LESS_ALWAYS, *NOTHING],
    ]
    tried = [solved(rows, [88.4, 97.9, 11.1, 5.21, 2.1, x]) for x in np.linspace(0, 10, 1001)]
    possible = [all97 for all97 in tried if all(97 < all97["unambiguous", kind] <= 100 for kind in KINDS)]
    assert len(possible) > 100
    for place, target in cells(targets).items():
        found = [one[place] for one in possible]
        assert target.accuracy == pytest.approx((min(found), max(found)), abs=0.1)


def test_only_the_always_asking_robot_is_predicted(targets: Targets) -> None:
    assert [target.paradigm for target in targets.cells if not target.fitted] == ["always", "always"]
    assert len(targets.free) <= MOST_FREE
    assert (targets.people, targets.trials) == (8, 8 * 6 * 3)
    assert (targets.study.people, targets.study.trials) == (16, 3)


@pytest.mark.parametrize(("accuracy", "off"), [(81.0, -1.0), (82.0, 0.0), (83.0, 0.0), (84.0, 0.0), (86.5, 2.5)])
def test_within_its_range_an_accuracy_is_not_off(accuracy: float, off: float) -> None:
    target = Target(layout="a", paradigm="b", time=1.0, accuracy=(82.0, 84.0), fitted=True)
    assert target.accuracy_off(accuracy) == pytest.approx(off)


def test_standard_error_of_an_accuracy() -> None:
    target = Target(layout="a", paradigm="b", time=1.0, accuracy=(88.0, 92.0), fitted=True)
    assert target.accuracy_error(100) == pytest.approx(3.0)  # the root of 0.9 * 0.1 / 100


def given(**changes: Any) -> dict[str, Any]:
    row = {"layout": "ambiguous", "paradigm": "fetch", "time": 5.0, "accuracy": [90.0, 92.0], "fitted": True}
    free = {"name": "wait", "low": 0.5, "high": 2.0, "start": 1.0, "why": "unknown"}
    data: dict[str, Any] = {"trials": 10, "people": 2, "time_error": 0.3, "cells": [row], "free": [free]}
    return {**data, **changes}


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"cells": []}, "cells"),
        ({"trials": 1.5}, "trials"),
        ({"time_error": 0.0}, "time_error"),
        ({"cells": [{**given()["cells"][0], "accuracy": [93.0, 92.0]}]}, r"cells\[0\]\.accuracy"),
        ({"cells": [{**given()["cells"][0], "layout": "nowhere"}]}, r"cells\[0\]\.layout"),
        ({"cells": [{**given()["cells"][0], "fitted": 1}]}, r"cells\[0\]\.fitted"),
        ({"free": [{**given()["free"][0], "name": "charm"}]}, r"free\[0\]\.charm"),
        ({"free": [{**given()["free"][0], "start": 3.0}]}, r"free\[0\]\.start"),
        ({"free": [{**given()["free"][0], "high": 0.5}]}, r"free\[0\]\.high"),
        ({"free": given()["free"] * 6}, "free"),
        ({"fixed": {"p_flip": 2.0}}, r"fixed\.p_flip"),
        ({"study": {"people": 0}}, r"study\.people"),
        ({"more": 1}, "more"),
    ],
)
def test_what_is_no_target_is_refused_with_its_field(changes: Mapping[str, Any], field: str) -> None:
    Targets.from_mapping(given(), Path())
    with pytest.raises(StudyError, match=f"^{field}: "):
        Targets.from_mapping(given(**changes), Path())

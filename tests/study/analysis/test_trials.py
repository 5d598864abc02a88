"""The table of trials: what is refused, and how trials are paired."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas
import pytest

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.analysis.trials import COLUMNS, checked, differences
from tests.study.made import drawn, table


@pytest.mark.parametrize("column", COLUMNS)
def test_a_missing_column_is_named(column: str) -> None:
    with pytest.raises(StudyError) as caught:
        checked(drawn(1, 0).drop(columns=column))
    assert caught.value.field == column


@pytest.mark.parametrize(
    ("column", "value", "expected"),
    [
        ("time", float("nan"), "seconds, 0 or more"),
        ("time", -1.0, "seconds, 0 or more"),
        ("time", float("inf"), "seconds, 0 or more"),
        ("time", "soon", "seconds, 0 or more"),
        ("questions", -1, "a whole number, 0 or more"),
        ("correct", "maybe", "true or false"),
        ("correct", None, "true or false"),
        ("person", None, "a name or number"),
    ],
)
def test_a_value_that_cannot_be_is_named_with_its_row(column: str, value: object, expected: str) -> None:
    broken = drawn(1, 0).astype({column: object})
    broken.loc[3, column] = value
    with pytest.raises(StudyError) as caught:
        checked(broken)
    assert caught.value.field == f"trials[3].{column}"
    assert str(caught.value).endswith(f"expected {expected}")


def test_an_empty_table_and_a_trial_found_twice_are_refused() -> None:
    whole = drawn(1, 0)
    with pytest.raises(StudyError, match="without trials"):
        checked(whole.iloc[:0])
    with pytest.raises(StudyError, match="each trial of a person once"):
        checked(pandas.concat([whole, whole.iloc[[5]]], ignore_index=True))


def test_the_order_of_rows_does_not_matter() -> None:
    whole = drawn(3, 1)
    shuffled = whole.sample(frac=1.0, random_state=2)
    one = differences(checked(whole), "fetch", "never", "time")
    other = differences(checked(shuffled), "fetch", "never", "time")
    np.testing.assert_array_equal(one.pairs, other.pairs)
    np.testing.assert_allclose(one.people, other.people, rtol=1e-12)


def row(paradigm: str, desired: str, order: int, time: float) -> dict[str, Any]:
    fixed = {"person": 1, "layout": "ambiguous", "correct": True, "picked": desired, "questions": 0, "waits": 0}
    return {**fixed, "paradigm": paradigm, "desired": desired, "order": order, "time": time}


def test_the_kth_trials_with_the_same_item_are_a_pair() -> None:
    rows = [
        row("fetch", "cup", 0, 10.0),  # first cup with fetch
        row("never", "mug", 1, 5.0),  # first mug with never
        row("never", "cup", 2, 7.0),  # first cup with never
        row("fetch", "cup", 3, 20.0),  # second cup with fetch
        row("fetch", "mug", 4, 6.0),  # first mug with fetch
        row("never", "cup", 5, 25.0),  # second cup with never
        row("never", "cup", 6, 99.0),  # third cup with never: no partner
    ]
    found = differences(checked(pandas.DataFrame(rows)), "fetch", "never", "time")
    assert sorted(found.pairs) == [20.0 - 25.0, 6.0 - 5.0, 10.0 - 7.0]
    assert found.unpaired == 1
    assert found.people == pytest.approx([(10 + 20 + 6) / 3 - (5 + 7 + 25 + 99) / 4])


def test_a_person_who_met_one_paradigm_only_is_left_out() -> None:
    found = differences(checked(table([(1, "fetch", 1.0, True), (2, "never", 2.0, True)])), "fetch", "never", "time")
    assert len(found.people) == len(found.pairs) == 0
    assert found.unpaired == 2

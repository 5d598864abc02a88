from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.people.parameters import People


def written(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_a_file_changes_what_it_names_and_nothing_else(tmp_path: Path) -> None:
    path = written(
        tmp_path / "people.toml",
        "patience = 4\ndescriptors = [0, 0.25, 0.75]\n[confusions.yes]\nhand = 0.2\n",
    )
    assert People.load(path) == dataclasses.replace(
        People(), patience=4.0, descriptors=(0.0, 0.25, 0.75), confusions={"yes": {"hand": 0.2}}
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("p_flip = 0.1\npatiense = 4\n", "2: patiense: unknown parameter"),
        ("\np_flip = 1.5\n", "2: p_flip: found 1.5, expected a probability from 0 to 1"),
        ("p_flip = true\n", "1: p_flip: found True, expected a probability from 0 to 1"),
        ("word_time = 0\n", "1: word_time: found 0, expected a time from 0.01 to 600 s"),
        ("bias = -0.1\n", "1: bias: found -0.1, expected an angle from 0 to 0.7 rad"),
        ("reach = nan\n", "1: reach: found nan, expected a length from 0.1 to 2 m"),
        ("descriptors = [0.5, 0.4]\n", "1: descriptors: found a sum of 0.9, expected a list of probabilities"),
        ("descriptors = 2\n", "1: descriptors: found 2, expected a list of probabilities that sum to 1"),
        ("descriptors = []\n", "1: descriptors: found [], expected a list of probabilities that sum to 1"),
        ("confusions = 3\n", "1: confusions: found 3, expected a table of named fields"),
        ("[confusions.yes]\nhand = 2\n", "2: confusions.yes.hand: found 2, expected a probability from 0 to 1"),
        ("[confusions.yes]\nhand = 0.6\nthe = 0.6\n", "1: confusions.yes: found chances of more than 1 together"),
        ("[confusions.Yes]\nhand = 0.6\n", "2: confusions.Yes.hand: found 'Yes', expected a word in lower case"),
        ("p_flip = \n", "1: broken TOML"),
    ],
)
def test_a_bad_file_is_named_with_its_line_and_field(tmp_path: Path, text: str, message: str) -> None:
    path = written(tmp_path / "people.toml", text)
    with pytest.raises(StudyError) as caught:
        People.load(path)
    assert str(caught.value).startswith(f"{path}:{message}")


def test_a_near_miss_is_answered_with_the_name() -> None:
    with pytest.raises(StudyError, match=r"did you mean 'patience'"):
        People.from_mapping({"patiense": 1.0})


@pytest.mark.parametrize(
    "field", [field for field in dataclasses.fields(People) if field.metadata], ids=lambda f: f.name
)
def test_every_number_has_a_range_that_holds_its_default(field: dataclasses.Field[float]) -> None:
    rule: Any = field.metadata
    assert rule["low"] <= field.default <= rule["high"]
    for value in (rule["low"], rule["high"]):
        assert getattr(People(**{field.name: value}), field.name) == value
    bad: list[Any] = [math.nextafter(rule["low"], -math.inf), math.nextafter(rule["high"], math.inf), math.nan, "1"]
    for value in bad:
        with pytest.raises(StudyError, match=field.name):
            People(**{field.name: value})


def test_every_field_is_checked() -> None:
    assert {field.name for field in dataclasses.fields(People) if not field.metadata} == {
        "descriptors",
        "confusions",
        "grammar",
    }


def test_every_parameter_is_on_the_page() -> None:
    page = (Path(__file__).parents[3] / "docs" / "people.md").read_text()
    for field in dataclasses.fields(People):
        assert f"`{field.name}`" in page, field.name
        if field.metadata:
            assert f"| `{field.name}` | {field.default:g} |" in page, field.name


def test_a_grammar_that_nobody_speaks_is_refused() -> None:
    with pytest.raises(StudyError, match="found 'latin', expected one of study, reader"):
        People(grammar="latin")

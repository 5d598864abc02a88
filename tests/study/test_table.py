"""Trials as a table, and back, in every format."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study import table
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.record import NAME, read_trials
from fetch_pomdp.study.table import TYPES, from_frame, read_table, to_frame, write_table
from fetch_pomdp.study.trial import Trial
from tests.files.disk import room_for
from tests.study.small import small

TRIALS = (
    Trial(0, "near", "sure", "item-0", 0, 4.25, True, "item-0", 1, 2),
    Trial(0, "near", "quick", "item-1", 1, 1 / 3, False, None, 0, 30),
    Trial(1, "weit, weg", 'say "so"', "löffel", 0, 1e-3, False, "item-0", 12, 0),
)
names = st.text(st.characters(codec="ascii", min_codepoint=97, max_codepoint=122), min_size=1, max_size=6)
numbers = st.integers(0, 2**40)
trials = st.builds(
    Trial, person=numbers, layout=names, paradigm=names, desired=names, order=numbers, time=st.floats(0, 1e6),
    correct=st.booleans(), picked=st.none() | names, questions=numbers, waits=numbers,
)  # fmt: skip


@given(st.lists(trials, max_size=5))
def test_a_frame_holds_what_the_trials_hold(rows: list[Trial]) -> None:
    frame = to_frame(rows)
    assert {name: str(kind) for name, kind in frame.dtypes.items()} == TYPES
    assert list(from_frame(frame)) == rows


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
@pytest.mark.parametrize("rows", [TRIALS, TRIALS[1:2], ()], ids=["three", "no pick", "none"])
def test_a_file_gives_the_same_table_back(
    ending: str, rows: tuple[Trial, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(table, "CHUNK", 2)
    path = tmp_path / f"trials{ending}"
    write_table(rows, path)
    assert tuple(from_frame(read_table(path))) == rows
    assert read_table(path).dtypes.equals(to_frame(rows).dtypes)


def test_a_folder_is_read_as_far_as_it_is_written(tmp_path: Path) -> None:
    run(small(), tmp_path)
    whole = tuple(read_trials(tmp_path / NAME))
    assert tuple(from_frame(read_table(tmp_path))) == whole
    (tmp_path / NAME).write_bytes((tmp_path / NAME).read_bytes()[:-10])
    assert tuple(from_frame(read_table(tmp_path / NAME))) == whole[:-1]


def test_what_is_no_table_is_refused_in_a_line(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"trials.jsonl: cannot be read: No such file"):
        read_table(tmp_path)
    with pytest.raises(StudyError, match=r"a.xlsx: found '.xlsx', expected one of .jsonl, .csv, .parquet"):
        read_table(tmp_path / "a.xlsx")
    with pytest.raises(StudyError, match=r"found '.jsonl', expected .csv or .parquet"):
        write_table(TRIALS, tmp_path / "a.jsonl")
    with pytest.raises(StudyError, match=r"a.csv: cannot be read: No such file"):
        read_table(tmp_path / "a.csv")
    (tmp_path / "a.parquet").write_bytes(b"no parquet")
    with pytest.raises(StudyError, match=r"a.parquet: cannot be read: "):
        read_table(tmp_path / "a.parquet")
    (tmp_path / "a.csv").write_text("person,layout\n1,near\n")
    with pytest.raises(StudyError, match=r"a.csv: paradigm: found no such field"):
        read_table(tmp_path / "a.csv")


def test_names_that_look_like_numbers_or_gaps_stay_names(tmp_path: Path) -> None:
    rows = (Trial(0, "NA", "007", "nan", 0, 1.0, True, "nan", 0, 0),)
    write_table(rows, tmp_path / "trials.csv")
    assert tuple(from_frame(read_table(tmp_path / "trials.csv"))) == rows


@pytest.mark.parametrize(
    ("column", "value", "found"),
    [
        ("time", math.nan, "found '', expected seconds"),
        ("questions", -1, "found -1, expected a whole number"),
        ("correct", "yes", "found 'yes', expected true or false"),
        ("layout", None, "found None, expected a name"),
    ],
)
def test_a_value_that_is_none_of_a_trial_is_refused_by_row_and_column(
    column: str, value: object, found: str, tmp_path: Path
) -> None:
    frame = to_frame(TRIALS).astype(object)
    frame.loc[1, column] = value
    frame.to_csv(tmp_path / "trials.csv", index=False)
    with pytest.raises(StudyError, match=rf"trials.csv:3: {column}: {found}"):
        read_table(tmp_path / "trials.csv")


def test_a_cell_that_is_none_is_refused_in_a_line(tmp_path: Path) -> None:
    path = tmp_path / "trials.csv"
    header = ",".join(TYPES)
    path.write_text(f"{header}\n0,near,{'x' * 200_000},a,0,1.0,True,a,0,0\n")
    with pytest.raises(StudyError, match=r"^\S+trials.csv:2: broken CSV: field larger than field limit \(131072\), "):
        read_table(path)
    for cell in ("a\0b", "\x01"):
        path.write_text(f"{header}\n0,near,{cell},a,0,1.0,True,a,0,0\n")
        with pytest.raises(StudyError, match=r"trials.csv:2: paradigm: found .*, expected a name without control"):
            read_table(path)
    path.write_text(f"{header}\n{10**30},near,sure,a,0,1.0,True,a,0,0\n")
    with pytest.raises(StudyError, match=r"trials.csv:2: person: found 10+, expected a whole number from 0"):
        read_table(path)
    with pytest.raises(StudyError, match=r"cannot be read: .*null byte"):
        read_table("a\0b.csv")


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_a_table_is_whole_or_the_one_before(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"trials{ending}"
    write_table(TRIALS, path)
    before = path.read_bytes()
    with room_for(len(before) - 20), pytest.raises(StudyError, match=r"cannot be written: .*, expected room for it"):
        write_table(TRIALS, path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]

"""The commands of a study, as a user calls them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fetch_pomdp.study.record import NAME
from fetch_pomdp.study.table import read_table
from tests.cli.conftest import Run

CONFIG = """
people = 4
trials = 1
[paradigms]
always = "paper-always"
quick = {planner = "threshold", pick = 0.8}
"""


@pytest.fixture
def config(tmp_path: Path) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(CONFIG)
    return path


def test_a_study_is_run_gone_on_with_and_reported(run: Run, config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ("study", "--config", config, "--out", out, "--workers", 1, "--people", 2)
    code, printed, _ = run(*command, "--json")
    cells = [json.loads(line) for line in printed.splitlines()]
    assert code == 0
    assert [(cell["layout"], cell["paradigm"], cell["people"], cell["trials"]) for cell in cells] == [
        ("ambiguous", "always", 1, 6), ("ambiguous", "quick", 1, 6),
        ("unambiguous", "always", 1, 6), ("unambiguous", "quick", 1, 6),
    ]  # fmt: skip
    table = read_table(out)
    for cell in cells:
        own = table[(table["layout"] == cell["layout"]) & (table["paradigm"] == cell["paradigm"])]
        assert cell["time"] == pytest.approx(own["time"].mean())
        assert cell["accuracy"] == pytest.approx(own["correct"].mean())
    for ending in (".csv", ".parquet"):
        assert read_table((out / NAME).with_suffix(ending)).equals(table)

    whole = (out / NAME).read_bytes()
    (out / NAME).write_bytes(whole[: len(whole) // 2])
    assert run(*command, "--json")[:2] == (0, printed)
    assert (out / NAME).read_bytes() == whole

    code, printed, _ = run("study", "report", out)
    assert code == 0
    assert printed.strip() == f"wrote {out / 'report' / 'report.html'}"
    assert (out / "report" / "report.html").stat().st_size > 1000


def test_wrong_input_is_one_line_and_code_2(run: Run, config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    given = ("study", "--config", config, "--out", out, "--workers", 1)
    assert run(*given, "--people", 1)[0] == 0
    code, _, told = run(*given, "--people", 2)
    assert code == 2
    assert "found another study there (people 1, not 2)" in told.splitlines()[-1]
    for arguments, expected in (
        ((*given, "--backend", "spark"), "backend: found 'spark'"),
        (("study", "--config", tmp_path / "none.toml"), "none.toml: cannot be read"),
        (("study", "report", tmp_path / "nowhere"), "nowhere"),
        (("study", "--out", config / "below", "--config", config, "--people", 1), "cannot be written"),
    ):
        code, _, told = run(*arguments)
        assert code == 2
        assert expected in told.splitlines()[-1]


def test_the_robots_of_a_study_read_with_the_reader_that_is_named(run: Run, config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ("study", "--config", config, "--out", out, "--workers", 1, "--people", 1)
    assert run(*command, "--reader", "table")[0] == 0
    header = json.loads((out / NAME).read_text().splitlines()[0])
    assert header["study"]["reader"] == "table"
    code, _, told = run(*command)
    assert code == 2
    assert "reader" in told.splitlines()[-1]
    code, _, told = run(*command, "--reader", "lips")
    assert code == 2
    assert "reader: found 'lips', expected words, table" in told.splitlines()[-1]


def test_a_study_can_be_stopped_by_hand(
    run: Run, config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from fetch_pomdp.study import experiment

    played, calls = experiment.play, []

    def interrupted(*arguments: object) -> object:
        calls.append(arguments)
        if len(calls) == 4:
            raise KeyboardInterrupt
        return played(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(experiment, "play", interrupted)
    code, _, told = run("study", "--config", config, "--out", tmp_path / "out", "--workers", 1)
    assert code == 130
    assert "stopped; run the same command again to go on" in told
    assert "3/48" in told
    assert len(read_table(tmp_path / "out")) == 3

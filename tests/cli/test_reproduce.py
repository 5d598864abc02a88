"""The commands that hold a study against the paper, as a user calls them."""

from __future__ import annotations

from pathlib import Path

import pytest

from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.reproduce import search, stories
from tests.cli.conftest import Run

TARGETS = """
trials = 12
people = 1
time_error = 0.3
[[cells]]
layout = "ambiguous"
paradigm = "fetch"
time = 4.0
accuracy = [90.0, 95.0]
fitted = true
[[cells]]
layout = "ambiguous"
paradigm = "always"
time = 6.0
accuracy = [90.0, 95.0]
fitted = false
[[free]]
name = "patience"
low = 2.0
high = 9.0
start = 4.0
why = "a test"
[study]
people = 2
trials = 1
[study.paradigms]
never = {planner = "threshold", pick = 0.4}
always = "paper-always"
fetch = {planner = "threshold", pick = 0.8}
"""


@pytest.fixture
def targets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(search, "COARSE", 1)
    monkeypatch.setattr(search, "FINE", 1)
    path = tmp_path / "targets.toml"
    path.write_text(TARGETS)
    return path


def test_what_is_fitted_is_a_study_that_can_be_compared(
    run: Run, targets: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "people.toml"
    code, printed, _ = run("study", "fit", "--targets", targets, "--budget", 8, "--out", out)
    assert code == 0
    assert [line.split()[0] for line in printed.splitlines()] == ["patience", "loss", "wrote", "wrote"]
    fitted = load_study(tmp_path / "fitted.toml")
    assert f"patience {fitted.population.patience:g}" in printed

    paradigms = TARGETS[TARGETS.index("[study.paradigms]") :].replace("study.", "")
    with (tmp_path / "fitted.toml").open("a") as stream:
        stream.write(paradigms)
    files = ("--targets", targets, "--config", tmp_path / "fitted.toml")
    code, printed, _ = run("study", "compare", *files, "--studies", 2)
    assert code == 0
    rows = [line.split(" | ") for line in printed.splitlines() if line.startswith("| ambiguous")]
    assert [(row[1], row[-1].rstrip(" |")) for row in rows] == [("fetch", "fitted"), ("always", "predicted")]

    monkeypatch.setattr(stories, "STORIES", stories.STORIES[:1])
    code, printed, _ = run("study", "stories", *files, "--people", 1)
    assert code == 0
    assert len(printed.splitlines()) == 2 + len(stories.STORIES[0].tried)


def test_wrong_targets_are_one_line_and_code_2(run: Run, targets: Path) -> None:
    targets.write_text(TARGETS.replace('"patience"', '"patients"'))
    code, _, complaint = run("study", "fit", "--targets", targets)
    assert code == 2
    assert complaint.startswith(f"fetch-pomdp: {targets}:")
    assert "did you mean 'patience'" in complaint

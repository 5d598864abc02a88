"""The commands on participants, as a researcher calls them."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from fetch_pomdp.user_study.store.store import Store
from tests.cli.conftest import Run
from tests.user_study.store.made import PICKED, WAITED, enrolled, header


@pytest.fixture
def url(tmp_path: Path) -> str:
    """Four people who have met two robots; one more has only come."""
    url = f"sqlite:///{tmp_path / 'participants.db'}"
    store = Store.open(url)
    for _ in range(4):
        someone, _ = enrolled(store, people=9)
        for order in range(4):
            paradigm = ("never", "always")[order % 2]
            trial = store.trial(someone.id, "trial", order, header(someone.person, order, "bowl-2", paradigm))
            trial.write(WAITED)
            trial.write(PICKED)
    enrolled(store, people=9)
    store.close()
    return url


def test_list_prints_how_far_they_are(run: Run, url: str) -> None:
    code, out, _ = run("participants", "list", "--database", url)
    people = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    assert [(one["person"], one["trials_done"], one["of"]) for one in people] == [
        (0, 4, 6), (1, 4, 7), (2, 4, 8), (3, 4, 9), (4, 0, 10),
    ]  # fmt: skip
    code, out, err = run("participants", "list", "--database", url, "--study", "pilt")
    assert (code, out) == (2, "")
    assert err == "fetch-pomdp: study: nobody takes part in 'pilt' yet\n"


def test_an_export_is_checked_and_reported(run: Run, url: str, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    code, out, _ = run("participants", "export", folder, "--database", url)
    assert (code, out) == (0, f"wrote {folder}: pilot, 5 people, 16 trials, 0 unfinished, 0 of practice\n")
    logs = sorted((folder / "logs").iterdir())
    assert run("log", "check", *logs)[0] == 0
    code, out, _ = run("study", "report", folder)
    assert (code, out) == (0, f"wrote {folder / 'report' / 'report.html'}\n")
    assert run("log", "trials", *logs)[1] == (folder / "trials.csv").read_text()


def test_forget_deletes_one(run: Run, url: str) -> None:
    people = [json.loads(line) for line in run("participants", "list", "--database", url)[1].splitlines()]
    code, out, _ = run("participants", "forget", people[1]["code"], "--database", url)
    assert (code, out) == (0, f"deleted {people[1]['code']}: 4 trials, 8 events, 0 answers, 0 sounds\n")
    left = [json.loads(line) for line in run("participants", "list", "--database", url)[1].splitlines()]
    assert [one["person"] for one in left] == [0, 2, 3, 4]
    code, out, err = run("participants", "forget", people[1]["code"], "--database", url)
    assert (code, out) == (2, "")
    assert err.endswith("code: no participant has this code\n")


def test_bad_input_is_one_line_and_code_2(tmp_path: Path) -> None:
    """In a process of its own, for libraries that print on their own."""
    program = [str(Path(sys.executable).with_name("fetch-pomdp")), "participants", "list", "--database"]
    for url in (f"sqlite:///{tmp_path / 'none.db'}", "postgresql://u:s3cr3t@127.0.0.1:1/d"):
        done = subprocess.run([*program, url], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith("fetch-pomdp: ")
        assert done.stderr.count("\n") == 1
        assert "s3cr3t" not in done.stderr

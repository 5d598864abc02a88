"""What tests of the command line share: commands run as a user calls them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator

import pytest

from fetch_pomdp.cli import compiling
from fetch_pomdp.cli.main import main

Run = Callable[..., tuple[int, str, str]]

# A recording in which the robot heard "marker", asked about one and was told "no".
ASKED = (
    {"scene": "ambiguous"},
    {"action": "wait"},
    {"observation": {"utterance": "hand me the marker"}},
    {"action": "point", "item": "marker-1"},
    {"observation": {"utterance": "no"}},
)


@pytest.fixture(autouse=True)
def patience() -> Iterator[None]:
    """Where nothing is compiled yet, what a command says of that is in no test's way."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compiling, "TOLD_AFTER", 600.0)
        yield


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fetch-pomdp", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        return int(ended.value.code or 0), captured.out, captured.err

    return call

"""Journals: found by their secret alone, whole after a kill."""

from __future__ import annotations

from pathlib import Path

import pytest

from fetch_pomdp.adapters.web import journal as module
from fetch_pomdp.adapters.web.journal import Journal, Journals, name_of
from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header

HEADER = Header(scene=Scene.load("ambiguous"), scene_name="ambiguous", planner="paper-never")
STORY = (
    Observed(Observation(("marker",)), time=1.0),
    Acted(Point(2), time=3.0),
    Observed(Observation(("no",)), time=4.5),
)


@pytest.mark.parametrize("folder", ["data", None])
def test_a_journal_goes_on_where_it_was(tmp_path: Path, folder: str | None) -> None:
    journals = Journals(tmp_path / folder if folder else None)
    journal = journals.new(HEADER)
    for event in STORY:
        journal.write(event)
    if folder:  # another server, after the first was killed in the middle of a line
        with (tmp_path / folder / f"{journal.name}.jsonl").open("a") as file:
            file.write('{"action": ')
        journals = Journals(tmp_path / folder)
    resumed = journals.resumed(journal.secret)
    assert resumed is not None
    assert tuple(resumed.events) == STORY
    assert resumed.time == 4.5
    assert resumed.agent().belief.argmax() == 3
    assert resumed.agent().asked == 2


def test_it_goes_on_later_if_somebody_was_there_after_the_last_event() -> None:
    assert Journal("", HEADER).time == 0.0
    assert Journal("", HEADER, clock=2.5).time == 2.5
    assert Journal("", HEADER, list(STORY), clock=2.5).time == 4.5
    assert Journal("", HEADER, list(STORY), clock=6.0).time == 6.0


def test_neither_its_name_nor_a_path_opens_a_journal(tmp_path: Path) -> None:
    journals = Journals(tmp_path)
    journal = journals.new(HEADER)
    for guess in (journal.name, f"{journal.name}.jsonl", "../x", "", "\ud800"):
        assert journals.resumed(guess) is None
    assert [path.name for path in tmp_path.iterdir()] == [f"{name_of(journal.secret)}.jsonl"]


def test_it_knows_what_was_handed_over() -> None:
    journal = Journals(None).new(HEADER)
    journal.write(Acted(Pick(3), Outcome.STOPPED))
    assert journal.picked is None
    journal.write(Acted(Pick(3)))
    assert journal.picked == "marker-2"


def test_without_a_folder_the_oldest_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_KEPT", 2)
    journals = Journals(None)
    first, *others = (journals.new(HEADER) for _ in range(3))
    assert journals.resumed(first.secret) is None
    assert [journals.resumed(other.secret) for other in others] == others

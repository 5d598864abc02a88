"""A study written into a folder: the same events, in the form that the analysis reads."""

from __future__ import annotations

import csv
import dataclasses
import tempfile
import wave
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.errors import StoreError
from fetch_pomdp.files.checking import checked
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.files.scanning import ends
from fetch_pomdp.study.table import from_frame, read_table
from fetch_pomdp.user_study.store import trials
from fetch_pomdp.user_study.store.exporting import Exported
from fetch_pomdp.user_study.store.store import Store
from tests.files.test_recordings import events as any_event
from tests.user_study.store.made import PICKED, SCENE, WAITED, header, joined


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def in_order(happened: list[Event]) -> list[Event]:
    """The events that one trial can have: up to a hand-over, and heard words in their utterance."""
    kept: list[Event] = []
    for event in happened:
        if isinstance(event, Observed) and event.words and not event.observation.words:
            continue  # an utterance of null is that of its words
        if (isinstance(event, Observed) and event.anew) or (
            isinstance(event, Acted) and event.outcome is Outcome.RETURNED
        ):
            continue  # nothing follows a hand-over
        kept.append(event)
        if ends(event):
            break
    return kept


@settings(max_examples=20)
@given(trials=st.lists(st.lists(any_event, max_size=8).map(in_order), min_size=1, max_size=3))
def test_what_is_written_is_what_is_exported(trials: list[list[Event]]) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        store = Store.open(f"sqlite:///{folder / 'p.db'}")
        someone = joined(store)
        for order, happened in enumerate(trials):
            trial = store.trial(someone.id, "trial", order, header(0, order))
            for event in happened:
                trial.write(event)
            assert store.trial(someone.id, "trial", order, header(0, order)).events == tuple(happened)
            trial.finish(given_up=not trial.finished)
        store.export(folder / "out")
        store.close()
        for order, happened in enumerate(trials):
            recording = read_recording(folder / "out" / "logs" / f"0000-{order:03}.jsonl")
            assert recording.header == header(0, order)
            assert list(recording.events) == happened
        assert len(rows(folder / "out" / "trials.csv")) == len(trials)


@pytest.fixture
def studied(store: Store) -> Store:
    """Two people: one has ended, given up and left trials, practised and answered; one has withdrawn."""
    someone, gone = joined(store), joined(store)
    store.trial(someone.id, "practice", 0, header(0, 0)).write(PICKED)
    for order in range(2):
        trial = store.trial(someone.id, "trial", order, header(0, order, "bowl-2" if order else "spoon-1"))
        trial.write(WAITED)
        trial.write(PICKED)
    left = store.trial(someone.id, "trial", 2, header(0, 2))
    left.note_clock(0.0)
    for _ in range(2):
        left = store.trial(someone.id, "trial", 2, header(0, 2))
    left.write(WAITED)
    left.finish(given_up=True)
    store.trial(someone.id, "trial", 3, header(0, 3)).write(WAITED)
    store.answer(someone.id, "understood", 'names, "one"\nand more')
    store.answer(someone.id, "parts", ["names", "pointing"])
    store.trial(gone.id, "trial", 0, header(1, 0)).write(PICKED)
    store.answer(gone.id, "understood", "nothing")
    store.forget(gone.code)
    return store


def test_an_export_holds_the_study_and_nothing_of_who_withdrew(studied: Store, tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "out"
    assert studied.export(folder) == Exported("pilot", 1, trials=3, unfinished=1, practice=1)
    assert sorted(str(path.relative_to(folder)) for path in folder.rglob("*.*")) == [
        "answers.csv", "conditions.csv", "logs/0000-000.jsonl", "logs/0000-001.jsonl", "logs/0000-002.jsonl",
        "participants.csv", "practice/0000-000.jsonl", "trials.csv", "unfinished/0000-003.jsonl",
    ]  # fmt: skip
    assert list(tmp_path.rglob(".*")) == []
    for log in folder.rglob("*.jsonl"):
        assert checked(log).faults == ()
    table = rows(folder / "trials.csv")
    assert [(row["order"], row["picked"], row["correct"], row["time"]) for row in table] == [
        ("0", "bowl-2", "False", "2.5"), ("1", "bowl-2", "True", "2.5"), ("2", "", "False", "1.0"),
    ]  # fmt: skip
    assert rows(folder / "answers.csv") == [
        {"person": "0", "question": "parts", "value": '["names", "pointing"]'},
        {"person": "0", "question": "understood", "value": 'names, "one"\nand more'},
    ]
    assert [tuple(row.values()) for row in rows(folder / "conditions.csv")] == [
        ("0", "0", "0", "False"), ("0", "1", "0", "False"), ("0", "2", "2", "True"),
    ]  # fmt: skip
    (first,) = rows(folder / "participants.csv")
    assert (first["person"], first["stage"], first["trials_done"], first["of"], first["given_up"]) == (
        "0", "instructions", "3", "6", "1",
    )  # fmt: skip
    assert len(first["consent_text"]) == 64
    assert not {"secret", "id"} & set(first)


def test_nothing_in_a_table_is_a_formula(store: Store, tmp_path: Path) -> None:
    texts = ["=1+1", "+1", "-1", "@sum", "\t=1", "'=1", "a=1", "1-1"]
    scene = dataclasses.replace(SCENE, items=tuple(dataclasses.replace(item, id=f"={item.id}") for item in SCENE.items))
    someone = joined(store)
    for number, text in enumerate(texts):
        store.answer(someone.id, f"q{number}", text)
    store.trial(
        someone.id, "trial", 0, dataclasses.replace(header(0, 0, "=bowl-2"), scene=scene, scene_name=None)
    ).write(PICKED)
    store.export(tmp_path / "out")
    kept = [row["value"] for row in rows(tmp_path / "out" / "answers.csv")]
    assert kept == [f"'{text}" for text in texts[:5]] + texts[5:]
    (trial,) = rows(tmp_path / "out" / "trials.csv")
    assert (trial["desired"], trial["picked"]) == ("'=bowl-2", "'=bowl-2")
    (log,) = (tmp_path / "out" / "logs").iterdir()
    assert read_recording(log).header.target == "=bowl-2"


def test_the_folder_is_read_as_the_table_of_a_study(studied: Store, tmp_path: Path) -> None:
    studied.export(tmp_path / "out")
    from_logs, from_csv = read_table(tmp_path / "out"), read_table(tmp_path / "out" / "trials.csv")
    assert list(from_frame(from_logs)) == list(from_frame(from_csv))
    assert len(from_logs) == 3


def test_a_folder_that_is_there_is_left_alone(studied: Store, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    with pytest.raises(StoreError, match="out: exists already, expected a new folder"):
        studied.export(tmp_path / "out")
    (tmp_path / "file").touch()
    with pytest.raises(StoreError, match="cannot be written: "):
        studied.export(tmp_path / "file" / "out")


def test_one_study_of_several_must_be_named(store: Store, tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="study: the database has no study yet"):
        store.export(tmp_path / "out")
    joined(store, "a"), joined(store, "b")
    with pytest.raises(StoreError, match="study: found a, b; say which one"):
        store.export(tmp_path / "out")
    with pytest.raises(StoreError, match="pilot: unknown study, expected one of a, b"):
        store.export(tmp_path / "out", "pilot")
    assert store.export(tmp_path / "out", "b").study == "b"
    assert rows(tmp_path / "out" / "answers.csv") == []
    assert not (tmp_path / "out" / "trials.csv").exists()


def test_sound_is_on_the_clock_of_its_trial(store: Store, tmp_path: Path) -> None:
    someone = joined(store)
    half = np.arange(8_000, dtype="<i2").tobytes()
    trial = store.trial(someone.id, "trial", 0, header(0, 0))
    trial.keep_sound(1.0, half)
    trial.keep_sound(1.55, half)  # late by 50 ms: it follows at once
    again = store.trial(someone.id, "trial", 0, header(0, 0))
    again.keep_sound(3.0, half)
    again.write(PICKED)
    store.trial(someone.id, "trial", 1, header(0, 1)).write(PICKED)
    store.export(tmp_path / "out")
    (path,) = (tmp_path / "out" / "sound").rglob("*.wav")
    assert path.name == "0000-000.wav"
    with wave.open(str(path)) as sound:
        assert sound.getparams()[:4] == (1, 2, 16_000, 3 * 16_000 + 8_000)
        found = np.frombuffer(sound.readframes(sound.getnframes()), dtype="<i2")
    assert np.flatnonzero(np.diff(found, prepend=0) > 1).tolist() == []
    for start in (16_000, 24_000, 48_000):
        assert found[start : start + 8_000].tolist() == list(range(8_000))
    assert not found[:16_000].any()
    assert not found[32_000:48_000].any()


def test_no_more_sound_of_a_trial_is_kept_than_ten_minutes(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trials, "MOST_SOUND", 3)
    someone, second = joined(store), bytes(32_000)
    for start in (0.0, 1.0):
        store.trial(someone.id, "trial", 0, header(0, 0)).keep_sound(start, second)
    again = store.trial(someone.id, "trial", 0, header(0, 0))  # what was kept before counts
    for start in (2.0, 3.0, 4.0):
        again.keep_sound(start, second)
    assert store.forget(someone.code).rows["sounds"] == 3


def test_attention_checks_are_counted_and_no_typed_text_is_taken_for_one(tmp_path: Path) -> None:
    store = Store.open(f"sqlite:///{tmp_path / 'p.db'}")
    careful, hasty = joined(store), joined(store)
    for person, passed in ((careful, (True, True)), (hasty, (True, False))):
        for number, one in enumerate(passed):
            store.answer(person.id, f"check-{number}", {"chosen": "often", "passed": one})
        store.answer(person.id, "open", '{"chosen": "often", "passed": true}')
    store.export(tmp_path / "out")
    store.close()
    assert rows(tmp_path / "out" / "attention.csv") == [
        {"person": "0", "passed": "2", "of": "2"},
        {"person": "1", "passed": "1", "of": "2"},
    ]
    assert {"person": "1", "question": "check-1", "value": '{"chosen": "often", "passed": false}'} in rows(
        tmp_path / "out" / "answers.csv"
    )

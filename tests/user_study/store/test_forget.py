"""One person's data deleted, and no byte of it left."""

from __future__ import annotations

import shutil
import threading
import time
from pathlib import Path

import pytest

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study.store.store import Store
from fetch_pomdp.user_study.store.trials import StoredTrial
from tests.user_study.store.made import PICKED, WAITED, enrolled, header, joined

MARK = "zanzibar"


def filled(store: Store, mark: str) -> tuple[str, str]:
    """Somebody whose words, answers and sound hold a mark; return their code and secret."""
    someone, secret = enrolled(store)
    for order in range(8):
        trial = store.trial(someone.id, "trial", order, header(someone.person, order))
        for step in range(20):
            said = (Word(mark, float(step), step + 0.5),)
            trial.write(Observed(Observation((mark,)), said, float(step)))
        trial.keep_sound(0.0, mark.encode() * 2_000)
        trial.write(PICKED)
    store.answer(someone.id, "understood", f"it knew {mark} " * 100)
    return someone.code, secret


def test_all_rows_of_a_person_go_and_nobody_elses(store: Store) -> None:
    (gone, secret), (kept, _) = filled(store, MARK), filled(store, "other")
    assert store.forget(gone).rows == {"participants": 1, "trials": 8, "events": 168, "answers": 1, "sounds": 8}
    assert store.returning("pilot", secret) is None
    assert [one.code for one in store.progress()] == [kept]
    assert store.forget(kept).rows["events"] == 168
    with pytest.raises(StoreError, match="code: no participant has this code"):
        store.forget(gone)


def test_no_byte_is_left_in_the_files(tmp_path: Path) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    store = Store.open(f"sqlite:///{folder / 'p.db'}")
    code, _ = filled(store, MARK)
    filled(store, "other")

    def there(mark: str) -> bool:
        return any(mark.encode() in path.read_bytes() for path in folder.iterdir())

    assert there(MARK)
    store.forget(code)  # while the database stays open, as a server's does
    assert not there(MARK)
    assert not there(code)
    assert there("other")
    store.close()


def test_the_secret_is_never_in_the_files(tmp_path: Path) -> None:
    store = Store.open(f"sqlite:///{tmp_path / 'p.db'}")
    secret = enrolled(store)[1]
    assert not any(secret.encode() in path.read_bytes() for path in tmp_path.iterdir())
    store.close()


def test_an_open_journal_of_somebody_who_is_gone_writes_nothing(store: Store) -> None:
    someone = joined(store)
    trial = store.trial(someone.id, "trial", 0, header(0, 0))
    trial.write(WAITED)
    store.forget(someone.code)
    again = joined(store)
    assert again.person == someone.person
    assert again.id != someone.id, "what is left open leads nowhere"
    store.trial(again.id, "trial", 0, header(0, 0))
    with pytest.raises(StoreError, match="contradicts what is there"):
        trial.write(PICKED)
    with pytest.raises(StoreError, match="contradicts what is there"):
        trial.keep_sound(0.0, b"\0\0")
    assert store.trial(again.id, "trial", 0, header(0, 0)).events == ()


def test_deleting_and_writing_at_once_never_wait_for_each_other(store: Store) -> None:
    for _ in range(5):
        someone = joined(store)
        trial = store.trial(someone.id, "trial", 0, header(0, 0))
        ended: list[StoreError] = []

        def write(trial: StoredTrial = trial, ended: list[StoreError] = ended) -> None:
            while not ended:
                try:
                    trial.write(WAITED)
                except StoreError as error:
                    ended.append(error)

        writer = threading.Thread(target=write)
        writer.start()
        while len(trial.events) < 5 and not ended:
            time.sleep(0.001)
        assert store.forget(someone.code).rows["events"] >= 5
        writer.join()
        assert "contradicts what is there" in str(ended[0]), "the trial is gone; no deadlock had to be broken"
    assert store.progress() == ()


def test_a_copy_of_the_file_has_all_that_was_committed(tmp_path: Path) -> None:
    """What a backup of file and -wal has, taken while a server has them open."""
    store = Store.open(f"sqlite:///{tmp_path / 'p.db'}")
    someone, secret = enrolled(store)
    store.trial(someone.id, "trial", 0, header(0, 0)).write(WAITED)
    copied = tmp_path / "copy"
    copied.mkdir()
    for path in tmp_path.glob("p.db*"):
        shutil.copy(path, copied)
    store.close()
    backup = Store.open(f"sqlite:///{copied / 'p.db'}")
    found = backup.returning("pilot", secret)
    assert found is not None
    assert isinstance(backup.trial(found.id, "trial", 0, header(0, 0)).events[0].action, Wait)  # type: ignore[union-attr]
    backup.close()

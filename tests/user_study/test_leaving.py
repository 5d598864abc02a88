"""Who leaves a study, or is let down by its server: nothing is lost of who stays, nothing kept of who withdraws."""

from __future__ import annotations

import sqlite3
import time
from pathlib import Path
from typing import Any

import pytest
from starlette.websockets import WebSocketDisconnect

from fetch_pomdp.adapters.web.page_connection import TRY_LATER
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study import trial
from fetch_pomdp.user_study.store.store import Store
from fetch_pomdp.user_study.store.trials import StoredTrial
from tests.adapters.web.test_server import Page
from tests.user_study.test_app import begin, enrolled, fetched, progress, reply, stage, study_at


def failing(*_: object, **__: object) -> Any:
    raise StoreError("the disk is full")


def let_go(page: Page) -> int:
    """Wait until the server lets a page go; return the code that it gives."""
    while True:
        try:
            page.socket.receive_text()
        except WebSocketDisconnect as gone:
            return gone.code


def query(folder: Path, text: str) -> list[tuple[Any, ...]]:
    with sqlite3.connect(folder / "participants.db") as connection:
        return connection.execute(text).fetchall()


@pytest.mark.parametrize(("owner", "name"), [(StoredTrial, "write"), (Agent, "decide")])
def test_a_round_that_breaks_ends_and_is_gone_on_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, owner: type, name: str
) -> None:
    monkeypatch.setattr(trial, "GIVE_UP", 0.0)
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        reply(page, "instructions")
        fetched(page, begin(page, "practice"))
        desired = begin(page, "trials")["desired"]
        with monkeypatch.context() as patched:
            patched.setattr(owner, name, failing)
            page.send({"type": "typed", "text": "the marker"})
            assert page.next("error")["code"] == "broken"
            assert let_go(page) == TRY_LATER, "the page comes back by itself"
        assert query(tmp_path, "SELECT finished, given_up FROM trials WHERE part = 'trial'") == [(None, 0)]
        page = house.page(participant=told["resume"])
        again = stage(page, "trials")
        assert (again["desired"], again["running"], again["order"]) == (desired, True, 0)
        page.next("begin")
        assert fetched(page, again) == desired
        assert (progress(house)[0]["interruptions"], progress(house)[0]["given_up"]) == (1, 0)


def test_the_clock_runs_while_somebody_is_there_and_nothing_happens(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        reply(page, "instructions")
        fetched(page, begin(page, "practice"))
        begin(page, "trials")
        time.sleep(0.5)
        page.socket.close()
        page = house.page(participant=told["resume"])
        assert stage(page, "trials")["running"], "no new countdown, though nothing had happened"
        ((noted,),) = query(tmp_path, "SELECT clock FROM trials WHERE part = 'trial'")
        assert page.next("begin")["t"] >= round(noted, 3) >= 0.5
        assert progress(house)[0]["interruptions"] == 1


def test_who_leaves_before_the_clock_runs_gets_a_new_countdown(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        reply(page, "instructions")
        stage(page, "practice")
        page = house.page(participant=told["resume"])
        assert not stage(page, "practice")["running"]
    assert query(tmp_path, "SELECT interruptions, clock FROM trials") == [(0, None)]


def test_who_withdraws_and_closes_the_page_at_once_is_forgotten(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        page.send({"type": "withdraw"})
        page.socket.close()
        stage(house.page(participant=told["resume"]), "consent")
        assert progress(house) == []


def test_who_cannot_be_deleted_now_is_not_told_so_and_may_ask_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        with monkeypatch.context() as patched:
            patched.setattr(Store, "erase", failing)
            page.send({"type": "withdraw"})
            assert page.next("error")["code"] == "broken"
            assert let_go(page) == TRY_LATER
        page = house.page(participant=told["resume"])
        assert stage(page, "instructions")["code"] == told["code"]
        page.send({"type": "withdraw"})
        stage(page, "withdrawn")
        assert progress(house) == []


def test_bytes_that_may_be_left_are_the_researcher_s_concern(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(Store, "scrub", failing)
    with study_at(tmp_path) as house:
        page, _ = enrolled(house)
        page.send({"type": "withdraw"})
        stage(page, "withdrawn")
        assert progress(house) == []
    assert "bytes may be left" in caplog.text
    assert "the disk is full" in caplog.text


def test_who_was_deleted_meanwhile_begins_anew(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        store = Store.open(f"sqlite:///{tmp_path / 'participants.db'}")
        store.forget(told["code"])
        store.close()
        page.send({"type": "withdraw"})
        stage(page, "withdrawn")
        stage(house.page(participant=told["resume"]), "consent")


def test_who_agrees_right_before_the_server_dies_has_their_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    enrol = Store.enrol

    def last_commit(*given: Any, **more: Any) -> Any:
        enrol(*given, **more)
        raise StoreError("the server dies")

    with study_at(tmp_path) as house:
        page = house.page()
        secret = stage(page, "consent")["resume"]
        with monkeypatch.context() as patched:
            patched.setattr(Store, "enrol", last_commit)
            reply(page, "consent", taking_part=True)
            assert let_go(page) == TRY_LATER
    with study_at(tmp_path) as house:  # another server
        told = stage(house.page(participant=secret), "instructions")
        assert [row["code"] for row in progress(house)] == [told["code"]]
        assert told["resume"] == secret


def test_who_only_reads_the_consent_takes_no_place(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        first = stage(house.page(), "consent")["resume"]
        again = stage(house.page(participant=first), "consent")["resume"]
        assert again != first
        assert progress(house) == []

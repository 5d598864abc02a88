"""A study as its participants' pages and the researcher see it, over a WebSocket and HTTP."""

from __future__ import annotations

import csv
import io
import json
import random
import time
import wave
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from fetch_pomdp.adapters.web import robot
from fetch_pomdp.adapters.web.connection_manager import ServerConfig
from fetch_pomdp.adapters.web.ears import speech_if_installed
from fetch_pomdp.adapters.web.server import create_app
from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study import trial
from fetch_pomdp.user_study.app import StudyApp
from fetch_pomdp.user_study.config import load_user_study
from fetch_pomdp.user_study.store.store import Store
from tests.adapters.web.test_server import ENDLESS, FOR_EVER, HOME, House, Page, house_of, nonsense
from tests.user_study.small import STUDY, small_study

TOKEN = "a researcher's own secret"
HIDDEN = {"belief", "values", "errors", "explanation", "unknown", "planner", "paradigm", "heard", "observation"}


@contextmanager
def study_at(folder: Path, text: str = STUDY, **config: Any) -> Iterator[House]:
    """A server with a study; started again at the same folder it goes on."""
    store = Store.open(f"sqlite:///{folder / 'participants.db'}")
    speech = speech_if_installed()
    study = StudyApp(load_user_study(small_study(folder, text)), store, TOKEN, speech=speech)
    app = create_app(ServerConfig(**config), study, voice=speech.voice, routes=study.routes())
    with TestClient(app, base_url=HOME) as client:
        house = House(client)
        try:
            yield house
        finally:
            for page in house.pages:
                page.leave()
    store.close()


def stage(page: Page, name: str, **wanted: Any) -> dict[str, Any]:
    return page.next("stage", stage=name, **wanted)


def reply(page: Page, name: str, **values: Any) -> None:
    page.send({"type": "reply", "stage": name, "values": values})


def enrolled(house: House, **given: bool) -> tuple[Page, dict[str, Any]]:
    """Somebody who has agreed, before the instructions."""
    page = house.page()
    stage(page, "consent")
    reply(page, "consent", taking_part=True, language="de", **given)
    return page, stage(page, "instructions")


def begin(page: Page, part: str) -> dict[str, Any]:
    """Begin the next trial."""
    told = stage(page, part)
    page.next("welcome")
    page.send({"type": "ready"})
    page.next("begin")
    return told


def fetched(page: Page, told: dict[str, Any], tell: Callable[[dict[str, Any]], None] = lambda _: None) -> str:
    """Ask for what is desired, answer, and return what the robot brings."""
    asked: str | None = None
    page.send({"type": "typed", "text": "the marker"})
    while True:
        message: dict[str, Any] = json.loads(page.socket.receive_text())
        tell(message)
        if message["type"] == "say" and message["key"] == "asks":
            time.sleep(0.3)  # nobody answers while they are asked
            page.send({"type": "typed", "text": "yes" if asked == told["desired"] else "no"})
        elif message["type"] == "decided":
            asked = message.get("item")
        elif message["type"] == "ended":
            page.send({"type": "next"})
            return str(message["picked"])


def test_from_consent_to_completion_code(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        assert (told["practice"], told["of"]) == (1, 2)
        reply(page, "instructions")
        heard: list[dict[str, Any]] = []
        brought = [fetched(page, begin(page, "practice"), heard.append)]
        wanted = []
        for _ in range(2):
            told = begin(page, "trials")
            wanted.append(told["desired"])
            brought.append(fetched(page, told, heard.append))
        assert sorted(wanted) == ["marker-1", "marker-2"]
        assert brought[1:] == wanted
        assert not HIDDEN & {name for message in heard for name in message}
        reply(page, "questions", open="")
        first = stage(page, "questions")
        assert [question["id"] for question in first["questions"]] == ["open"]
        assert page.next("error")["message"] == "open: an answer is required"
        reply(page, "questions", open="Everything.")
        assert [question["id"] for question in stage(page, "questions", order=1)["questions"]] == ["kinds", "ease"]
        reply(page, "questions", kinds=["places", "names"], ease=6)
        done = stage(page, "done")
        assert done["completion"]
        person = house.page(participant=done["resume"])
        assert stage(person, "done")["completion"] == done["completion"]
    store = Store.open(f"sqlite:///{tmp_path / 'participants.db'}")
    who = store.returning("small", done["resume"])
    assert who is not None
    assert who.answers == {"open": "Everything.", "kinds": ["names", "places"], "ease": 6}
    assert (who.language, who.consent) == ("de", {"taking_part": True, "sound": False})


def test_who_does_not_agree_leaves_no_trace(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page = house.page()
        stage(page, "consent")
        reply(page, "consent", taking_part=False)
        stage(page, "declined")
        assert progress(house) == []


def progress(house: House) -> list[dict[str, Any]]:
    answer = house.client.get("/researcher/progress", headers={"authorization": f"Bearer {TOKEN}"})
    rows: list[dict[str, Any]] = answer.json()["progress"]
    return rows


def test_places_are_limited(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        people = [enrolled(house)[1] for _ in range(2)]
        assert len({told["code"] for told in people}) == 2
        page = house.page()
        stage(page, "consent")
        reply(page, "consent", taking_part=True)
        stage(page, "full")


def test_who_withdraws_in_the_middle_of_a_trial_is_forgotten(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        other = enrolled(house)[1]["code"]
        reply(page, "instructions")
        begin(page, "practice")
        page.send({"type": "typed", "text": "a green marker"})
        page.next("heard")
        page.send({"type": "withdraw"})
        assert stage(page, "withdrawn").keys() == {"type", "stage", "title"}
        assert [row["code"] for row in progress(house)] == [other]
        stage(house.page(participant=told["resume"]), "consent")
    assert b"a green marker" not in (tmp_path / "participants.db").read_bytes()


def test_a_trial_goes_on_where_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, "SPEAK", 0.0)  # however soon the answer comes, it comes after the question
    with study_at(tmp_path) as house:
        page, told = enrolled(house)
        reply(page, "instructions")
        desired = begin(page, "practice")["desired"]
        page.send({"type": "typed", "text": "the marker"})
        asked = page.next("decided", action="point")["item"]
        page.next("say", key="asks")
        for part in ("ARM", "GRASP"):  # however long it takes to leave, no more is asked, and nothing brought
            monkeypatch.setattr(robot, part, FOR_EVER)
        monkeypatch.setattr(trial.AnnouncingRobot, "pick", robot.PageRobot.pick)
        page.send({"type": "typed", "text": "no"})  # it ends the step in which it is heard
        page.next("heard")
    with study_at(tmp_path) as house:  # another server
        page = house.page(participant=told["resume"], scene="unambiguous")
        again = stage(page, "practice")
        assert (again["desired"], again["running"], again["code"]) == (desired, True, told["code"])
        welcome = page.next("welcome")
        assert (welcome["resumed"], welcome["asked"], len(welcome["scene"]["items"])) == (True, None, 2)
        assert page.next("begin")["t"] > 1  # no new countdown: the clock goes on
        other = ({"marker-1", "marker-2"} - {asked}).pop()
        assert page.next("decided")["item"] == other
        assert progress(house)[0]["interruptions"] == 0  # of practice none is counted


def test_what_is_said_before_the_countdown_s_end_reaches_nobody(tmp_path: Path) -> None:
    with study_at(tmp_path) as house:
        page, _ = enrolled(house)
        page.send({"type": "typed", "text": "too early"})
        reply(page, "instructions")
        stage(page, "practice")
        page.send({"type": "ray", "head": [0, 0, 1.6], "wrist": [0.0675, 0.576, 1.447]})
        page.send({"type": "next"})
        assert "expected Ready" in page.next("error")["message"]
        sent = time.monotonic()
        page.send({"type": "ready"})
        assert page.next("countdown")["seconds"] == pytest.approx(0.1)
        page.next("begin")
        page.send({"type": "typed", "text": "marker"})
        assert page.next("heard")["t"] < time.monotonic() - sent


def test_who_has_waited_long_may_give_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial, "GIVE_UP", FOR_EVER)
    with study_at(tmp_path) as house:
        page, _ = enrolled(house)
        reply(page, "instructions")
        fetched(page, begin(page, "practice"))
        sent = time.monotonic()
        begin(page, "trials")
        page.send({"type": "give_up"})
        assert "can be given up after 1e+06 s, not after " in page.next("error")["message"]
        time.sleep(1.0)
        monkeypatch.setattr(trial, "GIVE_UP", 1.0)
        page.send({"type": "give_up"})
        assert page.next("ended")["picked"] is None
        waited = time.monotonic() - sent
        page.send({"type": "next"})
        fetched(page, begin(page, "trials"))
        stage(page, "questions")
        assert progress(house)[0]["given_up"] == 1
        rows = exported(house, tmp_path / "export")
    assert (rows[0]["picked"], rows[0]["correct"]) == ("", "False")
    assert 1.0 <= float(rows[0]["time"]) < waited


def exported(house: House, folder: Path) -> list[dict[str, str]]:
    """Export as the researcher does; return the rows of trials."""
    answer = house.client.get("/researcher/export", headers={"authorization": f"Bearer {TOKEN}"})
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        archive.extractall(folder)
    with (folder / "small" / "trials.csv").open() as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("agreed", [True, False])
def test_sound_is_kept_of_who_agrees_and_of_nobody_else(tmp_path: Path, agreed: bool) -> None:
    with study_at(tmp_path) as house:
        page, _ = enrolled(house, sound=agreed)
        reply(page, "instructions")
        for part in ("practice", "trials"):
            told = begin(page, part)
            page.socket.send_bytes(bytes(3200))
            fetched(page, told)
        exported(house, tmp_path / "export")
    kept = list((tmp_path / "export" / "small").rglob("*.wav"))
    assert len(kept) == agreed
    if agreed:
        with wave.open(str(kept[0])) as sound:
            assert sound.getnframes() >= 1600


@pytest.mark.parametrize("path", ["/researcher/progress", "/researcher/export"])
@pytest.mark.parametrize("header", ["", "Bearer", "Bearer a guess", f"Basic {TOKEN}", "Bearer é"])
def test_a_researcher_s_door_needs_the_token(tmp_path: Path, path: str, header: str) -> None:
    with study_at(tmp_path) as house:
        _, told = enrolled(house)
        answer = house.client.get(path, headers=[(b"authorization", header.encode())])
        assert (answer.status_code, answer.headers["www-authenticate"]) == (401, "Bearer")
        assert told["code"] not in answer.text
        assert "frame-ancestors" in answer.headers["content-security-policy"]


def test_without_a_study_there_is_no_researcher_s_door() -> None:
    with house_of() as house:
        assert house.client.get("/researcher/progress").status_code == 404


def test_a_database_that_breaks_is_no_reason_to_tell_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise StoreError("cannot be used", source=str(tmp_path))

    with study_at(tmp_path) as house:
        page, _ = enrolled(house)
        monkeypatch.setattr(Store, "advance", broken)
        reply(page, "instructions")
        error = page.next("error")
        assert (error["code"], error["message"]) == ("broken", "something went wrong on the server")


def test_malformed_messages_end_nothing(tmp_path: Path) -> None:
    rng = random.Random(1)
    with study_at(tmp_path, limits=ENDLESS) as house:
        page, _ = enrolled(house)
        for number in range(2_000):
            page.send(garbled(rng, number))
        reply(page, "instructions")
        told = begin(page, "practice")
        for number in range(2_000):
            page.send(garbled(rng, number))
        page.socket.send_bytes(b"odd")
        assert fetched(page, told) == told["desired"]


def garbled(rng: random.Random, number: int) -> str:
    if number % 2:
        return nonsense(rng)
    bad: list[Any] = [
        {"type": "reply"},
        {"type": "reply", "stage": rng.choice(["consent", "done", ""]), "values": {}},
        {"type": "reply", "stage": 3, "values": {}},
        {"type": "reply", "stage": "consent", "values": []},
        {"type": "ready", "now": True},
        {"type": "hello", "version": 1},
        {"type": "withdraw", "sure": False},
        {"type": "give-up"},
        [],
    ]
    return json.dumps(rng.choice(bad))

"""A study as its participants' pages and the researcher see it, over a WebSocket and HTTP."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from fetch_pomdp.adapters.store.store import Store
from fetch_pomdp.adapters.web.hall import Config
from fetch_pomdp.adapters.web.participation import rounds
from fetch_pomdp.adapters.web.participation.registry import Venue
from fetch_pomdp.adapters.web.server import create_app
from fetch_pomdp.study.participation import load_participation
from tests.adapters.web.participation.small import STUDY, small_study
from tests.adapters.web.test_server import HOME, House, Page, nonsense

TOKEN = "a researcher's own secret"
HIDDEN = {"belief", "values", "errors", "explanation", "unknown", "planner", "paradigm", "heard", "observation"}


@contextmanager
def study_at(folder: Path, text: str = STUDY, **config: Any) -> Iterator[House]:
    """A server with a study; started again at the same folder it goes on."""
    store = Store.open(f"sqlite:///{folder / 'participants.db'}")
    venue = Venue(load_participation(small_study(folder, text)), store, TOKEN)
    with TestClient(create_app(Config(**config), venue), base_url=HOME) as client:
        house = House(client)
        yield house
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
    page.send({"type": "typed", "text": "the marker"})
    while True:
        message: dict[str, Any] = json.loads(page.socket.receive_text())
        tell(message)
        if message["type"] == "say" and message["key"] == "asks":
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
        assert page.next("error")["message"] == "open: found no answer, expected one"
        reply(page, "questions", open="Everything.")
        assert [question["id"] for question in stage(page, "questions", order=1)["questions"]] == ["kinds", "ease"]
        reply(page, "questions", kinds=["places", "names"], ease=6)
        done = stage(page, "done")
        assert done["completion"]
        person = house.page(participant=done["resume"])
        assert stage(person, "done")["completion"] == done["completion"]
    store = Store.open(f"sqlite:///{tmp_path / 'participants.db'}")
    who = store.returning(done["resume"])
    assert who is not None
    assert who.answers == {"open": "Everything.", "kinds": ["names", "places"], "ease": 6}
    assert (who.language, who.consent) == ("de", {"taking_part": True, "sound": False})

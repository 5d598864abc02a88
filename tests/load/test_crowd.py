"""Fifty people at once on one server, as a user starts it; ten of them speak."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from latency import TEXTS, VOICES
from sayings import say_all
from serving import Served, Spent
from visitors import Speaker, Visitor

pytestmark = pytest.mark.load
PEOPLE, SPEAKERS, SHARE = 50, 10, 0.2
KEPT = 12  # threads and files that a server may keep when all have left: a pool to wait in, the recogniser's process


def run(going_on: Coroutine[Any, Any, Any]) -> None:
    """Run to the end, in a thread, for Playwright's loop goes on in this one when the browser's tests came before."""
    with ThreadPoolExecutor(1) as pool:
        pool.submit(asyncio.run, going_on).result()


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("data")


@pytest.fixture(scope="module")
def served(data: Path) -> Iterator[Served]:
    with Served("--data", str(data)) as made:
        yield made


@pytest.fixture(scope="module")
def before(served: Served) -> Spent:
    """What the server has taken when it has heard and seen one person off."""
    run(Visitor(served.host, PEOPLE).interact())
    time.sleep(1.0)
    return served.spent()


@pytest.fixture(scope="module")
def people(served: Served, before: Spent, tmp_path_factory: pytest.TempPathFactory) -> list[Visitor]:  # noqa: ARG001
    """All who came at once, when everybody has got something."""
    folder = tmp_path_factory.mktemp("voices")
    sayings = [say_all(TEXTS, voice, 20, folder) for voice in VOICES]
    speakers: list[Visitor] = [
        Speaker(served.host, seed, sayings[seed % len(sayings)], SHARE) for seed in range(SPEAKERS)
    ]
    typists = [Visitor(served.host, seed) for seed in range(SPEAKERS, PEOPLE)]

    async def come() -> None:
        async with asyncio.TaskGroup() as group:
            for visitor in (*speakers, *typists):
                group.create_task(visitor.interact())

    run(come())
    return [*speakers, *typists]


def left_behind(served: Served, than: Spent) -> tuple[int, int]:
    """Wait until the server has let go of all who came, at most half a minute; return threads and files it has more."""
    for _ in range(60):
        spent = served.spent()
        more = spent.threads - than.threads, spent.files - than.files
        if max(more) <= KEPT:
            break
        time.sleep(0.5)
    return more


def test_everybody_gets_something(people: list[Visitor]) -> None:
    assert [visitor.name for visitor in people if visitor.interactions[0].picked is None] == []


def test_who_types_gets_what_they_want(people: list[Visitor]) -> None:
    got = [(visitor.interactions[0].picked, visitor.interactions[0].wanted) for visitor in people[SPEAKERS:]]
    assert [pair for pair in got if pair[0] != pair[1]] == []


def test_nobody_is_told_of_another(people: list[Visitor]) -> None:
    sessions = [visitor.interactions[0].messages("welcome")[0].message["session"] for visitor in people]
    assert len(set(sessions)) == PEOPLE
    for visitor in people:
        received = [each.message for each in visitor.interactions[0].received]
        heard = {word for message in received if message["type"] == "belief" for word in message["heard"]}
        names = {word for word in heard if word.startswith("visitor")}
        assert names == (set() if isinstance(visitor, Speaker) else {visitor.name})


def test_each_log_is_of_one_person(people: list[Visitor], data: Path) -> None:
    logs = [path.read_text(encoding="utf-8") for path in data.iterdir()]
    names = [visitor.name for visitor in people[SPEAKERS:]]
    written = [[name for name in names if f'{name}"' in log or f"{name} " in log] for log in logs]
    assert sorted(name for of_log in written for name in of_log) == sorted(names)
    assert max(map(len, written)) == 1
    assert all(json.loads(line) for log in logs for line in log.splitlines())


def test_nothing_is_left_behind(served: Served, before: Spent, people: list[Visitor]) -> None:  # noqa: ARG001
    assert max(left_behind(served, before)) <= KEPT
    assert served.alive

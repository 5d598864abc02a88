"""Who gets a seat, and whether a page that gets none may come back by itself."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Sequence

import pytest

from fetch_pomdp.adapters.web import connection_manager as module
from fetch_pomdp.adapters.web import conversations, page_connection
from fetch_pomdp.adapters.web.access import GUESSES
from fetch_pomdp.adapters.web.connection_manager import IDLE, IDLE_NEW, ConnectionManager, ServerConfig
from fetch_pomdp.adapters.web.conversations import ConversationOpener
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.page_connection import POLICY, TAKEN_OVER, TRY_LATER
from fetch_pomdp.adapters.web.page_messages import Hello, header_of
from fetch_pomdp.errors import EventError, FetchPomdpError, MessageError, StoreError
from fetch_pomdp.files.header import Header
from tests.adapters.web.fakes import FakeClock, FakeOpener, FakeSocket, serve


async def until_closed(manager: ConnectionManager, pages: Sequence[FakeSocket], count: int) -> None:
    """Let pages come at once, wait until so many are closed, and let all leave."""
    coming = [asyncio.create_task(serve(manager, page)) for page in pages]
    async with asyncio.timeout(60):
        while sum(page.code is not None for page in pages) < count:
            await asyncio.sleep(0.01)
    for page in pages:
        page.leave()
    await asyncio.gather(*coming)


def resumes(secrets: bool, number: int) -> dict[str, str]:
    return {"resume": f"secret {number}"} if secrets else {}


@pytest.mark.parametrize("secrets", [False, True])
def test_of_twenty_who_come_at_once_as_many_come_in_as_there_are_seats(secrets: bool) -> None:
    opener = FakeOpener()

    async def come() -> list[FakeSocket]:
        pages = [FakeSocket(**resumes(secrets, number)) for number in range(20)]
        await until_closed(ConnectionManager(ServerConfig(most_people=3), opener), pages, 17)
        return pages

    pages = asyncio.run(come())
    assert len(opener.sessions) == 3
    refused = [page for page in pages if page.code == TRY_LATER]
    assert len(refused) == 17
    assert all(page.told[-1]["message"] == "server full (3 of 3); try again later" for page in refused)


def test_who_comes_back_takes_their_own_seat() -> None:
    opener = FakeOpener()

    async def come() -> tuple[FakeSocket, FakeSocket]:
        manager = ConnectionManager(ServerConfig(most_people=1), opener)
        first, second = FakeSocket(resume="mine"), FakeSocket(resume="mine")
        await until_closed(manager, [first, second], 1)
        return first, second

    codes = {page.code for page in asyncio.run(come())}
    assert codes == {TAKEN_OVER, None}
    assert [session.name for session in opener.sessions] == ["mine", "mine"]


def test_a_seat_is_free_again_when_its_page_has_left_or_was_refused() -> None:
    refusals = iter([MessageError("found nonsense"), None, None])

    def meet(hello: Hello) -> None:  # noqa: ARG001
        if (error := next(refusals)) is not None:
            raise error

    async def come() -> list[int | None]:
        manager, codes = ConnectionManager(ServerConfig(most_people=1), FakeOpener(meet)), []
        for _ in range(3):
            page = FakeSocket()
            page.leave()
            await serve(manager, page)
            codes.append(page.code)
        return codes

    assert asyncio.run(come()) == [POLICY, None, None]


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (MessageError("found nonsense"), POLICY),
        (StoreError("found a database that is locked"), TRY_LATER),
        (EventError("found a disk that is full"), TRY_LATER),
    ],
)
def test_who_is_refused_for_no_fault_of_their_own_may_come_back(error: FetchPomdpError, code: int) -> None:
    def meet(hello: Hello) -> None:  # noqa: ARG001
        raise error

    async def come() -> int | None:
        page = FakeSocket()
        await serve(ConnectionManager(ServerConfig(), FakeOpener(meet)), page)
        return page.code

    assert asyncio.run(come()) == code


def test_nor_is_a_slow_page_turned_away_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "GREETING", 0.05)

    async def come() -> int | None:
        page = FakeSocket()
        await page.receive()  # its hello does not arrive
        await serve(ConnectionManager(ServerConfig(), FakeOpener()), page)
        return page.code

    assert asyncio.run(come()) == TRY_LATER


async def until(happened: Callable[[], object]) -> None:
    async with asyncio.timeout(60):
        while not happened():
            await asyncio.sleep(0.01)


def test_nobody_waits_for_sessions_that_do_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Such as those of pages that leave while their planner is prepared; no pool is shared with them."""
    monkeypatch.setattr(page_connection, "FAREWELL", 1e6)
    opener = FakeOpener(ends=lambda: False)

    async def come() -> None:
        manager = ConnectionManager(ServerConfig(), opener)
        pages = [FakeSocket() for _ in range(50)]
        coming = [asyncio.create_task(serve(manager, page)) for page in pages]
        await until(lambda: all(page.told for page in pages))
        for page in pages:
            page.leave()
        newcomer = FakeSocket()
        coming.append(asyncio.create_task(serve(manager, newcomer)))
        await until(lambda: newcomer.told)
        newcomer.leave()
        for session in opener.sessions:
            session.ended()
        await asyncio.gather(*coming)

    asyncio.run(come())


def test_nobody_waits_for_a_table_that_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    reading, go_on = threading.Event(), threading.Event()

    def read(hello: Hello) -> Header:
        if hello.choices:
            reading.set()
            assert go_on.wait(60)
        return header_of(hello)

    monkeypatch.setattr(conversations, "header_of", read)

    async def come() -> None:
        manager = ConnectionManager(ServerConfig(), ConversationOpener(None, insight=True, speech=Speech()))
        slow, other = FakeSocket(scene="unambiguous"), FakeSocket()
        coming = [asyncio.create_task(serve(manager, slow))]
        await until(reading.is_set)
        coming.append(asyncio.create_task(serve(manager, other)))
        await until(lambda: other.told)
        assert slow.told == []
        go_on.set()
        await until(lambda: slow.told)
        for page in (slow, other):
            page.leave()
        await asyncio.gather(*coming)

    asyncio.run(come())


def test_of_a_page_with_a_wrong_token_nothing_else_is_read() -> None:
    async def come() -> FakeSocket:
        page = FakeSocket(token="a guess", scene={"toml": "["}, planner="nobody")
        await serve(ConnectionManager(ServerConfig(token="a secret of many letters"), FakeOpener()), page)
        return page

    page = asyncio.run(come())
    assert page.told[-1]["message"] == "token: wrong token, expected the one that the server printed"
    assert page.code == POLICY


def test_two_hundred_guesses_at_once_are_no_more_than_a_few() -> None:
    async def come() -> list[FakeSocket]:
        manager = ConnectionManager(ServerConfig(token="a secret of many letters"), FakeOpener(), now=FakeClock())
        pages = [FakeSocket(token=f"guess {number}") for number in range(200)]
        await asyncio.gather(*(serve(manager, page) for page in pages))
        return pages

    codes = [page.code for page in asyncio.run(come())]
    assert (codes.count(POLICY), codes.count(TRY_LATER)) == (GUESSES[1], 200 - GUESSES[1])


@pytest.mark.parametrize(("spoken", "idle"), [(False, IDLE_NEW), (True, IDLE)])
def test_a_page_that_is_silent_loses_its_seat_to_a_newcomer(spoken: bool, idle: float) -> None:
    clock = FakeClock()

    async def come() -> list[int | None]:
        manager = ConnectionManager(ServerConfig(most_people=1), opener := FakeOpener(), now=clock)
        silent = FakeSocket()
        coming = [asyncio.create_task(serve(manager, silent))]
        await until(lambda: silent.told)
        if spoken:
            silent.send("something")
            await until(lambda: opener.sessions[0].taken)
            await asyncio.sleep(0)
        clock.time, early = idle, FakeSocket()
        await serve(manager, early)
        clock.time, late = idle + 1, FakeSocket()
        coming.append(asyncio.create_task(serve(manager, late)))
        await until(lambda: late.told)
        late.leave()
        await asyncio.gather(*coming)
        return [page.code for page in (early, silent, late)]

    assert asyncio.run(come()) == [TRY_LATER, TRY_LATER, None]


def test_who_never_said_anything_leaves_before_who_did() -> None:
    clock = FakeClock()

    async def come() -> list[int | None]:
        manager = ConnectionManager(ServerConfig(most_people=2), opener := FakeOpener(), now=clock)
        talker, silent = FakeSocket(), FakeSocket()
        coming = [asyncio.create_task(serve(manager, talker))]
        await until(lambda: talker.told)
        talker.send("something")
        await until(lambda: opener.sessions[0].taken)
        clock.time = IDLE
        coming.append(asyncio.create_task(serve(manager, silent)))
        await until(lambda: silent.told)
        clock.time, newcomer = 2 * IDLE, FakeSocket()
        coming.append(asyncio.create_task(serve(manager, newcomer)))
        await until(lambda: newcomer.told)
        codes = [page.code for page in (talker, silent)]
        for page in (talker, newcomer):
            page.leave()
        await asyncio.gather(*coming)
        return codes

    assert asyncio.run(come()) == [None, TRY_LATER]

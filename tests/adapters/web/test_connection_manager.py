"""Who gets a seat, and whether a page that gets none may come back by itself."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

import pytest

from fetch_pomdp.adapters.web import connection_manager as module
from fetch_pomdp.adapters.web.connection_manager import ConnectionManager, ServerConfig
from fetch_pomdp.adapters.web.page_connection import POLICY, TAKEN_OVER, TRY_LATER
from fetch_pomdp.adapters.web.page_messages import Hello
from fetch_pomdp.errors import EventError, FetchPomdpError, MessageError, StoreError
from tests.adapters.web.fakes import FakeOpener, FakeSocket, serve


async def until_closed(manager: ConnectionManager, pages: Sequence[FakeSocket], count: int) -> None:
    """Let pages come at once, wait until so many are closed, and let all leave."""
    coming = [asyncio.create_task(serve(manager, page)) for page in pages]
    async with asyncio.timeout(20):
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

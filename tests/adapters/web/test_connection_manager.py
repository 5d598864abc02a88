"""Who gets a seat, and whether a page that gets none may come back by itself."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

import pytest

from fetch_pomdp.adapters.web import hall
from fetch_pomdp.adapters.web.hall import Config, Hall
from fetch_pomdp.adapters.web.protocol import Hello
from fetch_pomdp.adapters.web.visit import POLICY, TAKEN_OVER, TRY_LATER
from fetch_pomdp.errors import EventError, FetchPomdpError, MessageError, StoreError
from tests.adapters.web.people import Desk, Socket


async def until_closed(house: Hall, pages: Sequence[Socket], count: int) -> None:
    """Let pages come at once, wait until so many are closed, and let all leave."""
    coming = [asyncio.create_task(house.receive(page)) for page in pages]
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
    desk = Desk()

    async def come() -> list[Socket]:
        pages = [Socket(**resumes(secrets, number)) for number in range(20)]
        await until_closed(Hall(Config(most_people=3), desk), pages, 17)
        return pages

    pages = asyncio.run(come())
    assert len(desk.guests) == 3
    refused = [page for page in pages if page.code == TRY_LATER]
    assert len(refused) == 17
    assert all("people" in page.told[-1]["message"] for page in refused)


def test_who_comes_back_takes_their_own_seat() -> None:
    desk = Desk()

    async def come() -> tuple[Socket, Socket]:
        house = Hall(Config(most_people=1), desk)
        first, second = Socket(resume="mine"), Socket(resume="mine")
        await until_closed(house, [first, second], 1)
        return first, second

    codes = {page.code for page in asyncio.run(come())}
    assert codes == {TAKEN_OVER, None}
    assert [guest.name for guest in desk.guests] == ["mine", "mine"]


def test_a_seat_is_free_again_when_its_page_has_left_or_was_refused() -> None:
    refusals = iter([MessageError("found nonsense"), None, None])

    def meet(hello: Hello) -> None:  # noqa: ARG001
        if (error := next(refusals)) is not None:
            raise error

    async def come() -> list[int | None]:
        house, codes = Hall(Config(most_people=1), Desk(meet)), []
        for _ in range(3):
            page = Socket()
            page.leave()
            await house.receive(page)
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
        page = Socket()
        await Hall(Config(), Desk(meet)).receive(page)
        return page.code

    assert asyncio.run(come()) == code


def test_nor_is_a_slow_page_turned_away_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hall, "GREETING", 0.05)

    async def come() -> int | None:
        page = Socket()
        await page.receive()  # its hello does not arrive
        await Hall(Config(), Desk()).receive(page)
        return page.code

    assert asyncio.run(come()) == TRY_LATER

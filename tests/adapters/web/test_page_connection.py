"""What a page may do to the others on its server: nothing."""

from __future__ import annotations

import asyncio
import threading

import pytest

from fetch_pomdp.adapters.web.page_connection import LEAST_SOUND, POLICY, TRY_LATER
from fetch_pomdp.adapters.web.page_messages import LARGEST_MESSAGE
from fetch_pomdp.errors import MessageError
from tests.adapters.web.fakes import FakeClock, FakeSession, FakeSocket, connected


def test_nobody_waits_for_what_another_page_sends() -> None:
    busy, go_on, waited = threading.Event(), threading.Event(), list[bool]()

    def slow(message: str | bytes) -> None:  # noqa: ARG001
        busy.set()
        waited.append(not go_on.wait(120))

    async def come() -> list[str | bytes]:
        socket, session = FakeSocket(), FakeSession("slow", slow)
        connection = connected(socket)
        going_on = asyncio.create_task(connection.run(session))
        for text in ("one", "two"):
            socket.send(text)
        await asyncio.to_thread(busy.wait, 120)
        go_on.set()  # by the loop itself, which is not the one that waits
        while len(session.taken) < 3:
            await asyncio.sleep(0.01)
        socket.leave()
        await going_on
        return session.taken[1:]

    assert asyncio.run(come()) == ["one", "two"]
    assert waited == [False] * 3


@pytest.mark.parametrize("piece", [b"", bytes(2)])
def test_sound_in_many_small_pieces_is_too_much(piece: bytes) -> None:
    async def come() -> tuple[FakeSocket, FakeSession]:
        socket, session = FakeSocket(), FakeSession("")
        connection = connected(socket, FakeClock(), sound=0)
        for _ in range(1000):
            socket.send(piece)
        await connection.run(session)
        return socket, session

    socket, session = asyncio.run(come())
    assert socket.code == POLICY
    assert len(session.taken) == 1 + LARGEST_MESSAGE // LEAST_SOUND  # the hello is one


def test_a_microphone_s_sound_is_not() -> None:
    second = 25 * [bytes(1280)]

    async def come() -> FakeSession:
        socket, session = FakeSocket(), FakeSession("")
        connection = connected(socket, sound=32_000)
        for piece in second:
            socket.send(piece)
        socket.leave()
        await connection.run(session)
        return session

    assert asyncio.run(come()).taken[1:] == second


def test_what_is_no_message_is_told_to_the_page() -> None:
    def refuse(message: str | bytes) -> None:
        raise MessageError(f"found {message!r}, expected another")

    async def come() -> FakeSocket:
        socket = FakeSocket()
        connection, session = connected(socket), FakeSession("", refuse)
        going_on = asyncio.create_task(connection.run(session))
        while not socket.told:
            await asyncio.sleep(0.01)
        socket.leave()
        await going_on
        return socket

    assert asyncio.run(come()).told[0]["type"] == "error"


@pytest.mark.parametrize("message", [None, "nonsense"])
def test_a_page_that_sends_nothing_valid_is_disconnected(message: str | None) -> None:
    def refuse(message: str | bytes) -> None:
        raise MessageError(f"found {message!r}, expected another")

    async def come() -> FakeSocket:
        socket = FakeSocket()
        if message is not None:
            socket.send(message)
        await connected(socket, first_message=0.05).run(FakeSession("", refuse))
        return socket

    assert asyncio.run(come()).code == TRY_LATER


def test_one_that_has_sent_something_is_not() -> None:
    async def come() -> int | None:
        socket, session = FakeSocket(), FakeSession("")
        connection = connected(socket, first_message=1e6)
        going_on = asyncio.create_task(connection.run(session))
        while not connection.has_spoken:
            await asyncio.sleep(0.01)
        connection._expect_first_message()
        code = socket.code
        socket.leave()
        await going_on
        return code

    assert asyncio.run(come()) is None

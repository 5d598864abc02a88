"""What uvicorn itself does not limit: requests that never end, and control frames without end."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
import uvicorn
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from uvicorn.server import ServerState
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from fetch_pomdp.adapters.web.transports import http_protocol, websocket_protocol

LONG = 1e6  # s
made: list[Any] = []  # connections that were accepted


async def hello(_: Any) -> PlainTextResponse:
    return PlainTextResponse("hello")


async def listen(socket: Any) -> None:
    await socket.accept()
    while (await socket.receive())["type"] == "websocket.receive":
        await socket.send_text("heard")


@asynccontextmanager
async def served(within: float = LONG, frames: tuple[float, float] = (0.0, 10.0)) -> AsyncIterator[int]:
    """A server with these limits; its port."""
    http, app = http_protocol(within), Starlette(routes=[Route("/", hello), WebSocketRoute("/session", listen)])
    config = uvicorn.Config(app, http=http, ws=websocket_protocol(frames), timeout_keep_alive=10**6, lifespan="off")
    config.load()
    state = ServerState()

    def accept() -> asyncio.Protocol:
        made.append(http(config=config, server_state=state, app_state={}))
        protocol: asyncio.Protocol = made[-1]
        return protocol

    server = await asyncio.get_running_loop().create_server(accept, "127.0.0.1", 0)
    try:
        yield server.sockets[0].getsockname()[1]
    finally:
        server.close()


async def answer(port: int, *parts: str) -> bytes:
    """All that the server says to a client that sends some text and waits until it is disconnected."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    for part in parts:
        writer.write(part.encode())
    said = b""
    try:
        while chunk := await reader.read(1000):
            said += chunk
    except ConnectionError:
        pass
    finally:
        writer.close()
    return said


@pytest.mark.parametrize(
    "request_",
    ["", "GET / HTTP/1.1\r\nHost: 127", "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9\r\n\r\nhalf"],
)
def test_a_request_that_does_not_end_is_given_up(request_: str) -> None:
    async def come() -> None:
        async with asyncio.timeout(60), served(within=0.05) as port:
            await answer(port, request_)

    asyncio.run(come())


def test_whole_requests_are_answered() -> None:
    whole = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"

    async def come() -> bytes:
        async with asyncio.timeout(60), served() as port:
            return await answer(port, f"{whole}\r\n", f"{whole}Connection: close\r\n\r\n")

    assert asyncio.run(come()).count(b"hello") == 2


def test_a_session_has_no_deadline() -> None:
    async def come() -> list[Any]:
        async with (
            asyncio.timeout(60),
            served() as port,
            connect(f"ws://127.0.0.1:{port}/session", proxy=None) as line,
        ):
            await line.send("something")
            assert await line.recv() == "heard"
            return [protocol.deadline for protocol in made]

    made.clear()
    assert asyncio.run(come()) == [None]


async def pings(line: ClientConnection) -> None:
    for _ in range(11):
        await line.ping()


async def pongs(line: ClientConnection) -> None:
    for _ in range(11):
        await line.pong()


async def pieces(line: ClientConnection) -> None:
    await line.send(["a"] * 12)


@pytest.mark.parametrize("flood", [pings, pongs, pieces])
def test_a_page_that_floods_the_line_is_disconnected(flood: Any) -> None:
    async def come() -> int | None:
        async with (
            asyncio.timeout(60),
            served() as port,
            connect(f"ws://127.0.0.1:{port}/session", proxy=None) as line,
        ):
            await line.ping()
            with contextlib.suppress(ConnectionClosed):
                await flood(line)
            await line.wait_closed()
            return line.close_code

    assert asyncio.run(come()) == 1008

"""The page's server: files, the robot's voice, and a WebSocket for each person."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.web.connection_manager import ConnectionManager, ServerConfig, SessionOpener
from fetch_pomdp.adapters.web.middleware import SecurityMiddleware
from fetch_pomdp.adapters.web.page_messages import LARGEST_MESSAGE
from fetch_pomdp.adapters.web.server_messages import SENTENCES
from fetch_pomdp.errors import InputError
from fetch_pomdp.extras import require

if TYPE_CHECKING:
    from starlette.applications import Starlette
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.routing import BaseRoute

EXTRA = "serve"
MOST_CONNECTIONS = 500  # at once, of HTTP and WebSockets; beyond them requests are answered with 503


def create_app(
    config: ServerConfig, opener: SessionOpener, *, voice: Voice | None = None, routes: Sequence[BaseRoute] = ()
) -> Starlette:
    """Return the application. opener: makes the session of each page; routes: further ones, before the page's files.

    Raises MissingExtraError without Starlette.
    """
    require("starlette", EXTRA)
    from starlette.applications import Starlette
    from starlette.middleware import Middleware
    from starlette.responses import JSONResponse, PlainTextResponse, Response
    from starlette.routing import Mount, Route, WebSocketRoute
    from starlette.staticfiles import StaticFiles

    connections = ConnectionManager(config, opener)

    async def speak(request: Request) -> Response:
        sentence = SENTENCES.get(request.path_params["key"])
        if voice is None or sentence is None:
            return PlainTextResponse("no such sentence", status_code=404)
        return Response(voice.wav(sentence), media_type="audio/wav")

    async def table(_: Request) -> Response:
        return JSONResponse({"scene": config.scene})

    pages = StaticFiles(directory=str(files("fetch_pomdp.adapters.web") / "page"), html=True)
    return Starlette(
        routes=[
            WebSocketRoute("/session", connections.serve),
            Route("/voice/{key}.wav", speak),
            Route("/table.json", table),
            *routes,
            Mount("/", pages),
        ],
        middleware=[Middleware(SecurityMiddleware, rules=connections.rules)],
    )


def serve(
    app: Starlette, host: str, port: int, *, ready: Callable[[], None], warm_up: Callable[[], None] = lambda: None
) -> None:
    """Serve until interrupted; `ready` is called when pages and an interrupt may come, `warm_up` in a thread meanwhile.

    Raises MissingExtraError without uvicorn, InputError for an address that cannot be listened at.
    """
    require("uvicorn", EXTRA)
    import uvicorn

    from fetch_pomdp.adapters.web.transports import http_protocol, websocket_protocol

    try:
        listening = socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise InputError(f"found {host}:{port} ({error.strerror}), expected a free address", field="--port") from None
    # Inherited by each connection: otherwise a message waits up to 40 ms for the receipt of the one before it.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    threading.Thread(target=warm_up, daemon=True).start()
    settings = uvicorn.Config(
        app,
        http=http_protocol(),
        ws=websocket_protocol(),
        log_level="warning",
        server_header=False,
        limit_concurrency=MOST_CONNECTIONS,
        ws_max_size=LARGEST_MESSAGE,
        ws_ping_interval=10.0,
        ws_ping_timeout=20.0,
        timeout_graceful_shutdown=3,
    )

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            """Announce the server when it has begun to listen for interrupts too."""
            await super().startup(sockets)
            ready()

    with listening:
        Server(settings).run(sockets=[listening])

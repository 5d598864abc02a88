"""The page's server: files, the robot's voice, and a WebSocket for each person."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable
from importlib.resources import files
from typing import Any

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.web.ears import Hearing, hearing_if_installed, voice_if_installed
from fetch_pomdp.adapters.web.gate import Gate
from fetch_pomdp.adapters.web.hall import Config, Hall, Reception
from fetch_pomdp.adapters.web.participation.registry import Venue
from fetch_pomdp.adapters.web.protocol import LARGEST_MESSAGE
from fetch_pomdp.adapters.web.talks import Talks
from fetch_pomdp.adapters.web.tell import SENTENCES
from fetch_pomdp.errors import InputError
from fetch_pomdp.extras import load

EXTRA = "serve"
# No script or style but our own files; only the server itself is talked to; no other site shows the page.
POLICY = (
    "default-src 'self'; img-src 'self' data:; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)
# A worker has the policy it was served with: the one that runs the pose model may compile WebAssembly, the page not.
POLICIES = {"/pose-worker.js": f"{POLICY}; script-src 'self' 'wasm-unsafe-eval'"}
HEADERS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "permissions-policy": "microphone=(self), camera=(self), geolocation=()",
    "cache-control": "no-cache",
}


def create_app(config: Config, venue: Venue | None = None) -> Any:
    """Return the FastAPI application; venue: of a study, None for who just wants to talk to the robot.

    Raises MissingExtraError without FastAPI.
    """
    fastapi = load("fastapi", EXTRA)
    routing, static = load("starlette.routing", EXTRA), load("starlette.staticfiles", EXTRA)
    responses = load("starlette.responses", EXTRA)
    voice, hearing = voice_if_installed(), hearing_if_installed()
    reception = _reception(config, venue, voice, hearing)
    hall = Hall(config, reception)

    async def speak(request: Any) -> Any:
        sentence = SENTENCES.get(request.path_params["key"])
        if voice is None or sentence is None:
            return responses.PlainTextResponse("no such sentence", status_code=404)
        return responses.Response(voice.wav(sentence), media_type="audio/wav")

    async def table(_: Any) -> Any:
        return responses.JSONResponse({"scene": config.scene})

    async def session(page: Any) -> None:
        await hall.receive(page)

    pages = static.StaticFiles(directory=str(files("fetch_pomdp.adapters.web") / "page"), html=True)
    routes = [
        routing.WebSocketRoute("/session", session),
        routing.Route("/voice/{key}.wav", speak),
        routing.Route("/table.json", table),
        *([] if venue is None else venue.routes()),
        routing.Mount("/", pages),
    ]
    app = fastapi.FastAPI(routes=routes, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.reception = reception
    app.add_middleware(Doorman, gate=hall.gate)
    return app


def _reception(config: Config, venue: Venue | None, voice: Voice | None, hearing: Hearing | None) -> Reception:
    if venue is None:
        return Talks(config.data, insight=config.insight, voice=voice, hearing=hearing)
    return venue.reception(voice, hearing)


class Doorman:
    """ASGI middleware: answers only requests under a name that is allowed, and adds the headers that guard a page."""

    def __init__(self, app: Any, gate: Gate) -> None:
        self._app, self._gate = app, gate

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Pass a request on."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        responses = load("starlette.responses", EXTRA)
        host = dict(scope["headers"]).get(b"host", b"").decode("latin-1")
        allowed = self._gate.host_allowed(host)
        app = self._app if allowed else responses.PlainTextResponse("unknown host", status_code=421)

        headers = {"content-security-policy": POLICIES.get(scope["path"], POLICY), **HEADERS}

        async def guarded(message: Any) -> None:
            if message["type"] == "http.response.start":
                extra = [(name.encode(), value.encode()) for name, value in headers.items()]
                message = {**message, "headers": [*message["headers"], *extra]}
            await send(message)

        await app(scope, receive, guarded)


def serve(config: Config, host: str, port: int, ready: Callable[[], None], *, venue: Venue | None = None) -> None:
    """Serve until interrupted; `ready` is called when pages may come. venue: see `create_app`.

    Raises MissingExtraError without uvicorn, InputError for an address that cannot be listened at.
    """
    uvicorn = load("uvicorn", EXTRA)
    app = create_app(config, venue)
    try:
        door = socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise InputError(f"found {host}:{port} ({error.strerror}), expected a free address", field="--port") from None
    # Inherited by each connection: otherwise a message waits up to 40 ms for the receipt of the one before it.
    door.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    threading.Thread(target=app.state.reception.get_ready, daemon=True).start()
    settings = uvicorn.Config(
        app,
        log_level="warning",
        server_header=False,
        ws_max_size=LARGEST_MESSAGE,
        ws_ping_interval=10.0,
        ws_ping_timeout=20.0,
        timeout_graceful_shutdown=3,
    )
    with door:
        ready()
        uvicorn.Server(settings).run(sockets=[door])

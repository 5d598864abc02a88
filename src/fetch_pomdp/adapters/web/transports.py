"""Limits below the application: requests that never end, and floods of WebSocket control frames.

uvicorn waits for ever for the rest of a request, and answers every ping.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from fetch_pomdp.adapters.web.access import RateLimit

if TYPE_CHECKING:
    from uvicorn.protocols.http.h11_impl import H11Protocol
    from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
    from websockets.frames import Frame

REQUEST = 10.0  # s from its connection, or from the answer before it, until a request must have come whole
FRAMES = (20.0, 100.0)  # pings, pongs and continued frames: a second in the long run, and at once
POLICY = 1008


def http_protocol(within: float = REQUEST) -> type[H11Protocol]:
    """Return uvicorn's HTTP protocol, closing connections whose request has not come whole `within` so many seconds."""
    import h11
    from uvicorn.protocols.http.h11_impl import H11Protocol

    class TimedH11Protocol(H11Protocol):
        deadline: asyncio.TimerHandle | None = None

        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            super().connection_made(transport)
            self._set_deadline()

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            self._set_deadline()

        def on_response_complete(self) -> None:
            super().on_response_complete()
            self._set_deadline()

        def handle_websocket_upgrade(self, event: h11.Request) -> None:
            self._clear_deadline()
            self.upgraded = True
            super().handle_websocket_upgrade(event)

        def connection_lost(self, exc: Exception | None) -> None:
            self._clear_deadline()
            super().connection_lost(exc)

        upgraded = False

        def _set_deadline(self) -> None:
            """Begin to wait for a request, go on waiting for the rest of one, or end when it is whole."""
            if self.upgraded or self.conn.their_state not in (h11.IDLE, h11.SEND_BODY):
                self._clear_deadline()
            elif self.deadline is None:
                self.deadline = self.loop.call_later(within, self.transport.abort)

        def _clear_deadline(self) -> None:
            if self.deadline is not None:
                self.deadline.cancel()
                self.deadline = None

    return TimedH11Protocol


def websocket_protocol(frames: tuple[float, float] = FRAMES) -> type[WebSocketsSansIOProtocol]:
    """Return uvicorn's WebSocket protocol, closing connections with too many control or continued frames."""
    from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

    class LimitedWebSocketProtocol(WebSocketsSansIOProtocol):
        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            self.allowed_frames = RateLimit(*frames, self.loop.time)
            super().connection_made(transport)

        def handle_ping(self) -> None:
            if self._allowed():
                super().handle_ping()

        def handle_pong(self, event: Frame) -> None:
            if self._allowed():
                super().handle_pong(event)

        def handle_cont(self, event: Frame) -> None:
            if self._allowed():
                super().handle_cont(event)

        def _allowed(self) -> bool:
            """Whether a frame may come now; if not, the connection is closed."""
            if self.close_sent:
                return False
            if self.allowed_frames.take():
                return True
            self.conn.fail(POLICY, "too many frames")
            self.transport.write(b"".join(self.conn.data_to_send()))
            self.close_sent = True
            self.transport.close()
            return False

    return LimitedWebSocketProtocol

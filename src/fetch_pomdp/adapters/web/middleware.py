"""Middleware: host names that are answered, and the headers that protect a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fetch_pomdp.adapters.web.access import AccessRules

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

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


class SecurityMiddleware:
    """Answers HTTP requests to allowed host names alone, and adds the security headers."""

    def __init__(self, app: ASGIApp, rules: AccessRules) -> None:
        self._app, self._rules = app, rules

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on."""
        from starlette.responses import PlainTextResponse

        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        host = dict(scope["headers"]).get(b"host", b"").decode("latin-1")
        app = self._app if self._rules.host_allowed(host) else PlainTextResponse("unknown host", status_code=421)
        headers = {"content-security-policy": POLICIES.get(scope["path"], POLICY), **HEADERS}

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                extra = [(name.encode(), value.encode()) for name, value in headers.items()]
                message = {**message, "headers": [*message["headers"], *extra]}
            await send(message)

        await app(scope, receive, send_with_headers)

"""Who may come in, and how much they may send."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from dataclasses import dataclass
from urllib.parse import urlsplit

LOOPBACK = frozenset({"127.0.0.1", "::1", "localhost"})


@dataclass(frozen=True, slots=True)
class Gate:
    """The door of a server. token: what a page must know, None on loopback.

    A server without a token answers only those who call it by a loopback name: a page of another site whose name was
    made to lead here (DNS rebinding) calls it by that site's.
    """

    token: str | None

    def host_allowed(self, host: str | None) -> bool:
        """Whether a request may call the server by this name (its Host header)."""
        return self.token is not None or _hostname(f"//{host or ''}") in LOOPBACK

    def origin_allowed(self, origin: str | None, host: str | None) -> bool:
        """Whether a page from `origin` may talk to this server: only its own pages may."""
        if not origin or not host:
            return False
        try:
            parts = urlsplit(origin)
        except ValueError:
            return False
        return parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()

    def token_allowed(self, token: str | None) -> bool:
        """Whether this is the token, or none is needed."""
        if self.token is None:
            return True
        return token is not None and secrets.compare_digest(token.encode("utf-8", "replace"), self.token.encode())


def _hostname(address: str) -> str | None:
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None


class Allowance:
    """How much of something may come: `rate` a second in the long run, `burst` at once."""

    def __init__(self, rate: float, burst: float, now: Callable[[], float] = time.monotonic) -> None:
        self._rate, self._burst, self._now = rate, burst, now
        self._left, self._at = burst, now()

    def take(self, amount: float = 1.0) -> bool:
        """Whether so much may come now; if so, it has."""
        now = self._now()
        self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        if amount > self._left:
            return False
        self._left -= amount
        return True

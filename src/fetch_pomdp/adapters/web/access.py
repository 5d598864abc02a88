"""Who may connect, and how much they may send."""

from __future__ import annotations

import secrets
import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from urllib.parse import urlsplit

from fetch_pomdp.errors import MessageError

LOOPBACK = frozenset({"127.0.0.1", "::1", "localhost"})
GUESSES = (1.0, 5.0)  # wrong tokens from one address: a second in the long run, and at once
ALL_GUESSES = (10.0, 50.0)  # from all addresses together
MOST_ADDRESSES = 1_000  # whose wrong tokens are remembered


@dataclass(frozen=True, slots=True)
class AccessRules:
    """Which requests are answered. open_to_network: whether the server has a token, and answers to any host name.

    A server without a token answers only to loopback names: a page of another site whose name was made to lead here
    (DNS rebinding) uses that site's name.
    """

    open_to_network: bool

    def host_allowed(self, host: str | None) -> bool:
        """Whether a request may call the server by this name (its Host header)."""
        return self.open_to_network or _hostname(f"//{host or ''}") in LOOPBACK

    def origin_allowed(self, origin: str | None, host: str | None) -> bool:
        """Whether a page from `origin` may talk to this server: only the server's own pages may."""
        if not origin or not host:
            return False
        try:
            parts = urlsplit(origin)
        except ValueError:
            return False
        return parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()


def _hostname(address: str) -> str | None:
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None


class RateLimit:
    """How much of something is allowed: `rate` a second in the long run, `burst` at once."""

    def __init__(self, rate: float, burst: float, now: Callable[[], float] = time.monotonic) -> None:
        self._rate, self._burst, self._now = rate, burst, now
        self._left, self._at = burst, now()

    def allows(self, amount: float = 1.0) -> bool:
        """Whether so much is allowed now; nothing is counted."""
        now = self._now()
        self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        return amount <= self._left

    def take(self, amount: float = 1.0) -> bool:
        """Whether so much is allowed now; if so, it is counted."""
        if not self.allows(amount):
            return False
        self._left -= amount
        return True


class TooManyGuessesError(MessageError):
    """Too many wrong tokens; no token is compared for now."""


class TokenCheck:
    """Lets those in who know the token; None: everybody.

    Choice: wrong tokens are limited for each address and, more widely, for all together; beyond the limit no token is
    compared, so that many guesses at once are no faster than one after the other. One address that guesses keeps no
    other out.
    """

    def __init__(self, token: str | None, now: Callable[[], float] = time.monotonic) -> None:
        self._token, self._now = token, now
        self._all = RateLimit(*ALL_GUESSES, now)
        self._addresses: OrderedDict[str, RateLimit] = OrderedDict()

    def check(self, token: str | None, address: str) -> None:
        """Raise MessageError for a wrong token, TooManyGuessesError while there were too many from this address."""
        if self._token is None:
            return
        guesses = self._guesses_of(address)
        if not (guesses.allows() and self._all.allows()):
            raise TooManyGuessesError("too many wrong tokens; try again later", field="token")
        if token is not None and secrets.compare_digest(token.encode("utf-8", "replace"), self._token.encode()):
            return
        guesses.take()
        self._all.take()
        raise MessageError("wrong token, expected the one that the server printed", field="token")

    def _guesses_of(self, address: str) -> RateLimit:
        guesses = self._addresses.setdefault(address, RateLimit(*GUESSES, self._now))
        self._addresses.move_to_end(address)
        if len(self._addresses) > MOST_ADDRESSES:
            self._addresses.popitem(last=False)
        return guesses

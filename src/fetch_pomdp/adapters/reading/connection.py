"""A connection to an endpoint over HTTP: a question as JSON, its answer, and a limit of time for both.

Choice: an event loop in a thread of its own, because only a task that is cancelled keeps a limit: the timeouts of an
HTTP library hold for each read, and a server that sends a byte now and then is never late.
"""

from __future__ import annotations

import asyncio
import json
import os
import threading
from collections.abc import Coroutine, Mapping
from typing import Any

from fetch_pomdp.errors import EndpointError, InputError
from fetch_pomdp.extras import load

KEY = "FETCH_POMDP_READER_KEY"  # the environment's variable that holds the key
MOST_BYTES = 1_000_000  # of an answer
UNAUTHORIZED = (401, 403)
HEADERS = {"Content-Type": "application/json", "Accept-Encoding": "identity"}


class Connection:
    """Asks one endpoint. Safe to use from any thread.

    Choice: a key has a variable of its own, not that of any service, so that none is sent where it is not meant for.
    Neither the key nor what the server says of it is part of any message; redirections are not followed.
    """

    def __init__(self, url: str, limit: float) -> None:
        """url: up to before /chat/completions. limit: s. Raises MissingExtraError, InputError for what is no URL."""
        self._http = load("httpx2", "endpoint")
        self.url, self.limit = url.rstrip("/") + "/chat/completions", limit
        try:
            right = bool(self._http.URL(self.url).host)
        except self._http.InvalidURL:
            right = False
        if not right:
            raise InputError("found no host, expected http://HOST[:PORT]/v1 or https://HOST/v1", field="reader")
        self._client = self._http.AsyncClient(headers=_headers(os.environ.get(KEY, "")), timeout=None)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="endpoint", daemon=True)
        self._thread.start()

    def ask(self, question: Mapping[str, Any]) -> Any:
        """Return the answer to a question. Raises EndpointError for none in time, or one that is no JSON."""
        return self._run(self._asked(question))

    def close(self) -> None:
        """Close what is open; then nothing can be asked any more."""
        if self._thread.is_alive():
            self._run(self._client.aclose())
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._thread.join()
            self._loop.close()

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        if not self._thread.is_alive():  # after close, and in a process that was forked
            work.close()
            raise EndpointError("is not connected any more")
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    async def _asked(self, question: Mapping[str, Any]) -> Any:
        try:
            async with asyncio.timeout(self.limit):
                return _json(await self._posted(question))
        except TimeoutError:
            raise EndpointError(f"did not answer within {self.limit:g} s") from None
        except (self._http.HTTPError, self._http.InvalidURL, OSError) as error:
            raise EndpointError(f"could not be asked ({type(error).__name__})") from None

    async def _posted(self, question: Mapping[str, Any]) -> bytes:
        body, content = b"", json.dumps(question).encode()
        async with self._client.stream("POST", self.url, content=content) as response:
            if response.status_code in UNAUTHORIZED:
                raise EndpointError(f"refused (status {response.status_code}): expected a key of it in {KEY}")
            if response.status_code != self._http.codes.OK:
                raise EndpointError(f"answered with status {response.status_code}, expected 200")
            async for part in response.aiter_bytes():
                body += part
                if len(body) > MOST_BYTES:
                    raise EndpointError(f"answered with more than {MOST_BYTES:,} bytes")
        return body


def _json(body: bytes) -> Any:
    try:
        return json.loads(body)
    except (ValueError, RecursionError):
        raise EndpointError("answered with what is no JSON") from None


def _headers(key: str) -> dict[str, str]:
    key = key.strip()
    if not (key.isascii() and key.isprintable()):
        raise InputError("found letters that no key has, expected ASCII", field=KEY)
    return dict(HEADERS) | ({"Authorization": f"Bearer {key}"} if key else {})

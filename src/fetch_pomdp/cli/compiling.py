"""What happens while Numba compiles: a word to the user if it takes long, and an end at once on Ctrl-C."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

from numba.core import event

from fetch_pomdp.cli.interrupts import ending_at_once

TOLD_AFTER = 1.5  # s of compiling before a user is told why nothing happens
MESSAGE = "Compiling the planner: up to half a minute, after an installation only once if its cache can be written ..."


class Watch(event.Listener):
    """Hears from Numba when something is compiled; what a cache holds is not."""

    def __init__(self) -> None:
        self._depth = 0  # a function is compiled while its caller is
        self._left = TOLD_AFTER  # s
        self._begun = 0.0
        self._told = False
        self._meanwhile = ExitStack()

    def on_start(self, event: Any) -> None:  # noqa: ARG002 (Numba's name)
        """Begin to wait, with what is left of the patience."""
        self._depth += 1
        if self._depth > 1:
            return
        self._begun = time.monotonic()
        self._meanwhile.enter_context(ending_at_once())
        if not self._told:
            timer = threading.Timer(self._left, self._tell)
            timer.daemon = True
            timer.start()
            self._meanwhile.callback(timer.cancel)

    def on_end(self, event: Any) -> None:  # noqa: ARG002
        """Wait no longer."""
        self._depth -= 1
        if self._depth == 0:
            self._meanwhile.close()
            self._left = max(0.0, self._left - (time.monotonic() - self._begun))

    def _tell(self) -> None:
        self._told = True
        print(MESSAGE, file=sys.stderr, flush=True)


@contextmanager
def watched() -> Iterator[None]:
    """Say on standard error, once, if Numba compiles for long meanwhile."""
    with event.install_listener("numba:compile", Watch()):
        yield

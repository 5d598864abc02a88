"""Ctrl-C while there is nothing to tidy up."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Iterator

INTERRUPTED = 128 + signal.SIGINT  # the exit code by which a shell counts who is ended by a signal


@contextlib.contextmanager
def ending_at_once() -> Iterator[None]:
    """Let Ctrl-C end the process at once, in silence.

    Imports and Numba's compiler call Python from C: a KeyboardInterrupt raised there is lost, or becomes another error.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, lambda *_: os._exit(INTERRUPTED))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)

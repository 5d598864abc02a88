"""Optional libraries, loaded when they are needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from fetch_pomdp.errors import MissingExtraError


def require(module: str, extra: str) -> None:
    """Raise MissingExtraError, with the line that installs it, if an optional library is not installed.

    For libraries with types: after it an ordinary import keeps them, which `load` cannot.
    """
    load(module, extra)


def load(module: str, extra: str) -> Any:
    """Import an optional library. Raises MissingExtraError with the line that installs it."""
    try:
        return import_module(module)
    except ImportError:
        line = f'{module} is not installed; install it with: pip install "fetch-pomdp[{extra}]"'
        raise MissingExtraError(line) from None

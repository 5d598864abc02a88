"""Optional libraries, loaded when they are needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from fetch_pomdp.errors import MissingExtraError


def load(module: str, extra: str) -> Any:
    """Import an optional library. Raises MissingExtraError with the line that installs it."""
    try:
        return import_module(module)
    except ImportError:
        line = f'{module} is not installed; install it with: pip install "fetch-pomdp[{extra}]"'
        raise MissingExtraError(line) from None

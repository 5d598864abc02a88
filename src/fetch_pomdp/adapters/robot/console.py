"""A robot that says what it does, for a terminal and for the log."""

from __future__ import annotations

import logging
from collections.abc import Callable

from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Item

_log = logging.getLogger(__name__)


class ConsoleRobot:
    """A Robot without a body: every action is a line handed to `show`, and is done at once."""

    def __init__(self, show: Callable[[str], None] = print) -> None:
        self._show = show

    def point(self, item: Item) -> Outcome:
        """Point at an item and ask."""
        return self._do(f"(points at {item.id}) This one?")

    def pick(self, item: Item) -> Outcome:
        """Hand an item over."""
        return self._do(f"(hands over {item.id}) Here you are.")

    def take_back(self, item: Item) -> Outcome:
        """Take an item back."""
        return self._do(f"(puts {item.id} back)")

    def say(self, text: str) -> Outcome:
        """Say something."""
        return self._do(text)

    def stop(self) -> None:
        """Stop: nothing here takes time, so there is nothing to interrupt."""
        _log.info("robot: stop")

    def _do(self, line: str) -> Outcome:
        _log.info("robot: %s", line)
        self._show(line)
        return Outcome.DONE

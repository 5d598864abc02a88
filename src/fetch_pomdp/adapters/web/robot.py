"""The robot of the page: its body moves there, and the server waits as long as a body would take."""

from __future__ import annotations

import threading
from collections.abc import Callable

from fetch_pomdp.adapters.web.server_messages import ASKS, HANDS_OVER
from fetch_pomdp.core.interaction import ASKING_AGAIN
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Item

ARM = 1.0  # s, from rest to pointing at an item
SPEAK = 0.8  # s, "this one?"
SPEAK_AGAIN = 3.4  # s, the longer question
GRASP = 1.2  # s, from rest to holding an item
CARRY = 1.6  # s, from there to the person


class PageRobot:
    """A LiveRobot. say: sends a sentence to the page, which draws the movements from the decisions."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say
        self._asks_again = False  # whether the next question is asked in other words
        self._stopped = threading.Event()

    def point(self, item: Item) -> Outcome:  # noqa: ARG002
        """Point at an item, then ask; in other words if `say` was given them."""
        self._stopped.clear()
        again, self._asks_again = self._asks_again, False
        return self._then(ARM, ASKING_AGAIN, SPEAK_AGAIN) if again else self._then(ARM, ASKS, SPEAK)

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Take an item to the person, and say so when it is theirs."""
        self._stopped.clear()
        return self._then(GRASP + CARRY, HANDS_OVER, 0.0)

    def take_back(self, item: Item) -> Outcome:  # noqa: ARG002
        """Take an item back from the person to its place."""
        self._stopped.clear()
        return Outcome.STOPPED if self._stopped.wait(CARRY + GRASP) else Outcome.DONE

    def say(self, text: str) -> Outcome:
        """Say something; the robot listens meanwhile. A question is said when the arm shows what it is about."""
        if text == ASKING_AGAIN:
            self._asks_again = True
        else:
            self._say(text)
        return Outcome.DONE

    def stop(self) -> None:
        """Stop what is going on."""
        self._stopped.set()

    def _then(self, before: float, sentence: str, after: float) -> Outcome:
        if self._stopped.wait(before):
            return Outcome.STOPPED
        self._say(sentence)
        return Outcome.STOPPED if self._stopped.wait(after) else Outcome.DONE

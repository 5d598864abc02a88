"""How long the robot takes."""

from __future__ import annotations

from dataclasses import dataclass

from fetch_pomdp.core.interaction import Timing


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """Seconds of the robot's doings.

    A question is the arm's way to the item, the words "this one?", and listening; the arm goes back while the robot
    listens.
    """

    think: float = 0.1  # s, a decision
    wait: float = 1.0  # s, listening in a wait, and after a question
    arm: float = 1.0  # s, from rest to pointing at an item
    speak: float = 0.8  # s, "this one?"

    def timing(self) -> Timing:
        """Return the timing of the steps of an interaction."""
        wait = self.think + self.wait
        return Timing(wait=wait, question=self.think + self.arm + self.speak + wait)

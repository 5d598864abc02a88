"""How long the robot takes."""

from __future__ import annotations

from dataclasses import dataclass

from fetch_pomdp.core.interaction import Timing


@dataclass(frozen=True, slots=True, kw_only=True)
class Durations:
    """Seconds of the robot's doings.

    A question is the arm's way to the item, the words "this one?", and listening; the arm goes back while the robot
    listens. `overhead` is time that a trial is measured by and no step takes, in which nothing happens: Section IV-B
    has a trial begin with a countdown, and end when the robot has told which item it will pick.
    """

    think: float = 0.1  # s, a decision
    wait: float = 1.0  # s, listening in a wait
    listen: float = 1.0  # s, listening after a question
    arm: float = 1.0  # s, from rest to pointing at an item
    speak: float = 0.8  # s, "this one?"
    overhead: float = 0.0  # s, added to the time of every trial

    def timing(self) -> Timing:
        """Return the timing of the steps of an interaction."""
        listen = self.think + self.listen
        question = self.think + self.arm + self.speak + listen
        return Timing(wait=self.think + self.wait, question=question, listen=listen)

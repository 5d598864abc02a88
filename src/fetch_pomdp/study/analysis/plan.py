"""What an analysis asks, fixed before it looks at the numbers."""

from __future__ import annotations

from dataclasses import dataclass

from fetch_pomdp.checks import number, text, within
from fetch_pomdp.errors import StudyError


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """Who is compared with whom, by which margins, at which level.

    Choice: the paper names no margin for "as accurate" and "at least as fast"; ours are 2 points and 0.5 s, set
    before any trial was run.
    """

    system: str = "fetch"  # the paradigm that the hypotheses are about
    never: str = "never"  # the baseline that never asks
    always: str = "always"  # the baseline that always asks
    unambiguous: str = "unambiguous"  # layout of H1
    ambiguous: str = "ambiguous"  # layout of H2
    margin_accuracy: float = 0.02  # share of trials by which "as accurate" may be worse
    margin_time: float = 0.5  # s by which "at least as fast" may be slower
    level: float = 0.05  # of two-sided tests; one-sided ones and the ends of intervals have half of it
    power: float = 0.8  # chance with which a planned study is to show what there is
    most_people: int = 256  # the largest study that is tried
    draws: int = 1000  # simulated studies of one size
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("system", "never", "always", "unambiguous", "ambiguous"):
            text(getattr(self, name), name, "a name", StudyError)
        within(self.margin_accuracy, 0.0, 1.0, "margin_accuracy", "a share from 0 to 1", StudyError)
        within(self.margin_time, 0.0, 1e6, "margin_time", "seconds, 0 or more", StudyError)
        within(self.level, 1e-6, 0.5, "level", "a level from 0.000001 to 0.5", StudyError)
        within(self.power, 0.01, 0.999, "power", "a chance from 0.01 to 0.999", StudyError)
        for name, least in (("most_people", 6), ("draws", 50), ("seed", 0)):
            found = getattr(self, name)
            if number(found, name, "a whole number", StudyError) != int(found) or found < least:
                raise StudyError(f"found {found}, expected a whole number from {least}", field=name)

    def margin(self, measure: str) -> float:
        """Return how much worse `measure` ("time" in s, "accuracy" as a share) may be and still count as no worse."""
        return self.margin_time if measure == "time" else self.margin_accuracy

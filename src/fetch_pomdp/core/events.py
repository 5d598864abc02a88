"""What happens in an interaction, as data: shown by a screen, kept in a log, read back for a replay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from fetch_pomdp.core.action import Action, Pick, Point
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.ports import Outcome, Word

Likelihoods: TypeAlias = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class Observed:
    """The robot took in an observation of a step that ended at `time` (s); words: as they were heard.

    spoken: the words that the person really said, where somebody wrote them down; no belief reads them. early: whether
    it was heard while the next action, which had been decided, went on. anew: whether it begins another request, after
    a hand-over. read: where a reader reads, log p(words | item) of each reading of the observation, (readings,
    n_items), so that a replay needs no reader; it is known when the agent has taken the event.
    """

    observation: Observation
    words: tuple[Word, ...] = ()
    time: float | None = None
    spoken: tuple[str, ...] | None = None
    early: bool = False
    anew: bool = False
    read: Likelihoods = ()


@dataclass(frozen=True, slots=True)
class Acted:
    """The robot's action ended at `time` (s); decision: why it was chosen, where that is known.

    passes: of sampling, if the decision had a budget (`Agent.decide` repeats it from them); None without one. reason:
    why it failed, where the robot knows; else "".
    """

    action: Action
    outcome: Outcome = Outcome.DONE
    decision: Decision | None = None
    time: float | None = None
    passes: int | None = None
    reason: str = ""

    @property
    def done(self) -> bool:
        """Whether the action was carried out."""
        return self.outcome is Outcome.DONE

    @property
    def objected(self) -> bool:
        """Whether this is a pick that was stopped or given back: the person saw what it is, and did not want it."""
        return isinstance(self.action, Pick) and self.outcome in (Outcome.STOPPED, Outcome.RETURNED)

    @property
    def counts_as(self) -> Action | None:
        """The action of the model that it came to: a question if it was objected to, None if it was not done."""
        if isinstance(self.action, Pick) and self.objected:
            return Point(self.action.item)
        return self.action if self.done else None


Event: TypeAlias = Observed | Acted

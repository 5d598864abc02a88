"""Recorded interactions as steps of the model: what was done, what had been asked, and what was then perceived."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fetch_pomdp.core.action import Action, Pick, Wait
from fetch_pomdp.core.events import Event, Observed
from fetch_pomdp.core.generative import asked_after
from fetch_pomdp.core.language.unigram import split
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.header import Header


@dataclass(frozen=True, slots=True)
class Interaction:
    """An interaction whose desired item is known; `person` names who it was with."""

    scene: Scene
    desired: int  # i_d
    person: str
    events: tuple[Event, ...]


@dataclass(frozen=True, slots=True)
class Step:
    """An action and the observation after it, of the model's process (Section III-B)."""

    action: Action
    asked: int | None  # i_r
    observation: Observation


def interaction_of(header: Header, events: Iterable[Event], source: str = "") -> Interaction:
    """Return a recorded interaction. Raises StudyError, with the file, where the desired item is not recorded.

    Logs without `person` are held to be of one and the same, who has no name.
    """
    if header.target is None:
        raise StudyError(
            "found none, expected the id of the item that was desired", field="target", source=source, line=1
        )
    person = "" if header.person is None else str(header.person)
    return Interaction(header.scene, header.scene.index(header.target), person, tuple(events))


def steps_of(events: Iterable[Event], problem: Problem) -> Iterator[Step]:
    """Yield the steps of an interaction about a problem's scene.

    Choice: observations that follow one another without an action between are of one step: an answer that came before
    the question had been asked belongs to the step before. An action that was not done is a wait, but for a pick that
    was stopped, which is a question. A second request is another interaction, whose desired item nobody wrote down; so
    is what follows "never mind", after which the robot begins anew, and the step in which that is said tells nothing.
    """
    asked: int | None = None
    open_step: Step | None = None
    for event in events:
        if isinstance(event, Observed) and (event.anew or _cancels(event, problem)):
            return
        if isinstance(event, Observed):
            open_step = _with(open_step or Step(Wait(), asked, Observation()), event.observation)
            continue
        if open_step is not None:
            yield open_step
        action = event.counts_as or Wait()
        asked = asked_after(action, asked)
        open_step = None if isinstance(action, Pick) else Step(action, asked, Observation())
    if open_step is not None:
        yield open_step


def _cancels(event: Observed, problem: Problem) -> bool:
    return split(event.observation.words, problem).meaning is Meaning.CANCEL


def _with(step: Step, observation: Observation) -> Step:
    seen = step.observation
    both = Observation(seen.words + observation.words, observation.ray or seen.ray)
    return dataclasses.replace(step, observation=both)

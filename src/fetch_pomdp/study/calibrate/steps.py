"""Recorded interactions as steps of the model: what was done, what had been asked, and what was then perceived."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fetch_pomdp.core.action import Action, Pick, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Event, Observed
from fetch_pomdp.core.generative import asked_after
from fetch_pomdp.core.language.reading.catalogue import WORDS
from fetch_pomdp.core.language.reading.tokens import STOP
from fetch_pomdp.core.language.unigram import split
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import BeliefError, StudyError
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

    Logs without `person` are held to be of one and the same, who has no name. Where another reader was left the words
    as they were heard, they are read as the paper does (`in_words`).
    """
    if header.target is None:
        raise StudyError(
            "found none, expected the id of the item that was desired", field="target", source=source, line=1
        )
    person = "" if header.person is None else str(header.person)
    read = events if header.reader == WORDS else in_words(events, header.scene)
    return Interaction(header.scene, header.scene.index(header.target), person, tuple(read))


def in_words(events: Iterable[Event], scene: Scene) -> Iterator[Event]:
    """Yield events with the words of observations as the paper's reader knows them, answers among them (`lexicon`).

    Choice: of what somebody says of an item only the words of the scene count: "the leftmost one" is silence to a model
    of words, and the chance of words comes out that much lower.
    """
    agent = Agent(scene)
    for event in events:
        plain = _plain(event, agent) if isinstance(event, Observed) else event
        with contextlib.suppress(BeliefError):  # by the model it was impossible, and the robot went on without it
            agent.take(plain)
        yield plain


def _plain(event: Observed, agent: Agent) -> Observed:
    spoken = tuple(word for word in event.observation.words if word != STOP)
    words = agent.answers.read(spoken, agent.after).words
    return dataclasses.replace(event, observation=Observation(words, event.observation.ray), read=())


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

"""One simulated interaction: a person of a population before a robot."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Event
from fetch_pomdp.core.interaction import interact
from fetch_pomdp.core.language.answers import PAPER
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.clock import Durations
from fetch_pomdp.study.people.channel import Channel
from fetch_pomdp.study.people.person import Person
from fetch_pomdp.study.people.traits import Traits


@dataclass(frozen=True, slots=True)
class Encounter:
    """What happened, and when the person began the request (s on the clock of the events)."""

    events: tuple[Event, ...]
    begun: float


def encounter(
    agent: Agent, desired: int, traits: Traits, clock: Durations, rng: Generator, *, channel: Channel | None = None
) -> Encounter:
    """Let a fresh agent meet a person who wants the item at index `desired`.

    The layout enters by the places of the scene alone: utterances are missed by the person's distance from the items,
    and how well an arm tells them apart follows from where they are. channel: what is heard of what is said, by rates
    (MistakenWords) unless given. Answers are read by the paper's lists, which are all that these people answer with.
    The same agent, seed and traits give the same events. Raises StudyError for a desired item that the scene does not
    have.
    """
    n_items = agent.problem.n_items
    if not 0 <= desired < n_items:
        raise StudyError(f"found {desired!r}, expected an index below {n_items}", field="desired")
    person = Person(agent.scene, desired, traits, clock, rng, channel)
    events = tuple(interact(agent, person, person, person, timing=clock.timing(), answers=PAPER))
    return Encounter(events, person.begun)

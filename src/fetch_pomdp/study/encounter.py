"""One simulated interaction, as events: a person of a population, or of the model itself, before a robot."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.interaction import interact
from fetch_pomdp.core.language.answers import PAPER
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.durations import Durations
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


def modelled(agent: Agent, person: Problem, desired: int, rng: Generator) -> tuple[Event, ...]:
    """Let a fresh agent meet a person drawn from `person`, whose parameters the agent need not share.

    It ends with a pick, or after as many steps as a simulated episode has.
    """
    state, events = State(desired), list[Event]()
    for _ in range(MOST_STEPS):
        decision = agent.decide()
        acted = Acted(decision.action, passes=decision.passes)
        agent.take(acted)
        events.append(acted)
        if isinstance(decision.action, Pick):
            break
        state, observation, _ = step(person, state, decision.action, rng)
        if observation is not None:
            observed = Observed(observation)
            agent.take(observed)
            events.append(observed)
    return tuple(events)

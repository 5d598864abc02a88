"""Interactions with the person that the model itself describes, as events."""

from __future__ import annotations

from numpy.random import Generator

from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import MOST_STEPS


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

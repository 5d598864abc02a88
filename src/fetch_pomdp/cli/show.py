"""How beliefs, events and decisions look on a terminal, and as JSON."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape

from fetch_pomdp.core import language
from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.words import COURTESY
from fetch_pomdp.files.events import action_to_json

BAR = 28  # characters of a belief of 1
MOST_BARS = 8  # items shown of a larger scene, the likeliest


def belief_to_json(agent: Agent) -> dict[str, Any]:
    """Return the belief by item id, and the id of the item last asked about."""
    ids = [item.id for item in agent.scene.items]
    asked = None if agent.asked is None else ids[agent.asked]
    return {"belief": dict(zip(ids, agent.belief.tolist(), strict=True)), "asked": asked}


def decision_to_json(decision: Decision, scene: Scene) -> dict[str, Any]:
    """Return the action, its item's id or null, and the value of every action; null where the planner gives none."""
    ids = [item.id for item in scene.items]
    values = {
        "wait": _number(decision.wait),
        "point": {id: _number(value) for id, value in zip(ids, decision.point.tolist(), strict=True)},
        "pick": {id: _number(value) for id, value in zip(ids, decision.pick.tolist(), strict=True)},
    }
    action = action_to_json(decision.action, scene)
    return {"action": action["action"], "item": action.get("item"), "values": values}


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value


def show_event(event: Event, agent: Agent, console: Console) -> None:
    """Print what happened, and the belief after something was heard or seen."""
    time = "" if event.time is None else f"{event.time:5.1f} s  "
    if isinstance(event, Observed):
        console.print(f"[dim]{time}[/dim]{_perceived(event, agent)}", soft_wrap=True)
        if event.observation != Observation():
            show_belief(agent, console)
    else:
        reason = "" if event.decision is None else f"  [dim]{why(event.decision, agent.scene)}[/dim]"
        console.print(f"[dim]{time}[/dim][bold]{_acted(event, agent.scene)}[/bold]{reason}", soft_wrap=True)


def _perceived(event: Observed, agent: Agent) -> str:
    observation, parts = event.observation, []
    if observation.words:
        parts.append(f'hears "{escape(" ".join(observation.words))}"')
        unknown = [word for word in language.split(observation.words, agent.problem).unknown if word not in COURTESY]
        if unknown:
            parts.append(f"[yellow]not understood: {escape(', '.join(unknown))}[/yellow]")
    if observation.ray is not None:
        found = angles(observation.ray, agent.problem)
        nearest = int(found.argmin())
        where = f"{math.degrees(found[nearest]):.0f} degrees off {escape(agent.scene.items[nearest].id)}"
        parts.append(f"sees an arm pointing {where}")
    return ", ".join(parts) or "hears and sees nothing"


def _acted(event: Acted, scene: Scene) -> str:
    text = described(event, scene)
    return text if event.done else f"{text}: {event.outcome.value}"


def described(event: Acted, scene: Scene) -> str:
    """Return an action in a few words."""
    if isinstance(event.action, Point):
        return f"asks about {escape(scene.items[event.action.item].id)}"
    if isinstance(event.action, Pick):
        return f"picks {escape(scene.items[event.action.item].id)}"
    return "waits"


def why(decision: Decision, scene: Scene) -> str:
    """Return the best action of each kind with its expected return."""
    parts = [f"pick {_best(decision.pick, scene)}"]
    if not np.isnan(decision.point).any():
        parts.append(f"ask about {_best(decision.point, scene)}")
    if not math.isnan(decision.wait):
        parts.append(f"wait {decision.wait:+.2f}")
    return "expects " + ", ".join(parts)


def _best(values: Vector, scene: Scene) -> str:
    index = int(values.argmax())
    return f"{escape(scene.items[index].id)} {values[index]:+.2f}"


def show_belief(agent: Agent, console: Console) -> None:
    """Print the belief as bars, one an item; of a large scene the likeliest items."""
    belief, items = agent.belief, agent.scene.items
    shown = range(len(items)) if len(items) <= MOST_BARS else np.argsort(-belief, kind="stable")[:MOST_BARS].tolist()
    width = max(len(items[index].id) for index in shown)
    for index in shown:
        bar = "█" * round(BAR * belief[index])
        asked = "  [dim]asked[/dim]" if index == agent.asked else ""
        console.print(
            f"         {escape(items[index].id):{width}}  [cyan]{bar:{BAR}}[/cyan] {belief[index]:6.1%}{asked}"
        )

"""How beliefs and events look on a terminal."""

from __future__ import annotations

import math

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.explanation import deed
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.hearing import texts
from fetch_pomdp.core.language.reading.telling import told
from fetch_pomdp.core.language.words import COURTESY
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.scene import Scene

BAR = 28  # characters of a belief of 1
MOST_BARS = 8  # items shown of a larger scene, the likeliest


def show_event(event: Event, agent: Agent, console: Console) -> None:
    """Print what happened, and the belief after something was heard or seen."""
    time = "" if event.time is None else f"{event.time:5.1f} s  "
    if isinstance(event, Observed):
        console.print(f"[dim]{time}[/dim]{_perceived(event, agent)}", soft_wrap=True)
        if event.observation != Observation():
            show_belief(agent, console)
    else:
        why = None if event.decision is None else event.decision.explanation
        reason = "" if why is None else f"[dim]: {escape(str(why.reason()))}[/dim]"
        line = Table.grid()
        line.add_row(f"[dim]{time}[/dim]", f"[bold]{_acted(event, agent.scene)}[/bold]{reason}")
        console.print(line)


def _perceived(event: Observed, agent: Agent) -> str:
    observation, parts = event.observation, []
    if observation.words:
        parts.append(f'hears "{escape(" ".join(texts(event.words) or observation.words))}"')
        heard = agent.understood.heard
        if heard is not None and (heard.note or agent.understood.utterance.base):
            parts.append(f"[dim]{escape(told(heard))}[/dim]")
        unknown = [word for word in agent.understood.utterance.unknown if word not in COURTESY]
        if unknown and heard is None:
            parts.append(f"[yellow]not understood: {escape(', '.join(unknown))}[/yellow]")
    if observation.ray is not None:
        found = angles(observation.ray, agent.problem)
        nearest = int(found.argmin())
        where = f"{math.degrees(found[nearest]):.0f} degrees off {escape(agent.scene.items[nearest].id)}"
        parts.append(f"sees an arm pointing {where}")
    return ", ".join(parts) or "hears and sees nothing"


def _acted(event: Acted, scene: Scene) -> str:
    text = escape(str(deed(event.action, scene)))
    if event.done:
        return text
    return (
        f"{text} ({event.outcome.value}: {escape(event.reason)})" if event.reason else f"{text} ({event.outcome.value})"
    )


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

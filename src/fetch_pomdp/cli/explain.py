"""How a decision and its explanation look on a terminal."""

from __future__ import annotations

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table

from fetch_pomdp.cli.show import MOST_BARS, show_event
from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.explanation import ValuedAction, worth
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.decisions import named_odds

INDENT = (0, 0, 0, 9)  # beneath what was done: above, right, below, left


def show_decision(decision: Decision, agent: Agent, console: Console, *, explained: bool) -> None:
    """Print what was decided and why, in a sentence; where it is to be explained, with the numbers behind it."""
    show_event(Acted(decision.action, decision=decision), agent, console)
    why = decision.explanation
    if not explained or why is None:
        return
    console.print(Padding(_values(decision, agent), INDENT))
    gain = ValuedAction(why.question.action, why.gain, why.gain_error)
    for name, option in (("waiting is worth", why.wait), ("the best question is expected to gain", gain)):
        if option.valued:
            console.print(Padding(f"{name} {_with_error(option, agent.scene)}", INDENT))
    others = [index for index in _shown(decision, agent) if index != why.item]
    if others:
        console.print(Padding(_log_odds(why.item, others, agent), INDENT))


def _values(decision: Decision, agent: Agent) -> Table:
    """Return what asking about items and picking them is worth; of a large scene the likeliest items."""
    table = Table("item", box=None, padding=(0, 2, 0, 0))
    for title in ("belief", "asking is worth", "picking is worth"):
        table.add_column(title, justify="right")
    errors = np.zeros(len(decision.point)) if decision.point_error is None else decision.point_error
    for index in _shown(decision, agent):
        asking = ValuedAction(Point(index), float(decision.point[index]), float(errors[index]))
        picking = ValuedAction(Pick(index), float(decision.pick[index]), 0.0)
        worths = (_with_error(option, agent.scene) for option in (asking, picking))
        table.add_row(escape(agent.scene.items[index].id), f"{agent.belief[index]:.1%}", *worths)
    return table


def _shown(decision: Decision, agent: Agent) -> list[int]:
    """Return the items to show: all of a small scene, else the likeliest, and the one that the decision is about."""
    if agent.problem.n_items <= MOST_BARS:
        return list(range(agent.problem.n_items))
    likeliest = [int(index) for index in np.argsort(-agent.belief, kind="stable")[:MOST_BARS]]
    about = None if isinstance(decision.action, Wait) else decision.action.item
    return likeliest if about is None or about in likeliest else [*likeliest[:-1], about]


def _log_odds(item: int, others: list[int], agent: Agent) -> Table:
    """Return what each modality says of an item against others."""
    items = agent.scene.items
    table = Table(f"log-odds of {escape(items[item].id)} to", box=None, padding=(0, 2, 0, 0))
    for name in named_odds(agent.evidence.log_odds(item, item)):
        table.add_column(name, justify="right")
    for other in others:
        odds = named_odds(agent.evidence.log_odds(item, other))
        table.add_row(escape(items[other].id), *(f"{part:+.2f}" for part in odds.values()))
    return table


def _with_error(option: ValuedAction, scene: Scene) -> str:
    if not option.valued:
        return "-"
    error = f" ± {worth(option.error, scene)}" if option.error else ""
    return worth(option.value, scene) + error

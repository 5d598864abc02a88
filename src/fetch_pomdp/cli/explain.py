"""How a decision and its explanation look on a terminal, and as JSON."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table

from fetch_pomdp.cli.show import MOST_BARS, show_event
from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.evidence import LogOdds
from fetch_pomdp.core.explanation import Explanation, Option, worth
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.events import action_to_json

INDENT = (0, 0, 0, 9)  # beneath what was done: above, right, below, left


def decision_to_json(decision: Decision, scene: Scene) -> dict[str, Any]:
    """Return the action, its item's id or null, the value of every action with its error, and the explanation.

    What is not valued, or not finite, is null. Picks have no error: they are not sampled.
    """
    ids = [item.id for item in scene.items]
    point_error = np.zeros(len(ids)) if decision.point_error is None else decision.point_error
    values = {
        "wait": _number(decision.wait),
        "point": _by_item(decision.point, ids),
        "pick": _by_item(decision.pick, ids),
    }
    wait_error = _number(decision.wait_error) if _number(decision.wait) is not None else None
    errors = {"wait": wait_error, "point": _by_item(np.where(np.isnan(decision.point), np.nan, point_error), ids)}
    action = action_to_json(decision.action, scene)
    fields = {"action": action["action"], "item": action.get("item"), "values": values, "errors": errors}
    if decision.explanation is not None:
        fields["explanation"] = explanation_to_json(decision.explanation, scene)
    return fields


def explanation_to_json(why: Explanation, scene: Scene) -> dict[str, Any]:
    """Return the fields of an explanation; what is not valued, or not finite, is null."""
    ids = [item.id for item in scene.items]
    rival = why.rival
    return {
        "sentence": why.sentence(scene),
        "item": ids[why.item],
        "belief": why.belief,
        "rival": None if rival is None else ids[rival.item],
        "rival_belief": None if rival is None else rival.belief,
        "log_odds": None if rival is None else {name: _number(odds) for name, odds in _named(rival.log_odds).items()},
        "values": {
            "wait": _option_to_json(why.wait, scene),
            "point": _option_to_json(why.question, scene),
            "pick": _option_to_json(why.pick, scene),
        },
        "gain": _number(why.gain),
        "gain_error": _number(why.gain_error),
        "margin": _number(why.margin),
        "margin_error": _number(why.margin_error),
        "unanswered": None if why.unanswered is None else ids[why.unanswered],
    }


def _option_to_json(option: Option, scene: Scene) -> dict[str, Any]:
    item = action_to_json(option.action, scene).get("item")
    about = {} if item is None else {"item": item}
    return {**about, "value": _number(option.value), "error": option.error if option.valued else None}


def _by_item(values: Vector, ids: list[str]) -> dict[str, float | None]:
    return {id: _number(value) for id, value in zip(ids, values.tolist(), strict=True)}


def _named(odds: LogOdds) -> dict[str, float]:
    parts = {"prior": odds.prior, "words": odds.words, "answers": odds.answers, "pointing": odds.pointing}
    return {**parts, "total": odds.total}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def show_decision(decision: Decision, agent: Agent, console: Console, *, explained: bool) -> None:
    """Print what was decided and why, in a sentence; where it is to be explained, with the numbers behind it."""
    show_event(Acted(decision.action, decision=decision), agent, console)
    why = decision.explanation
    if not explained or why is None:
        return
    console.print(Padding(_values(decision, agent), INDENT))
    gain = Option(why.question.action, why.gain, why.gain_error)
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
        asking = Option(Point(index), float(decision.point[index]), float(errors[index]))
        picking = Option(Pick(index), float(decision.pick[index]), 0.0)
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
    for name in _named(agent.evidence.log_odds(item, item)):
        table.add_column(name, justify="right")
    for other in others:
        odds = _named(agent.evidence.log_odds(item, other))
        table.add_row(escape(items[other].id), *(f"{part:+.2f}" for part in odds.values()))
    return table


def _with_error(option: Option, scene: Scene) -> str:
    if not option.valued:
        return "-"
    error = f" ± {worth(option.error, scene)}" if option.error else ""
    return worth(option.value, scene) + error

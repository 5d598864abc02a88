"""Beliefs, decisions and their explanations as JSON objects."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.evidence import LogOdds
from fetch_pomdp.core.explanation import Explanation, ValuedAction
from fetch_pomdp.core.phrases import Figure, Phrase, Value
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.events import action_to_json


def belief_to_json(agent: Agent) -> dict[str, Any]:
    """Return the belief by item id, and the id of the item last asked about."""
    ids = [item.id for item in agent.scene.items]
    asked = None if agent.asked is None else ids[agent.asked]
    return {"belief": dict(zip(ids, agent.belief.tolist(), strict=True)), "asked": asked}


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
        "sentence": str(why),
        "item": ids[why.item],
        "belief": why.belief,
        "rival": None if rival is None else ids[rival.item],
        "rival_belief": None if rival is None else rival.belief,
        "log_odds": None
        if rival is None
        else {name: _number(odds) for name, odds in named_odds(rival.log_odds).items()},
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


def phrase_to_json(phrase: Phrase) -> dict[str, Any]:
    """Return a template's key and the values that fill it: phrases, ids, and numbers as English writes them."""
    return {"key": phrase.key, "values": {name: _value_to_json(value) for name, value in phrase.values.items()}}


def _value_to_json(value: Value) -> str | dict[str, Any]:
    if isinstance(value, Phrase):
        return phrase_to_json(value)
    return {"number": value.english} if isinstance(value, Figure) else value


def _option_to_json(option: ValuedAction, scene: Scene) -> dict[str, Any]:
    item = action_to_json(option.action, scene).get("item")
    about = {} if item is None else {"item": item}
    return {**about, "value": _number(option.value), "error": option.error if option.valued else None}


def _by_item(values: Vector, ids: list[str]) -> dict[str, float | None]:
    return {id: _number(value) for id, value in zip(ids, values.tolist(), strict=True)}


def named_odds(odds: LogOdds) -> dict[str, float]:
    """Return log-odds by where they come from, and their total."""
    parts = {"prior": odds.prior, "words": odds.words, "answers": odds.answers, "pointing": odds.pointing}
    return {**parts, "total": odds.total}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None

"""From a decision, the belief and where that comes from to the reasons of the decision."""

from __future__ import annotations

import math

import numpy as np

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explanation import AS_LIKELY, Explanation, Rival, ValuedAction
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.scene import Scene


def explain(decision: Decision, belief: Belief, evidence: Evidence, scene: Scene) -> Explanation:
    """Return why `decision` was taken at `belief`, which `evidence` led to. Every number is one of theirs.

    A wait is about the likeliest item.
    """
    chances = belief.probabilities
    likeliest = int(chances.argmax())
    item = likeliest if isinstance(decision.action, Wait) else decision.action.item
    chance, rival = float(chances[item]), _rival(chances, item, likeliest)
    return Explanation(
        scene=scene,
        chosen=_chosen(decision),
        item=item,
        belief=chance,
        rival=None if rival is None else Rival(rival, float(chances[rival]), evidence.log_odds(item, rival)),
        as_likely=_as_likely(chances, chance),
        wait=_wait(decision),
        question=_question(decision, _best(decision.point, item)),
        pick=_pick(decision, _best(decision.pick, item)),
        unanswered=evidence.unanswered,
    )


def even(chances: Vector) -> bool:
    """Return whether several items, (n_items,), are all as likely as the likeliest, as far as an explanation tells."""
    return len(chances) > 1 and _as_likely(chances, float(chances.max())) == len(chances)


def _as_likely(chances: Vector, chance: float) -> int:
    """Return how many items count as being as likely as `chance`."""
    return int(np.count_nonzero(np.abs(chances - chance) <= AS_LIKELY * chance))


def _rival(chances: Vector, item: int, likeliest: int) -> int | None:
    """Return the likeliest of the other items, or None where there is none."""
    if len(chances) == 1:
        return None
    if item != likeliest:
        return likeliest
    before, after = chances[:item], chances[item + 1 :]
    if not len(after) or (len(before) and before.max() >= after.max()):
        return int(before.argmax())
    return item + 1 + int(after.argmax())


def _best(values: Vector, fallback: int) -> int:
    """Return the index of the highest value that is a number, or `fallback` where none is."""
    best = int(values.argmax())
    if math.isnan(values[best]):  # argmax stops at the first NaN
        return fallback if np.isnan(values).all() else int(np.nanargmax(values))
    return best


def _chosen(decision: Decision) -> ValuedAction:
    if isinstance(decision.action, Wait):
        return _wait(decision)
    item = decision.action.item
    return _question(decision, item) if isinstance(decision.action, Point) else _pick(decision, item)


def _wait(decision: Decision) -> ValuedAction:
    return ValuedAction(Wait(), float(decision.wait), float(decision.wait_error))


def _question(decision: Decision, item: int) -> ValuedAction:
    error = 0.0 if decision.point_error is None else float(decision.point_error[item])
    return ValuedAction(Point(item), float(decision.point[item]), error)


def _pick(decision: Decision, item: int) -> ValuedAction:
    return ValuedAction(Pick(item), float(decision.pick[item]), 0.0)

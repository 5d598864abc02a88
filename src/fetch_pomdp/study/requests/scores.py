"""How well chances of items fit what was meant: right, logarithmic loss and calibration, and listeners beside them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.study.requests.corpus import Request

BINS = 10  # of a reliability diagram
VIEW_DEPENDENT = ("agent", "user")  # what annotators say needs somebody's view


@dataclass(frozen=True, slots=True)
class Bin:
    """Requests whose likeliest item had a chance in one range."""

    count: int
    believed: float  # mean chance of the likeliest item
    right: float  # share of them in which it was meant


@dataclass(frozen=True, slots=True)
class Score:
    """How well some requests were read."""

    count: int
    right: float  # share in which the likeliest item was meant, ties shared
    log_loss: float  # nats, mean of -log of the chance of what was meant
    calibration_error: float  # mean difference of chance and share over the bins (ECE)
    listeners: float  # share of the listeners who were right
    agreeing: float  # share of the listeners who took the request for our likeliest item
    bins: tuple[Bin, ...]


def score(requests: Sequence[Request], chances: Sequence[Vector]) -> Score:
    """Score the chances, (n_items,) a request, that a reader gave. Raises ValueError for none."""
    if not requests:
        raise ValueError("found no requests, expected one or more")
    right = np.array([_right(each, p) for each, p in zip(requests, chances, strict=True)])
    best = np.array([float(p.max()) for p in chances])
    loss = [-math.log(max(float(p[each.target]), 1e-300)) for each, p in zip(requests, chances, strict=True)]
    bins = _bins(best, right)
    error = sum(each.count * abs(each.believed - each.right) for each in bins) / len(requests)
    asked = [(each, p) for each, p in zip(requests, chances, strict=True) if each.clicked.any()]
    listeners = float(np.mean([each.listeners_right for each, _ in asked])) if asked else math.nan
    agreeing = float(np.mean([each.clicked[p.argmax()] for each, p in asked])) if asked else math.nan
    return Score(len(requests), float(right.mean()), float(np.mean(loss)), error, listeners, agreeing, bins)


def _right(request: Request, chances: Vector) -> float:
    best = chances >= chances.max() * (1.0 - 1e-9)
    return float(best[request.target]) / int(best.sum())


def _bins(best: Vector, right: Vector) -> tuple[Bin, ...]:
    places = np.minimum((best * BINS).astype(int), BINS - 1)
    found = []
    for place in range(BINS):
        inside = places == place
        if inside.any():
            found.append(Bin(int(inside.sum()), float(best[inside].mean()), float(right[inside].mean())))
    return tuple(found)


def groups(requests: Sequence[Request]) -> dict[str, Callable[[Request], bool]]:
    """Return the groups of requests that a report has: all, those that need a view, those that do not, each table's."""
    found: dict[str, Callable[[Request], bool]] = {"all": lambda _: True}
    if any(each.view for each in requests):
        found["need a view"] = lambda each: each.view in VIEW_DEPENDENT
        found["ambiguous view"] = lambda each: each.view == "ambiguous"
        found["need none"] = lambda each: each.view == "neither"
    for table in sorted({each.table for each in requests}):
        found[f"table {table}"] = lambda each, table=table: each.table == table  # type: ignore[misc]
    return found

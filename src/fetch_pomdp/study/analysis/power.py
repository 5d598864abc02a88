"""How many people a study needs to show a clause, by simulation from the persons there are.

The answer holds for people like those of the table and for a difference as large as theirs: with few persons it is
uncertain by much more than the number of simulated studies says, so that a second answer assumes half the advantage.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.random import Generator, default_rng

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.comparisons import gains
from fetch_pomdp.study.analysis.hypotheses import Clause
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.signed_rank import no_worse_in, superior_in
from fetch_pomdp.study.analysis.trials import Table, Values, alike, differences

FEWEST = 6  # below, signed ranks cannot reach one-sided 2.5 %, whatever happens
SIZES = (6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160, 192, 256, 384, 512, 768, 1024)

Tested = Callable[[Values], Values]  # (n_studies, n_people) gains to (n_studies,) one-sided p


@dataclass(frozen=True, slots=True)
class Chance:
    """The chance that a study of `people` shows the clause, with its 95% interval over simulated studies."""

    people: int
    chance: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Needed:
    """People a study needs to show a clause; each None if the largest study tried is too small."""

    people: int | None
    at_least: int | None  # the smallest study whose chance may be large enough, as far as the simulation tells
    at_most: int | None  # the smallest study whose chance surely is
    curve: tuple[Chance, ...]


def needed(clause: Clause, table: Table, plan: Plan, effect: float = 1.0) -> Needed | None:
    """Return the people that a study needs, each doing as many trials as the table's; None if no test can be made.

    effect: which part of the observed mean advantage to assume; persons keep their spread around it.
    """
    found = differences(table[table["layout"] == clause.layout], plan.system, clause.compared.other, clause.measure)
    people = gains(found, clause.measure).people
    if len(people) < 2 or alike(people):
        return None
    margin = 0.0 if clause.kind == "better" else plan.margin(clause.measure)
    advantage = float(people.mean()) + margin
    people = people - (1.0 - effect) * advantage
    test: Tested = superior_in if clause.kind == "better" else partial(no_worse_in, margin=margin)
    rng = default_rng(plan.seed)
    curve = _curve(people, test, plan, rng)
    first = partial(_first, curve, plan.power)
    return Needed(first("chance"), first("high"), first("low"), curve)


def _curve(people: Values, test: Tested, plan: Plan, rng: Generator) -> tuple[Chance, ...]:
    """Try growing studies until one surely suffices, then those between the last that fails and the first that does."""
    curve: dict[int, Chance] = {}
    for size in (size for size in SIZES if size <= plan.most_people):
        curve[size] = _chance(people, size, test, plan, rng)
        if curve[size].low >= plan.power:
            break
    enough = [size for size in curve if curve[size].chance >= plan.power]
    if enough:
        high = min(enough)
        low = max((size for size in curve if size < high), default=high)
        while high - low > 1:
            middle = (low + high) // 2
            curve[middle] = _chance(people, middle, test, plan, rng)
            low, high = (low, middle) if curve[middle].chance >= plan.power else (middle, high)
    return tuple(curve[size] for size in sorted(curve))


def _chance(people: Values, size: int, test: Tested, plan: Plan, rng: Generator) -> Chance:
    studies = people[rng.integers(len(people), size=(plan.draws, size))]
    shown = int(np.sum(test(studies) <= plan.level / 2))
    low, high = load("statsmodels.stats.proportion", "study").proportion_confint(shown, plan.draws, method="wilson")
    return Chance(size, shown / plan.draws, float(low), float(high))


def _first(curve: tuple[Chance, ...], power: float, end: str) -> int | None:
    return next((one.people for one in curve if getattr(one, end) >= power), None)

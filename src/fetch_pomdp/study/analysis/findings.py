"""All that an analysis finds in a table of trials, and the same as tables to keep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.cells import Cell, cells
from fetch_pomdp.study.analysis.comparisons import Comparison, comparisons
from fetch_pomdp.study.analysis.hypotheses import Clause, Hypothesis, hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.power import Needed, needed
from fetch_pomdp.study.analysis.trials import Table, checked

EFFECTS = (1.0, 0.5)  # parts of the observed advantage that a planned study may assume


@dataclass(frozen=True, slots=True)
class Sizing:
    """How many people a clause needs, if a part `effect` of the observed advantage is true; None: no test possible."""

    clause: Clause
    effect: float
    needed: Needed | None


@dataclass(frozen=True, slots=True)
class Findings:
    """What a checked table says."""

    plan: Plan
    trials: Table
    cells: tuple[Cell, ...]
    comparisons: tuple[Comparison, ...]
    hypotheses: tuple[Hypothesis, ...]
    sizings: tuple[Sizing, ...]


def analyse(table: Table, plan: Plan | None = None) -> Findings:
    """Analyse trials: a DataFrame whose columns are the fields of Trial.

    Raises StudyError for a table that cannot be used, MissingExtraError without the libraries of the extra "study".
    """
    plan = plan or Plan()
    trials = checked(table)
    judged = hypotheses(trials, plan)
    sizings = tuple(
        Sizing(clause, effect, needed(clause, trials, plan, effect))
        for hypothesis in judged
        for clause in hypothesis.clauses
        for effect in EFFECTS
    )
    return Findings(plan, trials, cells(trials, plan), comparisons(trials, plan), judged, sizings)


def tables(found: Findings) -> Mapping[str, Table]:
    """Return the findings as DataFrames by name: cells, comparisons, clauses, people, power."""
    clauses = [clause for hypothesis in found.hypotheses for clause in hypothesis.clauses]
    means = found.trials.groupby(["person", "layout", "paradigm"], as_index=False)
    return {
        "cells": _frame(Cell, [asdict(cell) for cell in found.cells]),
        "comparisons": _frame(Comparison, [asdict(row) for row in found.comparisons]),
        "clauses": load("pandas", "study")
        .DataFrame([_flat(clause) for clause in clauses])
        .astype({"p": float, "p_holm": float}),
        "people": means[["time", "correct", "questions", "waits"]].mean().rename(columns={"correct": "accuracy"}),
        "power": load("pandas", "study").DataFrame(_curves(found.sizings), columns=POWER),
    }


POWER = ("hypothesis", "claim", "effect", "people", "chance", "low", "high")


def _curves(sizings: Sequence[Sizing]) -> list[tuple[Any, ...]]:
    return [
        (one.clause.hypothesis, one.clause.claim, one.effect, at.people, at.chance, at.low, at.high)
        for one in sizings
        if one.needed is not None
        for at in one.needed.curve
    ]


def _flat(clause: Clause) -> dict[str, Any]:
    kept = ("hypothesis", "layout", "claim", "measure", "kind", "p", "p_holm", "verdict", "paper")
    return {"other": clause.compared.other, **{name: getattr(clause, name) for name in kept}}


def _frame(kind: type, rows: Sequence[dict[str, Any]]) -> Table:
    """Return rows of a dataclass as a DataFrame whose numbers are numbers even where all of them are missing."""
    numbers = {field.name: float for field in fields(kind) if "float" in str(field.type)}
    return load("pandas", "study").DataFrame(rows, columns=[field.name for field in fields(kind)]).astype(numbers)

"""The system against each other paradigm, in each layout and in all of them together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fetch_pomdp.study.analysis import intervals
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.signed_rank import holm, no_worse, no_worse_by_ranks, signed_rank
from fetch_pomdp.study.analysis.trials import EVERYWHERE, MEASURES, Differences, Table, alike, differences


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """How `system` differs from `other`; None where there is nothing to compute it from, and `note` says why."""

    layout: str
    measure: str  # "time" (s) or "accuracy" (share of trials)
    system: str
    other: str
    people: int
    pairs: int
    unpaired: int  # trials without a partner
    difference: float | None  # system less other, mean over persons
    low: float | None
    high: float | None
    p_pairs: float | None  # two-sided signed ranks of paired trials, the paper's test
    p_pairs_holm: float | None = None
    p_people: float | None  # two-sided signed ranks of persons
    p_people_holm: float | None = None
    effect_pairs: float | None  # rank-biserial
    effect_people: float | None
    p_no_worse: float | None  # one-sided, worse by the margin or more, Student's test of persons
    p_no_worse_ranks: float | None  # the same by signed ranks of persons
    note: str = ""


def gains(found: Differences, measure: str) -> Differences:
    """Return differences so that positive is better: less time, more accuracy."""
    sign = -1.0 if measure == "time" else 1.0
    return Differences(sign * found.people, sign * found.pairs, found.unpaired)


def comparisons(table: Table, plan: Plan) -> tuple[Comparison, ...]:
    """Return the comparisons of a checked table; those of one table are one family for Holm's correction."""
    layouts = sorted(table["layout"].unique(), key=str)
    others = [name for name in sorted(table["paradigm"].unique(), key=str) if name != plan.system]
    places = {layout: table[table["layout"] == layout] for layout in layouts}
    if len(layouts) > 1:
        places[EVERYWHERE] = table
    rows = [
        compare(trials, layout, other, measure, plan)
        for layout, trials in places.items()
        for other in others
        for measure in MEASURES
    ]
    return _corrected(rows)


def compare(trials: Table, layout: str, other: str, measure: str, plan: Plan) -> Comparison:
    """Return one comparison from the trials of a layout."""
    found = differences(trials, plan.system, other, measure)
    better = gains(found, measure).people
    mean = intervals.of_mean(found.people, plan.level) if len(found.people) else intervals.Interval(0.0, None, None)
    pairs, people = signed_rank(found.pairs), signed_rank(found.people)
    tested = len(found.people) > 1
    return Comparison(
        layout=layout, measure=measure, system=plan.system, other=other,
        people=len(found.people), pairs=len(found.pairs), unpaired=found.unpaired,
        difference=mean.mean if len(found.people) else None, low=mean.low, high=mean.high,
        p_pairs=pairs.p, p_people=people.p if tested else None,
        effect_pairs=pairs.rank_biserial, effect_people=people.rank_biserial if tested else None,
        p_no_worse=no_worse(better, plan.margin(measure)),
        p_no_worse_ranks=no_worse_by_ranks(better, plan.margin(measure)),
        note=_note(found, plan.system, other),
    )  # fmt: skip


def _note(found: Differences, system: str, other: str) -> str:
    if len(found.people) == 0:
        return f"nobody was served by both {system} and {other}"
    if len(found.people) == 1:
        return "one person only: nothing can be said of others"
    if alike(found.people):
        return "all persons differ by the same amount: no interval, and no test of their mean"
    if not found.pairs.any():
        return "no pair of trials differs" if len(found.pairs) else "no trial has a partner"
    return ""


def _corrected(rows: Sequence[Comparison]) -> tuple[Comparison, ...]:
    pairs, people = holm([row.p_pairs for row in rows]), holm([row.p_people for row in rows])
    return tuple(
        replace(row, p_pairs_holm=one, p_people_holm=other) for row, one, other in zip(rows, pairs, people, strict=True)
    )

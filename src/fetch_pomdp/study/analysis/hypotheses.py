"""H1 and H2 of Section IV, clause by clause.

Choice: a clause that says "faster" or "more accurate" is tested by signed ranks of persons, one that says "as" by a
margin; both one-sided at half the level, so that they agree with two-sided tests and with the ends of the intervals. A
hypothesis holds if all its clauses do, which needs no correction for their number; Holm's p is for who picks one out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from fetch_pomdp.study.analysis.comparisons import Comparison, compare, gains
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.signed_rank import holm, signed_rank
from fetch_pomdp.study.analysis.trials import Table, differences

Verdict = Literal["holds", "refuted", "not shown", "cannot be judged"]
Kind = Literal["better", "no worse"]
Claims: TypeAlias = tuple[tuple[str, str, Kind], ...]  # the other paradigm, the measure, how it compares


@dataclass(frozen=True, slots=True, kw_only=True)
class Clause:
    """One claim of a hypothesis, its test, and what came of it."""

    hypothesis: str
    layout: str
    measure: str
    kind: Kind
    claim: str
    compared: Comparison
    p: float | None  # one-sided, over persons
    p_holm: float | None = None  # among the clauses of the hypothesis
    verdict: Verdict
    paper: bool | None  # what the paper's reading of its test, over paired trials, would conclude


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """A hypothesis of Section IV with its clauses; holds only if all of them do."""

    name: str
    clauses: tuple[Clause, ...]

    @property
    def verdict(self) -> Verdict:
        """Return the weakest verdict among the clauses."""
        found = {clause.verdict for clause in self.clauses}
        order: tuple[Verdict, ...] = ("refuted", "cannot be judged", "not shown")
        return next((verdict for verdict in order if verdict in found), "holds")


def hypotheses(table: Table, plan: Plan) -> tuple[Hypothesis, Hypothesis]:
    """Return H1 and H2 judged on a checked table."""
    first: Claims = (
        (plan.never, "accuracy", "no worse"), (plan.always, "accuracy", "no worse"),
        (plan.always, "time", "better"), (plan.never, "time", "no worse"),
    )  # fmt: skip
    second: Claims = (
        (plan.never, "accuracy", "better"), (plan.always, "accuracy", "no worse"),
        (plan.always, "time", "better"), (plan.never, "time", "no worse"),
    )  # fmt: skip
    return judged("H1", plan.unambiguous, first, table, plan), judged("H2", plan.ambiguous, second, table, plan)


def judged(name: str, layout: str, claims: Claims, table: Table, plan: Plan) -> Hypothesis:
    """Return a hypothesis of so many claims about one layout, judged on a checked table."""
    trials = table[table["layout"] == layout]
    clauses = [_clause(name, layout, claim, trials, plan) for claim in claims]
    corrected = holm([clause.p for clause in clauses])
    return Hypothesis(name, tuple(replace(c, p_holm=p) for c, p in zip(clauses, corrected, strict=True)))


def _clause(name: str, layout: str, claim: tuple[str, str, Kind], trials: Table, plan: Plan) -> Clause:
    other, measure, kind = claim
    compared = compare(trials, layout, other, measure, plan)
    better = gains(differences(trials, plan.system, other, measure), measure).people
    p = signed_rank(better, "greater").p if kind == "better" else compared.p_no_worse
    p = p if compared.people > 1 else None
    return Clause(
        hypothesis=name, layout=layout, measure=measure, kind=kind, claim=_claim(claim, plan), compared=compared,
        p=p, verdict=_verdict(compared, kind, p, plan), paper=_paper(compared, kind, plan),
    )  # fmt: skip


def _claim(claim: tuple[str, str, Kind], plan: Plan) -> str:
    other, measure, kind = claim
    if kind == "better":
        return f"{plan.system} is {'faster' if measure == 'time' else 'more accurate'} than {other}"
    if measure == "time":
        return f"{plan.system} is at least as fast as {other} (slower by less than {plan.margin_time:g} s)"
    points = 100 * plan.margin_accuracy
    return f"{plan.system} is at least as accurate as {other} (worse by less than {points:g} points)"


def _verdict(compared: Comparison, kind: Kind, p: float | None, plan: Plan) -> Verdict:
    if p is None:
        return "cannot be judged"
    if p <= plan.level / 2:
        return "holds"
    ends = (compared.low, compared.high)
    if None not in ends:
        best = -compared.low if compared.measure == "time" else compared.high  # type: ignore[operator]
        if best is not None and best < (0.0 if kind == "better" else -plan.margin(compared.measure)):
            return "refuted"
    return "not shown"


def _paper(compared: Comparison, kind: Kind, plan: Plan) -> bool | None:
    """Return whether the paper would confirm a clause: "as" when it is not significantly worse."""
    if compared.p_pairs is None or compared.effect_pairs is None:
        return None
    ahead = -compared.effect_pairs if compared.measure == "time" else compared.effect_pairs
    significant = compared.p_pairs <= plan.level
    return significant and ahead > 0 if kind == "better" else not (significant and ahead < 0)

"""Findings in words, and numbers as they are printed."""

from __future__ import annotations

from fetch_pomdp.study.analysis.comparisons import Comparison
from fetch_pomdp.study.analysis.hypotheses import Clause, Hypothesis
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.power import Needed

NONE = "–"
UNITS = {"time": "s", "accuracy": "points"}
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def chance(p: float | None) -> str:
    """Return a p with two digits: 0.031, or 3.6 × 10⁻²²."""
    if p is None:
        return NONE
    if p >= 0.0001 or p == 0:
        return f"{p:.2g}"
    digits, _, power = f"{p:.1e}".partition("e")
    return f"{digits} × 10{str(int(power)).translate(RAISED)}"


def equals(p: float | None) -> str:
    """Return "p = ...", or that there is none."""
    return "no test possible" if p is None else f"p = {chance(p)}"


def difference(value: float | None, measure: str) -> str:
    """Return a signed difference: seconds with two digits, points with one."""
    if value is None:
        return NONE
    return (f"{value:+.2f}" if measure == "time" else f"{100 * value:+.1f}").replace("-", "−")


def span(low: float | None, high: float | None, measure: str) -> str:
    """Return the ends of an interval of differences."""
    return NONE if low is None or high is None else f"{difference(low, measure)} to {difference(high, measure)}"


def measured(row: Comparison, plan: Plan) -> str:
    """Return what was measured, such as "fetch − never: +0.59 s (95% interval −0.10 to +1.28), 8 persons"."""
    if row.difference is None:
        return row.note
    unit = UNITS[row.measure]
    value = f"{row.system} − {row.other}: {difference(row.difference, row.measure)} {unit}"
    interval = f"{100 * (1 - plan.level):g}% interval {span(row.low, row.high, row.measure)}"
    around = interval if row.low is not None else f"no interval: {row.note}"
    return f"{value} ({around}), {row.people} person{'s' * (row.people != 1)}"


def answer(hypothesis: Hypothesis) -> str:
    """Return what became of a hypothesis as a whole."""
    name, clauses = hypothesis.name, hypothesis.clauses
    held = sum(clause.verdict == "holds" for clause in clauses)
    layout = clauses[0].layout
    if hypothesis.verdict == "holds":
        return f"{name} holds in the {layout} layout: all {len(clauses)} clauses are shown."
    ends = {
        "refuted": "is refuted: at least one clause is contradicted",
        "cannot be judged": "cannot be judged: for at least one clause there is no test",
        "not shown": "is not shown: at least one clause is neither shown nor contradicted",
    }
    return f"{name} {ends[hypothesis.verdict]}; {held} of {len(clauses)} clauses hold ({layout} layout)."


def verdict(clause: Clause, plan: Plan) -> str:
    """Return a clause, its numbers and its tests as a sentence or two."""
    row = clause.compared
    if row.difference is None or clause.p is None:
        because = row.note or "no test can be made"
        numbers = "" if row.difference is None else f" {measured(row, plan)}."
        return f"{clause.claim}: cannot be judged, because {because}.{numbers}"
    test = "signed ranks of persons" if clause.kind == "better" else "margin test of persons"
    tested = f"{test}, one-sided {equals(clause.p)} (Holm {chance(clause.p_holm)}, level {plan.level / 2:g})"
    parts = [f"{clause.claim}: {clause.verdict}. {measured(row, plan)}; {tested}.", _caution(clause, plan)]
    return " ".join(part for part in [*parts, _reading(clause)] if part)


def _caution(clause: Clause, plan: Plan) -> str:
    row = clause.compared
    if clause.verdict == "holds" and clause.p_holm is not None and clause.p_holm > plan.level / 2:
        return "Taken alone, it does not survive the correction for the number of clauses."
    if clause.verdict != "not shown" or row.low is None or row.high is None:
        return ""
    if clause.kind == "better":
        return "That no difference was shown does not mean that there is none."
    worst = row.high if clause.measure == "time" else -row.low
    lost = f"{worst:.2f} s" if clause.measure == "time" else f"{100 * worst:.1f} points"
    return f"A loss of {lost} is not excluded; “not significantly different” is not “as {_as(clause)}”."


def _as(clause: Clause) -> str:
    return "fast" if clause.measure == "time" else "accurate"


def _reading(clause: Clause) -> str:
    """Return what the paper's test says, where it says something else."""
    row = clause.compared
    if clause.paper is None or clause.paper == (clause.verdict == "holds"):
        return ""
    what = "would confirm" if clause.paper else "would not confirm"
    pairs = f"two-sided signed ranks of {row.pairs} paired trials, {equals(row.p_pairs)}"
    return f"The paper's reading {what} it: {pairs}."


def people(found: Needed | None, plan: Plan) -> str:
    """Return how many people a study needs, with what the simulation leaves open."""
    if found is None:
        return "no test possible"
    if found.people is None:
        return f"more than {found.curve[-1].people}"
    if found.people == found.curve[0].people:
        return f"{found.people} or fewer"
    most = found.at_most or f"more than {plan.most_people}"
    return f"{found.people} ({found.at_least} to {most})"

"""Verdicts on tables whose answer is known, and what is said where there is none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.analysis import words
from fetch_pomdp.study.analysis.comparisons import comparisons
from fetch_pomdp.study.analysis.hypotheses import Hypothesis, hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import EVERYWHERE, checked
from tests.study.made import drawn, table

CLEAR = {
    "ambiguous": {"never": (9.0, 0.70), "always": (12.0, 0.70), "fetch": (7.0, 0.97)},
    "unambiguous": {"never": (5.0, 0.80), "always": (9.0, 0.80), "fetch": (3.0, 0.99)},
}
WORSE = {
    "ambiguous": {"never": (5.0, 0.97), "always": (5.0, 0.97), "fetch": (9.0, 0.60)},
    "unambiguous": {"never": (5.0, 0.97), "always": (5.0, 0.97), "fetch": (9.0, 0.60)},
}


def judged(trials: Any, plan: Plan | None = None) -> tuple[Hypothesis, Hypothesis]:
    return hypotheses(checked(trials), plan or Plan())


def test_a_system_that_is_better_throughout_confirms_both() -> None:
    for hypothesis in judged(drawn(8, 0, CLEAR)):
        assert hypothesis.verdict == "holds"
        assert all(clause.paper for clause in hypothesis.clauses)
        assert words.answer(hypothesis).endswith("all 4 clauses are shown.")


def test_a_system_that_is_worse_throughout_refutes_every_clause() -> None:
    for hypothesis in judged(drawn(8, 1, WORSE)):
        assert [clause.verdict for clause in hypothesis.clauses] == ["refuted"] * 4
        assert not any(clause.paper for clause in hypothesis.clauses)


def test_the_clauses_are_those_of_section_iv() -> None:
    first, second = judged(drawn(3, 2))
    asked = [(c.measure, c.compared.other, c.kind) for c in first.clauses]
    assert asked == [
        ("accuracy", "never", "no worse"),
        ("accuracy", "always", "no worse"),
        ("time", "always", "better"),
        ("time", "never", "no worse"),
    ]
    assert [c.kind for c in second.clauses] == ["better", "no worse", "better", "no worse"]
    assert {c.layout for c in first.clauses} == {"unambiguous"}
    assert {c.layout for c in second.clauses} == {"ambiguous"}


def test_no_significant_difference_is_not_as_accurate() -> None:
    """Two persons gain, two lose 10 points: the paper's reading confirms what the margin does not."""
    rows = []
    for person, right in enumerate((9, 7, 9, 7)):
        rows += [(person, "never", 5.0 + person, trial < 8) for trial in range(10)]
        rows += [(person, "fetch", 5.0 + person / 2, trial < right) for trial in range(10)]
    clause = judged(table(rows))[0].clauses[0]
    gains = np.array([0.1, -0.1, 0.1, -0.1])
    assert clause.compared.difference == pytest.approx(0.0)
    assert clause.p == pytest.approx(stats.ttest_1samp(gains, -0.02, alternative="greater").pvalue)
    assert clause.verdict == "not shown"
    assert clause.paper is True
    said = words.verdict(clause, Plan())
    assert "“not significantly different” is not “as accurate”" in said
    assert "A loss of 18.4 points is not excluded" in said  # 3.182 · 0.11547 / 2
    assert "The paper's reading would confirm it" in said


def test_the_numbers_of_a_small_table_by_hand() -> None:
    """Six persons, each two seconds or more faster with fetch: one-sided p of the signed ranks is 1 / 2^6."""
    rows = [(p, name, time + p * slope, True) for p in range(6) for name, time, slope in
            (("always", 9.0, 1.0), ("fetch", 7.0, 0.5), ("never", 7.1, 0.5))]  # fmt: skip
    clauses = judged(table(rows))[0].clauses
    faster, as_fast = clauses[2], clauses[3]
    assert faster.p == pytest.approx(1 / 64)
    assert faster.compared.p_people == pytest.approx(2 / 64)
    assert faster.compared.difference == pytest.approx(-3.25)
    assert faster.compared.effect_people == pytest.approx(-1.0)
    assert faster.verdict == "holds"
    assert as_fast.compared.difference == pytest.approx(-0.1)
    assert as_fast.verdict == "cannot be judged"  # all persons differ by the same 0.1 s
    assert "all persons differ by the same amount" in words.verdict(as_fast, Plan())


def test_holm_is_over_the_clauses_of_a_hypothesis() -> None:
    for hypothesis in judged(drawn(8, 3)):
        raw = sorted((c.p, c.p_holm) for c in hypothesis.clauses if c.p is not None and c.p_holm is not None)
        running = 0.0
        for place, (p, corrected) in enumerate(raw):
            running = max(running, min(1.0, p * (len(raw) - place)))
            assert corrected == pytest.approx(running)


@pytest.mark.parametrize(
    ("trials", "reason"),
    [
        (table([(0, "fetch", 1.0, True), (0, "never", 2.0, True), (0, "always", 3.0, True)]), "one person only"),
        (drawn(4, 4)[lambda t: t["paradigm"] != "fetch"], "nobody was served by both fetch and"),
        (drawn(4, 4)[lambda t: t["layout"] != "unambiguous"], "nobody was served by both fetch and"),
    ],
    ids=["one person", "no fetch", "no such layout"],
)
def test_what_cannot_be_judged_is_said(trials: Any, reason: str) -> None:
    first, _ = judged(trials)
    assert first.verdict == "cannot be judged"
    for clause in first.clauses:
        said = words.verdict(clause, Plan())
        assert "cannot be judged" in said
        assert reason in said
        assert "nan" not in said


def test_everybody_always_right_is_no_proof_of_as_accurate() -> None:
    trials = drawn(6, 5).assign(correct=True)
    clauses = judged(trials)[0].clauses
    assert [c.verdict for c in clauses[:2]] == ["cannot be judged"] * 2
    assert clauses[2].verdict == "holds"


def test_comparisons_cover_every_layout_and_all_of_them_together() -> None:
    rows = comparisons(checked(drawn(4, 6)), Plan())
    assert [(r.layout, r.other, r.measure) for r in rows][:4] == [
        ("ambiguous", "always", "time"),
        ("ambiguous", "always", "accuracy"),
        ("ambiguous", "never", "time"),
        ("ambiguous", "never", "accuracy"),
    ]
    assert len(rows) == 12
    assert {r.people for r in rows if r.layout == EVERYWHERE} == {8}
    assert {r.pairs for r in rows if r.layout == EVERYWHERE} == {8 * 18}


def test_another_system_can_be_put_on_trial() -> None:
    trials = drawn(8, 0, CLEAR).replace({"paradigm": {"fetch": "fitted"}})
    assert judged(trials, Plan(system="fitted"))[0].verdict == "holds"
    assert judged(trials)[0].verdict == "cannot be judged"


@pytest.mark.parametrize("seed", range(3))
def test_a_wider_margin_never_takes_a_verdict_back(seed: int) -> None:
    trials = checked(drawn(6, seed, repeats=1))
    narrow, wide = Plan(), replace(Plan(), margin_accuracy=0.1, margin_time=2.0)
    for one, other in zip(hypotheses(trials, narrow), hypotheses(trials, wide), strict=True):
        for before, after in zip(one.clauses, other.clauses, strict=True):
            if before.verdict == "holds":
                assert after.verdict == "holds"


@pytest.mark.parametrize(
    ("field", "value"),
    [("system", ""), ("margin_time", -1.0), ("margin_accuracy", float("nan")), ("level", 0.0), ("draws", 10.5),
     ("power", 1.0), ("most_people", 5), ("seed", -1)],
)  # fmt: skip
def test_a_plan_that_cannot_be_is_refused(field: str, value: Any) -> None:
    with pytest.raises(StudyError) as caught:
        replace(Plan(), **{field: value})
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("p", "said"),
    [(None, "–"), (0.0312, "0.031"), (3.62e-22, "3.6 × 10⁻²²"), (1.0, "1"), (0.0001, "0.0001"), (0.9961, "1")],
)
def test_how_a_p_is_printed(p: float | None, said: str) -> None:
    assert words.chance(p) == said

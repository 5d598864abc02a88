"""People needed, against the formulas of books and against analysed studies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from statsmodels.stats.power import TTestPower

from fetch_pomdp.study.analysis.hypotheses import hypotheses
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.power import FEWEST, needed
from fetch_pomdp.study.analysis.trials import Values, checked
from tests.study.made import drawn, table

PLAN = replace(Plan(), draws=1500)


def normal_scores(mean: float, sd: float, people: int) -> Values:
    """Numbers with exactly this mean and standard deviation, spread like a normal distribution."""
    scores = np.random.default_rng(0).normal(size=people)
    return np.asarray(mean + sd * (scores - scores.mean()) / scores.std(), float)


def test_people_for_a_margin_are_those_of_the_t_test() -> None:
    """At a margin of 0.5 s, a true gain of 0 and a sd of 1 s: effect 0.5, one-sided 2.5%, 80%."""
    gains = normal_scores(0.0, 1.0, 400)
    rows = [r for p, d in enumerate(gains) for r in ((p, "never", 20.0 + d, True), (p, "fetch", 20.0, True))]
    trials = checked(table(rows))
    clause = hypotheses(trials, PLAN)[0].clauses[3]
    expected = TTestPower().solve_power(effect_size=0.5, alpha=0.025, power=0.8, alternative="larger")
    found = needed(clause, trials, PLAN)
    assert found is not None
    assert found.people == pytest.approx(expected, abs=3)  # 33.4; 1% of power is one person
    assert (found.at_least or 0) <= (found.people or 0) <= (found.at_most or 0)


def test_people_for_a_difference_by_signed_ranks_are_a_twentieth_more_than_by_the_t_test() -> None:
    """The asymptotic relative efficiency on normal differences is 3 / pi."""
    gains = normal_scores(1.0, 2.0, 400)
    rows = [r for p, d in enumerate(gains) for r in ((p, "always", 20.0 + d, True), (p, "fetch", 20.0, True))]
    trials = checked(table(rows))
    clause = hypotheses(trials, PLAN)[0].clauses[2]
    expected = TTestPower().solve_power(effect_size=0.5, alpha=0.025, power=0.8, alternative="larger") * np.pi / 3
    found = needed(clause, trials, PLAN)
    assert found is not None
    assert found.people == pytest.approx(expected, abs=4)


def test_half_the_advantage_takes_four_times_the_people() -> None:
    gains = normal_scores(1.0, 1.5, 400)
    rows = [r for p, d in enumerate(gains) for r in ((p, "always", 20.0 + d, True), (p, "fetch", 20.0, True))]
    trials = checked(table(rows))
    clause = hypotheses(trials, PLAN)[0].clauses[2]
    whole, half = (needed(clause, trials, PLAN, effect) for effect in (1.0, 0.5))
    assert whole is not None
    assert half is not None
    assert whole.people is not None
    assert half.people is not None
    assert 3.2 < half.people / whole.people < 4.8


def test_the_same_seed_gives_the_same_answer_and_no_advantage_needs_more_than_there_are() -> None:
    trials = checked(drawn(8, 2))
    clauses = hypotheses(trials, Plan())[1].clauses
    assert needed(clauses[2], trials, Plan()) == needed(clauses[2], trials, Plan())
    none = needed(clauses[2], trials, replace(Plan(), most_people=64), effect=0.0)
    assert none is not None
    assert none.people is none.at_most is None
    assert max(one.chance for one in none.curve) < 0.06  # 2.5% is the level; eight persons are drawn again and again


def test_a_table_without_spread_has_no_answer_and_the_smallest_study_can_show_something() -> None:
    rows = [(p, name, 5.0, True) for p in range(3) for name in ("never", "always", "fetch")]
    trials = checked(table(rows))
    for clause in hypotheses(trials, Plan())[0].clauses:
        assert needed(clause, trials, Plan()) is None
    assert 0.5**FEWEST <= 0.025 < 0.5 ** (FEWEST - 1)

"""Tests of paired differences against enumeration, other libraries, and numbers worked by hand."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from statsmodels.stats.contingency_tables import mcnemar

from fetch_pomdp.study.analysis.signed_rank import (
    holm,
    no_worse,
    no_worse_by_ranks,
    no_worse_in,
    signed_rank,
    superior_in,
)

few = st.lists(st.integers(-4, 4).map(float), min_size=1, max_size=8)


def enumerated(values: list[float]) -> tuple[float, float, float]:
    """One-sided and two-sided p over all signs, and the rank-biserial correlation, from the definition."""
    kept = [value for value in values if value != 0]
    sizes = sorted(abs(value) for value in kept)
    ranks = [(2 * sizes.index(abs(v)) + sizes.count(abs(v)) + 1) / 2 for v in kept]
    total = sum(ranks)
    found = sum(rank for rank, value in zip(ranks, kept, strict=True) if value > 0)
    sums = [sum(r for r, sign in zip(ranks, signs, strict=True) if sign) for signs in product([0, 1], repeat=len(kept))]
    greater = sum(one >= found - 1e-9 for one in sums) / len(sums)
    away = sum(abs(one - total / 2) >= abs(found - total / 2) - 1e-9 for one in sums) / len(sums)
    return greater, away, (2 * found - total) / total


@given(values=few)
@settings(max_examples=60, deadline=None)
def test_signed_ranks_equal_enumeration(values: list[float]) -> None:
    found, greater = signed_rank(np.array(values)), signed_rank(np.array(values), "greater")
    if not any(values):
        assert found.p is None
        assert found.rank_biserial is None
        return
    one, two, effect = enumerated(values)
    assert greater.p == pytest.approx(one)
    assert found.p == pytest.approx(two)
    assert found.rank_biserial == pytest.approx(effect)


def test_a_table_worked_by_hand() -> None:
    # |d| 1 2 3 4 5, only the least is below 0: W+ = 14 of 15; as extreme among 32 signs: {15, 14} above, {0, 1} below
    found = signed_rank(np.array([2.0, -1.0, 3.0, 5.0, 4.0]))
    assert found.p == pytest.approx(4 / 32)
    assert found.rank_biserial == pytest.approx((14 - 1) / 15)


def test_signed_ranks_of_right_and_wrong_are_mcnemars_test() -> None:
    gained, lost, same = 21, 9, 114
    values = np.repeat([1.0, -1.0, 0.0], [gained, lost, same])
    expected = mcnemar([[same, lost], [gained, 0]], exact=False, correction=False).pvalue
    assert signed_rank(values).p == pytest.approx(expected)


def test_ties_but_for_rounding_are_ties() -> None:
    shares = np.array([1 / 18 - 2 / 18, 3 / 18 - 4 / 18, 7 / 18 - 8 / 18, 0.3 - 0.1 - 0.2])
    assert len(set(shares)) > 2
    assert signed_rank(shares).p == pytest.approx(2 / 8)


def test_no_worse_is_students_test_of_the_margin() -> None:
    gains = np.array([0.1, -0.3, 0.4, 0.2])
    t = (gains.mean() + 0.5) / (gains.std(ddof=1) / 2)
    assert no_worse(gains, 0.5) == pytest.approx(1 - stats.t.cdf(t, 3))
    assert no_worse_by_ranks(gains, 0.5) == pytest.approx(1 / 16)
    assert no_worse_by_ranks(gains, 0.2) == pytest.approx(2 / 16)  # -0.1 alone is below, and the least


def test_no_worse_agrees_with_the_end_of_the_interval() -> None:
    rng = np.random.default_rng(3)
    for _ in range(50):
        gains = rng.normal(0, 0.4, 8)
        low = stats.ttest_1samp(gains, 0).confidence_interval(0.95).low
        p = no_worse(gains, 0.3)
        assert p is not None
        assert (p <= 0.025) == (low >= -0.3)


@pytest.mark.parametrize("gains", [[0.0], [0.0, 0.0, 0.0], [0.1 + 0.2, 0.3]])
def test_persons_who_are_all_alike_cannot_be_tested(gains: list[float]) -> None:
    assert no_worse(np.array(gains), 0.5) is None


def test_holm_by_hand() -> None:
    assert holm([0.04, None, 0.01, 0.03]) == [pytest.approx(0.06), None, pytest.approx(0.03), pytest.approx(0.06)]
    assert holm([None, None]) == [None, None]
    assert holm([]) == []


def test_many_studies_at_once_are_as_one_by_one() -> None:
    studies = np.random.default_rng(4).normal(0.1, 0.3, (20, 60)).round(1)
    single = [stats.wilcoxon(study, alternative="greater", method="asymptotic").pvalue for study in studies]
    assert list(superior_in(studies)) == pytest.approx(single)
    assert list(no_worse_in(studies, 0.05)) == pytest.approx([no_worse(study, 0.05) for study in studies])


def test_studies_without_any_difference_show_nothing() -> None:
    studies = np.array([[0.0] * 8, [0.2] * 8])
    assert superior_in(studies)[0] == 1.0
    assert list(no_worse_in(studies, 0.1)) == [1.0, 1.0]

"""Intervals against other ways to compute them, and how often they cover the truth."""

from __future__ import annotations

import warnings

import numpy as np
import pandas
import pytest
import statsmodels.formula.api as smf
from scipy import stats

from fetch_pomdp.study.analysis import intervals
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.comparisons import compare
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from study_intervals import WAYS, cases
from tests.study.made import drawn


def test_the_interval_of_a_mean_by_hand() -> None:
    found = intervals.of_mean(np.array([1.0, 2.0, 3.0, 6.0]), 0.05)
    half = 3.182446305 * np.sqrt(14 / 3) / 2  # t of 3 degrees of freedom; squares 4 + 1 + 0 + 9
    assert (found.mean, found.low, found.high) == pytest.approx((3.0, 3.0 - half, 3.0 + half))


def test_it_is_the_interval_of_a_mixed_model() -> None:
    rng = np.random.default_rng(5)
    frame = pandas.DataFrame({"person": np.repeat(range(10), 12), "d": np.repeat(rng.normal(1, 1, 10), 12)})
    frame["d"] += rng.normal(0, 1, 120)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mixed = smf.mixedlm("d ~ 1", frame, groups="person").fit(reml=True)
    found = intervals.of_mean(frame.groupby("person")["d"].mean().to_numpy(), 0.05)
    assert found.mean == pytest.approx(mixed.params["Intercept"])
    assert found.high is not None
    half = found.high - found.mean
    assert half == pytest.approx(stats.t.ppf(0.975, 9) * mixed.bse["Intercept"], rel=1e-3)


def test_a_share_whose_persons_vary_as_coins_do_has_nearly_the_binomial_interval() -> None:
    people = np.random.default_rng(6).binomial(20, 0.9, 400) / 20
    found = intervals.of_share(people, 8000, 0.05)
    low, high = stats.binomtest(round(people.mean() * 8000), 8000).proportion_ci()
    assert (found.low, found.high) == pytest.approx((low, high), abs=0.001)


def test_a_share_by_hand() -> None:
    people = np.array([0.5, 0.9, 1.0, 0.8])  # mean 0.8, variance of the mean (0.09 + 0.01 + 0.04 + 0) / 3 / 4
    effective = 0.8 * 0.2 / (0.14 / 12) * (stats.t.ppf(0.975, 39) / stats.t.ppf(0.975, 3)) ** 2
    right, wrong = 0.8 * effective, 0.2 * effective
    expected = stats.beta.ppf(0.025, right, wrong + 1), stats.beta.ppf(0.975, right + 1, wrong)
    found = intervals.of_share(people, 40, 0.05)
    assert (found.low, found.high) == pytest.approx(expected)


@pytest.mark.parametrize(("share", "low", "high"), [(1.0, 0.025 ** (1 / 144), 1.0), (0.0, 0.0, 1 - 0.025 ** (1 / 144))])
def test_all_right_or_all_wrong_is_not_certainty(share: float, low: float, high: float) -> None:
    found = intervals.of_share(np.full(8, share), 144, 0.05)
    assert (found.low, found.high) == pytest.approx((low, high))


def test_one_person_or_persons_all_alike_have_no_interval_of_a_mean() -> None:
    assert intervals.of_mean(np.array([2.0]), 0.05) == intervals.Interval(2.0, None, None)
    assert intervals.of_mean(np.array([0.1 + 0.2, 0.3]), 0.05).low is None
    assert intervals.of_share(np.array([0.9]), 18, 0.05) == intervals.Interval(0.9, None, None)


def test_intervals_cover_the_truth_in_about_95_of_100_studies() -> None:
    """500 studies of eight persons; 95% of 500 has a standard error of 1 point, the tolerance is 3.

    The share's interval is conservative by construction, so that only its lower side is bounded; so is that of a
    difference of shares near 100%, which moves in steps.
    """
    rng = np.random.default_rng(7)
    hits: dict[tuple[str, str], list[bool]] = {}
    for _ in range(500):
        for name, truth, trials, ways in cases(8, rng):
            for way in {"Student, persons", "Korn-Graubard"}.intersection(ways):
                low, high = WAYS[way](trials, rng) or (np.nan, np.nan)
                hits.setdefault((name, way), []).append(bool(low <= truth <= high))
    covered = {case: float(np.mean(found)) for case, found in hits.items()}
    for name in ("time 9.16 - 8.57 s", "accuracy 93.7 - 82.6%"):
        assert covered[name, "Student, persons"] == pytest.approx(0.95, abs=0.03), name
    assert covered["accuracy 97.5 - 98.2%", "Student, persons"] > 0.92
    for name in ("accuracy 82.6%", "accuracy 97.5%"):
        assert covered[name, "Korn-Graubard"] > 0.93, name


def test_cells_and_comparisons_have_these_intervals() -> None:
    trials, plan = checked(drawn(8, 8)), Plan()
    row = compare(trials[trials["layout"] == "ambiguous"], "ambiguous", "never", "time", plan)
    mean = trials.groupby(["layout", "paradigm", "person"])["time"].mean()["ambiguous"]
    each = (mean["fetch"] - mean["never"]).to_numpy()
    expected = stats.ttest_1samp(each, 0).confidence_interval(0.95)
    assert (row.difference, row.low, row.high) == pytest.approx((each.mean(), expected.low, expected.high))
    cell = next(cell for cell in cells(trials, plan) if (cell.layout, cell.paradigm) == ("ambiguous", "fetch"))
    expected = stats.ttest_1samp(mean["fetch"], 0).confidence_interval(0.95)
    assert (cell.time_low, cell.time_high) == pytest.approx((expected.low, expected.high))
    assert (cell.people, cell.trials) == (8, 144)

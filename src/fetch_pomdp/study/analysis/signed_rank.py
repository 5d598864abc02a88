"""Tests of paired differences: Wilcoxon's signed ranks, margins, and the size of an effect."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.trials import DIGITS, Values, alike

EXACT = 13  # differences whose signs are all tried: 8,192 patterns
Alternative = Literal["two-sided", "greater", "less"]


@dataclass(frozen=True, slots=True)
class Signed:
    """Wilcoxon's signed-rank test of differences that are symmetric about 0 if there is no effect."""

    p: float | None  # None where no difference is left to rank
    rank_biserial: float | None  # from -1 to 1: share of rank sum above 0 less the share below (Kerby 2014)


def signed_rank(values: Values, alternative: Alternative = "two-sided") -> Signed:
    """Test differences; (n,) in any unit. Differences of 0 are dropped, as Wilcoxon did.

    Exact, over all signs, up to 13 differences, and up to 50 without ties; otherwise by the normal approximation.
    """
    rounded = np.round(values, DIGITS)
    kept = rounded[rounded != 0]
    if len(kept) == 0:
        return Signed(None, None)
    stats = load("scipy.stats", "study")
    ranks = stats.rankdata(np.abs(kept)) * np.sign(kept)
    p = _exact(ranks, alternative) if 1 < len(kept) <= EXACT else stats.wilcoxon(kept, alternative=alternative).pvalue
    return Signed(float(p), float(ranks.sum() / np.abs(ranks).sum()))


def _exact(ranks: Values, alternative: Alternative) -> float:
    """Return p over all signs of the ranks; SciPy's own test does the same one sign pattern at a time."""
    test = load("scipy.stats", "study").permutation_test
    found = test(
        (ranks,), np.sum, permutation_type="samples", vectorized=True, n_resamples=np.inf, alternative=alternative
    )
    return float(found.pvalue)


def no_worse(gains: Values, margin: float) -> float | None:
    """Return the one-sided p of "the mean gain is -margin or less", by Student's test over persons.

    gains: (n_people,) positive where the system is better. None for one person, or where all are alike.
    """
    if len(gains) < 2 or alike(gains):
        return None
    return float(load("scipy.stats", "study").ttest_1samp(gains, -margin, alternative="greater").pvalue)


def no_worse_by_ranks(gains: Values, margin: float) -> float | None:
    """Return the one-sided p of "gains are symmetric about -margin, or worse", by signed ranks; None for one person."""
    return signed_rank(gains + margin, "greater").p if len(gains) > 1 else None


def holm(raw: Sequence[float | None]) -> list[float | None]:
    """Return p after Holm's correction for the tests of one family; a test that could not be made (None) is no test."""
    made = [p for p in raw if p is not None]
    if not made:
        return list(raw)
    corrected = iter(load("statsmodels.stats.multitest", "study").multipletests(made, method="holm")[1])
    return [None if p is None else float(next(corrected)) for p in raw]


def superior_in(studies: Values) -> Values:
    """Return one-sided p of signed ranks for many studies at once; studies: (n_studies, n_people) gains."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a study of zeros only: its p becomes 1 below
        p = (
            load("scipy.stats", "study")
            .wilcoxon(np.round(studies, DIGITS), axis=1, alternative="greater", method="asymptotic")
            .pvalue
        )
    return np.asarray(np.nan_to_num(p, nan=1.0), float)


def no_worse_in(studies: Values, margin: float) -> Values:
    """Return one-sided p of `no_worse` for many studies at once; one whose persons are all alike shows nothing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        p = load("scipy.stats", "study").ttest_1samp(studies, -margin, axis=1, alternative="greater").pvalue
    return np.where(np.ptp(studies, axis=1) < 10.0**-DIGITS, 1.0, np.nan_to_num(p, nan=1.0))

"""Intervals of means that respect that the trials of a person are alike.

A person counts as one number, the mean of their trials; what varies between persons is what the interval shows. For a
balanced table that is the interval of a mixed model with an intercept and an effect for each person. It was chosen over
the bootstrap of persons and over generalised estimating equations because with eight persons both are too narrow (see
docs/analysis.md for the simulation).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.trials import Values, alike


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean with the ends of its interval, in the unit of the values; None where there can be no interval."""

    mean: float
    low: float | None
    high: float | None


def of_mean(people: Values, level: float) -> Interval:
    """Return the mean of persons' values with Student's interval of confidence 1 - level.

    people: (n_people,), n_people >= 1. There is no interval for one person, nor where all persons are alike.
    """
    mean = float(people.mean())
    if len(people) < 2 or alike(people):
        return Interval(mean, None, None)
    ends = load("scipy.stats", "study").ttest_1samp(people, 0.0).confidence_interval(1 - level)
    return Interval(mean, float(ends.low), float(ends.high))


def of_share(people: Values, trials: int, level: float) -> Interval:
    """Return a share of trials with the interval of Korn and Graubard (Survey Methodology 24, 1998).

    It is the exact binomial interval for as many independent trials as would vary like the persons do. people:
    (n_people,) shares of each person; trials: how many there were in all. There is no interval for one person.
    """
    share = float(people.mean())
    if len(people) < 2:
        return Interval(share, None, None)
    stats = load("scipy.stats", "study")
    variance = float(people.var(ddof=1)) / len(people)
    effective = float(trials)
    if not alike(people):
        few, many = (stats.t.ppf(1 - level / 2, count - 1) for count in (len(people), trials))
        effective = min(effective, share * (1 - share) / variance * (many / few) ** 2)
    confint = load("statsmodels.stats.proportion", "study").proportion_confint
    low, high = confint(share * effective, effective, alpha=level, method="beta")
    return Interval(share, 0.0 if math.isnan(low) else float(low), 1.0 if math.isnan(high) else float(high))

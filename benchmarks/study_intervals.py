"""How often intervals of a study cover the truth, and tests find what is not there (numbers of docs/analysis.md).

A simulated study: persons with 18 trials of each of two paradigms. The logarithm of a time has an offset of the person
(sd 0.15), one of the person with this paradigm (sd 0.05) and one of the trial (sd 0.3); a person is right with a chance
that is beta-distributed around the cell's with 30 pseudo-trials.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import statsmodels.api as sm
from numpy.random import Generator, default_rng
from scipy import stats

from fetch_pomdp.study.analysis import intervals
from fetch_pomdp.study.analysis.signed_rank import no_worse, no_worse_by_ranks, signed_rank

TRIALS, LEVEL = 18, 0.05
TIMES, SHARES = (9.16, 8.57), {"accuracy 93.7 - 82.6%": (0.937, 0.826), "accuracy 97.5 - 98.2%": (0.975, 0.982)}
Ends = tuple[float, float]
Ways = dict[str, Callable[[Any, Generator], Ends | None]]


def times(people: int, rng: Generator, levels: tuple[float, float] = TIMES) -> Any:
    """Draw (people, 18) differences of the times (s) of paired trials, with mean levels[0] - levels[1]."""
    offset = rng.normal(0, 0.15, (people, 1))
    sides = [
        mean * np.exp(offset + rng.normal(0, 0.05, (people, 1)) + rng.normal(0, 0.3, (people, TRIALS)))
        / np.exp((0.15**2 + 0.05**2 + 0.3**2) / 2)
        for mean in levels
    ]  # fmt: skip
    return sides[0] - sides[1]


def rights(mean: float, people: int, rng: Generator) -> Any:
    """Draw (people, 18) trials, 1 where the item was right, with mean `mean`."""
    chance = rng.beta(30 * mean, 30 * (1 - mean), (people, 1))
    return (rng.random((people, TRIALS)) < chance).astype(float)


def student(trials: Any, _: Generator) -> Ends | None:
    """Return Student's interval of persons."""
    found = intervals.of_mean(trials.mean(axis=1), LEVEL)
    return None if found.low is None or found.high is None else (found.low, found.high)


def share(trials: Any, _: Generator) -> Ends | None:
    """Return the interval of Korn and Graubard."""
    found = intervals.of_share(trials.mean(axis=1), trials.size, LEVEL)
    return None if found.low is None or found.high is None else (found.low, found.high)


def bootstrap(method: str) -> Callable[[Any, Generator], Ends | None]:
    """Return the bootstrap of persons by one of SciPy's methods."""

    def ends(trials: Any, rng: Generator) -> Ends | None:
        found = stats.bootstrap((trials.mean(axis=1),), np.mean, n_resamples=999, method=method, rng=rng)
        low, high = found.confidence_interval
        return None if np.isnan(low) else (float(low), float(high))

    return ends


def equations(cov_type: str) -> Callable[[Any, Generator], Ends | None]:
    """Return generalised estimating equations with an exchangeable correlation within a person."""

    def ends(trials: Any, _: Generator) -> Ends | None:
        if np.ptp(trials) == 0:
            return None
        groups = np.repeat(np.arange(len(trials)), trials.shape[1])
        model = sm.GEE(trials.ravel(), np.ones(trials.size), groups, cov_struct=sm.cov_struct.Exchangeable())
        low, high = model.fit(cov_type=cov_type).conf_int()[0]
        return float(low), float(high)

    return ends


def trialwise(trials: Any, _: Generator) -> Ends:
    """Return Student's interval of trials, as if they were independent."""
    low, high = stats.ttest_1samp(trials.ravel(), 0).confidence_interval()
    return float(low), float(high)


WAYS: Ways = {
    "Student, persons": student,
    "Korn-Graubard": share,
    "bootstrap, percentile": bootstrap("percentile"),
    "bootstrap, BCa": bootstrap("BCa"),
    "GEE, robust": equations("robust"),
    "GEE, bias-reduced": equations("bias_reduced"),
    "Student, trials": trialwise,
}


def cases(people: int, rng: Generator) -> Iterator[tuple[str, float, Any, list[str]]]:
    """Yield name, truth, trials and the ways that fit, for one simulated study."""
    others = [name for name in WAYS if name != "Korn-Graubard"]
    yield "time 9.16 - 8.57 s", TIMES[0] - TIMES[1], times(people, rng), others
    for name, (one, other) in SHARES.items():
        yield name, one - other, rights(one, people, rng) - rights(other, people, rng), others
    for mean in (0.826, 0.975):
        yield f"accuracy {100 * mean:.1f}%", mean, rights(mean, people, rng), list(WAYS)


def false_findings(people: int, rng: Generator) -> Iterator[tuple[str, bool]]:
    """Yield what each test finds in one study in which it should find nothing; two-sided 5%, one-sided 2.5%."""
    equal = {
        "time": times(people, rng, (9.0, 9.0)),
        "accuracy 89%": rights(0.89, people, rng) - rights(0.89, people, rng),
        "accuracy 98%": rights(0.98, people, rng) - rights(0.98, people, rng),
    }
    for name, trials in equal.items():
        for what, values in (("pairs", trials.ravel()), ("persons", trials.mean(axis=1))):
            yield f"{name}, no difference: signed ranks of {what}", (signed_rank(values).p or 1.0) <= LEVEL
    worse = {
        "time 0.5 s worse": (-times(people, rng, (9.0, 8.5)), 0.5),
        "accuracy 87 - 89%": (rights(0.87, people, rng) - rights(0.89, people, rng), 0.02),
        "accuracy 96 - 98%": (rights(0.96, people, rng) - rights(0.98, people, rng), 0.02),
    }
    for name, (trials, margin) in worse.items():
        gains = trials.mean(axis=1)
        for what, test in (("Student", no_worse), ("signed ranks", no_worse_by_ranks)):
            p = test(gains, margin)
            yield f"{name}: no worse by {what} of persons", p is not None and p <= LEVEL / 2


def covers(people: int, rng: Generator) -> Iterator[tuple[str, bool]]:
    """Yield whether each interval covers the truth in one study; no interval counts as not covering."""
    for name, truth, trials, ways in cases(people, rng):
        for way in ways:
            ends = WAYS[way](trials, rng)
            yield f"{name:24} {way}", ends is not None and ends[0] - 1e-12 <= truth <= ends[1] + 1e-12


def main() -> None:
    """Print the shares of simulated studies."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=1000)
    studies = parser.parse_args().studies
    warnings.simplefilter("ignore")
    for title, play in (("covered", covers), ("found though not there", false_findings)):
        for people in (8, 16):
            rng = default_rng(people)
            hits: dict[str, list[bool]] = {}
            for _ in range(studies):
                for name, hit in play(people, rng):
                    hits.setdefault(name, []).append(hit)
            for name, found in hits.items():
                print(f"{title}, {people:2} persons  {name:60} {100 * np.mean(found):5.1f}%")


if __name__ == "__main__":
    main()

"""Price lists: what our default planner trades of time for accuracy, against the paper's search.

A setting is the default planner with the scene's rewards scaled. Settings are searched with some people; the best one
is then checked with others.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.planners.catalogue import DEFAULT
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.comparisons import gains
from fetch_pomdp.study.analysis.hypotheses import Claims, Hypothesis, judged
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import MEASURES, Table, checked, differences
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.curves import sized
from fetch_pomdp.study.design import PAPER, Paradigm, Study
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.libraries import load
from fetch_pomdp.study.table import read_table

RUNS = "runs"
PAPERS, SYSTEM = "paper", "fetch"
MARGIN = 0.1  # s by which "no slower" may be slower: a tenth of a wait
WAITS, POINTS, WRONGS = (0.5, 1.0, 1.5, 2.0, 3.0), (0.5, 1.0, 2.0), (0.5, 1.0, 2.0, 4.0)


@dataclass(frozen=True, slots=True)
class Prices:
    """How many times the scene's price a wait, a question and a wrong pick cost."""

    wait: float
    point: float
    wrong: float

    @property
    def name(self) -> str:
        """Say what it is."""
        return f"wait x {self.wait:g}, point x {self.point:g}, wrong x {self.wrong:g}"

    @property
    def folder(self) -> str:
        """Return the name of the folder of its trials."""
        return f"wait-{self.wait:g}-point-{self.point:g}-wrong-{self.wrong:g}"

    def of(self, rewards: Rewards) -> dict[str, float]:
        """Return rewards that cost so many times as much, as changes."""
        return {"wait": self.wait * rewards.wait, "point": self.point * rewards.point,
                "pick_wrong": self.wrong * rewards.pick_wrong}  # fmt: skip


def grid(rewards: Rewards) -> Iterator[Prices]:
    """Yield the settings that are searched: all products of the factors where a question costs a wait or more."""
    for factors in itertools.product(WAITS, POINTS, WRONGS):
        prices = Prices(*factors)
        changed = prices.of(rewards)
        if changed["point"] <= changed["wait"]:
            yield prices


@dataclass(frozen=True, slots=True)
class Played:
    """A study, and the name of the folder of its trials."""

    folder: str
    study: Study


def rewards_of(study: Study) -> Rewards:
    """Return the rewards that settings scale: those of the study's first layout."""
    return next(iter(study.layouts.values())).rewards


def candidates(study: Study, trials: int) -> list[Played]:
    """Return the paper's paradigms, and a study of each setting, all with the same people."""
    rewards = rewards_of(study)
    settings = [(prices.folder, {prices.name: _setting(prices, rewards)}) for prices in grid(rewards)]
    return [
        Played(f"search/{folder}", sized(dataclasses.replace(study, paradigms=paradigms), trials))
        for folder, paradigms in [(PAPERS, PAPER), *settings]
    ]


def finalists(study: Study, name: str, trials: int) -> Played:
    """Return the study that checks a setting against the paper's search: other people, each of whom meets both."""
    rewards = rewards_of(study)
    prices = next(prices for prices in grid(rewards) if prices.name == name)
    paradigms = {SYSTEM: PAPER[SYSTEM], name: _setting(prices, rewards)}
    fresh = dataclasses.replace(study, seed=study.seed + 1, paradigms=paradigms)
    return Played(f"check/{prices.folder}", sized(fresh, trials))


def _setting(prices: Prices, rewards: Rewards) -> Paradigm:
    return Paradigm(planner=DEFAULT, rewards=prices.of(rewards))


def play(chosen: Sequence[Played], folder: Path, crew: Crew, told: Callable[[int], None] = lambda _: None) -> Table:
    """Play what is missing of studies, and return all their trials, checked.

    told: called with the number of trials on disk. Raises StudyError if the folder holds other studies.
    """
    done, tables = 0, []
    for one in chosen:
        place = folder / RUNS / one.folder
        run(one.study, place, crew, told=lambda count, before=done: told(before + count))  # type: ignore[misc]
        done += one.study.size
        tables.append(read_table(place))
    return checked(load("pandas").concat(tables, ignore_index=True))


def cell_table(trials: Table) -> Table:
    """Return the cells of a checked table as a DataFrame, with 95 % intervals."""
    return load("pandas").DataFrame([dataclasses.asdict(cell) for cell in cells(trials, Plan())])


def best(trials: Table) -> str | None:
    """Return the setting that is most likely to be no slower and more accurate than the paper's search everywhere.

    That is the one whose least gain, of time and accuracy in each layout, is the greatest in its standard errors over
    persons; None if no setting gains in all of them.
    """
    least = {name: _least_gain(trials, name) for name in trials["paradigm"].unique() if name not in PAPER}
    name = max(least, key=lambda one: least[one])
    return name if least[name] > 0.0 else None


def _least_gain(trials: Table, name: str) -> float:
    test = load("scipy.stats").ttest_1samp
    found = []
    for _, place in trials.groupby("layout"):
        for measure in MEASURES:
            people = gains(differences(place, name, SYSTEM, measure), measure).people
            found.append(float(test(people, 0.0).statistic) if people.any() else 0.0)
    return min(found)


def check(trials: Table, name: str) -> list[Hypothesis]:
    """Return "more accurate than the paper's search, and no slower", judged in each layout on fresh people."""
    plan = Plan(system=name, margin_time=MARGIN)
    claims: Claims = ((SYSTEM, "accuracy", "better"), (SYSTEM, "time", "no worse"))
    return [judged(layout, layout, claims, trials, plan) for layout in trials["layout"].unique()]

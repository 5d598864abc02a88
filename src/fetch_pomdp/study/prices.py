"""Price lists: what our default planner trades of time for accuracy, against the paper's search.

A setting is the default planner with the scene's rewards scaled. All settings meet the same people, the best few meet
others, and more of them; the best of these is then checked with people whom no search has seen.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.planners.catalogue import DEFAULT
from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.comparisons import gains
from fetch_pomdp.study.analysis.hypotheses import Claims, Hypothesis, judged
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.signed_rank import holm
from fetch_pomdp.study.analysis.trials import MEASURES, Table, alike, checked, differences
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.curves import sized
from fetch_pomdp.study.design import PAPER, Paradigm, Study
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.table import read_table

RUNS = "runs"
PAPERS, SYSTEM = "paper", "fetch"
MARGIN = 0.1  # s by which "no slower" may be slower: a tenth of a wait
SHORTLIST, SECOND = 6, 4  # settings of the second round, and how many times the trials of the first
MARGIN_ACCURACY = 0.005  # share of trials by which "as accurate" may be worse: one pick in 200
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


def second_round(study: Study, names: Sequence[str], trials: int) -> Played:
    """Return the study in which other people meet the settings of a shortlist, and more of them.

    The best of many settings owes something to luck; it does not have the same luck twice.
    """
    return Played("second", _against(study, names, SECOND * trials, study.seed + 1))


def final(study: Study, name: str, trials: int) -> Played:
    """Return the study that checks a setting: people whom no search has seen."""
    return Played("check", _against(study, [name], trials, study.seed + 2))


def _against(study: Study, names: Sequence[str], trials: int, seed: int) -> Study:
    """Return a study in which every person meets the paper's search and all these settings."""
    rewards = rewards_of(study)
    known = {prices.name: _setting(prices, rewards) for prices in grid(rewards)}
    paradigms = {SYSTEM: PAPER[SYSTEM], **{name: known[name] for name in names}}
    return sized(dataclasses.replace(study, seed=seed, paradigms=paradigms), trials)


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
    return checked(load("pandas", "study").concat(tables, ignore_index=True))


def cell_table(trials: Table) -> Table:
    """Return the cells of a checked table as a DataFrame, with 95 % intervals."""
    return load("pandas", "study").DataFrame([dataclasses.asdict(cell) for cell in cells(trials, Plan())])


def everywhere(trials: Table, name: str) -> float:
    """Return how clearly a setting is faster and more accurate than the paper's search in every layout.

    That is its least gain, of time or accuracy in a layout, in standard errors over persons.
    """
    return min(_gain(place, name, measure) for _, place in trials.groupby("layout") for measure in MEASURES)


def somewhere(trials: Table, name: str) -> float:
    """Return the same of: faster in every layout, in each as accurate by the margin, and in one of them more accurate.

    Where the paper's search makes no errors this is all that can be asked for.
    """
    places = [place for _, place in trials.groupby("layout")]
    as_accurate = [_gain(place, name, "accuracy", MARGIN_ACCURACY) for place in places]
    more_accurate = max(_gain(place, name, "accuracy") for place in places)
    return min(*(_gain(place, name, "time") for place in places), *as_accurate, more_accurate)


def ranked(trials: Table, score: Callable[[Table, str], float]) -> list[str]:
    """Return the settings of a checked table, the one with the highest score first."""
    scores = {name: score(trials, name) for name in trials["paradigm"].unique() if name not in PAPER}
    return sorted(scores, key=lambda one: scores[one], reverse=True)


def best(trials: Table, score: Callable[[Table, str], float]) -> str | None:
    """Return the setting with the highest score; None if none is above 0."""
    name = ranked(trials, score)[0]
    return name if score(trials, name) > 0.0 else None


def _gain(place: Table, name: str, measure: str, margin: float = 0.0) -> float:
    """Return the mean gain over the paper's search and a margin, in its standard errors over persons."""
    people = gains(differences(place, name, SYSTEM, measure), measure).people + margin
    if alike(people):
        return math.copysign(math.inf, people[0]) if people[0] else 0.0
    return float(load("scipy.stats", "study").ttest_1samp(people, 0.0).statistic)


def judge(name: str) -> Plan:
    """Return how a setting is judged against the paper's search."""
    return Plan(system=name, margin_time=MARGIN, margin_accuracy=MARGIN_ACCURACY)


def check(trials: Table, name: str) -> list[Hypothesis]:
    """Return what fresh people say of a setting against the paper's search, in each layout.

    The clauses are, in this order: no slower, as accurate, more accurate.
    """
    claims: Claims = (
        (SYSTEM, "time", "no worse"), (SYSTEM, "accuracy", "no worse"), (SYSTEM, "accuracy", "better"),
    )  # fmt: skip
    return [judged(layout, layout, claims, trials, judge(name)) for layout in trials["layout"].unique()]


def conclusion(checked: Sequence[Hypothesis]) -> str:
    """Return what a check comes to, in a sentence.

    Choice: a conclusion that needs all its clauses needs no correction for their number. "In one of them" leaves a
    choice of layout, so that there Holm's p over the layouts decides.
    """
    slower, as_accurate, more = zip(
        *([clause.verdict == "holds" for clause in one.clauses] for one in checked), strict=True
    )
    corrected = holm([one.clauses[2].p for one in checked])
    chosen = any(p is not None and p <= Plan().level / 2 for p in corrected)
    if all(slower) and all(more):
        return f"Shown with fresh people: no slower and more accurate than {SYSTEM} in every layout."
    if all(slower) and all(as_accurate) and chosen:
        return f"Shown with fresh people: no slower and as accurate as {SYSTEM} in every layout, more accurate in one."
    return f"Not shown with fresh people: no slower and more accurate than {SYSTEM}."

"""Price lists: settings by hand, the best one, and its check."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas
import pytest

from fetch_pomdp.core.model import Rewards
from fetch_pomdp.study import curve_plots, prices
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import PAPER, Study
from fetch_pomdp.study.prices import Prices
from tests.study.made import Cells, drawn
from tests.study.small import small

GOOD, HALF, WORSE = "good", "half", "worse"
MADE: Cells = {
    "ambiguous": {"fetch": (9.0, 0.85), GOOD: (8.0, 0.95), HALF: (7.0, 0.99), WORSE: (12.0, 0.95)},
    "unambiguous": {"fetch": (5.0, 0.85), GOOD: (4.5, 0.95), HALF: (4.0, 0.70), WORSE: (4.0, 0.95)},
}


def made(*names: str, people: int = 60, seed: int = 0) -> Any:
    kept = {layout: {name: cells[name] for name in ("fetch", *names)} for layout, cells in MADE.items()}
    return checked(drawn(people, seed, kept))


def test_prices_by_hand() -> None:
    setting = Prices(1.5, 0.5, 4.0)
    assert setting.of(Rewards()) == {"wait": -1.5, "point": -3.0, "pick_wrong": -50.0}
    assert setting.name == "wait x 1.5, point x 0.5, wrong x 4"
    assert Rewards().with_changes(setting.of(Rewards())).pick_correct == 10.0


def test_the_grid_holds_the_prices_that_can_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prices, "WAITS", (1.0, 3.0))
    monkeypatch.setattr(prices, "POINTS", (0.5, 1.0))
    monkeypatch.setattr(prices, "WRONGS", (1.0,))
    assert len(list(prices.grid(Rewards()))) == 4
    found = list(prices.grid(Rewards(point=-5.0)))  # three waits cost 3, half a question 2.5
    assert found == [Prices(1.0, 0.5, 1.0), Prices(1.0, 1.0, 1.0), Prices(3.0, 1.0, 1.0)]
    for setting in found:
        Rewards(point=-5.0).with_changes(setting.of(Rewards(point=-5.0)))


def test_candidates_meet_the_same_people_and_each_later_round_others() -> None:
    study = Study(seed=3)
    chosen = prices.candidates(study, 100)
    assert dict(chosen[0].study.paradigms) == PAPER
    assert {one.study.seed for one in chosen} == {3}
    assert {one.study.people for one in chosen} == {2 * 17}  # 100 trials of six items
    names = [Prices(1.0, 2.0, 4.0).name, Prices(1.0, 1.0, 1.0).name]
    again = prices.second_round(study, names, 250).study
    assert (again.seed, again.people, list(again.paradigms)) == (4, 2 * 167, ["fetch", *names])
    assert again.paradigms[names[0]].rewards == {"wait": -1.0, "point": -12.0, "pick_wrong": -50.0}
    last = prices.final(study, names[1], 100).study
    assert (last.seed, last.people, list(last.paradigms)) == (5, 2 * 17, ["fetch", names[1]])


def test_the_best_gains_in_both_measures_and_layouts() -> None:
    assert prices.ranked(made(GOOD, HALF, WORSE), prices.everywhere)[0] == GOOD
    assert prices.best(made(GOOD, HALF, WORSE), prices.everywhere) == GOOD
    assert prices.best(made(HALF, WORSE), prices.everywhere) is None
    assert prices.best(made(HALF, WORSE), prices.somewhere) is None


def test_where_there_are_no_errors_it_is_enough_to_be_as_accurate() -> None:
    perfect: Cells = {
        "ambiguous": {"fetch": (9.0, 0.85), GOOD: (8.0, 0.95), WORSE: (8.0, 0.85)},
        "unambiguous": {"fetch": (5.0, 1.0), GOOD: (4.5, 1.0), WORSE: (4.5, 0.97)},
    }
    trials = checked(drawn(60, 0, perfect))
    assert prices.best(trials, prices.everywhere) is None
    assert prices.best(trials, prices.somewhere) == GOOD


def test_a_check_says_what_is_shown_and_what_is_not() -> None:
    for name, verdicts, words in (
        (GOOD, {"ambiguous": ["holds"] * 3, "unambiguous": ["holds"] * 3}, "more accurate than fetch in every layout"),
        (HALF, {"ambiguous": ["holds"] * 3, "unambiguous": ["holds", "refuted", "refuted"]}, "Not shown"),
        (WORSE, {"ambiguous": ["refuted", "holds", "holds"], "unambiguous": ["holds"] * 3}, "Not shown"),
    ):
        found = prices.check(made(name, seed=1), name)
        assert {one.name: [clause.verdict for clause in one.clauses] for one in found} == verdicts
        assert words in prices.conclusion(found)


def test_as_accurate_everywhere_and_more_accurate_in_one_layout_is_said() -> None:
    nearly: Cells = {
        "ambiguous": {"fetch": (9.0, 0.85), GOOD: (8.0, 0.95)},
        "unambiguous": {"fetch": (5.0, 0.999), GOOD: (4.5, 0.999)},
    }
    found = prices.check(checked(drawn(150, 0, nearly)), GOOD)
    assert [clause.verdict for clause in found[1].clauses] == ["holds", "holds", "not shown"]
    assert prices.conclusion(found).endswith("as accurate as fetch in every layout, more accurate in one.")


def test_what_is_played_is_gone_on_with(tmp_path: Path) -> None:
    chosen = [prices.Played("a", small()), prices.Played("b/c", small(paradigms={"third": small().paradigms["sure"]}))]
    counts: list[int] = []
    trials = prices.play(chosen, tmp_path, Crew(), counts.append)
    assert len(trials) == counts[-1] == sum(one.study.size for one in chosen)
    again: list[int] = []
    assert prices.play(chosen, tmp_path, Crew(), again.append).equals(trials)
    assert again == [chosen[0].study.size, counts[-1]]
    table = prices.cell_table(trials)
    assert set(table["paradigm"]) == {"quick", "sure", "third"}
    assert int(table["trials"].sum()) == len(trials)


def test_the_frontier_by_hand() -> None:
    cells = pandas.DataFrame({"time": [4.0, 2.0, 3.0, 5.0, 2.0], "accuracy": [0.9, 0.6, 0.5, 0.9, 0.7]})
    assert list(curve_plots.frontier(cells).index) == [4, 0]


def test_a_plane_has_a_panel_a_layout() -> None:
    table = prices.cell_table(made(GOOD, HALF, people=8))
    figure = curve_plots.plane(table, GOOD, ["fetch"])
    assert [axis.get_title() for axis in figure.axes] == ["ambiguous", "unambiguous"]
    dots = figure.axes[0].get_lines()[0]
    ours = table[(table["layout"] == "ambiguous") & (table["paradigm"] != "fetch")]
    assert list(dots.get_xdata()) == pytest.approx(list(ours["time"]))

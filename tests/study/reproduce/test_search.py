from __future__ import annotations

import dataclasses
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.reproduce import search
from fetch_pomdp.study.reproduce.cells import Simulated, cell, loss, reduced, residuals, simulate
from fetch_pomdp.study.reproduce.files import write_fit
from fetch_pomdp.study.reproduce.free import Free, changed
from fetch_pomdp.study.reproduce.search import Fit, Objective, fit
from fetch_pomdp.study.reproduce.targets import Target, Targets
from fetch_pomdp.study.trial import Trial
from tests.study.small import small

OVERHEAD = Free(name="overhead", low=0.1, high=9.0, start=1.0, why="a test")
WORD = Free(name="word_time", low=0.1, high=1.0, start=0.2, why="a test")


def target(layout: str, paradigm: str, time: float, *, fitted: bool = True) -> Target:
    return Target(layout=layout, paradigm=paradigm, time=time, accuracy=(0.0, 100.0), fitted=fitted)


def tiny(*free: Free) -> Targets:
    """Two cells that a person of 0.5 s a word and an overhead of 2 s gives, with the people of seed 3."""
    wanted = (target("near", "quick", 0.0), target("far", "quick", 0.0))
    study = small(people=4)
    true = dataclasses.replace(reduced(changed(study, {"word_time": 0.5, "overhead": 2.0}), wanted, 4), seed=3)
    trials = simulate(true, Crew())
    cells = tuple(dataclasses.replace(one, time=cell(trials, one).time) for one in wanted)
    return Targets(cells=cells, trials=8, people=4, time_error=0.1, free=free, study=study)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "COARSE", 4)
    monkeypatch.setattr(search, "FINE", 4)


def test_cells_are_means_by_hand() -> None:
    rows = [(1, 2.0, True), (1, 4.0, False), (2, 6.0, True), (2, 8.0, True)]
    trials = [Trial(who, "near", "quick", "item-0", k, time, right, None, k, 0)
              for k, (who, time, right) in enumerate(rows)]  # fmt: skip
    other = dataclasses.replace(trials[0], paradigm="sure", time=99.0)
    found = cell([*trials, other], target("near", "quick", 0.0))
    assert (found.time, found.accuracy, found.questions) == (5.0, 75.0, 1.5)
    assert found.time_spread == pytest.approx(np.sqrt(8.0))  # of 3 and 7
    assert found.accuracy_spread == pytest.approx(np.sqrt(1250.0))  # of 50 and 100


def test_loss_by_hand_and_zero_at_the_targets() -> None:
    wanted = [
        Target(layout="a", paradigm="p", time=5.0, accuracy=(88.0, 92.0), fitted=True),
        Target(layout="b", paradigm="p", time=9.0, accuracy=(50.0, 50.0), fitted=True),
    ]
    at = [Simulated(5.0, 91.0, 0.0, 0.0, 0.0), Simulated(9.0, 50.0, 0.0, 0.0, 0.0)]
    assert loss(residuals(at, wanted, 0.5, 100)) == 0.0
    off = [Simulated(5.5, 86.0, 0.0, 0.0, 0.0), Simulated(8.0, 60.0, 0.0, 0.0, 0.0)]
    assert residuals(off, wanted, 0.5, 100) == pytest.approx([1.0, -2.0, -2 / 3, 2.0])
    assert loss(residuals(off, wanted, 0.5, 100)) == pytest.approx(1 + 4 + 4 / 9 + 4)


def test_the_overhead_is_solved_for() -> None:
    objective = Objective(tiny(OVERHEAD, WORD), 3, Crew())
    truth = np.log(0.5 / 0.1) / np.log(10.0)
    off, values = objective.at(np.array([1.0 + truth]), 4)
    assert values == pytest.approx({"word_time": 0.5, "overhead": 2.0})
    assert off == pytest.approx(np.zeros(4), abs=1e-9)


@pytest.mark.usefixtures("few")
def test_the_same_seed_gives_the_same_fit_and_a_better_one_than_the_start() -> None:
    targets = tiny(OVERHEAD, WORD)
    losses: list[float] = []
    found = fit(targets, 12, 3, told=lambda _, value: losses.append(value))
    assert fit(targets, 12, 3) == found
    assert found.evaluations == len(losses)
    assert found.loss in losses
    assert found.loss < losses[0] / 4
    assert 0.1 <= found.values["word_time"] <= 1.0


@pytest.mark.parametrize(("free", "budget", "field"), [((OVERHEAD,), 12, "free"), ((WORD,), 7, "budget")])
def test_a_search_that_cannot_be(free: tuple[Free, ...], budget: int, field: str) -> None:
    with pytest.raises(StudyError, match=f"^{field}: "):
        fit(tiny(*free), budget, 0)


def test_files_of_a_fit_are_read_back(tmp_path: Path) -> None:
    found = Fit(values={"word_time": 0.43217, "overhead": 2.5}, loss=3.0, evaluations=9)
    people, study = write_fit(tiny(OVERHEAD, WORD), found, tmp_path / "people.toml")
    assert tomllib.loads(people.read_text(encoding="utf-8")) == {"word_time": 0.4322}
    assert "a test" in people.read_text(encoding="utf-8")
    read = load_study(study)
    assert (read.population.word_time, read.clock.overhead, read.people) == (0.4322, 2.5, 4)
    with pytest.raises(StudyError, match="cannot be written"):
        write_fit(tiny(WORD), found, tmp_path / "missing" / "people.toml")

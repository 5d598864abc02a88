"""Robustness curves: what is varied, what the points hold, and what must get worse."""

from __future__ import annotations

import dataclasses
import math
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.errors import StudyError
from fetch_pomdp.study import curve_plots
from fetch_pomdp.study.alike import alike
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.curves import (
    CONDITIONS,
    CURVES,
    OFF,
    Point,
    points,
    sized,
    trace,
    with_default,
    with_population,
    with_spread,
    with_word_errors,
)
from fetch_pomdp.study.design import Paradigm, Study
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.record import NAME
from fetch_pomdp.study.table import read_table
from tests.study.small import row, small

ONCE = {"once": Paradigm(planner="one-shot")}


def test_word_errors_are_scaled_together() -> None:
    """By default 0.05 + 0.03 + 0.02: twice as many double each, and "yes" heard as "hand" 1 time in 10."""
    people = with_word_errors(People(), 0.2)
    assert (people.p_substitute, people.p_delete, people.p_insert) == pytest.approx((0.1, 0.06, 0.04))
    assert people.confusions["yes"]["hand"] == pytest.approx(0.1)
    assert people.p_miss == People().p_miss
    none = with_word_errors(People(), 0.0)
    assert none.p_substitute == none.p_delete == none.p_insert == 0.0
    assert {chance for heard in none.confusions.values() for chance in heard.values()} == {0.0}
    with pytest.raises(StudyError, match="population: found people whose words are never misheard"):
        with_word_errors(none, 0.1)
    with pytest.raises(StudyError, match=r"confusions\.yes: found chances of more than 1"):
        with_word_errors(People(), 2.0)


def test_a_spread_is_shared_as_before() -> None:
    before, people = People(), with_spread(People(), 0.1)
    assert math.sqrt(people.bias**2 + people.bias_episode**2 + people.jitter**2) == pytest.approx(0.1)
    assert people.bias / people.jitter == pytest.approx(before.bias / before.jitter)
    assert people.bias_episode / people.jitter == pytest.approx(before.bias_episode / before.jitter)
    with pytest.raises(StudyError, match="population: found people who point without error"):
        with_spread(dataclasses.replace(before, bias=0.0, bias_episode=0.0, jitter=0.0), 0.1)


def test_conditions_make_the_model_wrong_and_leave_the_rest() -> None:
    study = Study()
    changed = {name: change(study) for name, change in CONDITIONS.items()}
    assert changed["as it is"] == study
    for name, sigma in (("sigma doubled", 0.3), ("sigma halved", 0.075)):
        assert {scene.model.sigma for scene in changed[name].layouts.values()} == {sigma}
        assert changed[name].population == study.population
    assert changed["answers true 80 %"].population == dataclasses.replace(study.population, p_flip=0.2)
    assert changed["pointing off by 5 degrees"].layouts == study.layouts


def test_pointing_off_is_five_degrees_over_people() -> None:
    study = with_population(lambda people: dataclasses.replace(people, bias=0.0), Study())
    people = CONDITIONS["pointing off by 5 degrees"](study).population
    rng = default_rng(0)
    squares = np.array([np.square(people.traits(rng).bias).sum() for _ in range(4000)])
    assert squares.mean() == pytest.approx(OFF**2, abs=4 * squares.std() / math.sqrt(len(squares)))
    assert math.degrees(OFF) == pytest.approx(5.0)


def test_points_are_all_values_under_all_conditions() -> None:
    study = small(population=People(p_flip=0.1))
    chosen = list(points(study, ["items", "sigma"], 30))
    assert len({point.folder for point in chosen}) == len(chosen) == 5 * (7 + 6)
    for point in chosen:
        assert point.study.paradigms == study.paradigms
        assert point.study.seed == study.seed
        for layout, scene in point.study.layouts.items():
            for index, name in enumerate(point.study.layouts):
                if name == layout:
                    own = [person for person in range(point.study.people) if person % len(point.study.layouts) == index]
                    assert len(own) >= 8
                    assert len(own) * len(scene.items) >= 30
    crowd = next(p for p in chosen if (p.curve.name, p.condition, p.value) == ("items", "sigma halved", 50.0))
    assert {name: len(scene.items) for name, scene in crowd.study.layouts.items()} == {"alike": 50}
    assert crowd.study.layouts["alike"].model.sigma == 0.075
    with pytest.raises(StudyError, match="curve: found 'noise', expected one of speech, sigma, items"):
        list(points(study, ["noise"], 30))


def test_the_default_stands_beside_the_papers_paradigms_alone() -> None:
    assert list(with_default(Study()).paradigms) == ["never", "always", "fetch", "fitted"]
    assert with_default(small()) == small()


def test_a_size_is_reached_by_people() -> None:
    """45 trials of a table of two items take 23 people, of a table of three 15; two layouts take turns."""
    study = sized(small(people=2, trials=9), 45)
    assert (study.people, study.trials) == (46, 1)


def tiny() -> list[Point]:
    curve = CURVES["speech"]
    return [Point(curve, "as it is", value, curve.at(small(people=4), value)) for value in (0.0, 0.3)]


def test_curves_stopped_and_started_again_are_the_same(tmp_path: Path) -> None:
    whole: list[int] = []
    expected = trace(tiny(), tmp_path / "whole", Crew(), whole.append)
    assert whole == sorted(whole)
    assert whole[-1] == sum(point.study.size for point in tiny())

    class StoppedError(Exception):
        pass

    def stop(count: int) -> None:
        if count == tiny()[0].study.size + 3:
            raise StoppedError

    with pytest.raises(StoppedError):
        trace(tiny(), tmp_path / "again", Crew(), stop)
    rest: list[int] = []
    assert trace(tiny(), tmp_path / "again", Crew(), rest.append).equals(expected)
    assert rest == [tiny()[0].study.size, *range(tiny()[0].study.size + 3, whole[-1] + 1)]
    for point in tiny():
        one, other = (tmp_path / name / point.folder / NAME for name in ("whole", "again"))
        assert one.read_bytes() == other.read_bytes()


def test_a_row_is_a_cell_of_its_point(tmp_path: Path) -> None:
    table = trace(tiny(), tmp_path, Crew())
    assert len(table) == 2 * 4
    for line in table.itertuples():
        point = next(point for point in tiny() if point.value == line.value)
        trials = read_table(tmp_path / point.folder)
        own = trials[(trials["layout"] == line.layout) & (trials["paradigm"] == line.paradigm)]
        assert (line.curve, line.condition, line.trials) == ("speech", "as it is", len(own))
        assert line.accuracy == pytest.approx(own["correct"].mean())
        assert line.time == pytest.approx(own["time"].mean())


def test_misheard_words_and_loose_arms_cost_accuracy(tmp_path: Path) -> None:
    """Of 600 trials each; accuracy falls by more than 4 standard errors of a difference, at most 0.03 each."""
    speaking = Study(layouts={"row": row(3)}, paradigms=ONCE, population=People(p_point=0.0))
    pointing = Study(layouts={"row": alike(5)}, paradigms=ONCE)
    for name, base, values in (("speech", speaking, (0.0, 0.6)), ("sigma", pointing, (0.02, 0.3))):
        curve = CURVES[name]
        chosen = [Point(curve, "as it is", value, curve.at(sized(base, 600), value)) for value in values]
        good, bad = trace(chosen, tmp_path / name, Crew())["accuracy"]
        assert good - bad > 4 * 0.03, name


def test_a_picture_has_a_panel_a_condition_and_measure(tmp_path: Path) -> None:
    curve = CURVES["items"]
    change = partial(dataclasses.replace, people=2, trials=1)
    chosen = [
        Point(curve, condition, value, change(curve.at(small(), value)))
        for condition in ("as it is", "sigma doubled")
        for value in (2.0, 3.0)
    ]
    table = trace(chosen, tmp_path, Crew())
    figure = curve_plots.curve(table, curve)
    assert len(figure.axes) == 2 * 2
    for axis in figure.axes:
        assert [line.get_label() for line in axis.get_lines()] == ["quick", "sure"]
        assert [list(line.get_xdata()) for line in axis.get_lines()] == [[2.0, 3.0]] * 2
    accuracy = table[(table["condition"] == "as it is") & (table["paradigm"] == "sure")]["accuracy"]
    assert list(figure.axes[0].get_lines()[1].get_ydata()) == pytest.approx(list(100 * accuracy))

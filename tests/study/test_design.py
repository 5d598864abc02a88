"""The design is balanced, and every random number has its place."""

from __future__ import annotations

import dataclasses
from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.errors import InputError, ModelError, PlannerError, StudyError
from fetch_pomdp.study.design import ORDER, PERSON, ROBOT, WORLD, Paradigm, Study, assignments, stream
from tests.study.small import PARADIGMS, row, small


@given(
    people=st.integers(1, 7), trials=st.integers(1, 3), seed=st.integers(0, 2**63 - 1),
    sizes=st.lists(st.integers(1, 4), min_size=1, max_size=3), robots=st.integers(1, 3),
)  # fmt: skip
def test_every_item_comes_equally_often_with_every_paradigm(
    people: int, trials: int, seed: int, sizes: list[int], robots: int
) -> None:
    layouts = {f"layout-{index}": row(size) for index, size in enumerate(sizes)}
    paradigms = {f"robot-{index}": Paradigm(planner="paper-always") for index in range(robots)}
    study = Study(people=people, trials=trials, seed=seed, layouts=layouts, paradigms=paradigms)
    found = list(assignments(study))
    assert len(found) == study.size
    assert [row.person for row in found] == sorted(row.person for row in found)
    of_layouts: Counter[str] = Counter()
    for person in range(people):
        own = [row for row in found if row.person == person]
        (layout,) = {row.layout for row in own}
        of_layouts[layout] += 1
        assert [row.order for row in own] == list(range(len(own)))
        counts = Counter((row.paradigm, row.desired) for row in own)
        expected = {(robot, item.id): trials for robot in paradigms for item in layouts[layout].items}
        assert counts == expected
    numbers = [of_layouts[name] for name in layouts]
    assert max(numbers) - min(numbers) <= 1


def test_the_default_is_the_studys_of_the_paper() -> None:
    study = Study()
    found = list(assignments(study))
    assert len(found) == study.size == 16 * 54
    assert Counter(row.layout for row in found) == {"ambiguous": 8 * 54, "unambiguous": 8 * 54}
    assert Counter(row.paradigm for row in found) == dict.fromkeys(("never", "always", "fetch"), 16 * 18)
    assert study.header(found[0]).agent().planner is not None


def test_orders_differ_between_persons_and_seeds_and_cover_all_places() -> None:
    """The paradigm of a person's first trial is each of three equally often: 600 draws, within 4 standard errors."""
    study = Study(people=600)
    first = Counter(row.paradigm for row in assignments(study) if row.order == 0)
    for count in first.values():
        assert abs(count - 200) < 4 * (600 * 1 / 3 * 2 / 3) ** 0.5
    assert list(assignments(Study())) == list(assignments(Study()))
    assert list(assignments(Study())) != list(assignments(Study(seed=1)))


def test_more_people_change_nothing_about_those_before() -> None:
    few, many = list(assignments(small(people=2))), list(assignments(small(people=5)))
    assert many[: len(few)] == few


def test_no_two_streams_are_the_same() -> None:
    """Places with trailing zeros included, which seed sequences otherwise pad into one another."""
    studies = (small(seed=0), small(seed=1), small(seed=2**32))
    places: list[tuple[int, ...]] = [(use, person) for use in (PERSON, ORDER) for person in (0, 1, 2)]
    places += [(use, person, order) for use in (WORLD, ROBOT) for person in (0, 1, 2) for order in (0, 1)]
    drawn = [int(stream(study, *place).integers(2**63)) for study in studies for place in places]
    assert len(set(drawn)) == len(drawn)


def test_a_paradigm_has_beliefs_and_prices_of_its_own() -> None:
    patient = Paradigm(planner="paper-always", rewards={"wait": -0.5}, model={"sigma": 0.3})
    study = small(paradigms={**PARADIGMS, "patient": patient})
    assert study.scene("near", "patient").rewards.wait == -0.5
    assert study.scene("near", "patient").model.sigma == 0.3
    assert study.scene("near", "quick") == study.layouts["near"]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"people": 0}, "people"),
        ({"people": True}, "people"),
        ({"trials": 1.5}, "trials"),
        ({"seed": -1}, "seed"),
        ({"logs": 1}, "logs"),
        ({"real_speech": "yes"}, "real_speech"),
        ({"layouts": {}}, "layouts"),
        ({"paradigms": {}}, "paradigms"),
    ],
)
def test_a_wrong_study_is_refused_by_field(changes: dict[str, object], field: str) -> None:
    with pytest.raises(StudyError) as refused:
        dataclasses.replace(small(), **changes)  # type: ignore[arg-type]
    assert refused.value.field == field


def test_a_paradigm_is_refused_for_what_it_cannot_do() -> None:
    with pytest.raises(PlannerError, match="expected one of"):
        Paradigm(planner="best")
    with pytest.raises(PlannerError, match="unknown parameter"):
        Paradigm(planner="sparse", parameters={"deep": 2})
    with pytest.raises(StudyError, match="budget of time"):
        Paradigm(planner="fitted", parameters={"budget_ms": 5.0})
    with pytest.raises(ModelError) as refused:
        small(paradigms={"odd": Paradigm(planner="paper-always", model={"sigmas": 1.0})})
    assert isinstance(refused.value, InputError)
    assert refused.value.field == "paradigms.odd.model.sigmas"

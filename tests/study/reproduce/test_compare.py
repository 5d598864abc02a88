from __future__ import annotations

import dataclasses
import itertools

import pytest

from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import Paradigm
from fetch_pomdp.study.reproduce import compare as module
from fetch_pomdp.study.reproduce.cells import Simulated
from fetch_pomdp.study.reproduce.compare import Comparison, Held, Row, compare
from fetch_pomdp.study.reproduce.free import changed
from fetch_pomdp.study.reproduce.stories import STORIES, tell
from fetch_pomdp.study.reproduce.targets import Target, Targets
from fetch_pomdp.study.reproduce.words import markdown
from tests.study.small import row, small

SURE = Paradigm(planner="paper-always", parameters={"confidence": 0.9})
QUICK = Paradigm(planner="threshold", parameters={"pick": 0.8})
STUDY = small(
    layouts={"ambiguous": row(2), "unambiguous": row(3)},
    paradigms={"never": QUICK, "always": SURE, "fetch": QUICK},
)


def targets() -> Targets:
    cells = tuple(
        Target(layout=layout, paradigm=paradigm, time=5.0, accuracy=(88.0, 92.0), fitted=paradigm != "always")
        for layout in ("ambiguous", "unambiguous")
        for paradigm in ("never", "always", "fetch")
    )
    return Targets(cells=cells, trials=100, people=2, time_error=0.5, free=(), study=STUDY)


def test_rows_and_clauses_of_a_comparison() -> None:
    found = compare(targets(), STUDY, 2, 0)
    assert [one.target for one in found.rows] == list(targets().cells)
    for one in found.rows:
        assert one.time_off == pytest.approx((one.ours.time - 5.0) / 0.5)
        assert one.accuracy_off * 3.0 == pytest.approx(one.target.accuracy_off(one.ours.accuracy))
    assert [(held.hypothesis, held.studies) for held in found.clauses] == [("H1", 2)] * 4 + [("H2", 2)] * 4
    assert all(0 <= count <= 2 for held in found.clauses for count in (held.people, held.pairs))
    assert found.clauses[0].people <= found.clauses[0].studies


def test_studies_are_made_of_persons_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[list[int]] = []

    def judged(parts: list[list[object]]) -> tuple[Held, ...]:
        seen.extend(sorted({trial.person for trial in part}) for part in parts)  # type: ignore[attr-defined]
        return ()

    monkeypatch.setattr(module, "_held", judged)
    compare(targets(), STUDY, 2, 0)
    assert seen == [[0, 1, 2, 3], [4, 5, 6, 7]]


def test_text_of_a_comparison_by_hand() -> None:
    never, always = targets().cells[:2]
    rows = (
        Row(never, Simulated(5.25, 90.0, 0.5, 1.0, 1.0), 0.5, 0.0),
        Row(always, Simulated(3.5, 98.0, 1.25, 1.0, 1.0), -3.0, 2.1),
    )
    text = markdown(Comparison(rows, (Held("H1", "fetch is quick", 40, 12, 31),)))
    assert "| ambiguous | never | 5.00 | 5.25 | +0.5 | 88.0 to 92.0 | 90.0 | +0.0 | 0.50 | fitted |" in text
    assert "| ambiguous | always | 5.00 | 3.50 | -3.0 | 88.0 to 92.0 | 98.0 | +2.1 | 1.25 | predicted |" in text
    assert "| H1 | fetch is quick | 12 of 40 | 31 of 40 |" in text
    assert text.count("Does not fit") == 1
    assert "always, ambiguous (predicted): 1.50 s too fast; 6.0 points too accurate." in text
    assert markdown(Comparison(rows[:1], ())).endswith("Every cell is within 2 standard errors.")


def test_stories_are_of_the_same_people_but_for_their_error() -> None:
    outcomes = list(itertools.islice(tell(targets(), STUDY, 2, 0, Crew()), 5))
    assert [outcome.strength for outcome in outcomes] == [*STORIES[0].tried, STORIES[1].tried[0]]
    assert len({outcome.cells[0].time for outcome in outcomes[:4]}) == 1  # who does not ask is not answered wrongly
    honest = dataclasses.replace(STUDY.population, p_flip=0.0)
    flipped = next(iter(tell(targets(), dataclasses.replace(STUDY, population=honest), 2, 0)))
    assert flipped.cells == outcomes[0].cells  # the story sets the strength, whoever the people were


@pytest.mark.parametrize("story", STORIES, ids=lambda story: story.name)
def test_a_story_is_a_study(story: object) -> None:
    found = next(one for one in STORIES if one is story)
    for strength in found.tried:
        told = changed(STUDY, found.changes(STUDY.population, strength))
        assert (told != STUDY) or strength in (STUDY.population.reading, STUDY.population.p_late)

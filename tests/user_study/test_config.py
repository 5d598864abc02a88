"""A study with people as its file says it: complete, or refused where it is wrong."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.live.person import LIVE_MODEL
from fetch_pomdp.errors import InputError
from fetch_pomdp.user_study.config import UserStudy, load_user_study, template
from tests.user_study.small import STUDY, small_study


@pytest.fixture
def paper(tmp_path: Path) -> UserStudy:
    path = tmp_path / "paper.toml"
    path.write_text(template())
    return load_user_study(path)


def test_the_template_is_the_paper_s_design_with_live_people(paper: UserStudy) -> None:
    assert (paper.name, paper.people, paper.practice, paper.countdown, paper.keep_sound) == ("paper", 16, 2, 3.0, False)
    for person in (0, 1):
        trials = paper.trials(person)
        assert [trial.order for trial in trials] == list(range(54))
        assert set(Counter((trial.target, trial.paradigm) for trial in trials).values()) == {3}
        assert {(trial.person, trial.begun) for trial in trials} == {(person, 0.0)}
        assert {trial.scene.model for trial in trials} == {LIVE_MODEL}
    assert {paper.trials(person)[0].layout for person in (0, 1)} == {"ambiguous", "unambiguous"}
    assert paper.trials(0)[0].scene_name == "ambiguous"


@pytest.mark.parametrize(
    "paradigms", ["", '[paradigms]\nfetch = {planner = "sparse", model = {turns = false, p_l = 0.95, p_g = 0.1}}']
)
def test_the_robot_that_fetches_asks_who_has_said_too_little(tmp_path: Path, paradigms: str) -> None:
    """Not so the paper's search at a live table's p_l: it would pick at random, or wait for ever."""
    path = tmp_path / "mine.toml"
    path.write_text(f'{paradigms}\n[participation]\ntitle = {{en = "Mine"}}\nconsent = {{en = "Yours?"}}')
    trial = next(each for each in load_user_study(path).trials(0) if each.paradigm == "fetch")
    agent = trial.agent(seed=0)
    agent.observe("hand me the green marker pen")
    assert trial.layout == "ambiguous"
    assert isinstance(agent.act(), Point)


def test_the_open_question_comes_before_what_might_lead_its_answer(paper: UserStudy) -> None:
    assert [(question.id, question.kind) for question in paper.questions if question.page == 1] == [
        ("understood", "text")
    ]
    kinds = next(question for question in paper.questions if question.id == "understood_kinds")
    assert (kinds.page, kinds.kind) == (2, "choices")
    assert {"pointing", "names", "prepositions"} <= {option.id for option in kinds.options}
    for question in paper.questions:
        for texts in (question.text, *(option.text for option in question.options)):
            assert texts.keys() == {"en", "de"}


def test_practice_is_drawn_for_each_person_and_the_same_again(paper: UserStudy) -> None:
    drawn = {person: paper.practice_trials(person) for person in range(8)}
    assert drawn[3] == paper.practice_trials(3)
    assert len({tuple((trial.target, trial.paradigm) for trial in trials) for trials in drawn.values()}) > 4
    seeds = [trial.seed for trials in drawn.values() for trial in trials]
    assert len({*seeds, *(trial.seed for trial in paper.trials(0))}) == len(seeds) + 54


def test_wordings_may_change_and_nothing_else(tmp_path: Path) -> None:
    def digest(old: str, new: str) -> str:
        assert old in STUDY
        return load_user_study(small_study(tmp_path, STUDY.replace(old, new))).digest

    same = digest("people = 2", "people = 2")
    assert digest("You talk to a robot.", "You talk to this robot.") == same
    assert digest("What did it understand?", "What did it grasp?") == same
    simulated = "people = 2\nlogs = true\n[clock]\nwait = 0.7\n"
    assert load_user_study(small_study(tmp_path, moved(simulated))).digest == same, "of simulated people alone"
    changes = [
        ("trials = 1", "trials = 2"), ("practice = 1", "practice = 2"), ("0.1", "0.2"),
        ('id = "ease"', 'id = "effort"'), ("required = false", "required = true"),
        ('kind = "scale"\npage = 2', 'kind = "scale"\npage = 3'),
    ]  # fmt: skip
    assert len({same, *(digest(old, new) for old, new in changes)}) == 7


def moved(front: str) -> str:
    """The study with other fields before the first of its tables."""
    return STUDY.replace("people = 2\n", "").replace("[paradigms]", f"{front}[paradigms]")


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("[participation]", "[people_take_part]", "people_take_part: unknown field"),
        ('title = {en = "Fetching", de = "Holen"}', "", "participation.title: found no such field"),
        ('consent = {en = "You talk to a robot.", ', "consent = {", "participation.consent.en: found no such field"),
        ('de = "Holen"', 'fr = "Apporter"', "participation.title.fr: unknown language"),
        ("practice = 1", "practice = -1", "participation.practice: found -1"),
        ("countdown = 0.1", "countdown = 61", "participation.countdown: found 61"),
        ("keep_sound = true", 'keep_sound = "yes"', "participation.keep_sound: found 'yes'"),
        ('kind = "scale"', 'kind = "stars"', "participation.questions[2].kind: found 'stars'"),
        ('[{en = "hard"}, {en = "easy"}]', '[{en = "hard"}]', "participation.questions[2].options: found 1"),
        ('{id = "places", en', '{id = "names", en', "participation.questions[1].options: found names, names"),
        ('id = "ease"', 'id = "open"', "participation.questions: found 'open' twice"),
        ("required = false", "required = 0", "participation.questions[1].required: found 0"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(tmp_path: Path, old: str, new: str, complaint: str) -> None:
    assert old in STUDY
    with pytest.raises(InputError) as found:
        load_user_study(small_study(tmp_path, STUDY.replace(old, new)))
    assert f"{tmp_path / 'small.toml'}:" in str(found.value)
    assert complaint in str(found.value)

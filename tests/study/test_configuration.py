"""A study's file: what it says, and one clear line for what it cannot say."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import pytest

from fetch_pomdp.core.language.phrases import Answers
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import InputError
from fetch_pomdp.study.configuration import difference, digest, load_study, to_plain
from fetch_pomdp.study.design import PAPER, Paradigm, Study
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People

WHOLE = """
people = 4
trials = 2
seed = 7
logs = true
layouts = ["unambiguous", "kitchen.toml"]
population = "people.toml"

[model]
sigma = 0.2

[rewards]
point = -5.0

[clock]
speak = 0.5

[paradigms]
never = "paper-never"

[paradigms.deep]
planner = "sparse"
depth = 3
rewards = {wait = -0.5}
"""
KITCHEN = """
head = [0, 0, 1.6]
[[items]]
id = "mug"
position = [0, 1, 0.75]
vocabulary = ["mug"]
[[items]]
id = "whisk"
position = [0.3, 1, 0.75]
vocabulary = ["whisk"]
[rewards]
pick_wrong = -20.0
"""


def written(folder: Path, text: str) -> Path:
    (folder / "kitchen.toml").write_text(KITCHEN)
    (folder / "people.toml").write_text("patience = 5.0\n")
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


def test_a_file_says_all_that_a_study_is(tmp_path: Path) -> None:
    study = load_study(written(tmp_path, WHOLE))
    assert (study.people, study.trials, study.seed, study.logs) == (4, 2, 7, True)
    assert list(study.layouts) == ["unambiguous", "kitchen"]
    assert study.population == People(patience=5.0)
    assert study.clock == Durations(speak=0.5)
    assert study.paradigms == {
        "never": Paradigm(planner="paper-never"),
        "deep": Paradigm(planner="sparse", parameters={"depth": 3}, rewards={"wait": -0.5}),
    }
    scene = study.scene("kitchen", "deep")
    assert (scene.model.sigma, scene.rewards.point, scene.rewards.pick_wrong, scene.rewards.wait) == (
        0.2,
        -5,
        -20,
        -0.5,
    )
    assert study.scene("kitchen", "never").rewards.wait == -1.0


def test_an_empty_file_is_the_papers_study(tmp_path: Path) -> None:
    study = load_study(written(tmp_path, ""))
    assert study == Study()
    assert study.paradigms == PAPER
    assert study.layouts["ambiguous"] == Scene.load("ambiguous")


def test_the_default_people_and_clock_are_those_fitted_to_the_paper() -> None:
    assert load_study(Path(__file__).parents[2] / "studies" / "fitted.toml") == Study()


def test_the_file_in_the_documentation_is_the_papers_study_and_a_robot_more(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "study.md").read_text()
    (block,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    study = load_study(written(tmp_path, block))
    assert set(study.paradigms) - set(PAPER) == {"ours"}
    assert dataclasses.replace(study, paradigms=PAPER) == Study()
    load_study(written(tmp_path, re.sub("^# ", "", block, flags=re.MULTILINE)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("peeple = 3", "study.toml:1: peeple: unknown field, expected one of people, .*did you mean 'people'"),
        ("\npeople = 0", "study.toml:2: people: found 0, expected a whole number from 1"),
        ("trials = 1.5", "study.toml:1: trials: found 1.5"),
        ("layouts = []", "study.toml:1: layouts: found none"),
        ("layouts = 'ambiguous'", "study.toml:1: layouts: found 'ambiguous', expected a list"),
        ("layouts = ['ambiguous', 'ambiguous']", "study.toml:1: layouts: found 'ambiguous' twice"),
        ("layouts = ['table.toml']", "study.toml:1: layouts: .*table.toml: cannot be read"),
        ("population = 'kitchen.toml'", "study.toml:1: population: .*kitchen.toml:2: head: unknown parameter"),
        ("[model]\nsigmas = 1", "study.toml:2: model.sigmas: unknown parameter"),
        ("[rewards]\nwait = 1.0", "study.toml:2: rewards.wait: found 1.0"),
        ("[clock]\nspeek = 1.0", "study.toml:2: clock.speek: unknown time"),
        ("[clock]\nspeak = -1", "study.toml:2: clock.speak: found -1, expected seconds"),
        ("[clock]\nthink = 0\nwait = 0", "study.toml:1: clock.timing: .*0 < wait"),
        ("[paradigms]\na = 3", "study.toml:2: paradigms.a: found 3"),
        ("[paradigms.a]\ndepth = 3", "study.toml:1: paradigms.a.planner: found no such field"),
        ("[paradigms]\na = 'best'", "study.toml:2: paradigms.a.planner: found 'best', expected one of"),
        ("[paradigms.a]\nplanner = 'sparse'\ndepth = 0", "study.toml:3: paradigms.a.depth: found 0"),
        ("[paradigms.a]\nplanner = 'always'\nmodel = {sigma = 9}", "study.toml:3: paradigms.a.model.sigma: found 9"),
        ("people = [", "study.toml:1: broken TOML"),
        ("reader = 'lips'", "study.toml:1: reader: found 'lips', expected words, table"),
    ],
)
def test_what_a_file_cannot_say_is_answered_in_one_line(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message) as refused:
        load_study(written(tmp_path, text))
    assert "\n" not in str(refused.value)


def changes() -> dict[str, dict[str, Any]]:
    study = Study()
    return {
        "people": {"people": 17},
        "population.patience": {"population": People(patience=6.9)},
        "population.grammar": {"population": dataclasses.replace(Study().population, grammar="reader")},
        "population.p_unknown": {"population": dataclasses.replace(Study().population, p_unknown=0.1)},
        "reader": {"reader": "table"},
        "clock.arm": {"clock": dataclasses.replace(Study().clock, arm=1.1)},
        "paradigms.fetch.parameters.depth": {
            "paradigms": {**PAPER, "fetch": Paradigm(planner="sparse", parameters={"depth": 3})}
        },
        "layouts.ambiguous.model.sigma": {
            "layouts": {
                **study.layouts,
                "ambiguous": dataclasses.replace(
                    study.layouts["ambiguous"], model=study.layouts["ambiguous"].model.with_changes({"sigma": 0.16})
                ),
            }
        },
        "layouts.ambiguous.answers": {
            "layouts": {
                **study.layouts,
                "ambiguous": dataclasses.replace(study.layouts["ambiguous"], answers=Answers(yes=("aye",))),
            }
        },
        "layouts in another order": {"layouts": dict(reversed(list(study.layouts.items())))},
    }


def test_a_study_without_answers_of_its_own_has_the_digest_it_had_before_there_were_any() -> None:
    """Of the paradigms under the names they had then: "never" and "always" were the paper's."""
    paradigms = {
        name: Paradigm(planner=planner)
        for name, planner in (("never", "never"), ("always", "always"), ("fetch", "sparse"))
    }
    assert digest(to_plain(Study(paradigms=paradigms))) == "c1e73b0dea78d70a"


@pytest.mark.parametrize("place", changes())
def test_every_change_of_a_study_shows(place: str) -> None:
    before, after = to_plain(Study()), to_plain(dataclasses.replace(Study(), **changes()[place]))
    assert digest(before) != digest(after)
    assert (difference(before, after) or "").startswith(place)
    assert difference(before, to_plain(Study())) is None
    assert digest(before) == digest(to_plain(Study()))

"""Turn-taking: phases by hand and against the oracle, chances by their names, and what is no turn-taking."""

from __future__ import annotations

import dataclasses
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.model import Model
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import Interactions, played_out
from fetch_pomdp.core.turns import NO, SILENT, YES, Turns, phases_of
from fetch_pomdp.errors import InputError, ModelError
from tests.oracles.talking import ANSWERS, Person, Step, Talk, all_talks, answer_chance, group, talk_after

LISTS = [field.name for field in dataclasses.fields(Turns) if field.name not in ("patience", "question")]
SHORT = Turns(patience=3, question=2)
WAIT, ASK = 0, 1


def numbered(patience: int) -> Turns:
    """Turns in which no two chances are the same."""
    numbers = itertools.count(1)
    chances = {name: tuple(next(numbers) / 50 for _ in getattr(Turns(), name)) for name in LISTS}
    return Turns(patience=patience, question=2).with_changes(chances)


# With a patience of 3 steps the talks are 0 unbegun, 1 pointed, 2 due, 3 to 6 heard from one who pointed, and 7 to 10
# from one who did not; a phase is four times that, plus 0 no question, 1 denied, 2 open, 3 open for long.


@pytest.mark.parametrize(
    ("phase", "action", "words", "pointing", "answer", "expected"),
    [
        (0, WAIT, 0, 0, SILENT, 0),  # nothing, and nothing has begun
        (0, WAIT, 0, 1, SILENT, 4),
        (0, WAIT, 1, 1, SILENT, 12),
        (0, WAIT, 1, 0, SILENT, 28),  # words of one who has not pointed
        (0, ASK, 0, 0, SILENT, 2),  # a question to somebody who has not begun
        (0, ASK, 1, 1, YES, 12),
        (4, WAIT, 0, 0, SILENT, 8),  # pointed and said nothing: words are due
        (4, WAIT, 0, 1, SILENT, 8),
        (4, WAIT, 1, 0, SILENT, 12),
        (8, WAIT, 0, 0, SILENT, 8),
        (8, ASK, 0, 1, SILENT, 10),
        (8, WAIT, 1, 0, SILENT, 12),
        (12, WAIT, 0, 0, SILENT, 16),  # one quiet step
        (12, ASK, 0, 0, SILENT, 22),  # a question counts for two
        (16, ASK, 0, 0, NO, 25),  # 1 + 2 quiet steps, and denied
        (20, ASK, 0, 0, SILENT, 26),  # never more than the patience
        (20, WAIT, 1, 1, SILENT, 12),
        (24, WAIT, 0, 0, SILENT, 24),
        (24, WAIT, 0, 1, SILENT, 8),  # points after a long silence: says it all again
        (24, WAIT, 1, 0, SILENT, 12),
        (28, WAIT, 0, 0, SILENT, 32),
        (28, WAIT, 0, 1, SILENT, 16),  # points a step after the words
        (32, ASK, 0, 0, YES, 40),
        (40, ASK, 0, 1, SILENT, 10),
        (40, WAIT, 1, 0, NO, 29),
        (13, WAIT, 0, 0, SILENT, 16),  # a "no" is remembered for one step
        (13, ASK, 0, 0, NO, 21),  # denied twice
        (14, WAIT, 0, 0, SILENT, 19),  # a question open for one step, then for long
        (14, WAIT, 1, 0, SILENT, 15),
        (14, WAIT, 0, 0, NO, 17),
        (14, WAIT, 0, 0, YES, 16),
        (15, WAIT, 0, 0, SILENT, 19),
        (15, ASK, 0, 0, SILENT, 22),  # a new question is open for one step
        (12, WAIT, 0, 0, NO, 17),  # an answer to what was answered before
        (12, WAIT, 0, 0, YES, 16),
    ],
)  # fmt: skip
def test_phases_by_hand(phase: int, action: int, words: int, pointing: int, answer: int, expected: int) -> None:
    assert phases_of(SHORT).following[phase, action, words, pointing, answer] == expected


@pytest.mark.parametrize(("patience", "question"), [(1, 1), (1, 3), (3, 2), (6, 3), (50, 50)])
def test_phases_are_those_of_the_oracle(patience: int, question: int) -> None:
    talks, person = all_talks(patience), Person({}, patience, question)
    found = phases_of(Turns(patience=patience, question=question)).following
    assert found.shape == (len(talks), 2, 2, 2, 3)
    for place in np.ndindex(found.shape):
        phase, asked, words, seen, answer = place
        step = Step(bool(asked), bool(words), bool(seen), ANSWERS[answer])
        assert talks[found[place]] == talk_after(talks[phase], step, person), (talks[phase], step)


@pytest.mark.parametrize("patience", [1, 4])
def test_chances_are_those_of_the_named_fields(patience: int) -> None:
    turns = numbered(patience)
    person = Person({name: getattr(turns, name) for name in LISTS}, patience, 2)
    phases, used = phases_of(turns), set[float]()
    for (phase, talk), asked in itertools.product(enumerate(all_talks(patience)), (False, True)):
        name = group(talk, patience)
        expected = [
            person.chances[f"words_{name}"][asked],
            person.chances[f"points_{name}"][asked],
            answer_chance(talk, asked, True, person),
            answer_chance(talk, asked, False, person),
        ]
        assert phases.chances[phase, int(asked)].tolist() == expected, (talk, asked)
        used.update(expected)
    assert used == {chance for name in LISTS for chance in person.chances[name]}, "a chance that nothing reads"


def test_what_planners_read_of_a_phase() -> None:
    phases, talks = phases_of(numbered(4)), all_talks(4)
    for phase, talk in enumerate(talks):
        assert phases.begun[phase] == (talk.said or talk.pointed)
        assert phases.awaited[phase] == (talk.question in ("open", "open long"))
    by_group: dict[int, set[tuple[str, str]]] = {}
    for phase, talk in enumerate(talks):
        name = group(dataclasses.replace(talk, question="none"), 4)
        by_group.setdefault(int(phases.alike[phase]), set()).add((name, talk.question))
    assert all(len(members) == 1 for members in by_group.values())
    assert sorted(by_group) == list(range(6 * 4))


def test_a_talk_begins_with_phase_0() -> None:
    assert all_talks(6)[0] == Talk()
    assert Agent("ambiguous", model={"turns": {}}).phase == 0


# The paper's people.


def test_the_paper_has_one_phase() -> None:
    tables = Problem(Scene.load("ambiguous")).tables
    assert tables.following.shape == (1, 2, 2, 2, 3)
    assert not tables.following.any()
    assert tables.chances[0].tolist() == [[0.95, 0.1, 0.95, 0.95]] * 2
    assert tables.begun.tolist() == tables.awaited.tolist() == [1]


def test_the_papers_phase_is_0_for_ever() -> None:
    problem = Problem(Scene.load("ambiguous"))
    begun = Interactions.begin(np.arange(60) % 6, np.arange(60, dtype=np.uint64), 6)
    played = played_out(problem, Threshold(), begun, np.random.default_rng(0))
    assert not played.phases.any()
    agent = Agent("ambiguous", Threshold())
    for text in ("the marker", "", "no", "yes"):
        agent.observe(text, head=(0.0, 0.0, 1.6), wrist=(-0.01, 0.5, 1.47))
        agent.act()
        assert agent.phase == 0


def test_live_people_change_the_phase_of_an_agent() -> None:
    """By hand, patience 6: words 10 * 4; a quiet step 11 * 4; pointing 5 * 4; words 3 * 4."""
    agent = Agent("ambiguous", Threshold(), model={"turns": {}})
    found = []
    for text, wrist in [("marker", None), ("", None), ("", (-0.01, 0.5, 1.47)), ("marker", None)]:
        agent.observe(text, head=None if wrist is None else (0.0, 0.0, 1.6), wrist=wrist)
        found.append(agent.phase)
    assert found == [40, 44, 20, 12]


# Scenes and faults.

SCENE = """head = [0.0, 0.0, 1.6]
[[items]]
id = "cup"
position = [0.0, 2.0, 0.75]
vocabulary = ["cup"]
[model]
sigma = 0.1
"""


def test_a_scene_s_file_has_live_people(tmp_path: Path) -> None:
    path = tmp_path / "live.toml"
    path.write_text(SCENE + "[model.turns]\nwords_due = [0.4, 0.7]\npatience = 9\n")
    model = Scene.load(path).model
    assert model == Model(sigma=0.1, turns=Turns(words_due=(0.4, 0.7), patience=9))
    assert model.with_changes({"turns": {"question": 2}}).turns == Turns(words_due=(0.4, 0.7), patience=9, question=2)
    assert Problem(Scene.load(path)).tables.chances.shape == (4 * (3 + 2 * 10), 2, 4)
    path.write_text(SCENE)
    assert Scene.load(path).model.turns is None
    path.write_text(SCENE + "[model.turns]\n")
    assert Scene.load(path).model.turns == Turns()


PAIR = "expected a list of 2 probabilities above 0 and below 1"
FAULTS = [
    ("words_unbegun = [0.2]", "words_unbegun", f"found [0.2], {PAIR}"),
    ("words_unbegun = 0.2", "words_unbegun", f"found 0.2, {PAIR}"),
    ("points_silent = [0.2, 1.0]", "points_silent", f"found 1.0, {PAIR}"),
    ("points_silent = [0.0, 0.5]", "points_silent", f"found 0.0, {PAIR}"),
    ('words_due = "ab"', "words_due", f"found 'ab', {PAIR}"),
    ("words_due = [true, 0.5]", "words_due", f"found True, {PAIR}"),
    ("answers_other = [0.1, 0.2, 0.3, nan]", "answers_other", "expected a list of 4 probabilities above 0 and below 1"),
    ("answers_settled = [0.1, 0.2]", "answers_settled", "expected a list of 1 probability above 0 and below 1"),
    ("patience = 0", "patience", "found 0, expected a whole number of steps from 1 to 50"),
    ("patience = 51", "patience", "found 51, expected a whole number of steps from 1 to 50"),
    ("question = 2.0", "question", "found 2.0, expected a whole number of steps from 1 to 50"),
    ("question = true", "question", "found True, expected a whole number of steps from 1 to 50"),
]


@pytest.mark.parametrize(("line", "field", "message"), FAULTS, ids=[line for line, _, _ in FAULTS])
def test_faults_are_named_by_field(tmp_path: Path, line: str, field: str, message: str) -> None:
    path = tmp_path / "live.toml"
    path.write_text(SCENE + "[model.turns]\n" + line + "\n")
    with pytest.raises(InputError) as caught:
        Scene.load(path)
    assert caught.value.field == f"model.turns.{field}"
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_unknown_chance_is_named(tmp_path: Path) -> None:
    path = tmp_path / "live.toml"
    path.write_text(SCENE + "[model.turns]\nwords_du = [0.4, 0.7]\n")
    with pytest.raises(InputError, match=r"model\.turns\.words_du: unknown chance, expected one of .*words_due"):
        Scene.load(path)


@pytest.mark.parametrize("turns", [3, "live", [0.1], True])
def test_turns_that_are_none(turns: Any) -> None:
    with pytest.raises(ModelError, match=r"^turns: found .*, expected a table of chances, or none$"):
        Model().with_changes({"turns": turns})

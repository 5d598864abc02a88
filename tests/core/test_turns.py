"""Turn-taking: phases by hand and against the oracle, chances by their names, and what is no turn-taking."""

from __future__ import annotations

import dataclasses
import itertools
import math
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
from fetch_pomdp.core.turns import (
    DESIRED,
    NO,
    OTHER,
    REPEAT,
    SILENT,
    UNSURE,
    WIDTH,
    YES,
    Turns,
    answered_at_all,
    phases_of,
    places_of,
)
from fetch_pomdp.errors import InputError, ModelError
from tests.oracles.talking import (
    EVERY_ANSWER,
    Person,
    Question,
    Step,
    Talk,
    all_talks,
    answer_chance,
    group,
    is_late,
    ray_width,
    talk_after,
    talking,
)

COUNTS = ("patience", "question", "gesturing", "hesitation")
LISTS = [field.name for field in dataclasses.fields(Turns) if field.name not in (*COUNTS, "held")]
SHORT = Turns(patience=3, question=2, gesturing=2, hesitation=2)
WAIT, ASK = 0, 1


def numbered(**counts: int) -> Turns:
    """Turns in which no two chances are the same."""
    numbers = itertools.count(1)
    chances = {name: tuple(next(numbers) / 60 for _ in getattr(Turns(), name)) for name in LISTS}
    return Turns().with_changes({**counts, **chances, "held": (1.5, 2.5)})


def person_of(turns: Turns) -> Person:
    chances = {name: getattr(turns, name) for name in [*LISTS, "held"]}
    return Person(chances, **{name: getattr(turns, name) for name in COUNTS})


# With a patience of 3 steps and a gesturing of 2 the talks are 0 unbegun, 1 pointed, 2 and 3 due, 4 mute, 5 to 8 heard
# from one who pointed, and 9 to 12 from one who did not; with a hesitation of 2 the questions are 0 none, 1 denied, 2
# and 3 open and 4 late, 5 to 7 the same once asked again, 8 to 10 once asked in other words.
UNBEGUN, POINTED, DUE, MUTE, HEARD, SAID = 0, 1, 2, 4, 5, 9
NONE, DENIED, OPEN, AGAIN, THIRD = 0, 1, 2, 5, 8
LATE = 2  # steps after a question


def phase(talk: int, question: int) -> int:
    return 11 * talk + question


@pytest.mark.parametrize(
    ("talk", "action", "words", "pointing", "expected"),
    [
        (UNBEGUN, WAIT, 0, 0, UNBEGUN),
        (UNBEGUN, ASK, 0, 0, UNBEGUN),  # a question to somebody who has not begun
        (UNBEGUN, WAIT, 0, 1, POINTED),
        (UNBEGUN, ASK, 0, 1, POINTED),
        (UNBEGUN, WAIT, 1, 1, HEARD),
        (UNBEGUN, WAIT, 1, 0, SAID),  # words of one who has not pointed
        (POINTED, WAIT, 0, 0, DUE),  # pointed and said nothing: words are due
        (POINTED, WAIT, 0, 1, DUE),
        (POINTED, ASK, 0, 1, DUE + 1),  # a question counts for two
        (POINTED, WAIT, 1, 0, HEARD),
        (DUE, WAIT, 0, 1, DUE + 1),
        (DUE, ASK, 0, 1, MUTE),  # for too long
        (DUE + 1, WAIT, 0, 0, MUTE),
        (DUE + 1, WAIT, 1, 0, HEARD),
        (MUTE, WAIT, 0, 1, MUTE),
        (MUTE, ASK, 0, 0, MUTE),
        (MUTE, WAIT, 1, 0, HEARD),
        (HEARD, WAIT, 0, 0, HEARD + 1),  # one quiet step
        (HEARD, WAIT, 0, 1, HEARD + 1),
        (HEARD, ASK, 0, 0, HEARD + 2),
        (HEARD + 2, ASK, 0, 0, HEARD + 3),  # never more than the patience
        (HEARD + 2, WAIT, 1, 1, HEARD),
        (HEARD + 3, WAIT, 0, 0, HEARD + 3),
        (HEARD + 3, WAIT, 0, 1, DUE),  # points after a long silence: says it all again
        (HEARD + 3, WAIT, 1, 1, HEARD),
        (SAID, WAIT, 0, 0, SAID + 1),
        (SAID, WAIT, 0, 1, HEARD + 1),  # points a step after the words
        (SAID + 1, ASK, 0, 0, SAID + 3),
        (SAID + 3, ASK, 0, 1, DUE),
        (SAID + 3, WAIT, 1, 0, SAID),
    ],
)  # fmt: skip
def test_talks_by_hand(talk: int, action: int, words: int, pointing: int, expected: int) -> None:
    found = phases_of(SHORT).following
    for question, answer in itertools.product(range(11), range(5)):
        assert found[phase(talk, question), action, words, pointing, answer] // 11 == expected


@pytest.mark.parametrize(
    ("question", "open_now", "asked_now"),
    [
        (NONE, (), ("desired 0", "desired 2", "desired 3")),
        (DENIED, (), ("desired 0", "desired 2", "desired 3")),
        (OPEN, ("desired 2", "desired 3"), ("desired 1", "desired 2", "desired 3")),
        (OPEN + 1, ("desired 3",), ("desired 1", "desired 2", "desired 3")),
        (OPEN + LATE, (), ("again 0", "desired 2", "desired 3")),
        (AGAIN + LATE, (), ("again 1", "desired 2", "desired 3")),
        (THIRD + LATE, (), ("again 2",)),  # and after that nobody waits for an answer
    ],
)
def test_an_answer_at_all_is_no_silence_to_the_end(
    question: int, open_now: tuple[str, ...], asked_now: tuple[str, ...]
) -> None:
    turns = numbered(patience=3, question=2, gesturing=2, hesitation=2)

    def at_all(steps: tuple[str, ...], kind: str) -> float:
        names = [step.replace("desired", kind).split() for step in steps]
        chances = [float(getattr(turns, f"answers_{name}")[int(index)]) for name, index in names]
        return 1.0 - math.prod(1.0 - chance for chance in chances)

    for talk in range(13):
        for column, steps in enumerate((open_now, asked_now)):
            expected = (at_all(steps, "desired") + at_all(steps, "other")) / 2
            assert answered_at_all(turns)[phase(talk, question), column] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("question", "action", "words", "answer", "expected"),
    [
        (NONE, WAIT, 0, SILENT, NONE),
        (NONE, WAIT, 0, NO, DENIED),  # an answer to what was answered before
        (NONE, WAIT, 0, YES, NONE),
        (NONE, WAIT, 0, UNSURE, NONE),  # does not know what nobody asked
        (NONE, WAIT, 0, REPEAT, NONE),
        (NONE, ASK, 0, SILENT, OPEN),
        (NONE, ASK, 1, SILENT, OPEN),
        (NONE, ASK, 0, YES, NONE),
        (NONE, ASK, 0, NO, DENIED),
        (NONE, ASK, 0, REPEAT, OPEN + LATE),  # "what?": at once as if it had not been answered for long
        (NONE, ASK, 0, UNSURE, THIRD + LATE),  # "I don't know": at once as if asked three times
        (NONE, ASK, 1, UNSURE, OPEN + LATE),  # "I don't know, the green one" says something else
        (DENIED, WAIT, 0, SILENT, NONE),  # a "no" is remembered for one step
        (DENIED, WAIT, 0, UNSURE, NONE),
        (DENIED, ASK, 0, NO, DENIED),
        (DENIED, ASK, 0, SILENT, OPEN),
        (OPEN, WAIT, 0, SILENT, OPEN + 1),
        (OPEN, WAIT, 1, SILENT, OPEN + 1),
        (OPEN, WAIT, 0, YES, NONE),
        (OPEN, WAIT, 0, NO, DENIED),
        (OPEN, WAIT, 0, REPEAT, OPEN + LATE),
        (OPEN, WAIT, 0, UNSURE, THIRD + LATE),
        (OPEN, ASK, 0, SILENT, OPEN),  # another question before people could answer
        (OPEN + 1, WAIT, 0, SILENT, OPEN + LATE),
        (OPEN + 1, ASK, 0, SILENT, OPEN),
        (OPEN + LATE, WAIT, 0, SILENT, OPEN + LATE),
        (OPEN + LATE, WAIT, 1, SILENT, NONE),  # who says something else has answered in their way
        (OPEN + LATE, WAIT, 1, UNSURE, NONE),
        (OPEN + LATE, WAIT, 0, REPEAT, OPEN + LATE),
        (OPEN + LATE, WAIT, 0, UNSURE, THIRD + LATE),
        (OPEN + LATE, WAIT, 0, NO, DENIED),
        (OPEN + LATE, ASK, 0, SILENT, AGAIN),
        (OPEN + LATE, ASK, 1, SILENT, AGAIN),
        (OPEN + LATE, ASK, 0, YES, NONE),
        (OPEN + LATE, ASK, 0, REPEAT, AGAIN + LATE),
        (AGAIN, ASK, 0, SILENT, AGAIN),
        (AGAIN, WAIT, 0, SILENT, AGAIN + 1),
        (AGAIN + LATE, ASK, 0, SILENT, THIRD),
        (AGAIN + LATE, WAIT, 1, SILENT, NONE),
        (THIRD, WAIT, 0, SILENT, THIRD + 1),
        (THIRD + 1, WAIT, 0, SILENT, THIRD + LATE),
        (THIRD + LATE, ASK, 0, SILENT, THIRD + LATE),  # and no more
        (THIRD + LATE, ASK, 0, REPEAT, THIRD + LATE),
        (THIRD + LATE, ASK, 0, NO, DENIED),
        (THIRD + LATE, WAIT, 0, YES, NONE),
        (THIRD + LATE, WAIT, 1, SILENT, NONE),
    ],
)  # fmt: skip
def test_questions_by_hand(question: int, action: int, words: int, answer: int, expected: int) -> None:
    found = phases_of(SHORT).following
    for talk, pointing in itertools.product(range(13), range(2)):
        assert found[phase(talk, question), action, words, pointing, answer] % 11 == expected


COUNTED = [
    {"patience": 1, "question": 1, "gesturing": 1, "hesitation": 1},
    {"patience": 1, "question": 3, "gesturing": 2, "hesitation": 3},
    {"patience": 3, "question": 2, "gesturing": 4, "hesitation": 1},
    {"patience": 6, "question": 3, "gesturing": 3, "hesitation": 5},
    {"patience": 9, "question": 50, "gesturing": 2, "hesitation": 4},
]


@pytest.mark.parametrize("counts", COUNTED)
def test_phases_are_those_of_the_oracle(counts: dict[str, int]) -> None:
    person = Person({}, **counts)
    talks, found = all_talks(person), phases_of(Turns().with_changes(counts)).following
    numbers = {talk: number for number, talk in enumerate(talks)}
    assert found.shape == (len(talks), 2, 2, 2, 5)
    assert len(numbers) == len(talks)
    for place in np.ndindex(found.shape):
        number, asked, words, seen, answer = place
        step = Step(bool(asked), bool(words), bool(seen), EVERY_ANSWER[answer])
        assert found[place] == numbers[talk_after(talks[number], step, person)], (talks[number], step)


def test_the_oracle_s_answers_are_in_the_order_of_the_model_s() -> None:
    order = {SILENT: "silence", YES: "yes", NO: "no", UNSURE: "unsure", REPEAT: "what?"}
    assert [order[number] for number in range(5)] == list(EVERY_ANSWER)


@pytest.mark.parametrize("counts", COUNTED)
def test_chances_are_those_of_the_named_fields(counts: dict[str, int]) -> None:
    turns = numbered(**counts)
    person, phases, used = person_of(turns), phases_of(turns), set[float]()
    for (number, talk), asked in itertools.product(enumerate(all_talks(person)), (False, True)):
        name = group(talk, person)
        expected = [
            person.chances[f"words_{name}"][asked],
            person.chances[f"points_{name}"][asked],
            answer_chance(talk, asked, True, person),
            answer_chance(talk, asked, False, person),
        ]
        assert phases.chances[number, int(asked)].tolist() == [*expected, ray_width(talk, person)], (talk, asked)
        places = places_of(number, int(asked), turns)
        assert [getattr(turns, field)[index] for field, index in places] == expected
        used.update(expected)
    unread = {chance for name in LISTS for chance in person.chances[name]} - used
    late_at_once = {turns.answers_desired[3], turns.answers_other[3]}  # for people who are given one step, no later one
    assert unread == (late_at_once if turns.hesitation == 1 else set()), "a chance that nothing reads"
    assert set(phases.chances[..., WIDTH].ravel()) == {1.0, 1.5, 2.5}


def test_a_late_question_is_answered_alike_whatever_is_desired() -> None:
    """By hand: asked again .5, in other words .3, and then .02; while nobody asks, .03."""
    turns, chances = SHORT, phases_of(SHORT).chances
    assert turns.answers_again == (0.5, 0.3, 0.02)
    for talk in range(13):
        for question, again in ((OPEN, 0.5), (AGAIN, 0.3), (THIRD, 0.02)):
            late = chances[phase(talk, question + LATE)]
            assert late[ASK, DESIRED] == late[ASK, OTHER] == again
            assert late[WAIT, DESIRED] == late[WAIT, OTHER] == 0.03


def test_a_held_arm_says_what_one_with_a_constant_bias_does() -> None:
    """Rays that err by b together and by .8 b each: the mean of n of them by its variance, beside rays 1, 2, 4, 4, ..
    times as wide that are taken for independent; in units of the first ray's precision.
    """
    chances, at, precision = phases_of(Turns()).chances, 0, 0.0
    for number in range(1, 7):
        precision += chances[at, WAIT, WIDTH] ** -2
        at = int(phases_of(Turns()).following[at, WAIT, 0, 1, SILENT])
        assert precision == pytest.approx((1 + 0.64) / (1 + 0.64 / number), rel=0.03)


@pytest.mark.parametrize("counts", COUNTED)
def test_what_planners_read_of_a_phase(counts: dict[str, int]) -> None:
    turns = numbered(**counts)
    person, phases = person_of(turns), phases_of(turns)
    by_group: dict[int, set[tuple[str | int, ...]]] = {}
    for number, talk in enumerate(all_talks(person)):
        question = talk.question
        late = is_late(question, person)
        assert phases.begun[number] == (talk.said or talk.pointed)
        assert phases.awaited[number] == (question.state == "open" and not late)
        assert phases.late[number] == (question.asked if late else 0)
        age = "late" if late else "first" if question.asked == 1 and question.quiet == 0 else "open"
        alike = (talking(talk, person), question.state, question.asked, age)
        by_group.setdefault(int(phases.alike[number]), set()).add(alike)
    assert all(len(members) == 1 for members in by_group.values())
    assert len(set.union(*by_group.values())) == len(by_group), "one group twice"
    # Of seven kinds of talk: no question, denied; open at first, for longer, late; and twice more open and late.
    assert sorted(by_group) == list(range(7 * (8 if turns.hesitation == 1 else 9)))


def test_a_talk_begins_with_phase_0() -> None:
    assert all_talks(person_of(Turns()))[0] == Talk(question=Question())
    assert Agent("ambiguous", model={"turns": {}}).phase == 0


# The paper's people.


def test_the_paper_has_one_phase() -> None:
    tables = Problem(Scene.load("ambiguous")).tables
    assert tables.following.shape == (1, 2, 2, 2, 5)
    assert not tables.following.any()
    assert tables.chances[0].tolist() == [[0.95, 0.1, 0.95, 0.95, 1.0]] * 2
    assert tables.begun.tolist() == tables.awaited.tolist() == [1]
    assert tables.late.tolist() == tables.alike.tolist() == [0]


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
    """By hand, 20 questions a talk: words, talk 13; a quiet step, 14; pointing, 8; words, 6."""
    agent = Agent("ambiguous", Threshold(), model={"turns": {}})
    found = []
    for text, wrist in [("marker", None), ("", None), ("", (-0.01, 0.5, 1.47)), ("marker", None)]:
        agent.observe(text, head=None if wrist is None else (0.0, 0.0, 1.6), wrist=wrist)
        found.append(agent.phase)
    assert found == [260, 280, 160, 120]


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
    assert Problem(Scene.load(path)).tables.chances.shape == ((2 + 3 + 1 + 2 * 10) * (2 + 3 * 6), 2, 5)
    path.write_text(SCENE)
    assert Scene.load(path).model.turns is None
    path.write_text(SCENE + "[model.turns]\n")
    assert Scene.load(path).model.turns == Turns()


PAIR = "expected a list of 2 probabilities above 0 and below 1"
WIDTHS = "expected a list of 2 factors from 1 to 10"
FAULTS = [
    ("words_unbegun = [0.2]", "words_unbegun", f"found [0.2], {PAIR}"),
    ("words_unbegun = 0.2", "words_unbegun", f"found 0.2, {PAIR}"),
    ("points_silent = [0.2, 1.0]", "points_silent", f"found 1.0, {PAIR}"),
    ("points_silent = [0.0, 0.5]", "points_silent", f"found 0.0, {PAIR}"),
    ('words_due = "ab"', "words_due", f"found 'ab', {PAIR}"),
    ("words_due = [true, 0.5]", "words_due", f"found True, {PAIR}"),
    ("answers_other = [0.1, 0.2, 0.3, nan]", "answers_other", "expected a list of 4 probabilities above 0 and below 1"),
    ("answers_settled = [0.1, 0.2]", "answers_settled", "expected a list of 1 probability above 0 and below 1"),
    ("answers_again = [0.5, 0.3]", "answers_again", "found [0.5, 0.3], expected a list of 3 probabilities above 0"),
    ("answers_late = 0.03", "answers_late", "found 0.03, expected a list of 1 probability above 0 and below 1"),
    ("held = 2.0", "held", f"found 2.0, {WIDTHS}"),
    ("held = [2.0]", "held", f"found [2.0], {WIDTHS}"),
    ("held = [0.9, 4.0]", "held", f"found 0.9, {WIDTHS}"),
    ("held = [2.0, 10.5]", "held", f"found 10.5, {WIDTHS}"),
    ("held = [2.0, inf]", "held", f"found inf, {WIDTHS}"),
    ("gesturing = 0", "gesturing", "found 0, expected a whole number of steps from 1 to 50"),
    ("hesitation = 51", "hesitation", "found 51, expected a whole number of steps from 1 to 50"),
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

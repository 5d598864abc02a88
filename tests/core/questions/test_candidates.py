"""The questions of a scene."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.action import Point, Wait
from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import Asking, candidates, points
from fetch_pomdp.core.questions.places import regions
from fetch_pomdp.core.questions.prices import POINTING, SPEAKING, reward_of, seconds_worth
from fetch_pomdp.core.questions.question import Kind, Question
from fetch_pomdp.core.questions.wording import askable, asks_for
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import ModelError

AMBIGUOUS = Scene.load("ambiguous")
MUGS = Scene(
    items=tuple(
        Item(id=f"mug-{index}", position=(0.2 * (index - 1.5), 1.0, 0.75), vocabulary=("mug", colour, size))
        for index, (colour, size) in enumerate([("red", "big"), ("red", "old"), ("green", "big"), ("green", "old")])
    ),
    head=(0.0, 0.0, 1.6),
)


def of(kind: Kind, questions: tuple[Question, ...]) -> list[Question]:
    return [question for question in questions if question.kind is kind]


def test_the_papers_questions_are_table_one() -> None:
    discrete = Discrete(Problem(AMBIGUOUS))
    for item, question in enumerate(points(AMBIGUOUS)):
        silence, *answers = discrete.responses(item, Point(item)).T  # Eq. 6, Table I
        assert question.chances * (1.0 - silence) == pytest.approx(np.stack(answers), abs=1e-15)
        assert (question.item, question.said, question.shared) == (item, "this one?", 0.0)
    assert discrete.responses(None, Wait()).shape == (6, 3)


def test_a_problem_knows_the_papers_questions() -> None:
    assert Problem(AMBIGUOUS).asks_points
    assert Problem(AMBIGUOUS, points(AMBIGUOUS)).asks_points
    assert not Problem(AMBIGUOUS, points(AMBIGUOUS)[::-1]).asks_points
    assert not Problem(AMBIGUOUS, candidates(AMBIGUOUS)).asks_points
    assert not Problem(AMBIGUOUS, points(AMBIGUOUS, Asking(misunderstood=0.1))).asks_points
    with pytest.raises(ModelError, match="found a question about 6 items, expected the 4 of the scene"):
        Problem(MUGS, points(AMBIGUOUS))


def test_attributes_come_from_words() -> None:
    found = candidates(MUGS)
    attributes = of(Kind.ATTRIBUTE, found)
    # green is what red is not, and old what big is not: they would tell the same
    assert [(each.said, each.members) for each in attributes] == [("a red one?", (0, 1)), ("a big one?", (0, 2))]
    both = of(Kind.ATTRIBUTES, found)
    assert [(each.said, each.members) for each in both] == [
        ("a big red one?", (0,)), ("an old red one?", (1,)), ("a big green one?", (2,)), ("an old green one?", (3,)),
    ]  # fmt: skip
    assert both[0].chances[0] == pytest.approx([0.99, 0.01, 0.01, 0.01])


def test_how_words_are_said() -> None:
    assert asks_for(["mug"], MUGS) == "a mug?"
    assert asks_for(["old"], MUGS) == "an old one?"
    assert asks_for(["red", "mug"], MUGS) == "a red mug?"
    assert [word for word, _ in askable(AMBIGUOUS)] == ["bowl", "marker", "spoon"]  # not green, expo and pen as well


def test_regions_are_as_the_person_sees_them() -> None:
    half, left, middle, right = regions(Table.of(AMBIGUOUS))  # a line: nothing is nearer than another
    assert half.said == "on your left?"
    assert (half.holds[:3] > 0.9).all()
    assert (half.holds[3:] < 0.1).all()  # the person looks along y, so that x grows to their right
    assert left.holds + middle.holds + right.holds == pytest.approx(np.ones(6))
    assert [int(each.holds.argmax()) for each in (left, right)] == [0, 5]


def test_pairs_are_neighbours() -> None:
    pairs = {question.members for question in of(Kind.PAIR, candidates(AMBIGUOUS))}
    assert {(k, k + 1) for k in range(5)} <= pairs
    assert (0, 5) not in pairs


def test_an_open_question_has_many_answers() -> None:
    (question,) = of(Kind.OPEN, candidates(MUGS, Asking(names=0.75, slips=0.0)))
    assert set(question.words) == {"red", "green", "big", "old"}
    chance = dict(zip(question.answers, question.chances[:, 0], strict=True))
    named = {frozenset(text.split()): value for text, value in chance.items() if value > 0}
    assert named == {
        frozenset(): pytest.approx(0.0625), frozenset({"red"}): pytest.approx(0.1875),
        frozenset({"big"}): pytest.approx(0.1875), frozenset({"red", "big"}): pytest.approx(0.5625),
    }  # fmt: skip


def test_what_was_said_is_said_again_by_equation_five() -> None:
    (question,) = of(Kind.REPEAT, candidates(AMBIGUOUS))
    discrete = Discrete(Problem(AMBIGUOUS))
    assert question.chances * 0.95 == pytest.approx(discrete.words[:, 1:].T)


def test_kinds_and_their_number() -> None:
    assert {each.kind for each in candidates(MUGS, Asking(kinds=frozenset({Kind.POINT})))} == {Kind.POINT}
    few = candidates(MUGS, Asking(most=1))
    assert len(few) == 5
    assert few[4].kind is Kind.OPEN  # tells more than a yes or no
    with pytest.raises(ModelError, match="misunderstood"):
        Asking(misunderstood=1.0)


def test_a_misunderstood_question_is_about_a_neighbour() -> None:
    question = points(AMBIGUOUS, Asking(misunderstood=0.1))[0]
    yes = question.chances[0]
    assert yes[0] == pytest.approx(0.9 * 0.99 + 0.1 * 0.01)
    assert 0.08 < yes[1] < 0.1  # nearly all mistakes are about the next in the row
    assert yes[5] == pytest.approx(0.01, abs=1e-4)


@settings(max_examples=30, deadline=None)
@given(
    words=st.lists(st.lists(st.sampled_from(["mug", "red", "big", "old", "pen"]), min_size=1, unique=True), min_size=1,
                   max_size=6),
    missed=st.floats(0.0, 0.5),
)  # fmt: skip
def test_any_scene_has_questions(words: list[list[str]], missed: float) -> None:
    items = tuple(
        Item(id=f"x-{index}", position=(0.3 * index, 1.0 + 0.1 * (index % 3), 0.75), vocabulary=tuple(each))
        for index, each in enumerate(words)
    )
    scene = Scene(items=items, head=(0.0, 0.0, 1.6), model=Model(p_truth=0.95))
    found = candidates(scene, Asking(misunderstood=missed))
    assert [question.item for question in found[: len(items)]] == list(range(len(items)))
    for question in found:
        assert question.chances.sum(axis=0) == pytest.approx(1.0)
    assert Problem(scene, found).n_questions == len(found)


def test_prices_are_seconds() -> None:
    """At the paper's rewards pointing costs 6 and a spoken question half of that; nothing costs less than a wait."""
    assert reward_of(POINTING, Rewards()) == pytest.approx(-6.0)
    assert reward_of(SPEAKING, Rewards()) == pytest.approx(-3.0)
    assert reward_of(0.1, Rewards()) == pytest.approx(-1.0)
    assert reward_of(SPEAKING, Rewards(point=-3.0)) == pytest.approx(-1.5)
    assert seconds_worth(22.5, Rewards()) == pytest.approx(10.5)  # what a wrong pick costs more than a right one
    assert seconds_worth(1.0, Rewards(point=0.0, wait=0.0)) == np.inf

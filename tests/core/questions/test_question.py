"""A question as data: Table I, other answers, asking again, and what an answer tells."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.questions.answers import described, taken_for, understood, yes_no
from fetch_pomdp.core.questions.question import Kind, Question
from fetch_pomdp.errors import ModelError

SIZES = st.integers(1, 8)


@st.composite
def questions(draw: st.DrawFn) -> Question:
    """Questions with any number of answers, asked again with any share."""
    items, answers = draw(st.integers(1, 6)), draw(st.integers(1, 5))
    numbers = draw(st.lists(st.floats(0.01, 1.0), min_size=items * answers, max_size=items * answers))
    chances = np.array(numbers).reshape(answers, items)
    return Question(
        kind=Kind.OPEN,
        said="?",
        chances=chances / chances.sum(axis=0),
        answers=tuple(map(str, range(answers))),
        shared=draw(st.floats(0.0, 0.99)),
    )


def test_one_item_is_table_one() -> None:
    assert yes_no(np.array([0.0, 1.0, 0.0]), 0.99) == pytest.approx(np.array([[0.01, 0.99, 0.01], [0.99, 0.01, 0.99]]))


def test_what_half_holds_is_affirmed_every_second_time() -> None:
    assert yes_no(np.array([0.5]), 0.99) == pytest.approx(np.array([[0.5], [0.5]]))


def test_a_neighbour_is_mistaken_by_distance() -> None:
    """Three in a row, a chance of .1, half the weight of e a half distance: exp(-2) and exp(-4) of the first."""
    distances = np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 1.0], [2.0, 1.0, 0.0]])
    near, far = math.exp(-2), math.exp(-4)
    taken = taken_for(distances, 0.1, 0.5)
    assert taken[0] == pytest.approx([0.9, 0.1 * near / (near + far), 0.1 * far / (near + far)])
    assert taken[1] == pytest.approx([0.05, 0.9, 0.05])
    assert understood([1], taken) == pytest.approx([0.05, 0.9, 0.05])
    both = 1 - (1 - 0.9) * (1 - 0.05)  # either is taken for item 0
    assert understood([0, 1], taken)[0] == pytest.approx(both)


def test_nobody_mistakes_an_only_item() -> None:
    assert taken_for(np.zeros((1, 1)), 0.3, 0.5) == pytest.approx(np.ones((1, 1)))


def test_descriptions_name_attributes_independently() -> None:
    """Item 0 is red and big, item 1 red, item 2 neither; each is named with .75, and one description in ten slips."""
    chances, keys = described([(0, 1), (0,)], 3, 0.75, 0.1)
    assert keys == [0, 1, 2, 3]  # nothing, red, big, both
    true = np.array([[0.0625, 0.25, 1.0], [0.1875, 0.75, 0.0], [0.1875, 0.0, 0.0], [0.5625, 0.0, 0.0]])
    assert chances == pytest.approx(0.9 * true + 0.1 * true.mean(axis=1, keepdims=True))


@given(n=SIZES, missed=st.floats(0.0, 0.9), truth=st.floats(0.5, 1.0), data=st.data())
def test_answers_are_distributions(n: int, missed: float, truth: float, data: st.DataObject) -> None:
    places = np.array(data.draw(st.lists(st.floats(-3, 3), min_size=n, max_size=n)))
    taken = taken_for(np.abs(places[:, None] - places[None]), missed, 0.5)
    assert taken.sum(axis=1) == pytest.approx(1.0)
    members = data.draw(st.lists(st.integers(0, n - 1), unique=True))
    holds = understood(members, taken)
    assert ((holds >= -1e-12) & (holds <= 1 + 1e-12)).all()
    assert yes_no(holds, truth).sum(axis=0) == pytest.approx(1.0)
    chances, keys = described([members, [0]], n, 0.75, 0.02)
    assert chances.sum(axis=0) == pytest.approx(1.0)
    assert len(keys) == len(chances)


@given(question=questions())
def test_asked_again_answers_are_distributions_still(question: Question) -> None:
    for before in range(len(question.answers)):
        again = question.after(before)
        assert again.sum(axis=0) == pytest.approx(1.0)
        # what was said is said again at least as likely, and tells less: likelihood ratios are drawn to 1
        assert (again[before] >= question.chances[before] - 1e-12).all()
        first, second = question.chances[before], again[before]
        assert second.max() / second.min() <= first.max() / first.min() + 1e-9


def test_asked_again_by_hand() -> None:
    question = Question(kind=Kind.POINT, said="", chances=yes_no(np.array([1.0, 0.0]), 0.9), members=(0,), shared=0.5)
    assert question.after(None) is question.chances
    assert question.after(0) == pytest.approx(np.array([[0.95, 0.55], [0.05, 0.45]]))
    assert question.after(1) == pytest.approx(np.array([[0.45, 0.05], [0.55, 0.95]]))


def test_information_of_a_question_about_half() -> None:
    """A true yes or no that halves four items tells a bit; one that is true in 9 of 10 tells 1 - H(.1) = .531."""
    half = np.array([1.0, 1.0, 0.0, 0.0])
    for truth, bits in ((1.0, 1.0), (0.9, 0.5310044)):
        question = Question(kind=Kind.ATTRIBUTE, said="", chances=yes_no(half, truth))
        assert question.information(np.full(4, 0.25)) == pytest.approx(bits)
        assert question.information(np.array([0.5, 0.5, 0.0, 0.0])) == pytest.approx(0.0)


@given(question=questions(), data=st.data())
def test_information_is_the_entropy_that_an_answer_takes(question: Question, data: st.DataObject) -> None:
    n = question.n_items
    weights = np.array(data.draw(st.lists(st.floats(0.01, 1.0), min_size=n, max_size=n)))
    belief = weights / weights.sum()

    def entropy(p: np.ndarray) -> float:
        return -math.fsum(x * math.log2(x) for x in p if x > 0)

    after = 0.0
    for row in question.chances:
        joint = row * belief
        after += joint.sum() * entropy(joint / joint.sum())
    assert question.information(belief) == pytest.approx(entropy(belief) - after, abs=1e-9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"chances": np.array([[0.5, 0.5], [0.5, 0.4]])}, "found a sum of 0.9 for item 1"),
        ({"chances": np.array([[1.5, 0.5], [-0.5, 0.5]])}, "found a negative"),
        ({"chances": np.ones((3, 2))}, r"found shape \(3, 2\)"),
        ({"members": (2,)}, r"found \(2,\), expected different items from 0 to 1"),
        ({"shared": 1.0}, "shared"),
        ({"seconds": -1.0}, "seconds"),
    ],
)
def test_what_is_no_question(changes: dict[str, object], message: str) -> None:
    good = {"kind": Kind.POINT, "said": "", "chances": np.full((2, 2), 0.5)}
    with pytest.raises(ModelError, match=message):
        Question(**(good | changes))  # type: ignore[arg-type]

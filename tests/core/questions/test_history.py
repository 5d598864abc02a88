"""What was asked and answered, the belief after it, and the numbering of actions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core import discrete
from fetch_pomdp.core.action import Ask, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.answers import yes_no
from fetch_pomdp.core.questions.candidates import Asking, candidates, points
from fetch_pomdp.core.questions.history import History, belief_after, certainly, likelihood
from fetch_pomdp.core.questions.numbering import action_at, all_actions, number_of
from fetch_pomdp.core.questions.question import NO, YES, Kind, Question
from fetch_pomdp.core.questions.rows import chances_after, rows_of
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import ActionError, BeliefError, ModelError

AMBIGUOUS = Scene.load("ambiguous")
ALL = Problem(AMBIGUOUS, candidates(AMBIGUOUS))
weights = st.lists(st.floats(0.01, 1.0), min_size=6, max_size=6)


def test_a_history_counts_and_remembers() -> None:
    history = History.none(ALL)
    assert history.last is None
    history = history.asked(7).answered(NO).asked(3).asked(7)
    assert (history.last, history.times[7], history.times[3]) == (7, 2, 1)
    assert (history.before(7), history.before(3)) == (NO, None)
    with pytest.raises(ModelError, match="expected none before a question"):
        History.none(ALL).answered(YES)


@given(prior=weights, item=st.integers(0, 5), answer=st.sampled_from([YES, NO]))
def test_answers_to_points_are_the_papers(prior: list[float], item: int, answer: int) -> None:
    """The belief after "yes" or "no" to a point is that of Eq. 6 and Table I."""
    belief = Belief(np.array(prior) / sum(prior))
    question = points(AMBIGUOUS)[item]
    ours = belief_after(belief, likelihood(question, None, certainly(answer, question)))
    theirs = belief.updated(Observation(("yes", "no")[answer : answer + 1]), item, Problem(AMBIGUOUS))
    assert ours.probabilities == pytest.approx(theirs.probabilities)


def test_by_hand() -> None:
    """Four items, two of them red; "yes" with truth .9; then "yes" again, of which half says nothing."""
    red = Question(
        kind=Kind.ATTRIBUTE, said="", chances=yes_no(np.array([1.0, 1.0, 0.0, 0.0]), 0.9), members=(0, 1), shared=0.5
    )
    heard = certainly(YES, red)
    belief = belief_after(Belief.uniform(4), likelihood(red, None, heard))
    assert belief.probabilities == pytest.approx([0.45, 0.45, 0.05, 0.05])
    belief = belief_after(belief, likelihood(red, YES, heard))
    assert belief.probabilities == pytest.approx(np.array([0.4275, 0.4275, 0.0275, 0.0275]) / 0.91)


def test_an_answer_that_was_hardly_heard_tells_little() -> None:
    question = points(AMBIGUOUS)[0]
    nothing = belief_after(Belief.uniform(6), likelihood(question, None, np.array([0.5, 0.5])))
    assert nothing.probabilities == pytest.approx(np.full(6, 1 / 6))
    some = likelihood(question, None, np.array([0.8, 0.2]))  # as "yes", four times of five
    assert some[:2] == pytest.approx([0.8 * 0.99 + 0.2 * 0.01, 0.8 * 0.01 + 0.2 * 0.99])
    with pytest.raises(ModelError, match="found 2, expected 0 to 1"):
        certainly(2, question)
    with pytest.raises(BeliefError, match="no item allows"):
        belief_after(Belief.uniform(6), np.zeros(6))


def test_rows_after_answers_are_those_of_the_questions() -> None:
    problem = Problem(AMBIGUOUS, candidates(AMBIGUOUS, Asking(shared=0.3)))
    rows, answers = rows_of(problem), np.full(problem.n_questions, -1)
    assert chances_after(answers, rows) == pytest.approx(rows.chances)
    answers[2], answers[-1] = NO, 1
    found = chances_after(answers, rows)
    for index, question in enumerate(problem.questions):
        own = found[rows.starts[index] : rows.starts[index + 1]]
        assert own == pytest.approx(question.after(None if answers[index] < 0 else int(answers[index])))


def test_the_numbers_of_the_papers_actions_are_those_of_the_discrete_model() -> None:
    for problem in (Problem(AMBIGUOUS), Problem(AMBIGUOUS, points(AMBIGUOUS))):
        assert all_actions(problem) == discrete.all_actions(6)
    assert all_actions(ALL)[:7] == (Wait(), *map(Point, range(6)))
    assert all_actions(ALL)[7] == Ask(6)
    assert all_actions(ALL)[-1] == Pick(5)


def test_numbers_and_actions() -> None:
    for number, action in enumerate(all_actions(ALL)):
        assert number_of(action, ALL) == number
        assert action_at(number, ALL) == action
    for wrong in (Ask(99), Point(6), Pick(6)):
        with pytest.raises(ActionError, match="expected an action on 6 items and 19 questions"):
            number_of(wrong, ALL)
    with pytest.raises(ActionError, match="expected an action on 6 items and 6 questions"):
        number_of(Ask(0), Problem(AMBIGUOUS))
    with pytest.raises(ActionError, match="found 26, expected 0 to 25"):
        action_at(26, ALL)
    with pytest.raises(ActionError, match="expected the index"):
        Ask("green")  # type: ignore[arg-type]

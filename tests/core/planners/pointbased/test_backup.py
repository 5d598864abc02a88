"""A step ahead of plans, against enumeration; and plans against values that nothing can exceed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.planners.pointbased.ahead import Solved, step_ahead
from fetch_pomdp.core.planners.pointbased.backup import Steps, backup, best_vector
from fetch_pomdp.core.planners.pointbased.solve import memory_for, no_vectors, solved
from fetch_pomdp.core.planners.pointbased.steps import merged
from fetch_pomdp.core.questions.rows import Rows
from tests.oracles.quiz import Quiz, question_value, value

TRUTH, ANSWERED = 0.95, 0.9
HOLDS = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 0, 0], [1, 0, 1, 0]])  # two points, two attributes
PRICES = (-6.0, -6.0, -2.0, -2.5)


def chances(holds: np.ndarray) -> np.ndarray:
    yes = TRUTH * holds + (1 - TRUTH) * (1 - holds)
    return np.stack([yes, 1 - yes], axis=1)  # (k, 2, n)


QUIZ = Quiz(chances(HOLDS).tolist(), PRICES, ANSWERED)


def steps(outcomes: np.ndarray | None = None, again: float = 0.0) -> Steps:
    rows = np.ascontiguousarray(chances(HOLDS).reshape(8, 4))
    outcomes = np.ones((1, 4)) if outcomes is None else outcomes
    return Steps(rows, np.arange(0, 9, 2), np.array(PRICES), outcomes, ANSWERED, again, -1.0, 10.0, -12.5)


def rows_for(given: Steps) -> Rows:
    return Rows(given.rows, given.starts, given.prices, np.zeros(4), np.zeros(4), np.zeros(4, dtype=np.int64))


beliefs = st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4).filter(lambda found: sum(found) > 0.1)


@settings(max_examples=100, deadline=None)
@given(weights=beliefs)
def test_one_step_ahead_of_picks_is_enumeration(weights: list[float]) -> None:
    belief = np.array(weights) / sum(weights)
    given_steps = steps()
    nobody = np.full(4, -1)
    _, ask, action = step_ahead(belief, -1, nobody, Solved(given_steps, no_vectors(given_steps), rows_for(given_steps)))
    expected = [question_value(belief.tolist(), k, 1, QUIZ) for k in range(4)]
    assert ask == pytest.approx(expected, abs=2e-4)  # a millionth of a belief counts as nothing
    pick = (22.5 * belief - 12.5).max()
    best = max(*expected, pick)
    if abs(max(expected) - pick) > 1e-3:
        assert (
            action == (1 + int(np.argmax(expected)) if best > pick else 5 + int(belief.argmax()))
            or sorted([*expected, pick])[-2] > best - 1e-3
        )


def test_plans_reach_the_value_of_four_questions() -> None:
    """The oracle's plans have an end; those of the solver have none, and lose SLACK where others nearly match."""
    found = solved(steps(), 0)
    memory = memory_for(steps(), 4)
    for belief in ([0.25] * 4, [0.4, 0.3, 0.2, 0.1], [0.5, 0.5, 0.0, 0.0], [0.05, 0.05, 0.45, 0.45]):
        reached, _ = backup(np.array(belief), steps(), found, memory)
        assert reached == pytest.approx(value(belief, 4, QUIZ), abs=0.1)
        assert reached <= value(belief, 5, QUIZ) + 0.02


@settings(max_examples=20, deadline=None)
@given(weights=beliefs)
def test_plans_are_worth_what_they_say(weights: list[float]) -> None:
    """No plan is worth much more than the best with four questions, wherever it is used."""
    belief = np.array(weights) / sum(weights)
    memory = memory_for(steps(), 4)
    best = best_vector(belief, PLANS, memory)
    assert memory.scores[best] == pytest.approx(float((belief @ PLANS.values[:, : PLANS.size[0]]).max()), abs=1e-4)
    assert memory.scores[best] <= value(belief.tolist(), 4, QUIZ) + 0.05


PLANS = solved(steps(), 1)


def test_what_is_heard_beside_an_answer_counts() -> None:
    """A word that tells the first two apart in every step: a question about the two together then is as good as one."""
    word = np.array([[0.95, 0.05, 0.5, 0.5], [0.05, 0.95, 0.5, 0.5]])
    given_steps = steps(word)
    _, ask, _ = step_ahead(
        np.full(4, 0.25), -1, np.full(4, -1), Solved(given_steps, no_vectors(given_steps), rows_for(given_steps))
    )
    joint = 0.25 * chances(HOLDS)[2][:, None, :] * word[None]  # answers, words, items
    silent = 0.25 * word
    expected = PRICES[2] + ANSWERED * sum(
        max(22.5 * part[i] - 12.5 * part.sum() for i in range(4)) for row in joint for part in row
    )
    expected += (1 - ANSWERED) * sum(max(22.5 * part[i] - 12.5 * part.sum() for i in range(4)) for part in silent)
    assert ask[2] == pytest.approx(expected, abs=1e-3)


def test_an_answer_that_may_still_come_is_waited_for() -> None:
    """The last question was asked in vain: a wait at -1 brings its answer with .9, and it costs no more."""
    given_steps = steps(again=0.9)
    known = Solved(given_steps, no_vectors(given_steps), rows_for(given_steps))
    belief = np.array([0.5, 0.5, 0.0, 0.0])
    wait, ask, action = step_ahead(belief, 0, np.full(4, -1), known)
    then = 10 * TRUTH - 12.5 * (1 - TRUTH)  # a pick by the answer
    later = max(-1.25, -1.0 / 0.9 + then)  # a pick at once, or waiting on
    assert wait == pytest.approx(-1.0 + 0.9 * then + 0.1 * later, abs=1e-4)
    assert action == 0
    assert step_ahead(belief, -1, np.full(4, -1), known)[0] == pytest.approx(-1.0 - 1.25, abs=1e-4)
    assert ask[3] == pytest.approx(PRICES[3] + 0.9 * then + 0.1 * later, abs=1e-4)


def test_an_answer_that_is_shared_tells_less() -> None:
    rows = rows_for(steps())._replace(shared=np.full(4, 0.8))
    known = Solved(steps(), PLANS, rows)
    belief = np.array([0.4, 0.4, 0.1, 0.1])
    _, fresh, _ = step_ahead(belief, -1, np.full(4, -1), known)
    _, again, _ = step_ahead(belief, -1, np.array([-1, -1, -1, 0]), known)
    assert again[3] < fresh[3] - 0.5
    assert again[:3] == pytest.approx(fresh[:3])


def test_outcomes_that_say_the_same_are_one() -> None:
    rows = np.array([[0.2, 0.4], [0.1, 0.2], [0.3, 0.1], [0.4, 0.3]])
    assert merged(rows, 10) == pytest.approx(np.array([[0.3, 0.6], [0.3, 0.1], [0.4, 0.3]]))
    assert merged(rows, 2) == pytest.approx(np.array([[0.3, 0.6], [0.7, 0.4]]))  # those that are most alike
    assert merged(rows, 1) == pytest.approx(np.array([[1.0, 1.0]]))

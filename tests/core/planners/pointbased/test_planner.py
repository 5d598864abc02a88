"""PointBased, the default where there is more to ask than "this one?"."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Ask, Pick, Point
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.model import Model
from fetch_pomdp.core.planners.asking import Asked, AskingPlanner
from fetch_pomdp.core.planners.base import decide_many
from fetch_pomdp.core.planners.baselines.asking import (
    InformationGainAsking,
    OneStepAsking,
    ThresholdAsking,
    most_telling,
    tuned,
)
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.pointbased.planner import PointBased
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import Asking, candidates, points
from fetch_pomdp.core.questions.history import History
from fetch_pomdp.core.questions.question import YES, Kind
from fetch_pomdp.core.questions.rows import rows_of
from fetch_pomdp.core.questions.simulation import simulate_asking
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.simulation import simulate
from fetch_pomdp.errors import ModelError, PlannerError
from tests.tables import live

pytestmark = pytest.mark.slow  # without compilation plans take minutes
AMBIGUOUS = Scene.load("ambiguous")
ALL = Problem(AMBIGUOUS, candidates(AMBIGUOUS))
COLOURS, SIZES = ("red", "blue"), ("big", "small")
MUGS = Scene(
    items=tuple(
        Item(
            id=f"mug-{k}",
            position=(0.15 * (k % 6 - 2.5), 3.0 + 0.25 * (k // 6), 0.75),
            vocabulary=("mug", COLOURS[k % 2], SIZES[k // 2 % 2]),
        )
        for k in range(12)
    ),
    head=(0.0, 0.0, 1.6),
)
YES_OR_NO = frozenset(Kind) - {Kind.OPEN, Kind.REPEAT}
SILENT = Problem(  # people say nothing of use: their questions come from words that they do not say
    dataclasses.replace(MUGS, items=tuple(dataclasses.replace(item, vocabulary=("mug",)) for item in MUGS.items)),
    candidates(MUGS, Asking(kinds=YES_OR_NO)),
)
PLANNERS: tuple[AskingPlanner, ...] = (
    PointBased(), FittedValue(), OneStepAsking(), ThresholdAsking(), InformationGainAsking(),
)  # fmt: skip


@pytest.mark.parametrize("planner", PLANNERS, ids=lambda planner: type(planner).__name__)
def test_many_decisions_are_those_one_by_one(planner: AskingPlanner) -> None:
    rng = default_rng(1)
    beliefs = rng.dirichlet(np.full(6, 0.5), 40)
    last = rng.integers(-1, ALL.n_questions, 40)
    answers = np.full((40, ALL.n_questions), -1)
    answers[np.arange(40), np.maximum(last, 0)] = np.where(last >= 0, 0, -1)
    many = planner.decide_many_asking(ALL, beliefs, Asked(last, answers), rng=default_rng(0))
    for belief, about, row, number in zip(beliefs, last, answers, many, strict=True):
        history = History(tuple(row.tolist()), (0,) * len(row), None if about < 0 else int(about))
        decision = planner.decide_asking(ALL, Belief(belief), history, rng=default_rng(0))
        assert decision.number == number
        if isinstance(planner, PointBased):
            best = max(decision.wait, decision.ask.max(), decision.pick.max())
            assert decision.value == pytest.approx(best) or decision.ask.max() == best


def test_it_asks_what_halves_the_items() -> None:
    """Twelve alike items, and nobody has said which: one step ahead sees no use in any question, and picks."""
    decision = PointBased().decide_asking(SILENT, Belief.uniform(12), History.none(SILENT), rng=default_rng(0))
    assert isinstance(decision.action, Ask)
    question = SILENT.questions[decision.action.question]
    assert 4 <= len(question.members) <= 8
    hasty = OneStepAsking().decide_asking(SILENT, Belief.uniform(12), History.none(SILENT), rng=default_rng(0))
    assert isinstance(hasty.action, Pick)
    assert decision.value > decision.pick.max() + 2.0


def test_it_earns_more_than_one_step_ahead_and_rules() -> None:
    played = {type(p).__name__: simulate_asking(SILENT, p, 2_000, 3) for p in (*PLANNERS, tuned(SILENT, 9))}
    ours, same = played.pop("PointBased"), played.pop("FittedValue")  # whose plans they are
    assert (ours.earned == same.earned).all()
    for other in played.values():
        difference = ours.earned - other.earned
        assert difference.mean() > -3 * difference.std() / 2_000**0.5
    assert ours.mean_return > played["OneStepAsking"].mean_return + 3.0
    assert ours.accuracy > 0.9
    assert played["OneStepAsking"].accuracy < 0.5
    assert ours.by_kind[Kind.POINT] < 1.0


def test_what_it_says_a_belief_is_worth_is_what_it_earns() -> None:
    """Its value is a lower bound, and nearly reached: with answers in their own step there is nothing beside it."""
    model = Model(p_answer_again=0.0, gesture_likelihood="exact")
    problem = Problem(
        dataclasses.replace(SILENT.scene, model=model), candidates(MUGS, Asking(kinds=YES_OR_NO, shared=0.0))
    )
    decision = PointBased().decide_asking(problem, Belief.uniform(12), History.none(problem), rng=default_rng(0))
    played = simulate_asking(problem, PointBased(), 20_000, 5)
    assert decision.value - 4 * played.standard_error < played.mean_return < decision.value + 0.3


def test_with_the_papers_questions_the_default_is_itself() -> None:
    problem, paper = Problem(AMBIGUOUS, points(AMBIGUOUS)), Problem(AMBIGUOUS)
    rng = default_rng(2)
    beliefs, last = rng.dirichlet(np.full(6, 0.5), 60), rng.integers(-1, 6, 60)
    asked = Asked(last, np.full((60, 6), -1))
    many = FittedValue().decide_many_asking(problem, beliefs, asked, rng=default_rng(7))
    assert (many == 1 + decide_many(FittedValue(), paper, beliefs, last, rng=default_rng(7))).all()
    for belief, about in zip(beliefs[:10], last[:10], strict=True):
        index = None if about < 0 else int(about)
        history = dataclasses.replace(History.none(problem), last=index)
        ours = FittedValue().decide_asking(problem, Belief(belief), history, rng=default_rng(7))
        theirs = FittedValue().decide(paper, Belief(belief), index, rng=default_rng(7))
        assert ours.action == theirs.action
        assert (ours.wait, *ours.pick) == (theirs.wait, *theirs.pick)
        assert np.array_equal(ours.ask, theirs.point, equal_nan=True)


def test_people_of_both_simulations_are_the_same() -> None:
    """The paper's questions in the one and in the other: the same people, and so the same returns."""
    problem = Problem(AMBIGUOUS, points(AMBIGUOUS))
    ours = simulate_asking(problem, FittedValue(), 4_000, 5)
    theirs = simulate(Problem(AMBIGUOUS), FittedValue(), 4_000, 5)
    error = np.hypot(ours.standard_error, theirs.standard_error)
    assert abs(ours.mean_return - theirs.mean_return) < 4 * error
    assert ours.by_kind[Kind.POINT] == pytest.approx(theirs.mean_questions, abs=0.1)


def test_with_the_papers_questions_it_is_near_the_default() -> None:
    problem = Problem(AMBIGUOUS, points(AMBIGUOUS))
    ours, theirs = (simulate_asking(problem, planner, 10_000, 5) for planner in (PointBased(), FittedValue()))
    difference = ours.earned - theirs.earned
    assert difference.mean() > -0.1 - 4 * difference.std() / 100.0


def test_answers_come_as_often_as_their_chances_say() -> None:
    """A robot that asks one question for ever: a first answer by its chances, a second as often the same as shared."""
    item = 2
    question = next(k for k, each in enumerate(ALL.questions) if each.kind is Kind.OPEN)

    class Asks:
        def decide_many_asking(self, problem: Problem, beliefs: object, asked: Asked, *, rng: object) -> np.ndarray:
            seen.append(asked.answers[:, question].copy())
            return np.full(len(asked.last), 1 + question)

        decide_asking = None

    seen: list[np.ndarray] = []
    problem = Problem(AMBIGUOUS, ALL.questions)
    simulate_asking(problem, Asks(), 12_000, 4)  # type: ignore[arg-type]
    mine = np.arange(12_000) % 6 == item
    first, second = seen[1][mine], seen[2][mine]
    chances = problem.questions[question].chances[:, item]
    p_l = problem.model.p_l
    for answer, chance in enumerate(chances):
        share = (first == answer).mean()
        assert abs(share - p_l * chance) < 4 * np.sqrt(p_l * chance / mine.sum()) + 1e-9
    named = int(chances.argmax())
    repeated = (second[first == named] == named).mean()
    expected = 1 - p_l * (1 - problem.questions[question].after(named)[named, item])
    assert abs(repeated - expected) < 4 * np.sqrt(0.25 / (first == named).sum())


def test_the_question_that_tells_most_for_its_price() -> None:
    rows, problem = rows_of(SILENT), SILENT
    uniform = np.full((1, 12), 1 / 12)
    best, bits = most_telling(uniform, np.full((1, problem.n_questions), -1), rows)
    told = [question.information(uniform[0]) for question in problem.questions]
    assert bits[0] == pytest.approx(told[best[0]])
    assert best[0] == int(np.argmax(np.array(told) / -rows.prices))


def test_what_it_does_not_decide_about() -> None:
    people = live(Problem(AMBIGUOUS))
    problem = Problem(people.scene, candidates(people.scene))
    with pytest.raises(ModelError, match="found live people"):
        PointBased().decide_asking(problem, Belief.uniform(6), History.none(problem), rng=default_rng(0))
    with pytest.raises(PlannerError, match="found 5 items and 19 questions, expected 6 and 19"):
        PointBased().decide_asking(ALL, Belief.uniform(5), History.none(ALL), rng=default_rng(0))
    with pytest.raises(ModelError, match="found questions of other kinds"):
        FittedValue().decide(ALL, Belief.uniform(6), None, rng=default_rng(0))
    with pytest.raises(PlannerError, match="seed"):
        PointBased(seed=-1)


def test_the_same_seed_makes_the_same_plans() -> None:
    history = History.none(ALL).asked(7).answered(YES)
    belief = Belief([0.3, 0.3, 0.1, 0.1, 0.1, 0.1])
    one, other = (
        PointBased().decide_asking(Problem(AMBIGUOUS, ALL.questions), belief, history, rng=default_rng(0))
        for _ in range(2)
    )
    assert (one.number, one.wait) == (other.number, other.wait)
    assert isinstance(one.action, Point | Ask | Pick) or one.number == 0

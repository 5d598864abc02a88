"""Planning with live people: exact answers against enumeration, and the default against simpler planners."""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import code_of, decide_many
from fetch_pomdp.core.planners.catalogue import DEFAULT, PLANNERS, planner_named
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.planners.search.planner import ExactAnswers
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import Summary, simulate
from fetch_pomdp.core.turns import LEAST, Turns
from tests.core.planners.alone import decided_alone
from tests.oracles.talking import Person, action_values, all_talks
from tests.tables import live, table, world_of

NO, YES = LEAST, 1 - LEAST  # as good as never and always
CERTAIN = Turns(
    words_unbegun=(NO, YES), words_pointed=(NO, YES), words_due=(YES, NO), words_said=(NO, NO),
    words_heard=(NO, NO), words_silent=(NO, YES), words_denied=(YES, NO), words_mute=(NO, YES),
    points_unbegun=(YES, NO), points_pointed=(YES, YES), points_due=(NO, YES), points_said=(NO, YES),
    points_heard=(NO, NO), points_silent=(YES, NO), points_denied=(NO, NO), points_mute=(YES, NO),
    answers_desired=(0.5, 0.7, 0.6, 0.2), answers_other=(0.25, 0.45, 0.35, 0.3), answers_again=(0.8, 0.55, 0.05),
    answers_late=(0.15,), answers_settled=(0.1,), patience=2, question=1, gesturing=1, hesitation=2,
)  # fmt: skip
QUICK = dataclasses.replace(
    CERTAIN, answers_desired=(0.95, 0.9, 0.9, 0.8), answers_other=(0.1, 0.3, 0.9, 0.05), hesitation=1
)
# Silence tells nothing in the step of a question, and much in the next.
EQUAL = dataclasses.replace(
    CERTAIN, answers_desired=(0.6, 0.6, 0.9, 0.1), answers_other=(0.6, 0.6, 0.1, 0.9), question=2, hesitation=1
)
HERE = (0.0, 2.0, 0.75)


def person_of(turns: Turns, *, pointing: bool = True) -> Person:
    chances = {field.name: getattr(turns, field.name) for field in dataclasses.fields(Turns)}
    if not pointing:
        chances |= {name: (0.0, 0.0) for name in chances if name.startswith("points")}
    return Person(chances, turns.patience, turns.question, turns.gesturing, turns.hesitation)


@pytest.mark.parametrize("pointing", [True, False])
@pytest.mark.parametrize("turns", [CERTAIN, QUICK, EQUAL])
@pytest.mark.parametrize("asked", [None, 0, 1])
@pytest.mark.parametrize("belief", [[0.5, 0.5], [0.75, 0.25], [0.1, 0.9]])
def test_exact_answers_equals_enumeration_from_every_phase(
    turns: Turns, asked: int | None, belief: list[float], pointing: bool
) -> None:
    """Alike in words and place, so that answers are all there is to learn, and words and pointing move the talk."""
    problem = table([["thing"]] * 2, [HERE, HERE], turns=turns, sigma=0.02, p_g=0.1 if pointing else 0.0)
    world = world_of(problem)
    person, planner = person_of(turns, pointing=pointing), ExactAnswers(depth=3, width=1, leaf="pick")
    waits = set()
    for phase, talk in enumerate(all_talks(person)):
        found = planner.decide(problem, Belief(belief), asked, rng=default_rng(phase), phase=phase)
        expected = action_values(belief, asked, talk, 3, world, person)
        assert found.wait == pytest.approx(expected.wait, abs=1e-9), talk
        assert found.point.tolist() == pytest.approx(expected.point, abs=1e-9), talk
        assert found.pick.tolist() == pytest.approx(expected.pick, abs=1e-9)
        assert found.value == pytest.approx(expected.best, abs=1e-9)
        waits.add(round(found.wait, 9))
    assert asked is None or len(waits) > 1, "phases that make no difference test nothing"


# Words that tell all, answers that are true and silence that tells nothing leave beliefs of 0, 1/2 and 1: with two
# samples a node, one for each item, nothing is left to chance, and where the talk stands decides what a wait is worth.
TELLING = dataclasses.replace(
    CERTAIN,
    answers_desired=(0.5, 0.7, 0.6, 0.2),
    answers_other=(0.5, 0.7, 0.6, 0.2),
    patience=3,
    question=2,
    gesturing=2,
)
HURRIED = dataclasses.replace(
    TELLING, words_heard=(NO, YES), words_said=(YES, NO), words_silent=(YES, NO), words_unbegun=(YES, YES), patience=2
)


@pytest.mark.parametrize("turns", [TELLING, HURRIED])
@pytest.mark.parametrize("asked", [None, 0, 1])
def test_words_come_where_the_talk_stands(turns: Turns, asked: int | None) -> None:
    problem = table([["cup"], ["pot"]], [HERE, HERE], turns=turns, sigma=0.02, alpha=1e-9, p_truth=1.0)
    person, world = person_of(turns), world_of(problem)
    planner, waits = ExactAnswers(depth=3, width=2, leaf="pick"), set[float]()
    for phase, talk in enumerate(all_talks(person)):
        found = planner.decide(problem, Belief([0.5, 0.5]), asked, rng=default_rng(phase), phase=phase)
        expected = action_values([0.5, 0.5], asked, talk, 3, world, person)
        assert found.wait == pytest.approx(expected.wait, abs=1e-6), talk  # alpha is not quite 0
        assert found.point.tolist() == pytest.approx(expected.point, abs=1e-6), talk
        waits.add(round(found.wait, 6))
    assert len(waits) > 2


# The default planner with our simulated people's chances.


@functools.cache
def with_live_people(scene: str) -> Problem:
    return live(Problem(Scene.load(scene)))


@functools.cache
def earned(scene: str, planner: str) -> Summary:
    return simulate(with_live_people(scene), planner_named(planner), 3_000, seed=4)


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["ambiguous", "unambiguous"])
@pytest.mark.parametrize("other", ["threshold", "exact"])
def test_the_default_earns_no_less(scene: str, other: str) -> None:
    ours, theirs = earned(scene, DEFAULT), earned(scene, other)
    error = math.hypot(ours.standard_error, theirs.standard_error)
    assert ours.mean_return >= theirs.mean_return - 2 * error


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["ambiguous", "unambiguous"])
def test_the_default_waits_until_something_has_begun(scene: str) -> None:
    rng = default_rng(0)
    beliefs = np.vstack([np.full((1, 6), 1 / 6), np.eye(6), rng.dirichlet(np.full(6, 0.3), 120)])
    asked, problem = rng.integers(-1, 6, len(beliefs)), with_live_people(scene)
    unbegun = [phase for phase, talk in enumerate(all_talks(person_of(Turns()))) if not (talk.said or talk.pointed)]
    assert len(unbegun) == 20, "one talk with every question"
    for phase in unbegun:
        phases = np.full(len(beliefs), phase)
        many = decide_many(FittedValue(), problem, beliefs, asked, rng=rng, phases=phases)
        assert (many == NOBODY).all()
        for planner in (FittedValue(), FittedValue(budget_ms=1.0)):
            for belief, about in zip(beliefs[:20], asked, strict=False):
                last = None if about < 0 else int(about)
                decision = planner.decide(problem, Belief(belief), last, rng=rng, phase=phase)
                assert decision.action == Wait()


@pytest.mark.parametrize("name", sorted(set(PLANNERS) - {DEFAULT}))  # the default: below, in many phases
# Pointed; heard, and a question open, and late; said and denied; mute, and asked in vain for the third time.
@pytest.mark.parametrize("phase", [20, 120, 122, 127, 261, 119])
def test_every_other_planner_decides_in_a_phase(name: str, phase: int) -> None:
    problem, planner, belief = with_live_people("ambiguous"), planner_named(name), [0.05, 0.1, 0.35, 0.4, 0.06, 0.04]
    decision = planner.decide(problem, Belief(belief), 2, rng=default_rng(0), phase=phase)
    assert decision.pick == pytest.approx(22.5 * np.array(belief) - 12.5, abs=1e-9)
    assert isinstance(decision.action, Wait) or 0 <= decision.action.item < 6
    phases = np.full(2, phase)
    many = decide_many(planner, problem, np.array([belief] * 2), np.array([2, 2]), rng=default_rng(0), phases=phases)
    assert many[0] == code_of(decision.action, problem)


@pytest.mark.slow
def test_many_decisions_are_those_one_by_one() -> None:
    rng, problem, planner = default_rng(2), with_live_people("ambiguous"), FittedValue()
    beliefs, asked = rng.dirichlet(np.full(6, 0.4), 200), rng.integers(-1, 6, 200)
    phases = rng.integers(len(problem.tables.begun), size=200)
    many = decide_many(planner, problem, beliefs, asked, rng=default_rng(3), phases=phases)
    assert many.tolist() == decided_alone(planner, problem, beliefs, asked, seed=3, phases=phases)
    assert len(set(many.tolist())) > 8  # of a wait, 6 questions and 6 picks

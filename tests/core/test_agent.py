"""The robot's mind in one interaction."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.answers import After
from fetch_pomdp.core.language.phrases import Answers
from fetch_pomdp.core.language.unigram import Utterance
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import SparseSampling
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import (
    ActionError,
    BeliefError,
    InputError,
    ModelError,
    ObservationError,
    PlannerError,
    SceneError,
)


def test_starts_uniform_with_nothing_asked_and_our_planner() -> None:
    agent = Agent("ambiguous")
    assert agent.belief == pytest.approx([1 / 6] * 6)
    assert agent.asked is None
    assert agent.planner == FittedValue()
    assert agent.scene == Scene.load("ambiguous")


def test_observe_is_one_step_of_bayes_and_tells_how_words_were_understood() -> None:
    agent = Agent("ambiguous")
    heard = agent.observe("The green MARKER, please! Yes, left.", head=(0.0, 0.0, 1.6), wrist=(0.0, 1.0, 1.3))
    assert heard.base == ("green", "marker")
    assert heard.response == ("yes",)
    assert heard.unknown == ("the", "please", "left")
    words = ("the", "green", "marker", "please", "yes", "left")
    seen = Observation(words, Ray((0.0, 0.0, 1.6), (0.0, 1.0, 1.3)))
    expected = Belief.uniform(6).updated(seen, None, agent.problem)
    assert agent.belief == pytest.approx(expected.probabilities)


def test_answers_are_understood_as_people_give_them() -> None:
    for said, model in (("Yep.", "yes"), ("that's the one", "yes"), ("right", "yes"), ("ja", "yes"), ("nein", "no")):
        agent, expected = Agent("ambiguous"), Agent("ambiguous")
        for each, words in ((agent, said), (expected, model)):
            each.did(Point(2))
            each.observe(words)
        assert (agent.belief == expected.belief).all()
        assert agent.evidence.unanswered is None
        assert agent.observe("right").unknown == ("right",), "the question has been answered"


def test_outside_a_question_right_is_no_answer() -> None:
    agent = Agent("ambiguous")
    assert agent.observe("right").response == ()
    agent.did(Point(2))
    assert agent.observe("the right one").response == ()
    assert agent.observe("right").response == ("yes",)


@pytest.mark.parametrize(
    ("said", "meaning"),
    [
        ("I don't know", Meaning.UNSURE),
        ("not sure", Meaning.UNSURE),
        ("what?", Meaning.REPEAT),
    ],
)
def test_what_is_no_evidence_is_given_back_beside_it(said: str, meaning: Meaning) -> None:
    agent = Agent("ambiguous")
    agent.observe("marker")
    agent.did(Point(2))
    before = agent.belief
    heard = agent.observe(said)
    assert heard == Utterance(meaning=meaning)
    assert agent.belief == pytest.approx(before)
    assert agent.after is After.QUESTION


@pytest.mark.parametrize("model", [{}, {"turns": {}}])
def test_who_wants_nothing_any_more_begins_anew(model: dict[str, object]) -> None:
    prior = [0.3, 0.3, 0.1, 0.1, 0.1, 0.1]
    agent, other = (Agent("ambiguous", PaperAlwaysAsk(), model=model, prior=prior) for _ in range(2))
    agent.observe("marker")
    agent.did(Point(2))
    assert agent.observe("schon gut") == Utterance(meaning=Meaning.CANCEL)
    assert agent.belief == pytest.approx(prior)
    assert (agent.asked, agent.handed, agent.phase, agent.after) == (None, None, 0, After.NOTHING)
    assert agent.evidence.unanswered is None
    agent.did(Point(2))
    agent.observe("never mind, the bowl")
    other.observe("the bowl")
    assert agent.belief == pytest.approx(other.belief)
    assert (agent.asked, agent.phase) == (other.asked, other.phase)


def test_an_agent_begins_with_its_prior_and_knows_what_it_handed_over() -> None:
    agent = Agent("ambiguous", PaperAlwaysAsk(), model={"turns": {}})
    agent.observe("marker")
    agent.did(Point(2))
    agent.did(Pick(3))
    assert agent.handed == 3
    agent.did(Wait())
    assert agent.handed is None
    agent.take(Acted(Pick(3)))
    assert agent.handed == 3
    agent.take(Acted(Pick(3), Outcome.RETURNED))
    assert (agent.handed, agent.asked) == (None, 3)
    agent.take(Acted(Pick(4), Outcome.FAILED))
    assert agent.handed is None
    agent.take(Observed(Observation(("bowl",)), anew=True))
    other = Agent("ambiguous", PaperAlwaysAsk(), model={"turns": {}})
    other.observe("bowl")
    assert agent.belief == pytest.approx(other.belief)
    assert (agent.asked, agent.phase) == (None, other.phase)
    agent.begin()
    assert agent.belief == pytest.approx([1 / 6] * 6)
    assert agent.phase == 0


def test_a_scene_s_own_answers() -> None:
    scene = dataclasses.replace(Scene.load("ambiguous"), answers=Answers(yes=("roger that",)))
    agent = Agent(scene)
    agent.did(Point(2))
    assert agent.observe("roger that").response == ("yes",)


def test_silence_may_be_said_in_three_ways() -> None:
    for utterance in (None, "", " ... "):
        agent = Agent("ambiguous")
        agent.observe(utterance)
        assert agent.belief == pytest.approx([1 / 6] * 6)


def test_a_question_asked_persists_until_the_next() -> None:
    agent = Agent("ambiguous")
    agent.did(Point(2))
    for _ in range(3):
        agent.observe("marker")
        agent.did(Wait())
        assert agent.asked == 2
    agent.observe("no")
    assert agent.belief[3] > 20 * agent.belief[2]
    agent.did(Point(5))
    assert agent.asked == 5
    agent.did(Pick(1))
    assert agent.asked == 5


def test_act_goes_on_as_if_done() -> None:
    agent = Agent("ambiguous", PaperAlwaysAsk())
    assert agent.act() == Wait()
    assert agent.asked is None
    agent.observe(head=(0.0, 0.0, 1.6), wrist=(-0.075, 3.2, 0.75))
    assert agent.act() == Point(2)
    assert agent.asked == 2
    agent.observe("yes")
    assert agent.act() == Pick(2)


def test_take_counts_an_action_only_if_it_was_done() -> None:
    agent = Agent("ambiguous")
    for outcome in (Outcome.FAILED, Outcome.STOPPED):
        agent.take(Acted(Point(1), outcome))
        assert agent.asked is None
    agent.take(Acted(Point(1)))
    assert agent.asked == 1
    agent.take(Observed(Observation(("bowl",))))
    assert agent.belief[0] > 0.3


def test_decide_changes_nothing() -> None:
    agent = Agent("ambiguous", seed=4)
    agent.observe("marker")
    belief = agent.belief
    decisions = [agent.decide() for _ in range(3)]
    assert len({(d.action, d.wait, tuple(d.point)) for d in decisions}) == 1
    assert (agent.belief == belief).all()
    assert agent.asked is None


def test_seeds_decide_what_is_sampled() -> None:
    def values(seed: int, warmup: int = 0) -> float:
        agent = Agent("ambiguous", SparseSampling(), seed=seed)
        agent.observe("marker")
        for _ in range(warmup):
            agent.decide()
        return agent.decide().wait

    assert values(0) == values(0) == values(0, warmup=2)
    assert len({values(seed) for seed in range(8)}) > 1


def test_steps_draw_afresh() -> None:
    agent, found = Agent("ambiguous", SparseSampling()), set()
    for _ in range(8):
        found.add(agent.decide().wait)
        agent.observe()
    assert len(found) > 1


def test_model_and_rewards_as_a_whole_or_as_changes() -> None:
    agent = Agent("ambiguous", model={"alpha": 1.0}, rewards={"point": -2.0})
    assert agent.scene.model == Model(alpha=1.0)
    assert agent.scene.rewards == Rewards(point=-2.0)
    whole = Agent("ambiguous", model=Model(p_l=0.5), rewards=Rewards(wait=-0.5))
    assert whole.problem.tables.p_l == 0.5
    assert whole.problem.tables.wait == -0.5


def test_a_prior_replaces_the_uniform_start() -> None:
    prior = [0.5, 0.1, 0.1, 0.1, 0.1, 0.1]
    assert Agent("ambiguous", prior=prior).belief == pytest.approx(prior)
    with pytest.raises(ObservationError, match="prior: found 2 probabilities, expected 6"):
        Agent("ambiguous", prior=[0.5, 0.5])
    with pytest.raises(BeliefError):
        Agent("ambiguous", prior=[0.5] * 6)


def test_item_of_an_action() -> None:
    agent = Agent("ambiguous")
    assert agent.item(Wait()) is None
    found = agent.item(Point(3))
    assert found is not None
    assert found.id == "marker-2"


@pytest.mark.parametrize(
    ("kwargs", "message"),
    [
        ({"head": (0, 0, 1)}, "wrist: found none, expected head and wrist, or neither"),
        ({"wrist": (0, 0, 1)}, "head: found none, expected head and wrist, or neither"),
        ({"head": (0, 0, 1), "wrist": (0, 0, 1)}, "wrist: found the position of the head"),
        ({"head": (0, 0, math.inf), "wrist": (0, 0, 1)}, "head: found"),
        ({"head": (0, 0, 0), "wrist": (0, math.nan, 1)}, "wrist: found"),
        ({"head": "abc", "wrist": (0, 0, 1)}, "head: found 'abc'"),
        ({"head": (0, True, 0), "wrist": (0, 0, 1)}, "head: found True"),
        ({"utterance": 3}, "utterance: found 3, expected text or None"),
        ({"utterance": b"marker"}, "utterance: found b'marker'"),
    ],
)
def test_bad_observations_leave_the_belief_alone(kwargs: Any, message: str) -> None:
    agent = Agent("ambiguous")
    with pytest.raises(ObservationError, match=f"^{message}"):
        agent.observe(**kwargs)
    assert agent.belief == pytest.approx([1 / 6] * 6)


@pytest.mark.parametrize("item", [6, -1])
def test_an_action_about_no_item(item: int) -> None:
    agent = Agent("ambiguous")
    with pytest.raises(ActionError, match=f"item: found item {item}, expected an index below 6"):
        agent.did(Point(item))
    assert agent.asked is None


@pytest.mark.parametrize(
    ("make", "kind"),
    [
        (lambda: Agent("ambigous"), SceneError),
        (lambda: Agent(Path("nowhere.toml")), SceneError),
        (lambda: Agent("ambiguous", model={"sigmma": 1}), ModelError),
        (lambda: Agent("ambiguous", model={"sigma": -1}), ModelError),
        (lambda: Agent("ambiguous", rewards={"point": 3}), ModelError),
        (lambda: Agent("ambiguous", seed=-1), PlannerError),
        (lambda: Agent("ambiguous", seed=1.0), PlannerError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", seed=True), PlannerError),
        (lambda: Agent(None), SceneError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", model=False), ModelError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", rewards=0), ModelError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", "sparse"), PlannerError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", SparseSampling), PlannerError),  # type: ignore[arg-type]
        (lambda: Agent("ambiguous", prior=np.full(6, 1 / 6 + 0j)), BeliefError),
    ],
)
def test_bad_beginnings(make: Any, kind: type[InputError]) -> None:
    with pytest.raises(kind):
        make()


def test_impossible_evidence_changes_nothing() -> None:
    agent = Agent("ambiguous", model={"p_truth": 1.0})
    agent.did(Point(0))
    agent.observe("yes")
    before = agent.belief
    with pytest.raises(BeliefError, match="bowl-1"):
        agent.observe("no")
    assert np.array_equal(agent.belief, before)


@pytest.mark.parametrize("action", [None, "wait", 3, Wait, Point, ("point", 2)])
def test_what_is_no_action_is_refused(action: Any) -> None:
    agent = Agent("ambiguous")
    for take in (agent.did, agent.item):
        with pytest.raises(ActionError, match=r"^action: found .+, expected Wait\(\), Point\(item\) or Pick\(item\)$"):
            take(action)
    with pytest.raises(ActionError, match=r"^item: found item 6, expected an index below 6$"):
        agent.item(Pick(6))
    assert agent.asked is None


def test_numbers_of_numpy_are_as_good_as_python_s() -> None:
    agents = [Agent("ambiguous", seed=3), Agent("ambiguous", seed=np.int64(3), prior=np.full(6, 1 / 6))]  # type: ignore[arg-type]
    for agent, item in zip(agents, (2, np.int64(2)), strict=True):
        agent.did(Point(item))  # type: ignore[arg-type]
        agent.observe("no", head=np.array([0, 0, 1.6]), wrist=np.array([0, 1, 1.2]))  # type: ignore[arg-type]
    assert agents[0].asked == agents[1].asked == 2
    assert np.array_equal(agents[0].belief, agents[1].belief)
    assert agents[0].decide().action == agents[1].decide().action


@pytest.mark.parametrize("observation", ["marker", None, ("marker",)])
def test_what_is_no_observation_is_refused(observation: Any) -> None:
    agent = Agent("ambiguous")
    with pytest.raises(ObservationError, match=r"^observation: found .+, expected Observation\(\.\.\.\)$"):
        agent.update(observation)
    assert agent.belief == pytest.approx([1 / 6] * 6)

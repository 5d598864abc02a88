"""Several readings of what was said, against Bayes' rule written out."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import ObservationError
from tests.oracles.model import World, base_chance, response_chance

PROBLEM = Problem(Scene.load("ambiguous"))
WORLD = World(vocabularies=[item.vocabulary for item in PROBLEM.scene.items])
ITEMS = range(6)
NONE: tuple[str, ...] = ()
some = st.sampled_from(["marker", "green marker", "spoon", "", "the bowl", "bowl black"])
sentences = st.lists(some, min_size=2, max_size=4, unique=True)


def heard(*readings: tuple[str, float]) -> Observation:
    alternatives = tuple(Alternative(tuple(text.split()), weight) for text, weight in readings)
    return Observation(alternatives[0].words, None, alternatives)


def belief(observation: Observation, asked: int | None = None, prior: Belief | None = None) -> list[float]:
    return list((prior or Belief.uniform(6)).updated(observation, asked, PROBLEM).probabilities)


def test_a_single_reading_is_the_one_string_to_the_last_bit() -> None:
    alone, written = heard(("green marker", 1.0)), Observation(("green", "marker"))
    assert belief(alone, 2) == belief(written, 2)


@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        st.sampled_from(["marker", "green marker", "spoon", "", "the bowl", "bowl black"]),
        min_size=2,
        max_size=4,
        unique=True,
    ),
    st.data(),
)
def test_from_ignorance_it_is_the_mean_of_the_beliefs_by_weight(texts: list[str], data: st.DataObject) -> None:
    raw = [data.draw(st.floats(0.01, 1.0)) for _ in texts]
    weights = [part / sum(raw) for part in raw]
    each = np.array([belief(Observation(tuple(text.split()))) for text in texts])
    expected = np.array(weights) @ each
    assert belief(heard(*zip(texts, weights, strict=True))) == pytest.approx(list(expected))


def test_the_sum_over_readings_written_out() -> None:
    prior = Belief([0.05, 0.05, 0.4, 0.3, 0.1, 0.1])
    readings = [("no", 0.5), ("yes", 0.2), ("spoon", 0.2), ("", 0.1)]
    asked = 2
    total = np.zeros(6)
    for text, weight in readings:
        words = [word for word in text.split() if word == "spoon"]
        answers = [word for word in text.split() if word != "spoon"]
        base = np.array([base_chance(words, item, WORLD) for item in ITEMS])
        response = np.array([response_chance(answers, item, asked, WORLD, WORLD.p_l) for item in ITEMS])
        even = 0.5 * response[asked] + 0.5 * np.delete(response, asked).mean()
        total += weight * base / base.mean() * response / even
    expected = total * prior.probabilities
    assert belief(heard(*readings), asked, prior) == pytest.approx(list(expected / expected.sum()))


def test_a_no_that_may_be_no_word_says_less_than_a_no() -> None:
    beliefs = [
        belief(heard(("no", 1 - p), ("", p)), 2)[2] if p else belief(heard(("no", 1.0)), 2)[2]
        for p in (0.0, 0.2, 0.5, 0.9)
    ]
    assert all(before < after for before, after in itertools.pairwise(beliefs))
    assert beliefs[-1] < 1 / 6


def test_evidence_adds_up_to_the_belief() -> None:
    agent = Agent(live_scene("ambiguous"))
    agent.update(heard(("marker", 0.6), ("spoon", 0.3), ("", 0.1)))
    agent.did(agent.decide().action)
    agent.asked = 2
    agent.update(heard(("no", 0.7), ("bowl", 0.2), ("yes", 0.1)))
    sums = agent.evidence.prior + agent.evidence.words + agent.evidence.answers + agent.evidence.pointing
    log = np.log(agent.belief)
    assert list(sums - sums[0]) == pytest.approx(list(log - log[0]))


def test_where_the_talk_stands_is_what_most_readings_say() -> None:
    agent = Agent(live_scene("ambiguous"))
    agent.update(heard(("man money", 0.4), ("marker money", 0.35), ("the marker", 0.25)))
    assert agent.problem.tables.begun[agent.phase], "a request, though the likeliest reading is none"
    agent.did(Point(2))
    agent.update(heard(("who", 0.4), ("no", 0.35), ("nope", 0.25)))
    assert agent.evidence.unanswered is None
    again = Agent(live_scene("ambiguous"))
    again.update(heard(("marker", 0.4), ("man", 0.6)))
    assert not again.problem.tables.begun[again.phase]


def test_what_is_impossible_in_every_reading_stays_impossible() -> None:
    scene = Scene.load("ambiguous")
    problem = Problem(dataclasses.replace(scene, model=scene.model.with_changes({"p_truth": 1.0})))
    both = heard(("no", 0.6), ("nope", 0.4))
    found = Belief.uniform(6).updated(both, 2, problem).probabilities
    assert found[2] == 0.0
    assert math.fsum(found) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("alternatives", "message"),
    [
        ((Alternative(("no",), 0.5), Alternative(NONE, 0.4)), "found weights that sum to 0.9, expected 1"),
        (
            (Alternative(("yes",), 0.5), Alternative(NONE, 0.5)),
            r"found none with \('no',\), expected the words among them",
        ),
    ],
)
def test_alternatives_that_are_none(alternatives: tuple[Alternative, ...], message: str) -> None:
    with pytest.raises(ObservationError, match=message):
        Observation(("no",), None, alternatives)


@pytest.mark.parametrize("weight", [0.0, -0.1, 1.5, math.nan])
def test_weights_that_are_no_probability(weight: float) -> None:
    with pytest.raises(ObservationError, match="expected a probability above 0"):
        Alternative(NONE, weight)

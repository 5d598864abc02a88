"""What each modality has contributed to the belief."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from tests.oracles import model as oracle
from tests.tables import table

VOCABULARIES = [["cup"], ["cup", "mug", "tea"], ["pot", "tea"], ["pot"]]
WORDS = ["cup", "mug", "tea", "pot", *oracle.YES_WORDS, *oracle.NO_WORDS, "please"]
places = st.sampled_from([(0.5, 2.0, 0.75), (-0.6, 1.9, 0.8), (0.0, 2.0, 0.4), (0.0, -1.0, 2.0)])
observed = st.builds(
    Observation,
    st.lists(st.sampled_from(WORDS), max_size=3).map(tuple),
    st.none() | places.map(lambda place: Ray((0.0, 0.0, 1.6), place)),
)
questions = st.integers(0, 3).map(Point)
weights = st.lists(st.sampled_from([0.0, 1e-9, 0.2, 1.0]), min_size=4, max_size=4).filter(lambda w: sum(w) > 0.1)


@pytest.mark.parametrize("likelihood", ["eq7", "exact"])
@pytest.mark.parametrize("p_truth", [0.99, 0.5])
@given(steps=st.lists(observed | questions, max_size=8), prior=weights)
def test_prior_and_parts_together_are_the_belief(
    likelihood: str, p_truth: float, steps: list[Observation | Point], prior: list[float]
) -> None:
    problem = table(VOCABULARIES, gesture_likelihood=likelihood, p_truth=p_truth)
    agent = Agent(problem.scene, prior=[weight / sum(prior) for weight in prior])
    for step in steps:
        if isinstance(step, Point):
            agent.did(step)
        else:
            agent.update(step)
    found = agent.evidence
    together = np.exp(found.prior + found.words + found.answers + found.pointing - found.words.max())
    assert (together / together.sum()).tolist() == pytest.approx(agent.belief.tolist(), rel=1e-9, abs=1e-15)
    for rival in (1, 2, 3):
        if agent.belief[0] > 1e-290 and agent.belief[rival] > 1e-290:
            expected = math.log(agent.belief[0] / agent.belief[rival])
            assert found.log_odds(0, rival).total == pytest.approx(expected, abs=1e-9)


# By hand, two items: a cup at the left; a red cup, of two words, half a metre to its right.

PAIR = table([["cup"], ["cup", "red"]])


def parts(agent: Agent) -> list[float]:
    """Log-odds of the first item against the second: prior, words, answers, pointing."""
    return list(dataclasses.astuple(agent.evidence.log_odds(0, 1)))


def test_hand_worked_words() -> None:
    agent = Agent(PAIR.scene)
    agent.observe("red")
    # Eq. 5, alpha 0.2, two words in all: 0.2 / (1 + 0.4) against 1.2 / (2 + 0.4).
    assert parts(agent) == pytest.approx([0.0, math.log((0.2 / 1.4) / (1.2 / 2.4)), 0.0, 0.0])
    agent.observe("cup")
    # and 1.2 / 1.4 against 1.2 / 2.4 on top.
    assert agent.evidence.log_odds(0, 1).words == pytest.approx(math.log(0.2 / 1.2 * (2.4 / 1.4) ** 2))


def test_hand_worked_answers() -> None:
    agent = Agent(PAIR.scene)
    agent.observe("no")
    assert parts(agent) == pytest.approx([0.0, 0.0, 0.0, 0.0])  # Table I, i_r null
    agent.did(Point(0))
    agent.observe("no")
    assert parts(agent) == pytest.approx([0.0, 0.0, math.log(0.01 / 0.99), 0.0])
    agent.did(Point(1))
    agent.observe("yes")
    assert agent.evidence.log_odds(0, 1).answers == pytest.approx(2 * math.log(0.01 / 0.99))


def test_hand_worked_pointing() -> None:
    agent = Agent(PAIR.scene)
    head, left = (0.0, 0.0, 1.6), (-0.25, 2.0, 0.75)
    agent.observe(head=head, wrist=left)
    # Eq. 7, sigma 0.15: at angle 0 of the left one; the two directions are (-+0.25, 2, -0.85).
    length = 0.25**2 + 2.0**2 + 0.85**2
    angle = math.acos((-(0.25**2) + 2.0**2 + 0.85**2) / length)
    assert parts(agent) == pytest.approx([0.0, 0.0, 0.0, 0.5 * (angle / 0.15) ** 2])
    assert agent.evidence.log_odds(1, 0).pointing == pytest.approx(-0.5 * (angle / 0.15) ** 2)


def test_a_prior_is_evidence_too() -> None:
    agent = Agent(PAIR.scene, prior=[0.8, 0.2])
    assert parts(agent) == pytest.approx([math.log(4.0), 0.0, 0.0, 0.0])


def test_what_is_impossible_is_infinite() -> None:
    agent = Agent(PAIR.scene, model={"p_truth": 1.0})
    agent.did(Point(0))
    agent.observe("no")
    assert agent.evidence.log_odds(1, 0).answers == math.inf
    assert agent.evidence.log_odds(0, 1).total == -math.inf


def test_a_question_is_unanswered_until_a_response() -> None:
    agent = Agent(PAIR.scene)
    assert agent.evidence.unanswered is None
    agent.did(Point(1))
    assert agent.evidence.unanswered == 1
    agent.did(Wait())
    agent.observe("cup")
    assert agent.evidence.unanswered == 1
    agent.did(Point(0))
    assert agent.evidence.unanswered == 0
    agent.observe("cup yes")
    assert agent.evidence.unanswered is None
    agent.did(Pick(1))
    assert agent.evidence.unanswered is None


def test_evidence_cannot_be_written_to() -> None:
    evidence = Evidence.none(np.log([0.5, 0.5]))
    for sums in (evidence.prior, evidence.words, evidence.answers, evidence.pointing):
        with pytest.raises(ValueError, match="read-only"):
            sums[0] = 1.0

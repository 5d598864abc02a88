"""A person before a robot: one interaction of a study."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Pick, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.search.planner import ExactAnswers
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.encounter import Encounter, encounter
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.trial import Assignment, scored

from .people.plain import still

CLOCK = Durations()
AMBIGUOUS, UNAMBIGUOUS = Scene.load("ambiguous"), Scene.load("unambiguous")


def met(seed: int, people: People | None = None, scene: Scene = AMBIGUOUS, desired: int = 3) -> Encounter:
    rng = default_rng(seed)
    traits = (people or People()).traits(rng)
    return encounter(Agent(scene, ExactAnswers(), seed=seed), desired, traits, CLOCK, rng)


@pytest.mark.parametrize("seed", range(8))
def test_the_same_seed_gives_the_same_events(seed: int) -> None:
    one, other = met(seed), met(seed)
    assert one.begun == other.begun
    assert [(type(e), e.time) for e in one.events] == [(type(e), e.time) for e in other.events]
    assert [e.observation for e in one.events if isinstance(e, Observed)] == [
        e.observation for e in other.events if isinstance(e, Observed)
    ]
    assert [e.action for e in one.events if isinstance(e, Acted)] == [
        e.action for e in other.events if isinstance(e, Acted)
    ]


def test_people_without_errors_get_what_they_want_from_every_paradigm() -> None:
    traits = still(descriptors=(0.0, 0.0, 1.0), reach=0.65).traits(default_rng(0))
    for planner in (PaperNeverAsk(), PaperAlwaysAsk(), ExactAnswers()):
        for desired, item in enumerate(UNAMBIGUOUS.items):
            found = encounter(Agent(UNAMBIGUOUS, planner), desired, traits, CLOCK, default_rng(1))
            trial = scored(Assignment(0, "unambiguous", "any", item.id, 0), found.events, UNAMBIGUOUS, found.begun)
            assert trial.correct
            assert 0.0 < trial.time < 20.0
            assert trial.questions >= isinstance(planner, PaperAlwaysAsk)


def test_a_pick_before_the_request_took_no_time() -> None:
    assignment = Assignment(0, "unambiguous", "any", UNAMBIGUOUS.items[0].id, 0)
    trial = scored(assignment, [Acted(Pick(0), time=0.0)], UNAMBIGUOUS, 0.5)
    assert (trial.time, trial.correct, trial.waits) == (0.0, True, 0)
    assert scored(assignment, [Acted(Wait(), time=0.0), Acted(Pick(1), time=2.0)], UNAMBIGUOUS, 0.5).time == 1.5


def test_a_misheard_yes_makes_the_always_asking_robot_ask_again() -> None:
    people = still(
        confusions={said: {"hand": 1.0} for said in ("yes", "yeah", "yup", "sure")}, descriptors=(0.0, 0.0, 1.0)
    )
    traits = people.traits(default_rng(0))
    heard = {"clear": still(descriptors=(0.0, 0.0, 1.0)).traits(default_rng(0)), "misheard": traits}
    questions = {}
    for name, person in heard.items():
        found = encounter(Agent(AMBIGUOUS, PaperAlwaysAsk()), 3, person, CLOCK, default_rng(4))
        questions[name] = sum(isinstance(e, Acted) and type(e.action).__name__ == "Point" for e in found.events)
        words = {word for e in found.events if isinstance(e, Observed) for word in e.observation.words}
        assert ("hand" in words and "yes" not in words) or name == "clear"
    assert questions["misheard"] > questions["clear"]


def test_the_bias_of_a_person_is_in_all_their_trials() -> None:
    """With no other error, the rays of one person are off by the same angle whatever they ask for."""
    traits = dataclasses.replace(still().traits(default_rng(0)), bias=(0.05, 0.0))
    angles = []
    for desired in range(6):
        found = encounter(Agent(UNAMBIGUOUS, PaperNeverAsk()), desired, traits, CLOCK, default_rng(desired))
        rays = [e.observation.ray for e in found.events if isinstance(e, Observed) and e.observation.ray]
        aim = np.subtract(UNAMBIGUOUS.items[desired].position, UNAMBIGUOUS.head)
        arm = np.subtract(rays[-1].wrist, rays[-1].head)
        angles.append(np.arccos(aim @ arm / np.linalg.norm(aim) / np.linalg.norm(arm)))
    assert angles == pytest.approx([0.05] * 6, abs=1e-6)


def test_the_layout_matters_by_its_places_alone() -> None:
    far = dataclasses.replace(AMBIGUOUS, items=tuple(reversed(AMBIGUOUS.items)))
    one, other = met(5, desired=3), met(5, scene=far, desired=2)
    assert one.begun == other.begun
    words = [[e.observation.words for e in found.events if isinstance(e, Observed)][:3] for found in (one, other)]
    assert words[0] == words[1]


def test_more_is_missed_from_farther_away() -> None:
    people, heard = still(p_miss=0.2, miss_per_doubling=1.0, p_point=0.0), {}
    for name, scene in (("near", UNAMBIGUOUS), ("far", AMBIGUOUS)):
        firsts = [met(seed, people, scene).events for seed in range(200)]
        heard[name] = sum(
            any(e.observation.words for e in events if isinstance(e, Observed) and (e.time or 0.0) < 6.0)
            for events in firsts
        )
    assert heard["near"] > heard["far"] + 30


def test_an_item_that_is_not_there_is_refused() -> None:
    with pytest.raises(StudyError, match=r"^desired: found 6, expected an index below 6"):
        met(0, desired=6)

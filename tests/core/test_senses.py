"""Ears and eyes read step by step: words and their steps, and frames to a ray."""

from __future__ import annotations

import math

import pytest

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.hearing import texts
from fetch_pomdp.core.language.answers import PAPER, After
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Frame
from fetch_pomdp.core.senses import Senses, StreamPace, median_ray, pointing_arms
from fetch_pomdp.errors import ObservationError
from tests.core.staged import HEAD, Ears, Eyes, frame, towards

PROBLEM = Agent("ambiguous").problem


def test_median_of_pointing_frames_ignores_a_stray_one() -> None:
    steady = [frame(0.1 * k, towards(0.075)) for k in range(4)]
    stray = frame(0.9, towards(-0.375))
    ray = median_ray([*steady, stray], PROBLEM)
    assert ray is not None
    assert angles(ray, PROBLEM)[3] < 1e-9


def test_median_of_directions_not_of_lengths() -> None:
    # The arm in the middle is four times as long; of each coordinate of plain arms, the median would point at item 4.
    x, y, z = (h + 4 * (w - h) for h, w in zip(HEAD, towards(0.075), strict=True))
    ray = median_ray([frame(0, towards(-0.375)), frame(0, (x, y, z)), frame(0, towards(0.375))], PROBLEM)
    assert ray is not None
    assert angles(ray, PROBLEM)[3] < 0.01


def test_median_follows_a_moving_head() -> None:
    moved = (1.0, 0.0, 1.6)
    wrist = tuple(h + 0.2 * (p - h) for h, p in zip(moved, (0.375, 3.2, 0.75), strict=True))
    ray = median_ray([frame(0, (wrist[0], wrist[1], wrist[2]), head=moved)] * 3, PROBLEM)
    assert ray is not None
    assert ray.head == moved
    assert angles(ray, PROBLEM)[5] < 1e-9


def test_frames_that_do_not_point_do_not_count() -> None:
    down = (0.2, 0.0, 0.9)
    assert median_ray([frame(0, down)] * 5, PROBLEM) is None
    assert median_ray([], PROBLEM) is None
    ray = median_ray([*[frame(0, down)] * 5, frame(0, towards(0.375))], PROBLEM)
    assert ray is not None
    assert angles(ray, PROBLEM)[5] < 1e-9


def test_the_arm_that_points_best_counts_whichever_it_is() -> None:
    down, up = (0.2, 0.0, 0.9), towards(-0.225)
    for wrists in ((down, up), (up, down), (towards(-0.225, z=1.0), up), (up, towards(-0.225, z=1.0))):
        heads, arms = pointing_arms([frame(0, *wrists)], PROBLEM)
        assert heads.tolist() == [list(HEAD)]
        assert arms.tolist() == [list(up)]
    assert pointing_arms([Frame(0, HEAD, ())], PROBLEM)[0].shape == (0, 3)


@pytest.mark.parametrize("wrist", [HEAD, (math.nan, 0.0, 0.0), (0.0, 2e6, 0.0)])
def test_an_arm_that_is_no_ray_is_refused(wrist: tuple[float, float, float]) -> None:
    with pytest.raises(ObservationError, match=r"^wrist: found"):
        median_ray([frame(0, towards(0.0)), frame(0, wrist)], PROBLEM)


def test_opposed_rays_that_cancel_are_no_gesture() -> None:
    wide = Agent("ambiguous", model={"gesture_threshold": math.pi}).problem
    assert median_ray([frame(0, (1.0, 0.0, 1.6)), frame(0, (-1.0, 0.0, 1.6))], wide) is None


# Steps.


def senses(*words: tuple[str, float]) -> Senses:
    return Senses(PROBLEM, Ears(*words), Eyes(frame(0.5, towards(0.075)), frame(2.5, towards(-0.375))), StreamPace())


def test_a_step_holds_what_ended_in_it() -> None:
    both = senses(("green", 0.4), ("marker", 1.0), ("please", 1.1))
    first, second, third = (both.perceive(due, PAPER, After.NOTHING) for due in (1.0, 2.0, 3.0))
    assert [texts(step.words) for step in (first, second, third)] == [("green", "marker"), ("please",), ()]
    assert [step.time for step in (first, second, third)] == [1.0, 2.0, 3.0]
    assert [step.early for step in (first, second, third)] == [False] * 3
    assert second.observation == Observation(("please",))
    assert first.observation.ray is not None
    assert angles(first.observation.ray, PROBLEM)[3] < 1e-9
    assert third.observation.ray is not None
    assert angles(third.observation.ray, PROBLEM)[0] < 1e-9


def test_early_answers_are_taken_and_other_words_are_kept() -> None:
    both = senses(("green", 0.4), ("no", 0.8), ("marker", 1.6))
    early = both.answers(1.0, PAPER, After.QUESTION)
    assert early is not None
    assert (early.observation, early.early, early.time) == (Observation(("no",)), True, 1.0)
    assert both.answers(1.5, PAPER, After.QUESTION) is None
    assert both.perceive(2.0, PAPER, After.QUESTION).observation.words == ("green", "marker")


@pytest.mark.parametrize(("begins", "rest"), [(0.85, ("that", "one")), (1.4, ("yes",))])
def test_what_follows_an_early_answer_at_once_is_the_rest_of_it(begins: float, rest: tuple[str, ...]) -> None:
    """ "no, that one" in one breath answers once; "that one" half a second later confirms the question."""
    agent = Agent("ambiguous")
    both = senses(("no", 0.8), ("that", begins + 0.1), ("one", begins + 0.2))
    assert both.answers(0.82, agent.answers, After.QUESTION) is not None
    assert both.perceive(2.0, agent.answers, After.QUESTION).observation.words == rest


def test_without_ears_and_eyes_nothing_is_perceived() -> None:
    nothing = Senses(PROBLEM, None, None, StreamPace())
    assert nothing.answers(1.0, PAPER, After.QUESTION) is None
    found = nothing.perceive(2.0, PAPER, After.NOTHING)
    assert (found.observation, found.words, found.time) == (Observation(), (), 2.0)


class Talkative(Ears):
    """Ears that know when an utterance ends that goes on."""

    def utterance_end(self, time: float) -> float:
        return time + 0.7


def test_a_step_goes_on_to_the_end_of_an_utterance() -> None:
    found = Senses(PROBLEM, Talkative(("marker", 1.6)), None, StreamPace()).perceive(1.0, PAPER, After.NOTHING)
    assert found.time == 1.7
    assert found.observation.words == ("marker",)

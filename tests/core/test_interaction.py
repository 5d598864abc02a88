"""One interaction on the clock of its streams, with ears, eyes and a robot written here."""

from __future__ import annotations

import math

import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.interaction import Timing, interact
from fetch_pomdp.core.language.answers import PAPER
from fetch_pomdp.core.ports import Failure, Outcome
from fetch_pomdp.errors import ModelError
from tests.core.scripted import Script
from tests.core.staged import Arm, Ears, Eyes, acted, frame, observed, towards


def run(
    script: Script, ears: Ears | None = None, eyes: Eyes | None = None, arm: Arm | None = None
) -> tuple[Agent, list[Event]]:
    agent = Agent("ambiguous", script)
    return agent, list(interact(agent, arm or Arm(), ears, eyes))


def test_words_land_in_the_step_in_which_they_end() -> None:
    ears = Ears(("bowl", 0.4), ("black", 1.0), ("marker", 1.01), ("green", 2.9))
    _, events = run(Script(Wait(), Wait(), Wait()), ears)
    assert [event.observation.words for event in observed(events)] == [("bowl", "black"), ("marker",), ("green",)]
    assert [event.time for event in events] == [0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]
    assert [event.words[0].text for event in observed(events)] == ["bowl", "marker", "green"]


def test_an_answer_after_the_question_is_read_with_it() -> None:
    agent, events = run(Script(Point(2)), Ears(("no", 2.5)))
    assert [event.observation.words for event in observed(events)] == [("no",)]
    assert [event.time for event in events] == [pytest.approx(1.8), pytest.approx(2.8), pytest.approx(2.8)]
    assert agent.belief[2] < 0.01


def test_an_answer_before_the_question_has_ended_is_read_with_the_one_before() -> None:
    agent, events = run(Script(Point(2), Point(4)), Ears(("no", 2.8 + 1.7), ("yes", 2.8 + 2.0)))
    assert [type(event).__name__ for event in events] == ["Acted", "Observed", "Observed", "Acted", "Observed", "Acted"]
    early, late = observed(events)[1:]
    assert early.observation.words == ("no",)
    assert (early.early, late.early) == (True, False)
    assert early.time == pytest.approx(4.6)
    assert late.observation.words == ("yes",)
    assert agent.belief[2] < 0.01, "'no' was about item 2"
    assert agent.belief[4] > 0.9, "'yes' is about item 4"


def test_an_early_answer_to_nothing_moves_nothing() -> None:
    agent, events = run(Script(Point(2)), Ears(("no", 1.0)))
    assert observed(events)[0].observation.words == ("no",)
    assert agent.belief == pytest.approx([1 / 6] * 6)


def test_without_early_words_there_is_no_early_observation() -> None:
    _, events = run(Script(Point(2), Point(3)), Ears())
    assert [type(event).__name__ for event in events] == ["Acted", "Observed", "Acted", "Observed", "Acted"]


def test_words_are_tokenized() -> None:
    _, events = run(Script(Wait()), Ears(("The MARKER,", 0.5)))
    assert observed(events)[0].observation.words == ("the", "marker")


def test_after_the_end_of_the_streams_there_is_silence() -> None:
    agent, events = run(Script(*[Wait()] * 4))
    assert all(event.observation.words == () and event.observation.ray is None for event in observed(events))
    assert len(observed(events)) == 4
    assert agent.belief == pytest.approx([1 / 6] * 6)


def test_times_are_parameters() -> None:
    agent, ears = Agent("ambiguous", Script(Wait(), Point(1))), Ears()
    events = list(interact(agent, Arm(), ears, None, timing=Timing(wait=0.5, question=2.0, listen=0.75)))
    assert [event.time for event in events] == pytest.approx([0.0, 0.5, 1.75, 2.5, 2.5])
    assert ears.asked_until == pytest.approx([0.5, 1.75, 2.5])


@pytest.mark.parametrize(("wait", "question"), [(0.0, 1.0), (-1.0, 1.0), (1.0, 0.9), (math.nan, 1.0), (1.0, math.inf)])
def test_times_that_are_none(wait: float, question: float) -> None:
    with pytest.raises(ModelError, match=r"^timing: found wait"):
        Timing(wait=wait, question=question)


@pytest.mark.parametrize("overlap", [-0.1, 1.9, math.nan])
def test_an_overlap_that_is_none(overlap: float) -> None:
    with pytest.raises(ModelError, match=r"^timing: found an overlap"):
        Timing(overlap=overlap)


def test_an_answer_to_a_question_whose_words_have_begun_is_read_with_it() -> None:
    # The questions end at 1.8 and 4.6 s; with an overlap of 0.8 s they can be answered from 1.0 and 3.8 s on.
    agent = Agent("ambiguous", Script(Point(2), Point(4)))
    ears = Ears(("no", 1.1), ("no", 3.7), ("yes", 3.9))
    events = list(interact(agent, Arm(), ears, None, timing=Timing(overlap=0.8)))
    assert [event.observation.words for event in observed(events)] == [("no",), ("no",), ("yes",)]
    assert agent.belief[2] < 0.001
    assert agent.belief[4] > 0.9


def test_words_that_stop_a_pick_deny_its_item() -> None:
    agent, events = run(Script(Pick(1), Wait()), Ears(("stop", 0.5), ("stop", 1.5)), arm=Arm(Outcome.STOPPED))
    assert [event.observation.words for event in observed(events)] == [("no",), ("stop",)]
    assert agent.asked == 1
    assert agent.belief[1] < 0.01


def test_answers_are_read_as_people_give_them() -> None:
    agent, events = run(Script(Point(2), Wait()), Ears(("that's", 1.9), ("the", 2.1), ("one", 2.3), ("right", 3.5)))
    assert [event.observation.words for event in observed(events)] == [("yes",), ("right",)]
    assert [word.text for word in observed(events)[0].words] == ["that's", "the", "one"]
    assert agent.belief[2] > 0.9


def test_an_early_phrase_is_an_answer_to_the_question_before() -> None:
    ears = Ears(("wrong", 2.8 + 0.5), ("one", 2.8 + 0.7), ("marker", 2.8 + 2.0))
    agent, events = run(Script(Point(2), Point(4)), ears)
    assert [event.observation.words for event in observed(events)] == [(), ("no",), ("marker",)]
    assert agent.belief[2] < 0.01


def test_the_rest_of_an_early_answer_does_not_answer_the_next_question() -> None:
    ears = Ears(("no", 2.8 + 1.7), ("that", 2.8 + 1.85), ("one", 2.8 + 2.0))
    agent, events = run(Script(Point(2), Point(4)), ears)
    assert [event.observation.words for event in observed(events)] == [(), ("no",), ("that", "one")]
    assert agent.belief[4] == pytest.approx(0.2, abs=0.01)


def test_a_reader_may_be_given() -> None:
    agent = Agent("ambiguous", Script(Point(2)))
    events = list(interact(agent, Arm(), Ears(("yep", 2.5)), None, answers=PAPER))
    assert [event.observation.words for event in observed(events)] == [("yep",)]


def test_frames_of_a_step_become_one_ray() -> None:
    eyes = Eyes(*[frame(0.1 * k, towards(0.075)) for k in range(1, 11)], frame(1.05, towards(-0.375)))
    agent, events = run(Script(Wait(), Wait()), None, eyes)
    first, second = (event.observation.ray for event in observed(events))
    assert first is not None
    assert second is not None
    assert angles(first, agent.problem)[3] < 1e-9
    assert angles(second, agent.problem)[0] < 1e-9


def test_frames_during_a_question_belong_to_its_step() -> None:
    eyes = Eyes(frame(0.5, towards(0.075)), frame(2.0, towards(0.075)))
    _, events = run(Script(Point(0)), Ears(("no", 0.4)), eyes)
    early, late = observed(events)
    assert early.observation.ray is None
    assert late.observation.ray is not None


def test_words_that_are_no_answers_wait_for_the_end_of_the_question() -> None:
    _, events = run(Script(Wait(), Point(0)), Ears(("green", 1.5), ("no", 1.7), ("marker", 3.0)))
    first, early, late = observed(events)
    assert first.observation.words == ()
    assert early.observation.words == ("no",)
    assert late.observation.words == ("green", "marker")


# Robots that fail.


@pytest.mark.parametrize("outcome", [Outcome.FAILED, Outcome.STOPPED])
def test_a_pick_that_was_not_done_is_resumed(outcome: Outcome) -> None:
    arm = Arm(outcome)
    agent, events = run(Script(Pick(1), Wait(), Pick(3)), Ears(("marker", 0.5)), arm=arm)
    assert arm.done[0] == "pick bowl-2"
    assert arm.done[1].startswith("say ")
    assert arm.done[2:] == ["pick marker-2"]
    assert [event.outcome for event in acted(events)] == [outcome, Outcome.DONE, Outcome.DONE]
    assert observed(events)[0].observation.words == ("marker",)
    assert agent.belief[3] > 0.3


def test_a_robot_that_knows_why_it_failed_is_believed() -> None:
    _, events = run(Script(Pick(1), Pick(3)), arm=Arm(Failure("blocked by bowl-1")))
    first, second = acted(events)
    assert (first.outcome, first.reason, first.done) == (Outcome.FAILED, "blocked by bowl-1", False)
    assert (second.outcome, second.reason) == (Outcome.DONE, "")


@pytest.mark.parametrize("outcome", [Outcome.FAILED, Outcome.STOPPED])
def test_a_question_that_was_not_done_does_not_set_i_r(outcome: Outcome) -> None:
    script = Script(Point(1), Wait())
    agent, events = run(script, Ears(("no", 2.5)), arm=Arm(outcome))
    assert script.asked == [None, None, None]
    assert agent.belief == pytest.approx([1 / 6] * 6)
    assert acted(events)[0].outcome is outcome


def test_a_question_that_was_not_done_keeps_the_one_before() -> None:
    script = Script(Point(1), Point(2))
    agent, _ = run(script, Ears(("no", 5.5)), arm=Arm(Outcome.DONE, Outcome.FAILED))
    assert script.asked == [None, 1, 1]
    assert agent.belief[1] < 0.01
    assert agent.belief[2] > 0.15


def test_it_ends_after_thirty_waits_and_questions() -> None:
    script = Script(*[Wait()] * 40)
    _, events = run(script)
    assert len(acted(events)) == len(observed(events)) == 30
    assert len(script.asked) == 30


def test_a_pick_that_always_fails_ends_too() -> None:
    _, events = run(Script(), arm=Arm(*[Outcome.FAILED] * 100))
    assert len(acted(events)) == 30


def test_events_come_as_they_happen() -> None:
    agent, arm = Agent("ambiguous", Script(Wait(), Point(2))), Arm()
    events = interact(agent, arm, Ears(), None)
    next(events)
    assert arm.done == []
    next(events)
    next(events)
    assert arm.done == ["point marker-1"]
    assert agent.asked == 2


def test_decisions_are_in_the_events() -> None:
    _, events = run(Script(Wait()))
    for event in acted(events):
        assert event.decision is not None
        assert event.decision.action == event.action


def test_our_planner_hands_over_what_was_said_and_shown() -> None:
    agent, arm = Agent("ambiguous", model={"sigma": 0.02}), Arm()
    ears, eyes = Ears(("marker", 0.5)), Eyes(*[frame(0.1 * k, towards(0.075)) for k in range(1, 10)])
    events = list(interact(agent, arm, ears, eyes))
    assert acted(events)[-1].action == Pick(3)
    assert arm.done == ["pick marker-2"]


def test_what_was_said_before_is_heard_before_the_first_decision() -> None:
    script = Script(Wait(), Pick(0))
    ears = Ears(("marker", 0.2), ("green", 1.4))
    timing = Timing(before=1.0)
    events = list(interact(Agent("ambiguous", script), Arm(), ears, None, timing=timing))
    first, second = events[0], events[1]
    assert isinstance(first, Observed)
    assert first.observation.words == ("marker",)
    assert first.time == 1.0
    assert isinstance(second, Acted)
    assert second.action == Wait()
    assert [event.observation.words for event in events if isinstance(event, Observed)] == [("marker",), ("green",)]


def test_listening_before_takes_some_time_or_none() -> None:
    with pytest.raises(ModelError, match="before the first decision"):
        Timing(before=-1.0)

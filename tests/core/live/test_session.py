"""Live interactions on a clock that steps, with schedules worked out by hand, and one on the real clock."""

from __future__ import annotations

import threading
import time
from functools import partial

import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.interaction import Timing
from fetch_pomdp.core.live import BeliefChanged, Ended, Heard, Inbox, LiveSession, Update
from fetch_pomdp.core.ports import Frame, Outcome, Word
from fetch_pomdp.core.scene import Item
from tests.core.live.stepped import Stage
from tests.core.scripted import Script

HEAD = (0.0, 0.0, 1.6)
SIXTH = [1 / 6] * 6


def towards(x: float) -> tuple[float, float, float]:
    """A wrist on the ray from HEAD to (x, 3.2, 0.75)."""
    return (x * 0.2, 3.2 * 0.2, 1.6 - 0.85 * 0.2)


def after(*utterances: str) -> list[float]:
    """The belief of an agent that heard each utterance in a step of its own."""
    agent = Agent("ambiguous", Script())
    for utterance in utterances:
        agent.observe(utterance)
    return list(agent.belief)


def test_typed_words_move_the_belief_at_once_and_are_committed_when_the_step_ends() -> None:
    stage = Stage(Wait())
    stage.word(0.4, "marker")
    stage.run()
    first, shown, committed = stage.beliefs
    assert first[0] == 0.0
    assert first[1].belief == pytest.approx(SIXTH)
    assert (shown[0], shown[1].provisional, shown[1].words) == (0.4, True, ("marker",))
    assert shown[1].belief == pytest.approx(after("marker"))
    assert (committed[0], committed[1].provisional) == (1.0, False)
    assert committed[1].belief == pytest.approx(after("marker"))
    assert stage.ended == ["bowl-1"]
    assert [event.time for event in stage.acted] == [0.0, 3.0]


def test_a_hypothesis_that_is_replaced_leaves_no_trace() -> None:
    stage = Stage(Wait())
    stage.partial(0.3, "bowl")
    stage.partial(0.5, "marker")
    stage.final(0.7, "marker")
    stage.run()
    shown = [(at, belief.words, belief.provisional) for at, belief in stage.beliefs[1:]]
    assert shown == [(0.3, ("bowl",), True), (0.5, ("marker",), True), (1.0, ("marker",), False)]
    assert stage.beliefs[1][1].belief == pytest.approx(after("bowl"))
    assert stage.beliefs[2][1].belief == pytest.approx(after("marker"))
    assert [event.observation.words for event in stage.observed] == [("marker",)]
    assert stage.agent.belief == pytest.approx(after("marker"))


def test_a_step_goes_on_to_the_end_of_an_utterance() -> None:
    stage = Stage(Wait())
    stage.partial(0.9)
    stage.partial(1.2, "green")
    stage.final(1.7, "green", "marker")
    stage.run()
    (event,) = stage.observed
    assert event.observation.words == ("green", "marker")
    assert event.time == pytest.approx(1.7)
    assert stage.statuses == []


def test_a_word_that_comes_late_is_read_in_the_step_in_which_it_comes() -> None:
    stage = Stage(Wait(), Wait())
    stage.clock.at(1.3, lambda: stage.inbox.push_word(Word("marker", 0.7, 0.9, 0.8)))
    stage.run()
    assert [event.observation.words for event in stage.observed] == [(), ("marker",)]
    assert stage.observed[1].words == (Word("marker", 0.7, 0.9, 0.8),)


def test_an_answer_while_the_robot_still_asks_counts() -> None:
    # The question takes until 1.8, its words begin at 1.0: "no" at 1.5 is about item 2, whose question it is.
    stage = Stage(Point(2))
    stage.word(1.5, "no")
    stage.run()
    assert stage.acted[0].time == pytest.approx(1.8)
    assert [event.observation.words for event in stage.observed] == [("no",)]
    assert stage.agent.belief[2] < 0.01


def test_an_answer_before_the_arm_has_arrived_is_about_the_question_before() -> None:
    stage = Stage(Point(2), Point(4))
    stage.word(2.8 + 0.6, "no")
    stage.word(2.8 + 1.4, "yes")
    stage.run()
    assert [event.observation.words for event in stage.observed] == [(), ("no",), ("yes",)]
    assert stage.agent.belief[2] < 0.01
    assert stage.agent.belief[4] > 0.9


@pytest.mark.parametrize("word", ["no", "stop", "wrong", "nein", "stopp", "wait"])
def test_a_pick_is_stopped_and_its_item_is_ruled_out(word: str) -> None:
    stage = Stage(Pick(2), Pick(3))
    stage.word(0.7, word)
    stage.run()
    assert stage.robot.done[:3] == ["pick marker-1", "stop at 0.7", "say All right, not that one."]
    assert [event.outcome for event in stage.acted] == [Outcome.STOPPED, Outcome.DONE]
    (event,) = stage.observed
    assert event.observation.words == ("no",)
    assert event.words[0].text == word
    assert event.time == pytest.approx(0.7 + 0.5 + 1.0)
    assert stage.script.asked == [None, 2]
    assert stage.agent.belief[2] < 0.01
    assert stage.ended == ["marker-2"]


def test_half_a_hypothesis_stops_a_pick() -> None:
    stage = Stage(Pick(2), Pick(3))
    stage.partial(0.7, "no")
    stage.final(1.6, "no", "the", "other")
    stage.run()
    assert stage.robot.done[1] == "stop at 0.7"
    assert stage.observed[0].observation.words == ("no", "the", "other")


def test_other_words_stop_no_pick_and_a_stop_after_the_hand_over_is_too_late() -> None:
    stage = Stage(Pick(2))
    stage.word(0.7, "marker")
    stage.word(2.5, "no")
    stage.run()
    assert stage.robot.done == ["pick marker-1"]
    assert stage.ended == ["marker-1"]


def test_an_objection_that_came_while_the_robot_decided_keeps_it_from_the_pick() -> None:
    stage = Stage(Pick(2), Pick(3))
    decide = stage.script.decide

    def slow(*args: object, **named: object) -> object:
        stage.clock.wait_until(stage.clock.now() + 0.2, threading.Event())
        return decide(*args, **named)  # type: ignore[arg-type]

    stage.script.decide = slow  # type: ignore[method-assign, assignment]
    stage.word(0.1, "wait")
    stage.run()
    assert stage.robot.done[0] == "say All right, not that one."
    assert stage.ended == ["marker-2"]


def test_thirty_frames_a_second_are_one_gesture_a_step() -> None:
    stage = Stage(Wait())
    for k in range(30):
        frame = Frame(k / 30, HEAD, (towards(0.075),))
        stage.clock.at(k / 30, lambda frame=frame: stage.inbox.push_frame(frame))  # type: ignore[misc]
    stage.run()
    once = Agent("ambiguous", Script())
    once.observe(head=HEAD, wrist=towards(0.075))
    assert stage.agent.belief == pytest.approx(once.belief)
    ray = stage.observed[0].observation.ray
    assert ray is not None
    assert angles(ray, once.problem)[3] < 1e-9
    provisional = [belief for _, belief in stage.beliefs if belief.provisional]
    assert provisional[0].belief == pytest.approx(once.belief)
    assert len(provisional) == 1, "a gesture that stays what it was is told once"


def test_a_moving_gesture_is_shown_ten_times_a_second() -> None:
    stage = Stage(Wait())
    for k in range(30):
        frame = Frame(k / 30, HEAD, (towards(-0.375 + 0.02 * k),))
        stage.clock.at(k / 30, lambda frame=frame: stage.inbox.push_frame(frame))  # type: ignore[misc]
    stage.run()
    assert 8 <= sum(belief.provisional for _, belief in stage.beliefs) <= 11


def test_a_lost_sensor_is_told_once_and_ends_nothing() -> None:
    stage = Stage(*[Wait()] * 12)  # and half a second of "I am listening." after each fourth
    for k in range(10):
        stage.clock.at(0.1 * k, lambda k=k: stage.inbox.alive("camera", 0.1 * k))  # type: ignore[misc]
    stage.clock.at(12.05, lambda: stage.inbox.alive("camera", 12.05))
    stage.run()
    assert stage.statuses == [(2.9, "camera", "silent"), (10.9, "camera", "lost"), (13.0, "camera", "ok")]
    assert len(stage.observed) == 12
    assert stage.ended == ["bowl-1"]


def test_a_hung_recogniser_is_given_up_and_typed_words_still_count() -> None:
    stage = Stage(Wait(), Wait(), Wait())
    stage.clock.at(0.5, lambda: stage.inbox.alive("speech", 0.5))
    stage.partial(0.5, "bowl")  # and then nothing more
    stage.word(3.0, "marker")
    stage.run()
    assert (2.5, "speech", "slow") in stage.statuses
    assert [event.time for event in stage.observed] == pytest.approx([2.5, 3.5, 4.5])
    assert [event.observation.words for event in stage.observed] == [(), ("marker",), ()]
    assert stage.agent.belief == pytest.approx(after("marker"))


def test_a_text_that_is_not_typed_to_its_end_is_no_fault_of_the_ears() -> None:
    stage = Stage(Wait())
    stage.partial(0.5, "bowl")  # by a keyboard: there is no sensor that could be missed
    stage.run()
    assert stage.statuses == []
    assert [event.observation.words for event in stage.observed] == [()]


def test_a_recogniser_that_comes_back_is_heard_again() -> None:
    stage = Stage(*[Wait()] * 4)
    for tenth in range(60):
        stage.clock.at(tenth / 10, partial(stage.inbox.alive, "speech", tenth / 10))
    stage.partial(0.5, "bowl")
    stage.partial(3.1, "marker")
    stage.final(3.3, "marker")
    stage.run()
    assert [state for _, _, state in stage.statuses] == ["slow", "ok"]
    assert stage.agent.belief == pytest.approx(after("marker"))


def test_talk_without_end_prolongs_a_step_by_ten_seconds_at_most() -> None:
    stage = Stage(Wait())
    for k in range(200):
        stage.partial(0.1 * k, "bowl")
    stage.run()
    assert stage.observed[0].time == pytest.approx(11.0, abs=0.1)


def test_a_robot_that_breaks_has_failed() -> None:
    stage = Stage(Pick(1), Pick(2))
    pick = stage.robot.pick

    def broken(item: Item) -> Outcome:  # noqa: ARG001
        stage.robot.pick = pick  # type: ignore[method-assign]
        raise OSError("no arm")

    stage.robot.pick = broken  # type: ignore[method-assign]
    stage.run()
    assert [event.outcome for event in stage.acted] == [Outcome.FAILED, Outcome.DONE]
    assert [state for _, name, state in stage.statuses if name == "robot"] == ["lost", "ok"]
    assert stage.ended == ["marker-1"]


def test_an_observation_the_model_holds_impossible_is_left_out() -> None:
    stage = Stage(Point(0), Wait(), Wait(), Wait(), model={"p_truth": 1.0})
    stage.word(2.5, "yes")
    stage.word(3.5, "no")
    stage.run()
    assert [event.observation.words for event in stage.observed][:1] == [("yes",)]
    assert [state for _, name, state in stage.statuses if name == "model"] == ["lost", "ok"]
    assert stage.agent.belief == pytest.approx([1, 0, 0, 0, 0, 0])
    assert stage.ended == ["bowl-1"]


def test_a_listener_that_breaks_ends_nothing() -> None:
    stage = Stage(Wait())
    listen = stage.listen

    def broken(update: Update) -> None:
        listen(update)
        raise ConnectionError("the client has gone")

    session = LiveSession(stage.agent, stage.robot, Inbox(), listener=broken, clock=stage.clock)
    session.run()
    assert stage.ended == ["bowl-1"]


def test_nobody_who_brings_something_waits_for_a_listener_and_what_they_bring_is_shown() -> None:
    stage, busy, go_on = Stage(Wait()), threading.Event(), threading.Event()

    def slow(update: Update) -> None:
        if isinstance(update, Heard):  # as if it wrote the event to a disk
            busy.set()
            go_on.wait(10)
        stage.listen(update)

    session = LiveSession(stage.agent, stage.robot, stage.inbox, listener=slow, clock=stage.clock)
    running = threading.Thread(target=session.run)
    running.start()
    assert busy.wait(10)
    typing = threading.Thread(target=stage.inbox.push_words, args=([Word("marker", 1.0, 1.0)],))
    typing.start()
    typing.join(2)
    waited = typing.is_alive()
    go_on.set()
    for thread in (running, typing):
        thread.join(10)
    assert not waited
    shown = [belief.words for _, belief in stage.beliefs if belief.provisional]
    assert ("marker",) in shown


def test_what_a_closed_session_has_not_taken_is_for_the_next_one() -> None:
    stage = Stage(Wait(), Wait(), Wait())
    stage.clock.at(0.5, stage.session.close)
    stage.word(0.5, "marker")
    stage.run()
    told = list[Update]()
    LiveSession(stage.agent, stage.robot, stage.inbox, listener=told.append, clock=stage.clock).run()
    assert next(update.event.observation.words for update in told if isinstance(update, Heard)) == ("marker",)
    assert len([update for _, update in stage.told if isinstance(update, Ended)]) == 1
    stage.inbox.push_word(Word("spoon", stage.clock.now(), stage.clock.now()))
    assert isinstance(stage.told[-1][1], Ended), "a session that is over tells nothing more"


def test_closing_ends_it_without_a_pick() -> None:
    stage = Stage(*[Wait()] * 50)
    stage.clock.at(9.2, stage.session.close)  # after two times 4 s and "I am listening."
    stage.run()
    assert stage.ended == [None]
    assert len(stage.observed) == 8


def test_what_is_given_back_is_taken_back_on_the_clock_too() -> None:
    """By hand: the pick ends at 2, "no" is heard in the second after it; then .5 s of words and 1.5 s of an arm."""
    stage = Stage(Pick(2), Pick(3), after=2.0)
    stage.word(2.4, "no")
    stage.run()
    assert stage.robot.done == [
        "pick marker-1", "say All right, not that one.", "take back marker-1", "pick marker-2",
    ]  # fmt: skip
    assert [(event.outcome, event.time) for event in stage.acted] == [
        (Outcome.DONE, 2.0), (Outcome.RETURNED, 3.0), (Outcome.DONE, 7.0),
    ]  # fmt: skip
    (objection,) = stage.observed
    assert (objection.observation.words, objection.time) == (("no",), 3.0)
    assert stage.agent.belief[2] < 0.01
    assert stage.ended == ["marker-2"]
    assert stage.clock.now() == 9.0, "two seconds of silence after the second hand-over"


def test_a_second_request_begins_anew_on_the_clock_too() -> None:
    """ "Thanks" and "yes" after the hand-over are no part of the belief, nor of what is shown with the request."""
    stage = Stage(Wait(), Pick(2), Wait(), Pick(0), after=2.0)
    stage.word(0.5, "marker")
    stage.word(3.3, "yes")
    stage.word(3.5, "thanks")
    stage.word(5.2, "bowl")
    stage.word(6.4, "white")
    stage.run()
    assert [event.observation.words for event in stage.observed] == [("marker",), ("bowl",), ("white",)]
    assert [event.anew for event in stage.observed] == [False, True, False]
    once = Agent("ambiguous", Script())
    once.observe("bowl")
    once.observe("white")
    assert stage.agent.belief == pytest.approx(once.belief)
    shown = [belief.words for at, belief in stage.beliefs if at > 6.2]
    assert shown
    assert all("thanks" not in words for words in shown), "words that began nothing are not shown for ever"
    assert stage.ended == ["bowl-1"]


def test_an_item_given_back_is_not_what_it_ended_with() -> None:
    stage = Stage(Pick(2), *[Wait()] * 20, after=2.0)
    stage.word(2.4, "no")
    stage.clock.at(8.0, stage.session.close)
    stage.run()
    assert stage.ended == [None]


def test_a_replay_of_the_events_gives_the_same_belief() -> None:
    stage = Stage(Wait(), Point(2), Pick(4), Pick(3))
    stage.partial(0.3, "bowl")
    stage.final(0.7, "marker")
    stage.word(1.0 + 1.5, "no")
    stage.word(3.8 + 0.5, "stop")
    stage.run()
    replayed = Agent("ambiguous", Script())
    events = [update.event for _, update in stage.told if hasattr(update, "event")]
    for event in events:
        replayed.take(event)
    assert replayed.belief == pytest.approx(stage.agent.belief)
    assert replayed.asked == stage.agent.asked == 4


class QuickRobot:
    """A robot that takes a tenth of a second, and can be stopped."""

    def __init__(self) -> None:
        self.stopped = threading.Event()

    def _act(self) -> Outcome:
        self.stopped.clear()
        return Outcome.STOPPED if self.stopped.wait(0.1) else Outcome.DONE

    def point(self, item: Item) -> Outcome:
        return self._act()

    def pick(self, item: Item) -> Outcome:
        return self._act()

    def take_back(self, item: Item) -> Outcome:
        return self._act()

    def say(self, text: str) -> Outcome:
        return self._act()

    def stop(self) -> None:
        self.stopped.set()


def test_the_real_clock_and_threads() -> None:
    inbox, told = Inbox(), list[Update]()
    agent = Agent("ambiguous", Script(Wait(), Point(2)))
    timing = Timing(wait=0.3, listen=0.3, question=0.4, overlap=0.05)
    session = LiveSession(agent, QuickRobot(), inbox, listener=told.append, timing=timing)
    thread = threading.Thread(target=session.run)
    thread.start()
    inbox.push_word(Word("marker", session.clock.now(), session.clock.now()))
    deadline = time.monotonic() + 120
    while agent.asked is None and time.monotonic() < deadline:
        time.sleep(0.005)
    inbox.push_word(Word("no", session.clock.now(), session.clock.now()))
    thread.join(120)
    assert not thread.is_alive()
    assert isinstance(told[-1], Ended)
    assert told[-1].picked == "bowl-1"
    assert agent.belief[2] < 0.01
    assert any(isinstance(update, BeliefChanged) and update.provisional for update in told)

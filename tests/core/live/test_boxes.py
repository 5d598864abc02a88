"""What waits to be taken: words and frames that came, updates that a slow listener has not been told."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from fetch_pomdp.core.live import BeliefChanged, Ended, Inbox, UpdateQueue
from fetch_pomdp.core.ports import Frame, Word
from fetch_pomdp.errors import ObservationError

HEAD = (0.0, 0.0, 1.6)


def frame(time: float) -> Frame:
    return Frame(time, HEAD, ((0.0, 0.6, 1.4),))


def belief(time: float) -> BeliefChanged:
    return BeliefChanged(time, np.array([1.0]), provisional=True, words=())


def test_words_are_taken_once_in_the_order_of_their_ends() -> None:
    inbox = Inbox()
    for text, end in (("marker", 2.0), ("green", 1.0), ("please", 3.0)):
        inbox.push_word(Word(text, end - 0.1, end))
    assert [word.text for word in inbox.take_words(2.5)] == ["green", "marker"]
    assert inbox.take_words(2.5) == ()
    assert [word.text for word in inbox.take_words(3.0)] == ["please"]


def test_a_flood_drops_the_oldest_frames_and_words() -> None:
    inbox = Inbox(most_frames=10, most_words=20)
    for k in range(1000):
        inbox.push_frame(frame(k))
        inbox.push_word(Word("marker", k, k))
    inbox.push_words([Word("stop", k, k) for k in range(1000, 1005)])
    assert (inbox.dropped, inbox.dropped_words) == (990, 985)
    assert [seen.time for seen in inbox.take_frames(1e9)] == list(range(990, 1000))
    assert [word.end for word in inbox.take_words(1e9)] == list(range(985, 1005))


def test_words_that_come_at_once_are_told_once_and_to_those_alone_who_still_listen() -> None:
    inbox, told, left = Inbox(), list[object](), list[object]()
    inbox.subscribe(told.append)
    leave = inbox.subscribe(left.append)
    inbox.push_partial((Word("green", 0.0, 0.4), Word("mark", 0.4, 0.8), Word("no", 1.2, 1.4)))
    leave()
    inbox.push_words([Word("green", 0.0, 0.4), Word("marker", 0.4, 1.0)])
    inbox.push_words([])
    assert (len(told), len(left)) == (2, 1)
    assert inbox.pending().partial == (Word("no", 1.2, 1.4),)


def test_a_final_word_replaces_its_hypothesis() -> None:
    inbox = Inbox()
    inbox.push_partial((Word("green", 0.0, 0.4), Word("mark", 0.4, 0.8), Word("her", 0.8, 1.0)))
    inbox.push_word(Word("green", 0.0, 0.4))
    assert inbox.pending().partial == (Word("mark", 0.4, 0.8), Word("her", 0.8, 1.0))
    inbox.push_word(Word("marker", 0.4, 1.0))
    assert inbox.pending().partial == (), "the utterance is not over before None"
    inbox.push_partial(None)
    assert inbox.pending().partial is None


@pytest.mark.parametrize("wrist", [HEAD, (float("nan"), 0.0, 0.0), (1e9, 0.0, 0.0)])
def test_an_arm_that_is_none_is_refused(wrist: tuple[float, float, float]) -> None:
    inbox = Inbox()
    with pytest.raises(ObservationError, match=r"^wrist"):
        inbox.push_frame(Frame(0.0, HEAD, (wrist,)))
    assert inbox.pending().frames == ()


def test_many_threads_lose_nothing() -> None:
    inbox, told = Inbox(most_words=2000), list[object]()
    inbox.subscribe(told.append)

    def push(number: int) -> None:
        for k in range(500):
            inbox.push_word(Word(f"{number}-{k}", k, k))

    threads = [threading.Thread(target=push, args=(number,)) for number in range(4)]
    taken: list[Word] = []
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        inbox.wake.wait(0.01)
        inbox.wake.clear()
        taken += inbox.take_words(1e9)
    taken += inbox.take_words(1e9)
    assert len(taken) == len({word.text for word in taken}) == 2000
    assert len(told) == 2000


def test_a_slow_listener_is_told_the_last_belief_and_every_event() -> None:
    outbox = UpdateQueue()
    for time in (0.0, 1.0, 2.0):
        outbox(belief(time))
    outbox(Ended(None))
    for time in (3.0, 4.0):
        outbox(belief(time))
    times = [update.time if isinstance(update, BeliefChanged) else None for update in outbox.take()]
    assert times == [2.0, None, 4.0]
    assert outbox.take(timeout=0.0) == []


def test_a_listener_waits_for_what_comes() -> None:
    outbox = UpdateQueue()
    threading.Timer(0.05, lambda: outbox(Ended("marker-1"))).start()
    assert outbox.take(timeout=30.0) == [Ended("marker-1")]

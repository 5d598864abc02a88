"""A conversation: when it begins, when it rests, and that nobody makes it work for nothing."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fetch_pomdp.adapters.web import conversation as module
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.journal import Journals
from fetch_pomdp.adapters.web.page_messages import Pointed, Typed
from fetch_pomdp.adapters.web.server_messages import Send, ServerMessage, with_insight
from fetch_pomdp.core.live import LiveSession
from fetch_pomdp.core.live.inbox import MOST_WORDS, Inbox
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header

HEADER = Header(scene=Scene.load("ambiguous"), scene_name="ambiguous", planner="paper-never")
GESTURE = Pointed((0.0, 0.0, 1.6), (0.0675, 0.576, 1.447))


@contextmanager
def talking(send: Send = lambda _: None) -> Iterator[Conversation]:
    conversation = Conversation(Journals(None).new(HEADER), send, view=with_insight, speech=Speech())
    yield conversation
    conversation.close()


class Sessions:
    """In place of live sessions: each takes the words that wait when it begins, and goes on until it is let end."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.begun: queue.Queue[tuple[str, ...]] = queue.Queue()
        self.end = threading.Semaphore(0)
        self.inboxes: list[Inbox] = []
        stage = self

        class Session(LiveSession):
            def run(self) -> None:
                stage.inboxes.append(self._inbox)
                stage.begun.put(tuple(word.text for word in self._inbox.take_words(1e9)))
                stage.end.acquire(timeout=120)

        monkeypatch.setattr(module, "LiveSession", Session)
        monkeypatch.setattr(module, "prepare", lambda *_: None)

    def next(self) -> tuple[str, ...]:
        return self.begun.get(timeout=120)


@pytest.fixture
def sessions(monkeypatch: pytest.MonkeyPatch) -> Sessions:
    return Sessions(monkeypatch)


def test_a_conversation_rests_until_there_is_something_new(sessions: Sessions) -> None:
    with talking() as conversation:
        conversation.start()
        conversation.handle(Typed("marker"))
        assert sessions.next() == ("marker",)
        conversation.handle(Typed("green"))
        sessions.inboxes[-1].take_words(1e9)  # heard in the session
        sessions.end.release()
        with pytest.raises(queue.Empty):
            sessions.begun.get(timeout=0.3)
        conversation.handle(Typed("spoon"))
        assert sessions.next() == ("spoon",)
        sessions.end.release()


def test_what_came_too_late_for_a_session_begins_the_next_one(sessions: Sessions) -> None:
    with talking() as conversation:
        conversation.start()
        conversation.handle(Typed("marker"))
        sessions.next()
        conversation.handle(Typed("green"))
        sessions.end.release()
        assert sessions.next() == ("green",)
        conversation.handle(GESTURE)
        sessions.end.release()
        assert sessions.next() == ()
        assert len(sessions.inboxes[-1].pending().frames) == 1
        sessions.end.release()


def test_a_line_is_read_once_however_many_words_it_has() -> None:
    told: list[ServerMessage] = []
    with talking(told.append) as conversation:
        conversation.handle(Typed("green marker please"))
    beliefs = [message["heard"] for message in told if message["type"] == "belief"]
    assert beliefs == [["green", "marker", "please"]]


def test_a_step_holds_no_more_words_than_anybody_says(sessions: Sessions) -> None:
    with talking() as conversation:
        for _ in range(20):
            conversation.handle(Typed("a " * 150))
        conversation.handle(Typed("stop"))
        conversation.start()
        words = sessions.next()
        sessions.end.release()
    assert len(words) == MOST_WORDS
    assert words[-1] == "stop"


def test_when_it_is_over_nothing_is_kept_of_what_is_said(sessions: Sessions) -> None:
    with talking() as conversation:
        conversation.start()
        conversation.handle(Typed("marker"))
        sessions.next()
        conversation.close()
        conversation.handle(Typed("spoon"))
        conversation.handle(GESTURE)
        pending = sessions.inboxes[-1].pending()
        sessions.end.release()
        assert (pending.words, pending.frames) == ((), ())

"""The server's ears before they are open, and when they do not open."""

from __future__ import annotations

import queue
from collections.abc import Sequence
from typing import Any

import pytest

from fetch_pomdp.adapters.web import ears as module
from fetch_pomdp.adapters.web.ears import AGAIN, ECHO, MOST_EARLY, Ears
from fetch_pomdp.adapters.web.page_messages import LARGEST_MESSAGE
from fetch_pomdp.core.live import Inbox, SensorState, SensorStatus
from fetch_pomdp.errors import AudioError, MessageError

SOUND = bytes(3200)  # a tenth of a second


class Recorder:
    """In place of a recogniser: what it was told, in order."""

    def __init__(self, *_: Any, **__: Any) -> None:
        self.calls: list[tuple[Any, ...]] = []
        made.put(self)

    def feed(self, pcm: bytes, begin: float) -> None:
        self.calls.append(("feed", len(pcm), round(begin, 3)))

    def mute(self, begin: float, end: float) -> None:
        self.calls.append(("mute", begin, round(end - ECHO, 3)))

    def end(self) -> None:
        self.calls.append(("end",))

    def close(self) -> None:
        self.calls.append(("close",))


made: queue.Queue[Recorder] = queue.Queue()


class Opening:
    """Ears of which each attempt to open them waits to be told how it ends, and a clock that is set by hand."""

    def __init__(self) -> None:
        self.process, self.time = self, 0.0
        self.attempts: queue.Queue[None] = queue.Queue()
        self.ends: queue.Queue[Exception | None] = queue.Queue()
        self.told: queue.Queue[SensorStatus] = queue.Queue()
        self.ears = Ears(self, ("marker",), Inbox(), lambda: self.time, self.told.put)  # type: ignore[arg-type]

    def transcriber(self, vocabulary: Sequence[str]) -> Any:
        self.attempts.put(None)
        if (error := self.ends.get(timeout=120)) is not None:
            raise error

    def detector(self) -> Any:
        return None

    def hear(self, at: float) -> None:
        self.time = at
        self.ears.hear(SOUND)

    def state(self) -> SensorState:
        return self.told.get(timeout=120).state


@pytest.fixture
def opening(monkeypatch: pytest.MonkeyPatch) -> Opening:
    monkeypatch.setattr(module, "StreamingRecognizer", Recorder)
    return Opening()


@pytest.mark.parametrize("size", [0, 1, 3, LARGEST_MESSAGE + 2])
def test_what_is_no_sound_is_refused_and_opens_nothing(opening: Opening, size: int) -> None:
    with pytest.raises(MessageError, match=f"found {size} bytes"):
        opening.ears.hear(bytes(size))
    assert opening.attempts.empty()


def test_what_happens_before_they_are_open_counts_when_they_are(opening: Opening) -> None:
    opening.ears.mute(2.0)  # until 2 s, and the echo
    opening.hear(1.0)
    opening.hear(1.1)
    opening.time = 15.0
    opening.ears.mute(1.0)
    opening.ears.end()
    opening.ends.put(None)
    recorder = made.get(timeout=120)
    opening.ears.mute(3.0)  # waits until they are open
    early = [("mute", 15.0, 16.0), ("mute", 0.0, 2.0), ("feed", 3200, 0.9), ("feed", 3200, 1.0), ("end",)]
    assert recorder.calls == [*early, ("mute", 15.0, 18.0)]
    assert opening.told.empty()


def test_a_flood_before_they_are_open_is_not_kept(opening: Opening) -> None:
    for number in range(2 * MOST_EARLY):
        opening.hear(0.1 * number)
    opening.ends.put(None)
    recorder = made.get(timeout=120)
    opening.ears.close()
    assert sum(call[0] == "feed" for call in recorder.calls) == MOST_EARLY


@pytest.mark.parametrize("error", [AudioError("found no answer, expected words"), OSError("no memory")])
def test_ears_that_do_not_open_are_told_of_and_tried_again_with_later_sound(opening: Opening, error: Exception) -> None:
    opening.hear(1.0)
    opening.time = 2.0
    opening.ends.put(error)
    assert opening.state() is SensorState.LOST
    opening.hear(2.0 + AGAIN - 0.1)
    assert opening.attempts.qsize() == 1, "not at once again"
    opening.hear(2.0 + AGAIN)
    opening.ends.put(None)
    assert made.get(timeout=120).calls[0] == ("feed", 3200, 2.0 + AGAIN - 0.1)
    assert opening.state() is SensorState.OK
    assert opening.attempts.qsize() == 2


def test_ears_of_a_conversation_that_is_over_stay_closed(opening: Opening) -> None:
    opening.ears.close()
    opening.hear(1.0)
    assert opening.attempts.empty()

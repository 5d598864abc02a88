"""Where sensors leave words and skeletons, from any thread, for the interaction to take."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from threading import Event, Lock

from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.ports import Frame, Word

MOST_FRAMES = 600  # 20 s at 30 Hz: longer than any step
MOST_WORDS = 500  # two minutes of talk: longer than any step


class News(Enum):
    """What has come into an inbox."""

    WORDS = "words"
    FRAME = "frame"


@dataclass(frozen=True, slots=True)
class Pending:
    """What has come and was not taken yet."""

    words: tuple[Word, ...]
    partial: tuple[Word, ...] | None  # of the utterance under way; None if there is none
    frames: tuple[Frame, ...]


class Inbox:
    """Words and frames with their times (s on the interaction's clock), each taken once. Safe to use from any thread.

    A flood drops the oldest frames and words, and counts what it dropped; so the last word, which may stop a hand-over,
    is always heard.
    """

    def __init__(self, most_frames: int = MOST_FRAMES, most_words: int = MOST_WORDS) -> None:
        self._lock = Lock()
        self._words: deque[Word] = deque(maxlen=most_words)
        self._partial: tuple[Word, ...] | None = None
        self._frames: deque[Frame] = deque(maxlen=most_frames)
        self._alive: dict[str, float] = {}
        self._subscribers: tuple[Callable[[News], None], ...] = ()
        self.dropped = self.dropped_words = 0
        self.wake = Event()  # set by words; cleared by whoever waits for them, before looking

    def subscribe(self, told: Callable[[News], None]) -> Callable[[], None]:
        """Call `told`, in the thread of the sensor, after words or a frame have come; it must return soon.

        Returns what ends it.
        """
        with self._lock:
            self._subscribers += (told,)
        return lambda: self._unsubscribe(told)

    def push_word(self, word: Word) -> None:
        """Leave a word that is final; the hypothesis of the utterance under way loses the words it replaces."""
        self.push_words((word,))

    def push_words(self, words: Sequence[Word]) -> None:
        """Leave words that came at once, as `push_word`; what that means is told, and computed, once."""
        if not words:
            return
        with self._lock:
            self.dropped_words += max(0, len(self._words) + len(words) - (self._words.maxlen or 0))
            self._words.extend(words)
            if self._partial is not None:
                end = max(word.end for word in words)
                self._partial = tuple(guess for guess in self._partial if guess.start >= end)
        self._tell(News.WORDS)

    def push_partial(self, words: tuple[Word, ...] | None) -> None:
        """Replace the hypothesis of the utterance under way; None: the utterance is over.

        A step does not end in the middle of an utterance, so a recogniser says () as soon as it hears somebody speak,
        and says what it has again and again, changed or not, for as long as it goes on.
        """
        with self._lock:
            self._partial = words
        self._tell(News.WORDS)

    def push_frame(self, frame: Frame) -> None:
        """Leave a skeleton. Raises ObservationError for an arm without length or an invalid position."""
        for wrist in frame.wrists:
            Ray(frame.head, wrist)
        with self._lock:
            self.dropped += len(self._frames) == self._frames.maxlen
            self._frames.append(frame)
        self._tell(News.FRAME)

    def alive(self, sensor: str, time: float) -> None:
        """Note that a sensor lives at `time` (s); from its first sign of life on it is missed when it gives none."""
        with self._lock:
            self._alive[sensor] = max(time, self._alive.get(sensor, time))

    def signs_of_life(self) -> dict[str, float]:
        """Return when (s) each sensor last gave a sign of life."""
        with self._lock:
            return dict(self._alive)

    def pending(self) -> Pending:
        """Return what has come, without taking it."""
        with self._lock:
            return Pending(tuple(self._words), self._partial, tuple(self._frames))

    def take_words(self, until: float) -> tuple[Word, ...]:
        """Take the words that ended by `until` (s), in order of their ends."""
        with self._lock:
            taken = sorted((word for word in self._words if word.end <= until), key=lambda word: word.end)
            self._words = deque((word for word in self._words if word.end > until), self._words.maxlen)
            return tuple(taken)

    def take_frames(self, until: float) -> tuple[Frame, ...]:
        """Take the frames up to `until` (s)."""
        with self._lock:
            taken = tuple(frame for frame in self._frames if frame.time <= until)
            self._frames = deque((frame for frame in self._frames if frame.time > until), self._frames.maxlen)
            return taken

    def _unsubscribe(self, told: Callable[[News], None]) -> None:
        with self._lock:
            self._subscribers = tuple(each for each in self._subscribers if each is not told)

    def _tell(self, news: News) -> None:
        if news is News.WORDS:
            self.wake.set()
        for told in self._subscribers:
            told(news)

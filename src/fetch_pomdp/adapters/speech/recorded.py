"""Ears over a Sound, for any recogniser of utterances: a recording, a pipe, a microphone."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from fetch_pomdp.adapters.speech.audio import Sound
from fetch_pomdp.adapters.speech.foreground import Foreground
from fetch_pomdp.adapters.speech.silero import Silero, model
from fetch_pomdp.adapters.speech.utterances import SpeechSegment, Utterances
from fetch_pomdp.core.ports import Word


class SoundRecognizer:
    """Ears over a Sound. Implements Recognizer. transcribe: finds the words of each utterance in turn.

    A word is given when its utterance has ended, so `hear` may listen on past its time while someone is speaking, by up
    to 10 s; words that end later than that time are kept for the next call.
    Raises MissingExtraError without onnxruntime.
    """

    def __init__(self, sound: Sound, transcribe: Callable[[SpeechSegment], Sequence[Word]]) -> None:
        self._utterances = Utterances(sound, Foreground(Silero(model())))
        self._transcribe = transcribe
        self._heard: deque[Word] = deque()
        self._spoken = (0.0, 0.0)  # s, the last utterance with words in it

    def hear(self, until: float) -> list[Word]:
        """Listen until the stream's time `until` (s); see Recognizer. Raises AudioError for a stream that breaks."""
        self._listen(until)
        words = []
        while self._heard and self._heard[0].end <= until:
            words.append(self._heard.popleft())
        return words

    def utterance_end(self, time: float) -> float:
        """Return when (s) the utterance ends that goes on at a time; see UtteranceRecognizer."""
        self._listen(time)
        begin, end = self._spoken
        return end if begin <= time < end else time

    def _listen(self, until: float) -> None:
        while not self._utterances.ended and self._utterances.settled < until:
            if (utterance := self._utterances.step()) and (words := self._transcribe(utterance)):
                self._heard.extend(words)
                self._spoken = words[0].start, words[-1].end

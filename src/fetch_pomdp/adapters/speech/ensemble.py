"""Several recognisers that hear the same utterance: each counts as much as the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fetch_pomdp.adapters.speech.utterances import SpeechSegment, Transcriber
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.hearing import texts
from fetch_pomdp.core.ports import Word


class Ensemble:
    """A Transcriber over others. The words given are those of whoever's reading is the likeliest of all together.

    Choice: a reading's probability is the mean of what each recogniser gives it. One that gives no probabilities is
    taken at its word, but for as much as it doubts its least certain one; who hears nothing says that nothing was said.
    """

    def __init__(self, transcribers: Sequence[Transcriber]) -> None:
        self._transcribers = tuple(transcribers)

    def words(self, utterance: SpeechSegment) -> list[Word]:
        """Return the words of an utterance; see Transcriber."""
        heard = [tuple(transcriber.words(utterance)) for transcriber in self._transcribers]
        weights: dict[tuple[str, ...], float] = {}
        for words in heard:
            for reading in _readings(words):
                weights[reading.words] = weights.get(reading.words, 0.0) + reading.weight / len(heard)
        spoken = [words for words in heard if words]
        if not spoken:
            return []
        best = max(spoken, key=lambda words: weights.get(texts(words), 0.0))
        first = texts(best)
        order = sorted(weights, key=lambda said: (said != first, -weights[said]))
        readings = tuple(Alternative(said, weights[said]) for said in order)
        return [replace(word, readings=readings if len(readings) > 1 else ()) for word in best]


def _readings(words: Sequence[Word]) -> tuple[Alternative, ...]:
    """Return the readings of what one recogniser heard; their weights sum to 1."""
    if not words:
        return (Alternative((), 1.0),)
    if words[0].readings:
        total = sum(reading.weight for reading in words[0].readings)
        return tuple(replace(reading, weight=reading.weight / total) for reading in words[0].readings)
    sure = min(max(word.posterior, 0.01) for word in words)
    return (Alternative(texts(words), sure), *((Alternative((), 1.0 - sure),) if sure < 1 else ()))

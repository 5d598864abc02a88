"""From the words that ears give to the words of an observation: answers as people give them, in every reading."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.answers import After, AnswerReader
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word

MOST = 12  # readings of a step; each is read when a belief is updated


def texts(words: Sequence[Word]) -> tuple[str, ...]:
    """Return the words of an utterance as they were heard."""
    return tuple(text for word in words for text in tokenize(word.text))


def understood(
    words: Sequence[Word],
    reader: AnswerReader,
    after: After,
    ray: Ray | None = None,
    *,
    before: tuple[str, ...] = (),
) -> Observation:
    """Return the observation of a step. before: words that were read already, and come first.

    Of several utterances, each with its readings, every combination is a reading, and the MOST likely are kept.
    """

    def read(heard: tuple[str, ...]) -> tuple[str, ...]:
        return before + reader.read(heard, after).words

    best = read(_words(words, reader))
    combined: list[tuple[tuple[str, ...], float]] = [((), 1.0)]
    for options in _utterances(words, reader):
        combined = [(said + each.words, p * each.weight) for said, p in combined for each in options]
        combined = sorted(combined, key=lambda one: -one[1])[:MOST]
    if len(combined) == 1:
        return Observation(best, ray)
    weights = {best: 0.0}
    for said, p in combined:
        found = read(said)
        weights[found] = weights.get(found, 0.0) + p
    total = sum(weights.values())
    if len(weights) == 1 or not weights[best]:
        return Observation(best, ray)
    return Observation(best, ray, tuple(Alternative(found, p / total) for found, p in weights.items()))


def _utterances(words: Sequence[Word], reader: AnswerReader) -> Iterator[Sequence[Alternative]]:
    """Yield the readings of each utterance; one, its words, where it has no others or is not here as a whole."""
    for _, run in groupby(words, key=lambda word: id(word.readings) if word.readings else 0):
        utterance = tuple(run)
        readings = utterance[0].readings
        whole = readings and readings[0].words == texts(utterance)
        yield readings if whole else (Alternative(_words(utterance, reader), 1.0),)


def _words(words: Sequence[Word], reader: AnswerReader) -> tuple[str, ...]:
    return tuple(text for word in words for text in reader.words(word.text))

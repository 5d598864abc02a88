"""Readers: from the words of an utterance to the log-likelihood of every item, and what was understood.

`Reader` is the door for others; `TableReader` is ours.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Protocol, runtime_checkable

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.chart import covers
from fetch_pomdp.core.language.reading.degrees import Array
from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.discourse import NOTHING_BEFORE, Before, Candidate, candidates
from fetch_pomdp.core.language.reading.form import Description
from fetch_pomdp.core.language.reading.grammar import Grammar, grammar
from fetch_pomdp.core.language.reading.likelihood import understood, view_prior
from fetch_pomdp.core.language.reading.speaker import ease
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.language.reading.tokens import Vocabulary, clauses
from fetch_pomdp.core.language.reading.weights import Weights, shipped
from fetch_pomdp.core.scene import Scene

SCENES = 16  # that are kept
NUMBERS = 6_000_000  # of a scene that are kept: 48 MB
LEAST = 1e-6  # chance of a view


@dataclass(frozen=True, slots=True)
class Context:
    """What was going on when something was said.

    views: log of the chance of each view so far, None before anything was said. before: what was meant last, and the
    item that the robot asked about.
    """

    views: tuple[float, ...] | None = None
    before: Before = NOTHING_BEFORE

    def after_question(self, asked: int | None) -> Context:
        """Return the context after a question about an item, or after it was handed over; None if neither was."""
        if asked is None:
            return self
        return dataclasses.replace(self, before=dataclasses.replace(self.before, asked=asked))


@dataclass(frozen=True, slots=True)
class Reading:
    """A meaning that an utterance may have, and how likely it has it."""

    meaning: Description
    chance: float


@dataclass(frozen=True, slots=True, eq=False)
class Heard:
    """What a reader made of an utterance.

    log_likelihood: (n_items,), log p(words | item) up to a constant. readings: likeliest first. unknown: words that
    nobody knows. views: (views,), the chance of each view (`table.VIEWS`). lost: how likely the utterance was not
    understood. corrects: whether it takes back what was said before. context: for what is said next.
    note: what is to be known of who read it, where that is not clear.
    """

    log_likelihood: Vector
    readings: tuple[Reading, ...]
    unknown: tuple[str, ...]
    views: tuple[float, ...]
    lost: float
    corrects: bool
    context: Context
    note: str = ""


class Reader(Protocol):
    """What turns words into evidence about the items of a scene."""

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Read what was said. words: lower case, as `tokens.words_of` or `words.tokenize` give them."""
        ...


@runtime_checkable
class SlowReader(Reader, Protocol):
    """A Reader that takes its time, such as one that asks a server."""

    @property
    def meanwhile(self) -> Reader:
        """A quick reader for what is shown while somebody still speaks, and for what is on record already."""
        ...


def meanwhile(reader: Reader | None) -> Reader | None:
    """Return the quick reader of a slow one; any other is quick."""
    return reader.meanwhile if isinstance(reader, SlowReader) else reader


@dataclass(frozen=True, slots=True)
class Parsed:
    """The readings of an utterance before they meet the table, and the shares of it that are unknown and left out."""

    found: tuple[Candidate, ...]
    unknown: tuple[str, ...]
    confusion: tuple[float, float]
    corrects: bool


def parse(words: Sequence[str], vocabulary: Vocabulary, language: Grammar, before: Before = NOTHING_BEFORE) -> Parsed:
    """Return the readings of an utterance on a table with these words."""
    said = clauses(words, vocabulary, language)
    covered = [covers(each.tokens, each.skips, language) for each in said]
    found = candidates([each.kind for each in said], covered, before)
    unknown = tuple(word for each in said for word in each.unknown)
    count = max(sum(len(each.words) for each in said), 1)
    found = found or [Candidate(Description(), 0.0, 0.0)]
    corrects = any(each.kind == "correct" for each in said)
    return Parsed(tuple(found), unknown, (2.0 * len(unknown) / count, found[0].skipped), corrects)


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    """A scene as the reader knows it: what it computed of it once."""

    scene: Scene
    table: Table
    denotation: Denotation
    ease: Array


class TableReader:
    """Reads with a grammar, with weights learnt from what people said. Keeps what it computed of the last scenes.

    Safe from any thread.
    """

    def __init__(self, language: str = "english", weights: Weights | None = None) -> None:
        self.language, self.grammar = language, grammar(language)
        self.weights = Weights.of(shipped()) if weights is None else weights
        self._prior = view_prior(self.weights)
        self._places: dict[int, _Place] = {}
        self._lock = Lock()

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Read what was said about a scene."""
        with self._lock:
            return self._read(words, scene, context)

    def _read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        place = self._place(scene)
        parsed = parse(words, place.table.vocabulary, self.grammar, context.before)
        views = self._prior if context.views is None else np.array(context.views)
        result = understood(
            parsed.found, place.denotation, self.weights, views=views, confusion=parsed.confusion, ease=place.ease
        )
        chances, weights = result.chances.reshape(-1), result.readings.reshape(-1)
        order = np.argsort(-weights, kind="stable")
        readings = tuple(Reading(parsed.found[index].meaning, float(weights[index])) for index in order)
        meant = readings[0].meaning if readings[0].meaning.parts else context.before.meaning
        after = result.views.reshape(-1)
        return Heard(
            np.log(chances),
            readings,
            parsed.unknown,
            tuple(after.tolist()),
            float(np.ravel(result.lost)[0]),
            parsed.corrects,
            Context(tuple(np.log(np.maximum(after, LEAST)).tolist()), Before(meant, context.before.asked)),
        )

    def _place(self, scene: Scene) -> _Place:
        place = self._places.get(id(scene))
        if place is None or place.scene is not scene:
            table = Table.of(scene)
            meaning = Denotation(table, self.grammar, self.weights)
            while len(self._places) >= SCENES:
                del self._places[next(iter(self._places))]
            place = self._places[id(scene)] = _Place(scene, table, meaning, ease(meaning))
        elif place.denotation.numbers > NUMBERS:
            fresh = Denotation(place.table, self.grammar, self.weights)
            place = self._places[id(scene)] = dataclasses.replace(place, denotation=fresh)
        return place

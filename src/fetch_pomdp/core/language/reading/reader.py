"""Readers: from the words of an utterance to the log-likelihood of every item, and what was understood.

`Reader` is the door for others; `TableReader` is ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.chart import covers
from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.discourse import NOTHING_BEFORE, Before, Candidate, candidates
from fetch_pomdp.core.language.reading.form import Description
from fetch_pomdp.core.language.reading.grammar import Grammar, grammar
from fetch_pomdp.core.language.reading.likelihood import understood, view_prior
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.language.reading.tokens import Vocabulary, clauses
from fetch_pomdp.core.language.reading.weights import Weights, shipped
from fetch_pomdp.core.scene import Scene


@dataclass(frozen=True, slots=True)
class Context:
    """What was going on when something was said.

    views: log of the chance of each view so far, None before anything was said. before: what was meant last, and the
    item that the robot asked about.
    """

    views: tuple[float, ...] | None = None
    before: Before = NOTHING_BEFORE


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
    """

    log_likelihood: Vector
    readings: tuple[Reading, ...]
    unknown: tuple[str, ...]
    views: tuple[float, ...]
    lost: float
    corrects: bool
    context: Context


class Reader(Protocol):
    """What turns words into evidence about the items of a scene."""

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Read what was said. words: lower case, as `tokens.words_of` or `words.tokenize` give them."""
        ...


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


class TableReader:
    """Reads with a grammar, with weights learnt from what people said. Keeps what it computed of a scene."""

    def __init__(self, language: str = "english", weights: Weights | None = None) -> None:
        self.grammar = grammar(language)
        self.weights = Weights.of(shipped()) if weights is None else weights
        self._prior = view_prior(self.weights)
        self._tables: dict[int, tuple[Scene, Table]] = {}

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Read what was said about a scene."""
        table = self._table(scene)
        parsed = parse(words, table.vocabulary, self.grammar, context.before)
        views = self._prior if context.views is None else np.array(context.views)
        denotation = Denotation(table, self.grammar, self.weights)
        result = understood(parsed.found, denotation, self.weights, views=views, confusion=parsed.confusion)
        chances = result.chances.reshape(-1)
        order = np.argsort(-result.readings.reshape(-1), kind="stable")
        readings = tuple(Reading(parsed.found[i].meaning, float(result.readings.reshape(-1)[i])) for i in order)
        after = tuple(np.log(np.maximum(result.views.reshape(-1), 1e-6)).tolist())
        meant = readings[0].meaning if readings[0].meaning.parts else context.before.meaning
        return Heard(
            np.log(chances),
            readings,
            parsed.unknown,
            tuple(result.views.reshape(-1).tolist()),
            float(np.ravel(result.lost)[0]),
            parsed.corrects,
            Context(after, Before(meant, context.before.asked)),
        )

    def _table(self, scene: Scene) -> Table:
        kept = self._tables.get(id(scene))
        if kept is None or kept[0] is not scene:
            kept = self._tables[id(scene)] = (scene, Table.of(scene))
        return kept[1]

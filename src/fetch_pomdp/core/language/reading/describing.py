"""How a person who wants an item tells where it is: of all places, one that a listener takes for this item's.

Rational speech acts, as in `speaker`: of the places by which the item is likelier than any other, one is said the more
often, the better it tells the item apart and the shorter it is. The listener is the robot's own reader, which does not
know whose left or right is meant where nobody's is named.

Choice: what a listener would take for another item's once it is in words is said otherwise.

Choice: places are a side of the table (somebody's or nobody's, and its utmost), the nearest and farthest to a person, a
number from a side, next to, beside, before or behind a landmark, in the middle, alone, and what is not so; one at a
time. A landmark is named by one word, which the item has not.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.degrees import Array
from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.discourse import Candidate, settled
from fetch_pomdp.core.language.reading.form import (
    Alone,
    Description,
    Form,
    Middle,
    Not,
    Ordinal,
    Person,
    Relation,
    Select,
    Side,
    Superlative,
    Toward,
)
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.language.reading.likelihood import understood, view_prior
from fetch_pomdp.core.language.reading.reader import parse
from fetch_pomdp.core.language.reading.saying import Phrases, Speaker, earlier
from fetch_pomdp.core.language.reading.speaker import ease
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.language.reading.weights import Weights, shipped
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.scene import Scene

SIDES, RELATIONS = ("left", "right"), ("next to", "left of", "right of", "in front of", "behind")
MOST_COUNTED = 4  # places from a side that somebody counts
APART = 0.1  # chance by which a place must put an item before all others; one that does not is no help
TIED = 1e-6  # difference of chances
TRIES = 10  # to say something, after which no place is said

Place: TypeAlias = tuple[Form, ...]


def places(landmarks: Sequence[str]) -> Iterator[Place]:
    """Yield the places that may be said, as a grammar builds them. landmarks: words of other items."""
    yield from (((Middle(),), (Alone(),)))
    for viewer in (*Person, None):
        for side in SIDES:
            yield (Side((side,), viewer),)
            yield (Side((side,), viewer, extreme=True),)
            yield from ((Ordinal(rank), Toward(Side((side,), viewer))) for rank in range(2, MOST_COUNTED + 1))
    yield from ((Superlative(whom, far),) for whom in Person for far in (False, True))
    beside = [Relation(name, Description((Select(word),))) for word in landmarks for name in RELATIONS]
    yield from ((each,) for each in beside)
    yield from ((Not(Side((side,), Person.ME)),) for side in SIDES)
    yield from ((Not(each),) for each in beside if each.name == RELATIONS[0])


@dataclass(frozen=True, slots=True, eq=False)
class Describer:
    """Tells where the items of a scene are; what was computed once is kept."""

    scene: Scene
    speaker: Speaker
    denotation: Denotation
    weights: Weights
    ease: Array
    kept: dict[tuple[int, tuple[str, ...]], tuple[list[Place], Vector]] = field(default_factory=dict)
    ways: dict[tuple[str, Place], tuple[Phrases, ...]] = field(default_factory=dict)

    @classmethod
    def of(cls, scene: Scene) -> Describer:
        """Return that of a scene, in English, by the weights that come with the package."""
        table, language, weights = Table.of(scene), grammar("english"), Weights.of(shipped())
        denotation = Denotation(table, language, weights)
        return cls(scene, Speaker(language, table.vocabulary), denotation, weights, ease(denotation))

    def chances(self, found: Sequence[Candidate], confusion: tuple[float, float] = (0.0, 0.0)) -> Vector:
        """Return the chance of each item for who hears something that may mean these, (n_items,)."""
        views = view_prior(self.weights)
        heard = understood(found, self.denotation, self.weights, views=views, confusion=confusion, ease=self.ease)
        return np.asarray(heard.chances.reshape(-1))

    def choices(self, item: int, words: tuple[str, ...]) -> tuple[list[Place], Vector]:
        """Return the places that tell an item with these words apart, and how often each is said, (places,)."""
        key = item, words
        if key not in self.kept:
            self.kept[key] = self._weighed(item, words)
        return self.kept[key]

    def _weighed(self, item: int, words: tuple[str, ...]) -> tuple[list[Place], Vector]:
        w, found, logs = self.weights.values, list[Place](), list[float]()
        own = self.scene.items[item].vocabulary
        landmarks = dict.fromkeys(each.vocabulary[0] for each in self.scene.items if each.vocabulary[0] not in own)
        for place in places(tuple(landmarks)):
            meaning = settled(Description((*map(Select, words), *place)))
            chances = self.chances([Candidate(meaning, 0.0, 0.0)])
            others = np.delete(chances, item).max(initial=0.0)
            if chances[item] > others + APART and self._ways(words, place):
                found.append(place)
                logs.append(w.speaker_sharpness * math.log(chances[item]) - w.speaker_length * len(place))
        weights = np.exp(np.array(logs))
        return found, weights / weights.sum() if found else weights

    def _ways(self, words: Sequence[str], place: Place) -> tuple[Phrases, ...]:
        head = words[-1] if words else ""
        if (head, place) not in self.ways:
            named = (Select(head),) if head else ()
            self.ways[head, place] = self.speaker.ways(Description((*named, *place)))
        return self.ways[head, place]

    def described(self, item: int, words: tuple[str, ...], rng: Generator) -> Phrases:
        """Draw how an item is told by some of its words and a place, phrase by phrase; () if no place tells it.

        words: the last is what it is called, the others come before that.
        """
        found, weights = self.choices(item, words)
        for _ in range(TRIES if found else 0):
            place = found[min(int(np.searchsorted(np.cumsum(weights), rng.random())), len(found) - 1)]
            ways = self._ways(words, place)
            way = ways[earlier(len(ways), rng)]
            said = tuple(part for phrase in way for part in (_each(words) if phrase == words[-1:] else [phrase]))
            if self._is_understood(item, said):
                return said
        return ()

    def _is_understood(self, item: int, said: Phrases) -> bool:
        words = [word for phrase in said for word in phrase]
        parsed = parse(words, self.speaker.vocabulary, self.speaker.language)
        chances = self.chances(parsed.found, parsed.confusion)
        return bool(chances[item] >= chances.max() - TIED)


def _each(words: Sequence[str]) -> Phrases:
    return tuple((word,) for word in words)


def describer(scene: Scene) -> Describer:
    """Return the describer of a scene, whatever robot stands there; those of the last scenes are kept."""
    return _kept(dataclasses.replace(scene, model=Model(), rewards=Rewards()))


@functools.lru_cache(maxsize=8)
def _kept(scene: Scene) -> Describer:
    return Describer.of(scene)

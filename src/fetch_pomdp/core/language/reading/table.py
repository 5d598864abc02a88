"""A table as the reader sees it: where its items are for each person, how far apart, and what they are called."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from fetch_pomdp.core.language.reading.form import Person
from fetch_pomdp.core.language.reading.grammar import Grammar
from fetch_pomdp.core.language.reading.tokens import ID, Vocabulary
from fetch_pomdp.core.scene import Scene

Mask = npt.NDArray[np.bool_]
Array = npt.NDArray[np.float64]

PEOPLE = (Person.ME, Person.YOU)
SPEAKER, LISTENER = 0, 1
# A view is (swapped, whose left and right, whose front and behind); all of them, in the order of every views' axis.
VIEWS = tuple((swapped, wide, deep) for swapped in (0, 1) for wide in (0, 1) for deep in (0, 1))
FARTHER = 0.6  # m, of the robot behind the items where a scene does not say where it is
COLOUR_BLUR = 0.22  # distance of colours that are called the same


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """What stands on a table: n items, as two people see them, 0 the speaker and 1 the listener (the robot)."""

    points: Array  # (n, 2), m, horizontal
    people: Array  # (2, 2), m
    vocabularies: tuple[frozenset[str], ...]
    ids: tuple[str, ...]
    facing: Array  # (n, 2), unit direction of each item's front; 0 where it has none
    vocabulary: Vocabulary = field(init=False)
    distances: Array = field(init=False)  # (n, n), in distances of neighbours
    near: Array = field(init=False)  # (n, n), from each item to a landmark; of a landmark far from all, in its distance
    spacing: float = field(init=False)  # m, the median distance of an item to its neighbour
    spread: float = field(init=False)  # m, root mean square distance from the middle of the items
    right: Array = field(init=False)  # (2, n), to each person's right of the middle of the items, in spreads
    away: Array = field(init=False)  # (2, n), away from each person, in spreads
    remote: Array = field(init=False)  # (2, n), distance from each person, in spreads
    axes: Array = field(init=False)  # (2, 2, 2): of each person, the directions right and away
    words: dict[str, Array] = field(default_factory=dict)
    kept: dict[Any, Any] = field(default_factory=dict)  # what depends on the table alone, once computed

    def __post_init__(self) -> None:
        points = self.points
        middle = points.mean(axis=0)
        gaps = np.sqrt(((points[:, None] - points[None]) ** 2).sum(axis=2))
        nearby = np.sort(gaps + np.diag(np.full(len(points), np.inf)), axis=1)[:, 0] if len(points) > 1 else np.ones(1)
        spacing = max(float(np.median(nearby)), 1e-3)
        spread = max(float(np.sqrt(((points - middle) ** 2).sum(axis=1).mean())), 1e-3)
        away = middle - self.people
        away /= np.maximum(np.sqrt((away**2).sum(axis=1, keepdims=True)), 1e-9)
        right = np.stack([away[:, 1], -away[:, 0]], axis=1)
        centred = (points - middle) / spread
        for name, value in (
            ("vocabulary", Vocabulary.of(self.vocabularies, self.ids)),
            ("distances", gaps / spacing),
            ("near", gaps / np.maximum(nearby, spacing)[None, :]),
            ("spacing", spacing),
            ("spread", spread),
            ("right", right @ centred.T),
            ("away", away @ centred.T),
            ("remote", np.sqrt(((points[None] - self.people[:, None]) ** 2).sum(axis=2)) / spread),
            ("axes", np.stack([right, away], axis=1)),
        ):
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, scene: Scene) -> Table:
        """Return a scene's table. Where a scene does not say where the robot is, it faces the person.

        Choice: across the table is where a robot that hands things over stands, and where who is asked looks from.
        """
        points = np.array([item.position[:2] for item in scene.items])
        head = np.array(scene.head[:2])
        if scene.robot is not None:
            robot = np.array(scene.robot[:2])
        else:
            towards = points.mean(axis=0) - head
            length = float(np.sqrt((towards**2).sum()))
            robot = head + towards * (1.0 + (length + FARTHER) / max(length, 1e-9))
        vocabularies = tuple(frozenset(item.vocabulary) for item in scene.items)
        facing = np.array([item.facing or (0.0, 0.0) for item in scene.items])
        facing /= np.maximum(np.sqrt((facing**2).sum(axis=1, keepdims=True)), 1e-9)
        return cls(points, np.stack([head, robot]), vocabularies, tuple(item.id for item in scene.items), facing)

    @property
    def size(self) -> int:
        """How many items there are."""
        return len(self.points)

    def called(self, word: str, grammar: Grammar) -> Array:
        """Return how well a word fits each item, 0 to 1, (n,): as its own word, a synonym, or a like colour."""
        found = self.words.get(word)
        if found is None:
            found = self.words[word] = self._called(word, grammar)
        return found

    def _called(self, word: str, grammar: Grammar) -> Array:
        if word.startswith(ID):
            return np.array([float(word == ID + id) for id in self.ids])
        own = self._having(word)
        if own.any():
            return own
        for other in grammar.synonyms.get(word, ()):
            own = np.maximum(own, self._having(other))
        if own.any():
            return own
        return self._coloured(word, grammar) if word in grammar.colours else own

    def _having(self, word: str) -> Array:
        return np.array([float(word in words) for words in self.vocabularies])

    def _coloured(self, word: str, grammar: Grammar) -> Array:
        meant = np.array(grammar.colours[word])
        result = np.zeros(self.size)
        for index, words in enumerate(self.vocabularies):
            away = [
                float(((np.array(grammar.colours[each]) - meant) ** 2).sum()) for each in words & grammar.colours.keys()
            ]
            if away:
                result[index] = np.exp(-min(away) / (2.0 * COLOUR_BLUR**2))
        return result / result.max() if result.max() > 0 else result


def person_in(view: tuple[int, int, int], whom: Person) -> int:
    """Return who is meant by me or you in a view: the speaker and the listener, unless the writer swaps them."""
    return int(whom is Person.YOU) ^ view[0]

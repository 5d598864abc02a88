"""The model with finitely many observations, for planners that enumerate them.

An observation is three classes. Words that the same items own are one class: they say the same about every item, so
this loses nothing. A response is none, yes or no, which loses nothing either. A gesture is the item that the ray is
nearest to and, with rings, how near: here the classes are coarser than the model.

Choice: the chances of gesture classes are those of the rays that `gesture.sample` draws, also where the model judges
rays by Eq. 7: that is no distribution over rays, so it gives no chances. A ray beyond the threshold is null.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from fetch_pomdp.checks import shown
from fetch_pomdp.core import gesture
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.compiled import Vector, compiled
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.words import POSITIVE
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem, constant_only
from fetch_pomdp.core.rays import turned
from fetch_pomdp.core.turns import NO, SILENT, YES
from fetch_pomdp.errors import ModelError, ObservationError, SceneError

MOST_RINGS = 16
MOST_ITEMS = 200  # the quadrature takes time quadratic in their number: 200 take some 5 s
ROLLS, CELLS = 256, 512  # of the quadrature over rays: errors of chances are about p_g / 2000


def all_actions(n_items: int) -> tuple[Action, ...]:
    """Return the 2n + 1 actions in the order of their numbers: wait, ask about each item, pick each item."""
    items = range(n_items)
    return (Wait(), *map(Point, items), *map(Pick, items))


@dataclass(frozen=True, slots=True, eq=False)
class Discrete:
    """A problem whose observations are classes. Raises ModelError for a number of rings out of range, SceneError for
    over MOST_ITEMS items.

    rings: each item's cone within the gesture threshold is split into that many rings of equal width. Columns of
    `gestures`: null, then 1 + item * rings + ring; null alone where p_g is 0.
    """

    problem: Problem
    rings: int = 1
    word_classes: tuple[tuple[str, ...], ...] = field(init=False)  # the first is (), silence
    words: Vector = field(init=False, repr=False)  # (n, len(word_classes)), chance of each given each desired item
    gestures: Vector = field(init=False, repr=False)  # (n, 1 + n * rings), likewise

    def __post_init__(self) -> None:
        rings = self.rings
        if not isinstance(rings, int) or isinstance(rings, bool) or not 1 <= rings <= MOST_RINGS:
            found = f"found {shown(rings)}, expected a whole number from 1 to {MOST_RINGS}"
            raise ModelError(found, field="rings")
        constant_only(self.problem, "the enumerated model")
        if self.problem.n_items > MOST_ITEMS:
            raise SceneError(f"found {self.problem.n_items} items, expected at most {MOST_ITEMS}", field="items")
        by_owners = self.problem.words_by_owners().items()
        classes = {owners: tuple(self.problem.words[word] for word in words) for owners, words in by_owners}
        object.__setattr__(self, "word_classes", ((), *classes.values()))
        object.__setattr__(self, "words", _word_chances(self.problem, classes))
        object.__setattr__(self, "gestures", _gesture_chances(self.problem, rings))

    @property
    def n_classes(self) -> tuple[int, int, int]:
        """How many classes of words, responses and gestures there are."""
        return len(self.word_classes), 3, self.gestures.shape[1]

    def responses(self, asked: int | None, action: Action) -> Vector:
        """Return the chances of no response, yes and no given each desired item, (n_items, 3) (Eq. 6, Table I).

        asked: index of i_r after the action, or None.
        """
        tables, truth = self.problem.tables, self.problem.model.p_truth
        rate = tables.p_again if isinstance(action, Wait) else tables.p_answer
        yes = np.full(self.problem.n_items, 0.5 if asked is None else 1.0 - truth)
        if asked is not None:
            yes[asked] = truth
        return np.stack([np.full_like(yes, 1.0 - rate), rate * yes, rate * (1.0 - yes)], axis=1)

    def likelihood(self, asked: int | None, action: Action) -> Vector:
        """Return the chance of every observation given each desired item, (n_items, words, responses, gestures)."""
        words, responses = self.words[:, :, None, None], self.responses(asked, action)[:, None, :, None]
        return words * responses * self.gestures[:, None, None, :]

    def classify(self, observation: Observation) -> tuple[int, int, int]:
        """Return the classes of an observation's words, response and gesture.

        Raises ObservationError for more than one word or response of the scene: the model's people say one at a time.
        """
        utterance = unigram.split(observation.words, self.problem)
        for name, heard in (("words", utterance.base), ("responses", utterance.response)):
            if len(heard) > 1:
                raise ObservationError(
                    f"found {shown(heard)}, expected at most one: the classes know no more", field=name
                )
        word = next((k for k, words in enumerate(self.word_classes) if set(utterance.base) & set(words)), 0)
        response = SILENT if not utterance.response else YES if utterance.response[0] in POSITIVE else NO
        return word, response, self._gesture_class(observation.ray)

    def _gesture_class(self, ray: gesture.Ray | None) -> int:
        if ray is None or self.gestures.shape[1] == 1:
            return 0
        angles, threshold = gesture.angles(ray, self.problem), self.problem.model.gesture_threshold
        item = int(angles.argmin())
        if angles[item] > threshold:
            return 0
        return 1 + item * self.rings + min(self.rings - 1, int(angles[item] / threshold * self.rings))


def _word_chances(problem: Problem, classes: dict[tuple[int, ...], tuple[str, ...]]) -> Vector:
    tables, result = problem.tables, np.empty((problem.n_items, 1 + len(classes)))
    result[:, 0] = 1.0 - tables.p_l
    for column, (owners, words) in enumerate(classes.items(), start=1):
        mass = np.full(problem.n_items, tables.alpha)
        mass[list(owners)] += 1.0
        result[:, column] = tables.p_l * len(words) * mass * tables.smoothing
    return result


def _gesture_chances(problem: Problem, rings: int) -> Vector:
    """Return the chance of every gesture class given each desired item, by quadrature over angle and roll."""
    n_items, tables = problem.n_items, problem.tables
    if tables.p_g == 0.0:
        return np.ones((n_items, 1))
    end = min(math.pi, 9.0 * tables.sigma)
    # Cells end where rings around the desired item do; each weighs what the normal distribution gives it.
    edges = np.concatenate([np.linspace(0.0, end, CELLS + 1), np.linspace(0.0, tables.threshold, 16 * rings + 1)])
    edges = np.unique(np.minimum(edges, end))
    mass = np.diff([math.erf(edge / tables.sigma / math.sqrt(2.0)) for edge in edges])
    shares = _shares(tables.directions, (edges[:-1] + edges[1:]) / 2, mass / mass.sum(), tables.threshold, rings)
    shares *= tables.p_g
    shares[:, 0] += 1.0 - tables.p_g
    return shares


@compiled
def _shares(directions: Vector, angles: Vector, mass: Vector, threshold: float, rings: int) -> Vector:
    """Return, for rays around each item, the share that is null and the share in each ring of each item."""
    count = len(directions)
    shares = np.zeros((count, 1 + count * rings))
    for desired in range(count):
        for cell in range(len(angles)):
            for roll in range(ROLLS):
                x, y, z = turned(directions[desired], angles[cell], 2.0 * math.pi * (roll + 0.5) / ROLLS)
                nearest, closest = 0, -2.0
                for item in range(count):
                    cosine = directions[item, 0] * x + directions[item, 1] * y + directions[item, 2] * z
                    if cosine > closest:
                        nearest, closest = item, cosine
                angle = math.acos(min(1.0, max(-1.0, closest)))
                ring = int(angle / threshold * rings)
                column = 0 if angle > threshold else 1 + nearest * rings + min(ring, rings - 1)
                shares[desired, column] += mass[cell] / ROLLS
    return shares

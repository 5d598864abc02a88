"""Section III-C of the paper in plain Python, written from the paper alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

Point3 = tuple[float, float, float]

YES_WORDS = ["yes", "yeah", "sure", "yup"]
NO_WORDS = ["no", "nope", "other", "not"]


@dataclass(frozen=True, kw_only=True)
class World:
    """Items, each with its words and place, and the parameters and rewards of the paper."""

    vocabularies: Sequence[Sequence[str]]
    places: Sequence[Point3] = ()
    head: Point3 = (0.0, 0.0, 0.0)
    alpha: float = 0.2
    p_l: float = 0.95
    p_g: float = 0.1
    sigma: float = 0.15
    p_truth: float = 0.99
    threshold: float = 0.3
    again: float = 1.0
    right: float = 10.0
    wrong: float = -12.5
    ask: float = -6.0
    wait: float = -1.0

    @property
    def count(self) -> int:
        return len(self.vocabularies)

    @property
    def words(self) -> list[str]:
        return sorted({word for vocabulary in self.vocabularies for word in vocabulary})


def word_chance(word: str, item: int, world: World) -> float:
    """Eq. 5."""
    vocabulary = world.vocabularies[item]
    return ((word in vocabulary) + world.alpha) / (len(vocabulary) + world.alpha * len(world.words))


def base_chance(words: Sequence[str], item: int, world: World) -> float:
    """Eq. 4."""
    if not words:
        return 1 - world.p_l
    product = world.p_l
    for word in words:
        product *= word_chance(word, item, world)
    return product


def class_chance(positive: bool, item: int, asked: int | None, world: World) -> float:
    """Table I."""
    if asked is None:
        return 0.5
    truthful = positive == (asked == item)
    return world.p_truth if truthful else 1 - world.p_truth


def response_chance(words: Sequence[str], item: int, asked: int | None, world: World, rate: float) -> float:
    """Eq. 6; a word is uniform within its class."""
    if not words:
        return 1 - rate
    product = rate
    for word in words:
        product *= class_chance(word in YES_WORDS, item, asked, world) / 4
    return product


def angle(head: Point3, towards: Point3, place: Point3) -> float:
    """Angle at the head between two points, by the law of cosines on unit vectors (chord length)."""
    a = [t - h for t, h in zip(towards, head, strict=True)]
    b = [p - h for p, h in zip(place, head, strict=True)]
    a = [x / math.hypot(*a) for x in a]
    b = [x / math.hypot(*b) for x in b]
    chord = math.dist(a, b)
    return 2 * math.asin(min(1.0, chord / 2))


def gesture_density(head: Point3, wrist: Point3, item: int, world: World) -> float:
    """Eq. 7, with the rule of the threshold."""
    angles = [angle(head, wrist, place) for place in world.places]
    if min(angles) > world.threshold:
        return 1 - world.p_g
    z = angles[item] / world.sigma
    return world.p_g * math.exp(-z * z / 2) / (world.sigma * math.sqrt(2 * math.pi))


def posterior(
    prior: Sequence[float],
    utterance: Sequence[str],
    ray: tuple[Point3, Point3] | None,
    asked: int | None,
    world: World,
) -> list[float]:
    """Bayes' rule with Eq. 1-7; words that nobody knows are left out."""
    base = [word for word in utterance if word in world.words]
    response = [word for word in utterance if word in YES_WORDS or word in NO_WORDS]
    joint = []
    for item, chance in enumerate(prior):
        product = chance * base_chance(base, item, world)
        product *= response_chance(response, item, asked, world, world.p_l)
        product *= 1 - world.p_g if ray is None else gesture_density(*ray, item, world)
        joint.append(product)
    return [x / sum(joint) for x in joint]

"""What people say: requests, answers and corrections, as words in lower case.

Choice: the first word of an item's vocabulary is its name; the others come before it ("the green marker").
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

from numpy.random import Generator

from fetch_pomdp.core.scene import Item, Scene

Words = tuple[str, ...]
Option = TypeVar("Option")

OPENINGS = (
    "", "hand me", "give me", "please give me", "i want", "i would like", "can i have", "can you give me",
    "could you hand me", "could you please pass me",
)  # fmt: skip
DETERMINERS = ("the", "the", "the", "that")
CLOSINGS = ("", "", "", "please")
AFFIRMATIONS = ("yes", "yes", "yes", "yes", "yes please", "yes that one", "yeah", "yup", "sure")
DENIALS = ("no", "no", "no", "no", "nope", "not that one", "no not that one")
UNSURE = ("i", "don't", "know")
OTHER = "other one"
GRAMMARS = ("study", "reader")  # see `wording`


def chosen(options: Sequence[Option], rng: Generator) -> Option:
    """Draw one of the options, each as likely."""
    return options[int(rng.random() * len(options))]


def weighted(options: Sequence[Option], weights: Sequence[float], rng: Generator) -> Option:
    """Draw one of the options by weight."""
    left = rng.random() * math.fsum(weights)
    for option, weight in zip(options, weights, strict=True):
        left -= weight
        if left < 0.0:
            return option
    return options[-1]


def request(item: Item, shares: Sequence[float], p_name: float, place: str, rng: Generator) -> Words:
    """Draw a request; shares: the chance of 0, 1, 2 ... words of the item; place: what it ends with, or ""."""
    count = min(weighted(range(len(shares)), shares, rng), len(item.vocabulary))
    described = " ".join(_description(item, count, p_name, rng)) or "one"
    determiner = chosen(DETERMINERS, rng) if count else "that"
    return tuple(f"{chosen(OPENINGS, rng)} {determiner} {described} {place} {chosen(CLOSINGS, rng)}".split())


def description(item: Item, shares: Sequence[float], p_name: float, rng: Generator) -> Words:
    """Draw how an item is called; shares: the chance of 0, 1, 2 ... of its words. The name, if it is said, is last."""
    count = min(weighted(range(len(shares)), shares, rng), len(item.vocabulary))
    return tuple(_description(item, count, p_name, rng))


def around(rng: Generator) -> tuple[Words, Words]:
    """Draw what comes before and after the item in a request."""
    return tuple(chosen(OPENINGS, rng).split()), tuple(chosen(CLOSINGS, rng).split())


def _description(item: Item, count: int, p_name: float, rng: Generator) -> list[str]:
    name, others = item.vocabulary[0], list(item.vocabulary[1:])
    named = count > 0 and (rng.random() < p_name or count > len(others))
    words = [others.pop(int(rng.random() * len(others))) for _ in range(count - named)]
    return [*words, name] if named else words


def next_to(desired: int, scene: Scene) -> str:
    """Return "next to the ..." with the nearest item of another name, or "" if there is none."""
    wanted = scene.items[desired]
    others = [item for item in scene.items if item.vocabulary[0] != wanted.vocabulary[0]]
    if not others:
        return ""
    nearest = min(others, key=lambda item: math.dist(item.position, wanted.position))
    return f"next to the {nearest.vocabulary[0]}"


def affirmation(rng: Generator) -> Words:
    """Draw a yes."""
    return tuple(chosen(AFFIRMATIONS, rng).split())


def denial(rng: Generator) -> Words:
    """Draw a no."""
    return tuple(chosen(DENIALS, rng).split())


def contrast(item: Item, asked: Item, weight: float, rng: Generator) -> Words:
    """Draw how the item is named against the one asked about: "the bowl", or "the other one" of two of a kind.

    A word has its literal listener's probability of the item, among the two, to the power of `weight`: 1 for a word
    that the item asked about lacks and for "the other one", 1/2 for the others (Frank and Goodman 2012).
    """
    shared = [word in asked.vocabulary for word in item.vocabulary]
    options = [*item.vocabulary, OTHER] if any(shared) else [*item.vocabulary]
    weights = [0.5**weight if common else 1.0 for common in shared]
    return "the", *weighted(options, [*weights, 1.0][: len(options)], rng).split()

"""Eleven scenes, each hard in its own way. All have the exact gesture likelihood, the density of the sampled rays."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping

from fetch_pomdp import Item, Model, Rewards, Scene

HEAD = (0.0, 0.0, 1.6)
HEIGHT = 0.8  # m, of every shelf and table here


def study(name: str, rewards: Mapping[str, float] | None = None, **parameters: float) -> Scene:
    """Return a scene of the study with some parameters and rewards changed."""
    scene = Scene.load(name)
    model = scene.model.with_changes({"gesture_likelihood": "exact", **parameters})
    return dataclasses.replace(scene, model=model, rewards=scene.rewards.with_changes(rewards or {}))


def line(n_items: int, gap: float, words: Callable[[int], tuple[str, ...]], **parameters: float) -> Scene:
    """Return items in a row 1 m ahead, `gap` m apart."""
    items = tuple(
        Item(id=f"item-{k}", position=(1.0, (k - (n_items - 1) / 2) * gap, HEIGHT), vocabulary=words(k))
        for k in range(n_items)
    )
    return Scene(items=items, head=HEAD, model=Model(gesture_likelihood="exact").with_changes(parameters))


def arc(n_items: int, step: float) -> Scene:
    """Return items 1 m around the person, `step` rad apart, each with two words of its own."""
    items = tuple(
        Item(id=f"item-{k}", position=(math.cos(angle), math.sin(angle), HEIGHT), vocabulary=(f"a{k}", f"b{k}"))
        for k in range(n_items)
        for angle in [(k - (n_items - 1) / 2) * step]
    )
    return Scene(items=items, head=HEAD, model=Model(gesture_likelihood="exact"), rewards=Rewards())


def kinds(count: int, *stems: str) -> Callable[[int], tuple[str, ...]]:
    """Return the words of item k: those of kind k modulo `count`."""
    return lambda k: tuple(f"{stem}{k % count}" for stem in stems)


SCENES: Mapping[str, Callable[[], Scene]] = {
    # The study's two; and each with what made the other planners fail: cheap questions, cheap waits.
    "amb": lambda: study("ambiguous"),
    "unamb": lambda: study("unambiguous"),
    "amb-cheap-questions": lambda: study("ambiguous", {"point": -2.0}),
    "unamb-cheap-waits": lambda: study("unambiguous", {"wait": -0.3}, p_g=0.4),
    # Words say nothing: all items share them. Only pointing and answers tell.
    "two-alike": lambda: line(2, 0.5, lambda _: ("cup",)),
    "line-12-alike": lambda: line(12, 0.1, lambda _: ("cup", "blue")),
    # Every item has words of its own, but there are many.
    "arc-20": lambda: arc(20, 0.15),
    # Five alike of each kind, neighbours too close to tell by pointing, and a word that all share.
    "shelf-50": lambda: line(50, 0.08, lambda k: (*kinds(10, "k", "l")(k), "thing")),
    # Three of four words are shared; pointing is rare and sharp.
    "three-share-words": lambda: line(3, 0.3, lambda k: ("a", "b", "c", f"d{k}"), sigma=0.05),
    # Pairs of twins; pointing is blunt, people often say nothing.
    "eight-in-four": lambda: line(8, 0.2, kinds(4, "k", "m"), sigma=0.4, p_l=0.7),
    # Pairs of twins; words are often wrong (a high alpha).
    "ten-in-five": lambda: line(10, 0.12, kinds(5, "k", "m"), alpha=1.0, p_l=0.8),
}

"""Scenes of any size by one rule."""

from __future__ import annotations

import math

import numpy as np

from fetch_pomdp import Item, Problem, Scene

SPACING = 0.15  # m between neighbours, as in the study
NEAREST = 1.2  # m from the person to the first row
RULE = (
    "6 items: the ambiguous study scene. More: a square grid 0.15 m apart that starts 1.2 m from the person, at the "
    "study's height, each item moved by up to 0.03 m; about sqrt(n) kinds in random order, each kind with four words "
    "of its own, as in the study; one seed."
)


def problem_of(n_items: int, seed: int = 0) -> Problem:
    """Return the problem with this many items."""
    return Problem(Scene.load("ambiguous") if n_items == 6 else grid(n_items, seed))


def grid(n_items: int, seed: int) -> Scene:
    """Return a table made by `RULE`."""
    rng = np.random.default_rng(seed)
    side, n_kinds = math.ceil(math.sqrt(n_items)), round(math.sqrt(n_items))
    kinds = rng.permutation(np.arange(n_items) % n_kinds)
    shifts = rng.uniform(-0.03, 0.03, (n_items, 2))
    items = []
    for index in range(n_items):
        row, column = divmod(index, side)
        x = (column - (side - 1) / 2) * SPACING + float(shifts[index, 0])
        y = NEAREST + row * SPACING + float(shifts[index, 1])
        words = tuple(f"kind{kinds[index]}word{number}" for number in range(4))
        items.append(Item(id=f"item-{index}", position=(x, y, 0.75), vocabulary=words))
    return Scene(items=tuple(items), head=(0.0, 0.0, 1.6))

"""What stands on the table, as bodies: the shape of a cup, a bowl, a marker, a spoon, and where a hand takes each.

Choice: a scene says words and a place, no shape, so the shape follows from the words; what no kind claims is a small
block. Sizes are those of ordinary things that a gripper of 64 mm opening can take. A body's origin is on the table,
below its middle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fetch_pomdp.checks import Point3

Rgba = tuple[float, float, float, float]
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
ALONG_X = (math.cos(math.pi / 4), 0.0, math.sin(math.pi / 4), 0.0)  # turns a cylinder's axis from z to x
COLORS: dict[str, Rgba] = {
    "red": (0.8, 0.1, 0.1, 1.0), "green": (0.1, 0.6, 0.2, 1.0), "blue": (0.1, 0.2, 0.8, 1.0),
    "yellow": (0.9, 0.8, 0.1, 1.0), "black": (0.08, 0.08, 0.08, 1.0), "white": (0.95, 0.95, 0.95, 1.0),
    "silver": (0.75, 0.76, 0.78, 1.0),
}  # fmt: skip
PLAIN: Rgba = (0.6, 0.45, 0.3, 1.0)


@dataclass(frozen=True, slots=True)
class Part:
    """A primitive of a body. size: MuJoCo's half sizes, m. mass: kg."""

    shape: Literal["box", "cylinder", "ellipsoid"]
    size: Point3
    place: Point3  # m, of its middle in the body's frame
    mass: float
    rotation: tuple[float, float, float, float] = UPRIGHT  # quaternion, w first


@dataclass(frozen=True, slots=True)
class Across:
    """Taken from above, with the fingers on either side of a round thing. height: m, of the tcp above the table."""

    height: float


@dataclass(frozen=True, slots=True)
class Along:
    """Taken from above, with the fingers on either side of a long thing that lies along its x axis."""

    height: float
    offsets: tuple[float, ...]  # m, along x, where to take it, the best first


@dataclass(frozen=True, slots=True)
class Rim:
    """Taken from above at a round rim, one finger inside."""

    height: float
    radius: float  # m, of the middle of the wall


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of item. radius: m, of the circle that it needs on the table. top: m, of its highest point."""

    name: str
    words: tuple[str, ...]
    parts: tuple[Part, ...]
    radius: float
    top: float
    take: Across | Along | Rim


def ring(radius: float, low: float, high: float, *, thickness: float, pieces: int, mass: float) -> tuple[Part, ...]:
    """Return a round wall of boxes, from `low` to `high` (m above the table), `radius` to its outside."""
    half = radius * math.tan(math.pi / pieces) * 1.02
    middle = radius - thickness / 2
    parts = []
    for index in range(pieces):
        angle = math.tau * index / pieces
        place = (middle * math.cos(angle), middle * math.sin(angle), (low + high) / 2)
        turn = (math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2))
        parts.append(Part("box", (thickness / 2, half, (high - low) / 2), place, mass / pieces, turn))
    return tuple(parts)


def disc(radius: float, height: float, mass: float) -> Part:
    """Return a bottom that lies on the table."""
    return Part("cylinder", (radius, height / 2, 0.0), (0.0, 0.0, height / 2), mass)


CUP = Kind(
    "cup", ("cup", "mug", "glass", "beaker", "can"),
    (*ring(0.028, 0.002, 0.09, thickness=0.004, pieces=16, mass=0.10), disc(0.026, 0.004, 0.03)),
    radius=0.028, top=0.09, take=Across(height=0.058),
)  # fmt: skip
BOWL = Kind(
    "bowl", ("bowl", "dish", "container"),
    (*ring(0.065, 0.004, 0.05, thickness=0.006, pieces=20, mass=0.15), disc(0.055, 0.006, 0.08)),
    radius=0.065, top=0.05, take=Rim(height=0.038, radius=0.062),
)  # fmt: skip
# A marker lies on one of two flattened sides, which keep it from rolling away.
MARKER = Kind(
    "marker", ("marker", "pen", "pencil", "crayon", "expo"),
    (
        Part("box", (0.068, 0.008, 0.0085), (0.0, 0.0, 0.0085), 0.02),
        Part("cylinder", (0.0082, 0.07, 0.0), (0.0, 0.0, 0.0085), 0.02, ALONG_X),
    ),
    radius=0.07, top=0.017, take=Along(height=0.009, offsets=(0.0, 0.02, -0.02)),
)  # fmt: skip
# The handle is arched: it touches the table at its end, and a finger finds room beside it.
SPOON = Kind(
    "spoon", ("spoon", "fork", "whisk", "utensil"),
    (
        Part("ellipsoid", (0.028, 0.019, 0.006), (0.057, 0.0, 0.0062), 0.02),
        Part("box", (0.055, 0.0055, 0.003), (-0.025, 0.0, 0.0105), 0.025),
        Part("box", (0.004, 0.0055, 0.00675), (-0.081, 0.0, 0.00675), 0.005),
    ),
    radius=0.085, top=0.0135, take=Along(height=0.009, offsets=(-0.02, 0.0, -0.04)),
)  # fmt: skip
BLOCK = Kind(
    "block", ("block", "box", "cube"),
    (Part("box", (0.02, 0.02, 0.03), (0.0, 0.0, 0.03), 0.08),),
    radius=0.029, top=0.06, take=Along(height=0.04, offsets=(0.0,)),
)  # fmt: skip
KINDS = (CUP, BOWL, MARKER, SPOON, BLOCK)


def kind_of(vocabulary: Sequence[str]) -> Kind:
    """Return the first kind that one of the words names, in the order of the words; a block if none does."""
    return next((kind for word in vocabulary for kind in KINDS if word in kind.words), BLOCK)


def color_of(vocabulary: Sequence[str]) -> Rgba:
    """Return the colour that a word names, or a plain one."""
    return next((COLORS[word] for word in vocabulary if word in COLORS), PLAIN)

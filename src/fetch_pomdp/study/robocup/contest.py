"""Games of "Hand Me That", and how planners stand after them.

Choice: walking, finding the objects and the ten minutes are left out; a robot that has waited and asked 30 times at a
group goes on with guesses. Nor does it pass on a group.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Action, Pick, Point
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.problem import Problem, constant_only
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.study.robocup.operators import Guests, Operator, Operators, group_scene
from fetch_pomdp.study.robocup.rules import GroupRecord, Rules, game_score, whole

DIFFERENT_GROUPS = 40


def play_group(problem: Problem, planner: Planner, desired: int, operator: Operator, robot: Generator) -> GroupRecord:
    """Play one group: a wrong guess takes its item out, and the robot goes on. It guesses each item once at most.

    Raises ModelError for live people (`turns`).
    """
    constant_only(problem, "Hand Me That")
    belief, asked = Belief.uniform(problem.n_items), None
    guessed: list[int] = []
    questions = waits = 0
    while len(guessed) < problem.n_items:
        action: Action = Pick(int(belief.log_probabilities.argmax()))
        if questions + waits < MOST_STEPS:
            action = planner.decide(problem, belief, asked, rng=robot).action
        if isinstance(action, Pick):
            guessed.append(action.item)
            if action.item == desired:
                return GroupRecord(True, len(guessed), questions, waits)
            belief = without(belief, guessed)
            continue
        if isinstance(action, Point):
            asked, questions = action.item, questions + 1
        else:
            waits += 1
        belief = belief.updated(operator.respond(action, asked), asked, problem)
    return GroupRecord(False, len(guessed), questions, waits)


def without(belief: Belief, guessed: Sequence[int]) -> Belief:
    """Return a belief without the items that were wrong; over the others alike if it gave those nothing."""
    log = belief.log_probabilities
    others = np.ones(len(log))
    others[list(guessed)] = 0.0
    if not others.any():
        return belief
    largest = log[others > 0.0].max()
    weights = others * np.exp(log - largest) if np.isfinite(largest) else others
    return Belief(weights / weights.sum())


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """How a planner did over games; `standard_error` is that of the mean score."""

    planner: str
    games: int
    mean_score: float  # points of a game
    standard_error: float
    right: float  # share of groups whose object was determined by a guess that earns points
    first: float  # share determined at the first guess
    questions: float  # a group
    waits: float  # a group


@dataclass(frozen=True, slots=True, kw_only=True)
class Contest:
    """Games that planners are compared by: each has the same groups, wishes and operators for every planner.

    Raises StudyError for a number of games, or a seed, out of range.

    Choice: the groups of all games are drawn from a few, so that a planner that solves each scene first need not solve
    thousands. The standard errors are those of games with these groups.
    """

    games: int = 200
    seed: int = 0
    rules: Rules = field(default_factory=Rules)
    operators: Operators = field(default_factory=Guests)

    def __post_init__(self) -> None:
        whole(self.games, 1, 1_000_000, "games")
        whole(self.seed, 0, 2**63 - 1, "seed")

    def courses(self) -> Iterator[list[Problem]]:
        """Yield the groups of each game."""
        rng = np.random.default_rng((self.seed, 0))
        known = [Problem(group_scene(self.rules, rng)) for _ in range(DIFFERENT_GROUPS)]
        for _ in range(self.games):
            yield [known[number] for number in rng.integers(len(known), size=self.rules.groups)]

    def standings(self, planners: Mapping[str, Planner]) -> list[Standing]:
        """Return how planners do; same seed, same result."""
        courses = list(self.courses())
        return [self._standing(name, planner, courses) for name, planner in planners.items()]

    def _standing(self, name: str, planner: Planner, courses: Sequence[Sequence[Problem]]) -> Standing:
        games = [
            [self._played(problem, planner, (game, group)) for group, problem in enumerate(course)]
            for game, course in enumerate(courses)
        ]
        scores = np.array([game_score(records, self.rules) for records in games], dtype=np.float64)
        records = [record for records in games for record in records]
        return Standing(
            planner=name,
            games=len(scores),
            mean_score=float(scores.mean()),
            standard_error=float(scores.std(ddof=1) / math.sqrt(len(scores))) if len(scores) > 1 else 0.0,
            right=float(np.mean([record.right and self.rules.earned(record.guesses) > 0 for record in records])),
            first=float(np.mean([record.right and record.guesses == 1 for record in records])),
            questions=float(np.mean([record.questions for record in records])),
            waits=float(np.mean([record.waits for record in records])),
        )

    def _played(self, problem: Problem, planner: Planner, place: tuple[int, int]) -> GroupRecord:
        person, robot = (np.random.default_rng((self.seed, *place, who)) for who in (1, 2))
        desired = int(person.integers(problem.n_items))
        return play_group(problem, planner, desired, self.operators.meet(problem, desired, person), robot)

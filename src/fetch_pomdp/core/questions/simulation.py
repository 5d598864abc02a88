"""Interactions with people from the model who are asked questions of all kinds, played side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, uniform
from fetch_pomdp.core.planners.asking import Asked, AskingPlanner
from fetch_pomdp.core.planners.base import whole_number
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, Turn, hear, normalise, smoothed_mass
from fetch_pomdp.core.problem import Problem, Tables, nobody_live
from fetch_pomdp.core.questions.question import Kind
from fetch_pomdp.core.questions.rows import KINDS, Rows, chance_after, rows_of
from fetch_pomdp.core.simulation import MOST_STEPS

WAITING = 1.0  # s, of a wait (`Timing.wait`)


@dataclass(frozen=True, slots=True)
class AskingSummary:
    """Means over episodes; `standard_error` is that of the mean return, steps count waits and questions."""

    episodes: int
    mean_return: float
    standard_error: float
    accuracy: float
    mean_steps: float
    mean_questions: float
    mean_seconds: float  # s, of the robot's waits and questions
    by_kind: Mapping[Kind, float]  # questions an episode
    earned: Vector  # (episodes,), each episode's return


class AskingInteractions(NamedTuple):
    """m interactions, changed in place."""

    desired: Integers  # (m,)
    people: RandomState  # (m,)
    beliefs: Vector  # (m, n)
    last: Integers  # (m,), the question asked last, or -1
    answers: Integers  # (m, k), the last answer of each, or -1
    earned: Vector  # (m,)
    seconds: Vector  # (m,)
    correct: Integers  # (m,)
    steps: Integers  # (m,)
    kinds: Integers  # (m, kinds), questions asked
    over: Integers  # (m,)

    @classmethod
    def begin(cls, desired: Integers, people: RandomState, problem: Problem) -> AskingInteractions:
        """Return interactions before their first action, with uniform beliefs."""
        count, items = len(desired), problem.n_items
        return cls(
            desired, people, np.full((count, items), 1.0 / items), np.full(count, NOBODY),
            np.full((count, problem.n_questions), -1), np.zeros(count), np.zeros(count),
            np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64),
            np.zeros((count, len(KINDS)), dtype=np.int64), np.zeros(count, dtype=np.int64),
        )  # fmt: skip


def simulate_asking(problem: Problem, planner: AskingPlanner, episodes: int, seed: int) -> AskingSummary:
    """Play `episodes` interactions, each item being the desired one equally often; same seed, same result.

    Raises PlannerError for a number of episodes or a seed out of range, ModelError for live people. Planners meet the
    same people, who answer as the questions' chances say, a question asked again as `Question.after` says. After
    MOST_STEPS waits and questions the robot picks what it holds likeliest.
    """
    whole_number(episodes, 1, 10**9, "episodes")
    nobody_live(problem, "a simulation of questions")
    robot = np.random.default_rng(whole_number(seed, 0, 2**63 - 1, "seed"))
    streams = np.random.default_rng((seed, 1)).integers(2**63, size=episodes, dtype=np.uint64)
    played = AskingInteractions.begin(np.arange(episodes) % problem.n_items, streams, problem)

    def decide(active: Integers, asked: Asked) -> Integers:
        return planner.decide_many_asking(problem, played.beliefs[active], asked, rng=robot)

    played_out(problem, played, decide)
    return _summary(played)


def played_out(problem: Problem, played: AskingInteractions, decide: Callable[[Integers, Asked], Integers]) -> None:
    """Play interactions to their ends; `decide` returns the actions, (j,), of those that go on, (j,)."""
    rows, active = rows_of(problem), np.arange(len(played.desired))
    for _ in range(MOST_STEPS):
        actions = decide(active, Asked(played.last[active], played.answers[active]))
        _advance(active, actions, played, rows, problem.tables)
        active = active[played.over[active] == 0]
        if not len(active):
            return
    _advance(active, 1 + problem.n_questions + played.beliefs[active].argmax(axis=1), played, rows, problem.tables)


def _summary(played: AskingInteractions) -> AskingSummary:
    count = len(played.earned)
    return AskingSummary(
        episodes=count,
        mean_return=float(played.earned.mean()),
        standard_error=float(played.earned.std(ddof=1)) / math.sqrt(count) if count > 1 else 0.0,
        accuracy=float(played.correct.mean()),
        mean_steps=float(played.steps.mean()),
        mean_questions=float(played.kinds.sum(axis=1).mean()),
        mean_seconds=float(played.seconds.mean()),
        by_kind=dict(zip(KINDS, played.kinds.mean(axis=0).tolist(), strict=True)),
        earned=played.earned,
    )


@compiled
def _advance(active: Integers, actions: Integers, played: AskingInteractions, rows: Rows, tables: Tables) -> None:
    heard, questions = np.empty(played.beliefs.shape[1]), len(rows.prices)
    for index in range(len(active)):
        k, action = active[index], actions[index]
        if action > questions:
            played.correct[k] = 1 if action - 1 - questions == played.desired[k] else 0
            played.earned[k] += tables.pick_correct if played.correct[k] else tables.pick_wrong
            played.over[k] = 1
            continue
        played.steps[k] += 1
        if action == 0:
            played.earned[k] += tables.wait
            played.seconds[k] += WAITING
        else:
            played.last[k] = action - 1
            played.earned[k] += rows.prices[action - 1]
            played.seconds[k] += rows.seconds[action - 1]
            played.kinds[k, rows.kinds[action - 1]] += 1
        live_through(k, action, played, heard, rows, tables)


@compiled
def live_through(k: int, action: int, played: AskingInteractions, heard: Vector, rows: Rows, tables: Tables) -> None:
    """Update an interaction's belief by a step of its person: words, pointing, an answer to the last question."""
    belief, state, desired, last = played.beliefs[k], played.people[k : k + 1], played.desired[k], played.last[k]
    turn = Turn(NOBODY, 0, WAITED if action == 0 else ASKED)
    hear(belief, smoothed_mass(belief, tables), desired, turn, heard, state, tables)
    belief[:] = heard
    speaks, which = uniform(state), uniform(state)
    if last == NOBODY or speaks >= (tables.p_again if action == 0 else tables.p_answer):
        return
    begin, end, before, shared = rows.starts[last], rows.starts[last + 1], played.answers[k, last], rows.shared[last]
    answer, reached = end - 1, 0.0
    for row in range(begin, end):
        reached += chance_after(row, desired, begin, before, shared, rows.chances)
        if which < reached:
            answer = row
            break
    for item in range(len(belief)):
        belief[item] *= chance_after(answer, item, begin, before, shared, rows.chances)
    normalise(belief)
    played.answers[k, last] = answer - begin

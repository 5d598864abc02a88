"""Twelve alike items with three attributes, the questions about them, and a world of few outcomes to play in.

Words say nothing there; a ray is the item that it is nearest to. Answers come in the step of their question or never.
A point-based solver of its own, Perseus, stands for the optimum: slow, and written from the model alone.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from fetch_pomdp import Item, Model, Scene
from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.answers import described, yes_no
from fetch_pomdp.core.questions.prices import LISTENING, POINTING, SPEAKING
from fetch_pomdp.core.questions.question import Kind, Question

Array = NDArray[np.float64]
TRUTH, N = 0.99, 12
LONGEST = 30  # steps
NOBODY_POINTS, RAY_FIRST = False, True


@dataclass(frozen=True)
class World:
    """A problem as matrices: o[action] is (n, answers * rays); actions are the questions and, last, a wait."""

    problem: Problem
    o: list[Array]
    costs: Array
    rays: Array  # (n, 1 + n), null first

    @property
    def n(self) -> int:
        """How many items there are."""
        return self.problem.n_items


def attributes() -> NDArray[np.int64]:
    """Three attributes, each of six items: every combination once, and four of them twice, in any order."""
    every = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    return np.random.default_rng(0).permutation(np.array([*every, (0, 0, 1), (0, 1, 0), (1, 0, 0), (1, 1, 1)]))


def places() -> list[tuple[float, float, float]]:
    """Two rows of six."""
    return [((k % 6 - 2.5) * 0.15, 2.95 + 0.25 * (k // 6), 0.75) for k in range(N)]


def scene(wrong: float = -12.5) -> Scene:
    """Return the scene, whose people say "mug" and answer in the step of a question or not at all."""
    items = tuple(Item(id=f"mug-{k}", position=place, vocabulary=("mug",)) for k, place in enumerate(places()))
    plain = Scene(items=items, head=(0.0, 0.0, 1.6), model=Model(p_answer_again=0.0, gesture_likelihood="exact"))
    return dataclasses.replace(plain, rewards=plain.rewards.with_changes({"pick_wrong": wrong}))


def asks(kind: Kind, holds: NDArray[np.bool_]) -> Question:
    """Return a question that is answered by yes or no."""
    return Question(
        kind=kind, said=kind.value, chances=yes_no(holds.astype(float), TRUTH),
        members=tuple(np.flatnonzero(holds).tolist()),
        seconds=POINTING if kind in (Kind.POINT, Kind.PAIR) else SPEAKING,
    )  # fmt: skip


def questions(kinds: set[Kind], names: float = 0.75) -> tuple[Question, ...]:
    """Return the questions of some kinds, those of the first measurements (regions: every border between columns)."""
    owned, x, number = attributes(), np.array([place[0] for place in places()]), np.arange(N)
    found = [asks(Kind.POINT, number == k) for k in range(N)]
    found += [asks(Kind.ATTRIBUTE, owned[:, k] == 1) for k in range(3)]
    found += [
        asks(Kind.ATTRIBUTES, (owned[:, one] == a) & (owned[:, other] == b))
        for one in range(3) for other in range(one + 1, 3) for a in (0, 1) for b in (0, 1)
    ]  # fmt: skip
    found += [asks(Kind.REGION, x < border) for border in (-0.3, -0.15, 0.0, 0.15, 0.3)]
    found += [asks(Kind.REGION, number < 6)]
    found += [asks(Kind.PAIR, (number == k) | (number == k + 1)) for k in range(N - 1) if k != 5]
    groups = [np.flatnonzero(owned[:, k] == value).tolist() for k in range(3) for value in (0, 1)]
    chances, keys = described(groups, N, names, 0.01)
    found.append(Question(
        kind=Kind.OPEN, said="what is it like?", chances=chances, answers=tuple(map(str, keys)), seconds=LISTENING
    ))  # fmt: skip
    return tuple(question for question in found if question.kind in kinds)


def world(problem: Problem) -> World:
    """Return a problem's matrices."""
    rays, p_l, n = Discrete(Problem(problem.scene)).gestures, problem.model.p_l, problem.n_items
    silence = np.zeros((n, 1))
    o = []
    for question in problem.questions:
        answers = np.concatenate([silence + 1.0 - p_l, p_l * question.chances.T], axis=1)
        o.append((answers[:, :, None] * rays[:, None, :]).reshape(n, -1))
    o.append(rays)
    rewards = problem.rewards
    costs = [min(rewards.wait, rewards.point * question.seconds / POINTING) for question in problem.questions]
    return World(problem, o, np.array([*costs, rewards.wait]), rays)


Decide = Callable[[Array], NDArray[np.int64]]  # beliefs (m, n) to actions (m,): a question, the wait, or -1 for a pick


def play(of: World, decide: Decide, episodes: int, rng: Generator, *, ray_first: bool) -> dict[str, Array]:
    """Play episodes side by side; the person of an episode is the same whoever plays."""
    desired = np.arange(episodes) % of.n
    beliefs = np.full((episodes, of.n), 1.0 / of.n)
    if ray_first:
        pointing = of.rays[:, 1:] / of.rays[:, 1:].sum(axis=1, keepdims=True)
        drawn = 1 + (rng.random(episodes)[:, None] > np.cumsum(pointing, axis=1)[desired]).sum(axis=1)
        beliefs *= of.rays.T[drawn]
        beliefs /= beliefs.sum(axis=1, keepdims=True)
    earned, asked, active = np.zeros(episodes), np.zeros((episodes, len(of.costs))), np.arange(episodes)
    for _ in range(LONGEST):
        numbers = rng.random((episodes, 2))
        actions = decide(beliefs[active])
        active, actions = active[actions >= 0], actions[actions >= 0]
        if not len(active):
            break
        for action in np.unique(actions):
            who = active[actions == action]
            o = of.o[action]
            seen = (numbers[who, :1] > np.cumsum(o, axis=1)[desired[who]]).sum(axis=1)
            beliefs[who] *= o.T[np.minimum(seen, o.shape[1] - 1)]
            earned[who] += of.costs[action]
            asked[who, action] += 1
        beliefs[active] /= beliefs[active].sum(axis=1, keepdims=True)
    correct = beliefs.argmax(axis=1) == desired
    rewards = of.problem.rewards
    return {
        "earned": earned + np.where(correct, rewards.pick_correct, rewards.pick_wrong),
        "correct": correct.astype(float),
        "questions": asked[:, :-1].sum(axis=1),
        "steps": asked.sum(axis=1),
    }


def told(of: World, beliefs: Array) -> Array:
    """Return what each question tells of each belief, in bits, rays and silence included, (m, k)."""

    def entropy(p: Array) -> Array:
        return np.asarray(-(p * np.log2(np.maximum(p, 1e-300))).sum(axis=-1))

    found = []
    for o in of.o[:-1]:
        joint = beliefs[:, :, None] * o[None]
        chance = joint.sum(axis=1)
        after = (joint / np.maximum(chance[:, None], 1e-300)).transpose(0, 2, 1)
        found.append(entropy(beliefs) - (chance * entropy(after)).sum(axis=1))
    return np.stack(found, axis=1)


def until_sure(of: World, confidence: float) -> Decide:
    """Return the robot that asks what tells most until it is so sure."""

    def decide(beliefs: Array) -> NDArray[np.int64]:
        return np.where(beliefs.max(axis=1) >= confidence, -1, told(of, beliefs).argmax(axis=1))

    return decide

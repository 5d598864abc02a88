"""Scenes for tests, and the same scenes as worlds of the oracles."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

from fetch_pomdp.core.model import Model
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from tests.oracles.model import World

Point3 = tuple[float, float, float]


def row(count: int) -> list[Point3]:
    """Places half a metre apart, two metres ahead."""
    return [(0.5 * index - 0.25 * (count - 1), 2.0, 0.75) for index in range(count)]


def table(vocabularies: Sequence[Sequence[str]], places: Sequence[Point3] | None = None, **model: Any) -> Problem:
    places = row(len(vocabularies)) if places is None else places
    items = tuple(
        Item(id=f"item-{index}", position=place, vocabulary=tuple(words))
        for index, (words, place) in enumerate(zip(vocabularies, places, strict=True))
    )
    return Problem(Scene(items=items, head=(0.0, 0.0, 1.6), model=Model(**model)))


def twins(count: int, **model: Any) -> Problem:
    """Items that share their only word, before a person who never points: answers are all there is to learn."""
    return table([["thing"]] * count, p_g=0.0, **model)


def live(problem: Problem) -> Problem:
    """The same table with live people, who speak and point by where the talk stands."""
    model = problem.model.with_changes({"turns": {}})
    return Problem(dataclasses.replace(problem.scene, model=model))


def world_of(problem: Problem) -> World:
    model, rewards = problem.model, problem.rewards
    return World(
        vocabularies=[item.vocabulary for item in problem.scene.items],
        places=[item.position for item in problem.scene.items],
        head=problem.scene.head,
        alpha=model.alpha,
        p_l=model.p_l,
        p_g=model.p_g,
        sigma=model.sigma,
        p_truth=model.p_truth,
        threshold=model.gesture_threshold,
        again=model.p_answer_again,
        right=rewards.pick_correct,
        wrong=rewards.pick_wrong,
        ask=rewards.point,
        wait=rewards.wait,
    )

"""The policies behind leaf `question`: ask about an item and wait the answer out. Nobody points, no word is heard."""

from __future__ import annotations

import random
from collections.abc import Sequence

from tests.oracles.model import World
from tests.oracles.value import picks


def best_other(belief: Sequence[float], about: int) -> int:
    others = [item for item in range(len(belief)) if item != about]
    return max(others, key=lambda item: belief[item]) if others else about


def answered(belief: Sequence[float], about: int, world: World) -> float:
    """Value once an answer is certain to be there: pick the item after yes, the best other after no."""
    other = best_other(belief, about)
    total = 0.0
    for desired, chance in enumerate(belief):
        yes = world.p_truth if desired == about else 1 - world.p_truth
        total += chance * yes * (world.right if desired == about else world.wrong)
        total += chance * (1 - yes) * (world.right if desired == other else world.wrong)
    return total


def waited_out(belief: Sequence[float], about: int, world: World) -> float:
    """Value of waiting until the answer comes."""
    rate = world.p_l * world.again
    if rate == 0:
        return float("-inf")
    total, silent, settled = 0.0, 1.0, answered(belief, about, world)
    step = 0
    while silent > 1e-15:
        step += 1
        total += silent * rate * (settled + world.wait * step)
        silent *= 1 - rate
    return total


def asked_now(belief: Sequence[float], about: int, world: World) -> float:
    """Value of asking: an answer at once, or else waiting it out or picking the likeliest, whichever is better."""
    later = max(waited_out(belief, about, world), *picks(belief, world))
    return world.ask + world.p_l * answered(belief, about, world) + (1 - world.p_l) * later


def question_leaf(belief: Sequence[float], asked: int | None, world: World) -> float:
    choices = [world.wait, *picks(belief, world), *(asked_now(belief, item, world) for item in range(len(belief)))]
    if asked is not None:
        choices.append(waited_out(belief, asked, world))
    return max(choices)


def play_question(belief: Sequence[float], about: int, patient: bool, world: World, rng: random.Random) -> float:
    """One interaction in which the policy is followed with a person drawn from the model."""
    desired = rng.choices(range(len(belief)), belief)[0]
    earned, rate = world.ask, world.p_l
    while True:
        if rng.random() < rate:
            truthful = rng.random() < world.p_truth
            yes = truthful == (desired == about)
            item = about if yes else best_other(belief, about)
            return earned + (world.right if item == desired else world.wrong)
        if not patient:
            item = max(range(len(belief)), key=lambda i: belief[i])
            return earned + (world.right if item == desired else world.wrong)
        earned += world.wait
        rate = world.p_l * world.again

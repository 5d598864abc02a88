"""The exact value of actions by enumeration, for worlds where nobody points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tests.oracles.model import World, class_chance, word_chance

Leaf = Callable[[Sequence[float], int | None, World], float]


@dataclass(frozen=True)
class Values:
    wait: float
    point: list[float]
    pick: list[float]

    @property
    def best(self) -> float:
        return max(self.wait, *self.point, *self.pick)


def picks(belief: Sequence[float], world: World) -> list[float]:
    return [world.right * p + world.wrong * (1 - p) for p in belief]


def pick_leaf(belief: Sequence[float], asked: int | None, world: World) -> float:  # noqa: ARG001
    return max(world.wait, *picks(belief, world))


def after(belief: Sequence[float], about: int | None, rate: float, world: World) -> list[tuple[float, list[float]]]:
    """Every observation's chance and the belief it leads to."""
    results = []
    spoken: list[str | None] = [None]
    # Words that all items share say nothing: they are not enumerated.
    if len({tuple(sorted(vocabulary)) for vocabulary in world.vocabularies}) > 1:
        spoken += world.words
    for word in spoken:
        for answer in (None, True, False):
            joint = []
            for item, chance in enumerate(belief):
                heard = 1.0
                if len(spoken) > 1:
                    heard = 1 - world.p_l if word is None else world.p_l * word_chance(word, item, world)
                if answer is None:
                    heard *= 1 - rate
                else:
                    heard *= rate * class_chance(answer, item, about, world)
                joint.append(chance * heard)
            total = sum(joint)
            if total > 0:
                results.append((total, [x / total for x in joint]))
    return results


def action_values(
    belief: Sequence[float], asked: int | None, depth: int, world: World, leaf: Leaf = pick_leaf
) -> Values:
    """Depth counts actions and is at least 2: the last of them is worth the leaf."""

    def ahead(about: int | None, rate: float) -> float:
        total = 0.0
        for chance, following in after(belief, about, rate, world):
            if depth == 2:
                total += chance * leaf(following, about, world)
            else:
                total += chance * action_values(following, about, depth - 1, world, leaf).best
        return total

    wait = world.wait + ahead(asked, world.p_l * world.again)
    point = [world.ask + ahead(item, world.p_l) for item in range(len(belief))]
    return Values(wait, point, picks(belief, world))


def value(belief: Sequence[float], asked: int | None, depth: int, world: World, leaf: Leaf = pick_leaf) -> float:
    if depth == 1:
        return leaf(belief, asked, world)
    return action_values(belief, asked, depth, world, leaf).best

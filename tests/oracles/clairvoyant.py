"""Slow and plain: the optimal value between two twins, and the best a clairvoyant does by trying every sequence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tests.oracles.model import World
from tests.oracles.value import after, picks

Value = Callable[[Sequence[float], int | None], float]


def share_of(net: int, world: World) -> float:
    """The belief in item 0 after so many more answers for it than against it."""
    odds = (world.p_truth / (1 - world.p_truth)) ** net
    return odds / (1 + odds)


@dataclass(frozen=True)
class TwinValues:
    """What the optimal policy earns between two twins, before a person who only answers, by the net of answers."""

    wait: dict[tuple[int, bool], float]  # by whether one of them was asked about; the step's own reward left out
    ask: dict[int, float]
    best: dict[tuple[int, bool], float]


def twin_values(world: World, most: int = 12) -> TwinValues:
    nets = range(-most, most + 1)
    pick = {net: max(picks([share_of(net, world), 1 - share_of(net, world)], world)) for net in nets}
    best = {(net, asked): pick[net] for net in nets for asked in (False, True)}

    def answered(net: int, rate: float) -> float:
        share, true = share_of(net, world), world.p_truth
        rises = share * true + (1 - share) * (1 - true)
        up, down = best[min(net + 1, most), True], best[max(net - 1, -most), True]
        return rate * (rises * up + (1 - rises) * down) + (1 - rate) * best[net, True]

    while True:
        ask = {net: answered(net, world.p_l) for net in nets}
        wait = {(net, True): answered(net, world.p_l * world.again) for net in nets}
        wait |= {(net, False): best[net, False] for net in nets}
        new = {key: max(pick[key[0]], world.ask + ask[key[0]], world.wait + wait[key]) for key in best}
        if max(abs(new[key] - best[key]) for key in best) < 1e-14:
            return TwinValues(wait, ask, new)
        best = new


@dataclass(frozen=True)
class Foresight:
    """All that a clairvoyant knows: the desired item, and for each step what is heard and how an answer falls out."""

    desired: int
    evidence: Sequence[Sequence[float]]
    speaks: Sequence[float]
    means: Sequence[float]

    def following(
        self, belief: Sequence[float], step: int, about: int | None, rate: float, world: World
    ) -> list[float]:
        joint = [p * likelihood for p, likelihood in zip(belief, self.evidence[step], strict=True)]
        if about is not None and self.speaks[step] < rate:
            positive = (self.means[step] < world.p_truth) == (about == self.desired)
            for item in range(len(joint)):
                joint[item] *= world.p_truth if positive == (item == about) else 1 - world.p_truth
        return [x / sum(joint) for x in joint]


@dataclass(frozen=True)
class Clairvoyant:
    """Tries every sequence, node by node; closes a node at `ceiling` where it can end at no more than tau."""

    world: World
    control: Value
    ceiling: Value
    tau: float
    last: int

    def best(
        self, seen: Foresight, belief: Sequence[float], asked: int | None, step: int = 0, total: float = 0.0
    ) -> float:
        world, here = self.world, self.control(belief, asked)
        pick, most = max(picks(belief, world)), self.ceiling(belief, asked)
        found = max(self.tau, total + pick - here)
        if total + most - here <= self.tau:
            return found
        if step == self.last or most <= pick + 1e-9:
            return max(found, total + most - here)
        asks = [(item, world.p_l, world.ask) for item in range(world.count) if not self.repeated(item, belief, asked)]
        for about, rate, reward in [(asked, world.p_l * world.again, world.wait), *asks]:
            ahead = sum(chance * self.control(b, about) for chance, b in after(belief, about, rate, world))
            then = seen.following(belief, step, about, rate, world)
            found = max(found, self.best(seen, then, about, step + 1, total + reward + ahead - here))
        return found

    def repeated(self, item: int, belief: Sequence[float], asked: int | None) -> bool:
        """Whether an earlier twin, of the same belief and as little asked about, is as good to ask about."""
        words = self.world.vocabularies
        return item != asked and any(
            words[other] == words[item] and other != asked and abs(belief[other] - belief[item]) < 1e-11
            for other in range(item)
        )

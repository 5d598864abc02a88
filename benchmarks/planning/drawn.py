"""Scenes drawn at random, by seed: layouts, vocabularies, parameters and rewards far from the study's."""

from __future__ import annotations

import math

from numpy.random import Generator, default_rng

from fetch_pomdp import Item, Model, Rewards, Scene

LOOKED_AT = range(150)  # seeds that were looked at while the planner was made
HELD_OUT = range(150, 200)  # seeds that were opened once, at the end


def random_scene(seed: int) -> Scene:
    """Return the scene of a seed. U is uniform and L uniform in the logarithm.

    - items: n = L(2, 50). Kinds: 1 to n, as likely each, in four scenes of five; else n. Every kind has an item at
      least, the others' kinds are uniform; order is random.
    - words of a kind: 1 to 4 from a pool of kinds * words * U(0.3, 1.2), and 0 to 2 that all items share. Kinds may
      share words, or all of them.
    - places, a third each: on an arc of 1.2 m, spaced L(0.05, 0.6) rad and 5.5 rad wide at the most; on a line 0.8 m
      ahead, spaced L(0.05, 0.6) m; anywhere on a table of 1.2 by 1.6 m.
    - alpha L(0.05, 1), p_l U(0.6, 0.98), p_g U(0, 0.5), sigma L(0.05, 0.4) rad, p_truth U(0.9, 0.995); the gesture
      likelihood is exact or that of Eq. 7, as likely either.
    - a right pick 10, a wrong one -12.5 * L(1/e, e), a wait -L(0.2, 2), a question -6 * L(0.3, 1.8), at the most the
      reward of a wait.
    """
    rng = default_rng((20261, seed))
    n_items = round(log_uniform(rng, 2.0, 50.0))
    n_kinds = int(rng.integers(1, n_items + 1)) if rng.random() < 0.8 else n_items
    words = vocabularies(rng, n_kinds)
    places = positions(rng, n_items)
    kinds = [k if k < n_kinds else int(rng.integers(n_kinds)) for k in range(n_items)]
    rng.shuffle(kinds)
    items = tuple(
        Item(id=f"item-{k}", position=place, vocabulary=words[kind])
        for k, (place, kind) in enumerate(zip(places, kinds, strict=True))
    )
    return Scene(items=items, head=(0.0, 0.0, 1.6), model=model(rng), rewards=rewards(rng))


def log_uniform(rng: Generator, low: float, high: float) -> float:
    """Return a number that is uniform in the logarithm."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def vocabularies(rng: Generator, n_kinds: int) -> list[tuple[str, ...]]:
    """Return the words of each kind."""
    own, shared = int(rng.integers(1, 5)), int(rng.integers(0, 3))
    pool = max(own, int(n_kinds * own * rng.uniform(0.3, 1.2)))
    common = {f"c{word}" for word in range(shared)}
    return [
        tuple(sorted({f"w{word}" for word in rng.choice(pool, own, replace=False)} | common)) for _ in range(n_kinds)
    ]


def positions(rng: Generator, n_items: int) -> list[tuple[float, float, float]]:
    """Return where the items are (m)."""
    spacing, layout = log_uniform(rng, 0.05, 0.6), rng.integers(3)
    offsets = [k - (n_items - 1) / 2 for k in range(n_items)]
    if layout == 0:
        angles = [offset * min(spacing, 5.5 / n_items) for offset in offsets]
        return [(1.2 * math.cos(angle), 1.2 * math.sin(angle), 0.8) for angle in angles]
    if layout == 1:
        return [(0.8, offset * spacing, 0.8) for offset in offsets]
    # the third number has no use, and keeps the scenes those that the planner was made on
    return [(0.5 + x, y, 0.75) for x, y, _ in (drawn_place(rng) for _ in offsets)]


def drawn_place(rng: Generator) -> tuple[float, float, float]:
    """Return a place on the table, and a number."""
    return rng.uniform(0.0, 1.2), rng.uniform(-0.8, 0.8), rng.uniform()


def model(rng: Generator) -> Model:
    """Return parameters."""
    return Model(
        alpha=log_uniform(rng, 0.05, 1.0),
        p_l=rng.uniform(0.6, 0.98),
        p_g=rng.uniform(0.0, 0.5),
        sigma=log_uniform(rng, 0.05, 0.4),
        p_truth=rng.uniform(0.9, 0.995),
        gesture_likelihood="exact" if rng.random() < 0.5 else "eq7",
    )


def rewards(rng: Generator) -> Rewards:
    """Return rewards."""
    wait = -log_uniform(rng, 0.2, 2.0)
    wrong = -12.5 * math.exp(rng.uniform(-1.0, 1.0))
    return Rewards(
        pick_correct=10.0, pick_wrong=wrong, wait=wait, point=min(wait, -6.0 * math.exp(rng.uniform(-1.2, 0.6)))
    )

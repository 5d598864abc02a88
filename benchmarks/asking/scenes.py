"""Scenes drawn at random, by seed, whose items have attributes, and the questions that may be asked there."""

from __future__ import annotations

import math

from numpy.random import Generator, default_rng

from fetch_pomdp import Item, Model, Rewards, Scene
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.candidates import Asking, candidates
from fetch_pomdp.core.questions.question import Kind
from planning.drawn import log_uniform, positions

LOOKED_AT = range(1000, 1200)  # seeds that were looked at while the planner was made
OPENED = range(1200, 1250)  # seeds that were opened once; the number of sweeps was raised after that, on others
HELD_OUT = range(1250, 1300)  # seeds that were opened once, after that

ATTRIBUTES = (
    ("red", "blue", "green", "yellow"),
    ("big", "small", "tiny", "huge"),
    ("striped", "plain", "dotted", "chequered"),
    ("wooden", "metal", "plastic", "paper"),
)
NOUNS = ("mug", "bowl", "spoon", "marker", "box", "fork")


def random_problem(seed: int) -> Problem:
    """Return the problem of a seed. U is uniform and L uniform in the logarithm.

    - items: 3 to 15; nouns: 1 to 4, or as many as items, an item's drawn evenly. Attributes: 1 to 4 of two to four
      values, drawn evenly.
    - places as in `planning.drawn`; alpha L(0.05, 1), p_l U(0.6, 0.98), p_g U(0, 0.4), sigma L(0.05, 0.4) rad, p_truth
      U(0.9, 0.995); the gesture likelihood is exact or that of Eq. 7; answers come again after a wait, never, or with
      a chance in between, a third each.
    - people say the noun alone, or all words, as likely each: words that are asked about but not said are in no
      vocabulary the robot hears.
    - a right pick 10, a wrong one -12.5 * L(1/e, 4), a wait -L(0.3, 1.5), pointing -6 * L(0.3, 1.5), at the most a
      wait.
    - answers are about a neighbour with a chance of U(0, 0.15), shared by a question asked again with U(0, 0.9). Kinds
      of question: points and attributes, and each other kind with a chance of two thirds.
    """
    rng = default_rng((20262, seed))
    n_items = int(rng.integers(3, 16))
    nouns = NOUNS[: int(rng.integers(1, min(4, n_items) + 1))]
    values = [kinds[: int(rng.integers(2, 5))] for kinds in ATTRIBUTES[: int(rng.integers(1, 5))]]
    items = tuple(
        Item(
            id=f"{(noun := nouns[int(rng.integers(len(nouns)))])}-{index}",
            position=place,
            vocabulary=(noun, *(kinds[int(rng.integers(len(kinds)))] for kinds in values)),
        )
        for index, place in enumerate(positions(rng, n_items))
    )
    wait = -log_uniform(rng, 0.3, 1.5)
    rewards = Rewards(
        pick_correct=10.0,
        pick_wrong=-12.5 * log_uniform(rng, 1.0 / math.e, 4.0),
        wait=wait,
        point=min(wait, -6.0 * log_uniform(rng, 0.3, 1.5)),
    )
    scene = Scene(items=items, head=(0.0, 0.0, 1.6), model=model(rng), rewards=rewards)
    kinds = {Kind.POINT, Kind.ATTRIBUTE} | {kind for kind in Kind if rng.random() < 2.0 / 3.0}
    asking = Asking(kinds=frozenset(kinds), misunderstood=rng.uniform(0.0, 0.15), shared=rng.uniform(0.0, 0.9))
    questions = candidates(scene, asking)
    if rng.random() < 0.5:
        heard = tuple(Item(id=item.id, position=item.position, vocabulary=item.vocabulary[:1]) for item in items)
        scene = Scene(items=heard, head=scene.head, model=scene.model, rewards=scene.rewards)
    return Problem(scene, questions)


def model(rng: Generator) -> Model:
    """Return parameters."""
    again = rng.uniform()
    return Model(
        alpha=log_uniform(rng, 0.05, 1.0),
        p_l=rng.uniform(0.6, 0.98),
        p_g=rng.uniform(0.0, 0.4),
        sigma=log_uniform(rng, 0.05, 0.4),
        p_truth=rng.uniform(0.9, 0.995),
        gesture_likelihood="exact" if rng.random() < 0.5 else "eq7",
        p_answer_again=(0.0, 1.0, again)[int(rng.integers(3))],
    )

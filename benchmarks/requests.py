"""How well what real people say about a table is read: each table by weights learnt from the others.

    python benchmarks/requests.py DIR                        # each table left out in turn; about ten minutes
    python benchmarks/requests.py DIR --weights shipped      # by the weights that come with the package
    python benchmarks/requests.py DIR --questions            # and how many questions it takes, at the paper's prices
    python benchmarks/requests.py DIR --speed                # milliseconds a sentence at 15 and 100 items

DIR holds tables.json and requests.csv (`study.requests.corpus`). Printed: the share in which the likeliest item was
meant, of all requests and of those that need somebody's view; the share of listeners who were right and of those who
took what we take; logarithmic loss (nats), calibration error and the reliability diagram behind it.
"""

from __future__ import annotations

import argparse
import dataclasses
import gc
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.reader import Context, Heard, TableReader
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.language.reading.weights import shipped, theta_of
from fetch_pomdp.core.live.person import LIVE_MODEL
from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.planners.base import Decision, Planner
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.study.requests.corpus import Corpus, Request, load_corpus
from fetch_pomdp.study.requests.fit import Learner
from fetch_pomdp.study.requests.scores import Score, groups, score

P_TRUTH = 0.97  # of the person's answers
MOST_STEPS = 30
WRONG = (-12.5, -40.0, -80.0)  # prices of a wrong item that the default planner plans with; the first is the paper's
UNTIL = (0.5, 0.6, 0.7, 0.8, 0.87, 0.9)


def left_out(corpus: Corpus, steps: int) -> list[Vector]:
    """Return the chances of each request's items by weights learnt from all tables but its own."""
    learner, found = Learner(corpus), dict[int, Vector]()
    for table in corpus.scenes:
        begun = time.perf_counter()
        theta = learner.fit([other for other in corpus.scenes if other != table], steps=steps)
        found |= learner.read(theta, [table])
        print(f"table {table} left out, {time.perf_counter() - begun:.0f} s", flush=True)
    return [found[index] for index in range(len(corpus.requests))]


def by_shipped(corpus: Corpus) -> list[Vector]:
    """Return the chances of each request's items by the weights that come with the package."""
    found = Learner(corpus).read(theta_of(shipped()), list(corpus.scenes))
    return [found[index] for index in range(len(corpus.requests))]


def show(corpus: Corpus, chances: Sequence[Vector]) -> Score:
    """Print the scores of all groups of requests, and the reliability diagram; return the score of all."""
    print(f"{'':16}{'count':>6}{'right':>8}{'listeners':>11}{'took ours':>11}{'log loss':>10}{'ECE':>7}")
    found_of: dict[str, Score] = {}
    for name, belongs in groups(corpus.requests).items():
        inside = [index for index, each in enumerate(corpus.requests) if belongs(each)]
        found = score([corpus.requests[index] for index in inside], [chances[index] for index in inside])
        print(f"{name:16}{found.count:6}{found.right:8.3f}{found.listeners:11.3f}{found.agreeing:11.3f}"
              f"{found.log_loss:10.3f}{found.calibration_error:7.3f}")  # fmt: skip
        found_of[name] = found
    whole = found_of["all"]
    print("\nlikeliest item   right   of")
    for each in whole.bins:
        print(f"{each.believed:14.3f}{each.right:8.3f}{each.count:5}  {'#' * round(40 * each.right)}")
    return whole


def play(corpus: Corpus, chances: Sequence[Vector], planners: Sequence[tuple[str, Planner, float]], seed: int) -> None:
    """Let robots ask a person who has said a request once and answers truly with P_TRUTH; print how it ends.

    The planners plan with the model of live people (docs/live-people.md): with the paper's they wait for more words, of
    which there are none here. The prices are the paper's, and a step of waiting has its price, too; a planner may plan
    with another price of a wrong item, which stands beside it.
    """
    told = Told()
    model = dataclasses.replace(LIVE_MODEL, p_truth=P_TRUTH)
    print(f"\n{'with questions':24}{'right':>8}{'questions':>11}{'waits':>8}{'return':>8}")
    for name, planner, wrong in planners:
        agents = {
            table: Agent(scene, planner, model=model, rewards={"pick_wrong": wrong}, reader=told, seed=seed)
            for table, scene in corpus.scenes.items()
        }
        ends = []
        for index, each in enumerate(corpus.requests):
            told.log_likelihood = np.log(chances[index])
            ends.append(asked_out(agents[each.table], each, np.random.default_rng((seed, index))))
        right, questions, waits = np.array(ends, dtype=float).T
        paid = Rewards()
        value = paid.pick_correct * right + paid.pick_wrong * (1.0 - right) + paid.point * questions + paid.wait * waits
        print(f"{name:24}{right.mean():8.3f}{questions.mean():11.2f}{waits.mean():8.2f}{value.mean():8.2f}", flush=True)


class Told:
    """A reader that was told what every text means: for words that weights were not learnt from."""

    log_likelihood: Vector

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Return what it was told."""
        return Heard(self.log_likelihood, (), (), (), 0.0, False, context)


def asked_out(agent: Agent, request: Request, rng: Generator) -> tuple[bool, int, int]:
    """Return whether the right item is picked in the end, after how many questions and how many waits."""
    questions = waits = 0
    agent.begin()
    agent.observe(request.text)
    for _ in range(MOST_STEPS):
        action = agent.act()
        if isinstance(action, Pick):
            return action.item == request.target, questions, waits
        answer = ""
        if isinstance(action, Point):
            questions += 1
            answer = "yes" if (action.item == request.target) == (rng.random() < P_TRUTH) else "no"
        else:
            waits += 1
        agent.observe(answer)
    return False, questions, waits


@dataclass(frozen=True, slots=True)
class AskUntil:
    """Asks about the likeliest item until one has a chance, and picks it then."""

    chance: float

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Decide by the likeliest item alone."""
        chances = belief.probabilities
        best = int(chances.argmax())
        action = Pick(best) if chances[best] >= self.chance else Point(best)
        return Decision(action, wait=0.0, point=0 * chances, pick=0 * chances)


def speed(corpus: Corpus) -> None:
    """Print how long a sentence takes to read at 15 and at 100 items, and a new scene once, in the processor's time."""
    rng = np.random.default_rng(0)
    places = np.stack([rng.uniform(-1.0, 1.0, 100), rng.uniform(0.5, 2.0, 100)], axis=1)
    words = [item.vocabulary for scene in corpus.scenes.values() for item in scene.items]
    items = tuple(
        Item(id=str(index), position=(float(x), float(y), 0.75), vocabulary=words[index % len(words)])
        for index, (x, y) in enumerate(places)
    )
    big = Scene(items=items, head=(0.0, 0.0, 1.25), robot=(0.0, 2.5, 1.25))
    reader = TableReader()

    def taken(text: str, scene: Scene) -> float:
        begun = time.process_time()
        reader.read(words_of(text), scene, Context())
        return 1e3 * (time.process_time() - begun)

    gc.freeze()  # a search of all that was loaded for garbage is no part of reading
    for name, scenes in (("15 items", corpus.scenes), ("100 items", dict.fromkeys(corpus.scenes, big))):
        once = [taken("", scene) for scene in {id(scene): scene for scene in scenes.values()}.values()]
        each = [taken(request.text, scenes[request.table]) for request in corpus.requests]
        middle, late, later, most = np.quantile(each, [0.5, 0.95, 0.99, 1.0])
        spread = f"half {middle:.2f}, 95 % {late:.2f}, 99 % {later:.2f}, most {most:.1f}"
        print(f"{name}: mean {np.mean(each):.2f} ms, {spread}; a new scene {np.median(once):.1f}")


def main() -> None:
    """Read the command line, measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--weights", choices=["shipped"], help="in place of weights learnt from the other tables")
    parser.add_argument("--steps", type=int, default=14, help="of the fit")
    parser.add_argument("--questions", action="store_true")
    parser.add_argument("--speed", action="store_true")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    corpus = load_corpus(given.folder)
    if given.speed:
        speed(corpus)
        return
    chances = by_shipped(corpus) if given.weights else left_out(corpus, given.steps)
    show(corpus, chances)
    if given.questions:
        until = [(f"asks until {chance}", AskUntil(chance), WRONG[0]) for chance in UNTIL]
        planned = [(f"the default, {price:g}", FittedValue(), price) for price in WRONG]
        play(corpus, chances, [*until, *planned], given.seed)


if __name__ == "__main__":
    main()

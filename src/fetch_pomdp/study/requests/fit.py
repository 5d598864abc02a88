"""Learns the reader's weights from requests: maximum likelihood of what was meant, with a normal prior around none.

Choice: the target counts for 0.6 of a request, and what its listeners took it for for the rest: half of what separates
a reader from a writer is that the writer erred, and ten listeners tell how sure one may be.

Choice: a last step fits how sure to be (`SURE`) to the targets alone: what listeners took a request for tells the
weights what words mean, but a belief is about what was meant.

Choice: gradients are differences. All variants of the weights go through the same arrays at once, so that a gradient
costs some ten evaluations, not fifty; and the reader stays plain arithmetic, without a library that differentiates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.degrees import Array
from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.grammar import Grammar, grammar
from fetch_pomdp.core.language.reading.likelihood import understood, view_prior
from fetch_pomdp.core.language.reading.reader import Parsed, parse
from fetch_pomdp.core.language.reading.speaker import ease
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.language.reading.weights import NAMES, WEIGHTS, Weights
from fetch_pomdp.extras import load
from fetch_pomdp.study.requests.corpus import Corpus

MEANT = 0.6  # weight of the target, against the listeners
PRIOR = 4.0  # precision of the normal prior of each weight's logarithm or difference
STEP = 1e-3  # of the differences
LEAST = 1e-12
SURE = ("sharpness", "lost", "lost_unknown", "lost_skipped")  # weights of the last step
SURE_STEPS = 6


@dataclass(frozen=True, slots=True, eq=False)
class Example:
    """Requests about a table that are read alike: their readings, and how often each item was meant."""

    table: int
    parsed: Parsed
    meant: Vector  # (n_items,), weights: of the targets and of what listeners took
    targets: Vector  # (n_items,), of the targets alone
    requests: tuple[int, ...]  # indices into the corpus


@dataclass(frozen=True, slots=True)
class _Goal:
    """Which weights are fitted, by index, and whether to the targets alone."""

    free: tuple[int, ...]
    alone: bool


class Learner:
    """The examples of a corpus, ready to be fitted to any choice of its tables."""

    def __init__(self, corpus: Corpus, language: str = "english") -> None:
        self.grammar: Grammar = grammar(language)
        self.tables = {number: Table.of(scene) for number, scene in corpus.scenes.items()}
        self.examples = _examples(corpus, self.tables, self.grammar)

    def chances(self, examples: Sequence[Example], weights: Weights) -> list[Array]:
        """Return what each example's words say of each item, (..., n_items)."""
        prior, kept, found = view_prior(weights), dict[int, tuple[Denotation, Array]](), []
        for each in examples:
            if each.table not in kept:
                fresh = Denotation(self.tables[each.table], self.grammar, weights)
                kept[each.table] = fresh, ease(fresh)
            parsed, (meaning, easy) = each.parsed, kept[each.table]
            result = understood(parsed.found, meaning, weights, views=prior, confusion=parsed.confusion, ease=easy)
            found.append(result.chances)
        return found

    def fit(self, tables: Sequence[int], *, steps: int = 14) -> Vector:
        """Return the weights learnt from some tables, as a point for `Weights.at`, (n_weights,)."""
        learnt = self._descended(tables, np.zeros(len(NAMES)), _Goal(tuple(range(len(NAMES))), alone=False), steps)
        return self.surer(tables, learnt)

    def surer(self, tables: Sequence[int], theta: Vector) -> Vector:
        """Return weights with those of how sure to be learnt from the targets alone, (n_weights,)."""
        goal = _Goal(tuple(NAMES.index(name) for name in SURE), alone=True)
        return self._descended(tables, theta, goal, SURE_STEPS)

    def _descended(self, tables: Sequence[int], start: Vector, goal: _Goal, steps: int) -> Vector:
        optimize = load("scipy.optimize", "study")
        by_table = [[each for each in self.examples if each.table == table] for table in tables]
        free = list(goal.free)

        def loss(moved: Vector) -> tuple[float, Vector]:
            theta = start.copy()
            theta[free] = moved
            values = sum((self._loss(each, theta, goal) for each in by_table), start=np.zeros(len(free) + 1))
            total = values[0] + PRIOR * float((moved**2).sum()) / 2.0
            return float(total), (values[1:] - values[0]) / STEP + PRIOR * moved

        options = {"maxiter": steps, "maxfun": steps + 6}
        found = optimize.minimize(loss, start[free], jac=True, method="L-BFGS-B", options=options)
        theta = start.copy()
        theta[free] = found.x
        return theta

    def _loss(self, examples: Sequence[Example], theta: Vector, goal: _Goal) -> Vector:
        """Return the loss at a point and at a step from it along each free weight, (1 + n_free,)."""
        steps = STEP * np.eye(len(theta))[:, list(goal.free)]
        variants = np.concatenate([theta[:, None], theta[:, None] + steps], axis=1)
        total = np.zeros(variants.shape[1])
        for each, chances in zip(examples, self.chances(examples, Weights.at(variants)), strict=True):
            meant = each.targets if goal.alone else each.meant
            total = total - np.log(np.maximum(chances, LEAST)) @ meant
        return total

    def read(self, theta: Vector, tables: Sequence[int]) -> dict[int, Vector]:
        """Return the chances of the items, (n_items,), for each request about some tables, by its index."""
        examples = [each for each in self.examples if each.table in tables]
        found = self.chances(examples, Weights.at(theta))
        return {
            index: chances.reshape(-1) for each, chances in zip(examples, found, strict=True) for index in each.requests
        }


def _examples(corpus: Corpus, tables: dict[int, Table], language: Grammar) -> list[Example]:
    alike: dict[object, list[int]] = {}
    parsed: dict[object, Parsed] = {}
    for index, each in enumerate(corpus.requests):
        found = parse(words_of(each.text), tables[each.table].vocabulary, language)
        key = (each.table, found.found, found.confusion)
        parsed.setdefault(key, found)
        alike.setdefault(key, []).append(index)
    examples = []
    for kind, indices in alike.items():
        meant, targets = np.zeros((2, tables[corpus.requests[indices[0]].table].size))
        for index in indices:
            each = corpus.requests[index]
            share = MEANT if each.clicked.any() else 1.0
            targets[each.target] += 1.0
            meant[each.target] += share
            meant += (1.0 - share) * each.clicked
        examples.append(Example(corpus.requests[indices[0]].table, parsed[kind], meant, targets, tuple(indices)))
    return examples


def weights_text(theta: Vector, corpus: Corpus, source: str) -> str:
    """Return the text of a weights file. theta: a point of `Weights.at`, (n_weights,). source: of the requests."""
    values = Weights.at(theta).values
    tables = len({each.table for each in corpus.requests})
    lines = [
        f"# Learnt from {len(corpus.requests)} requests about {tables} tables: {_plain(source)}",
        f"# The target counts for {MEANT}, the prior's precision is {PRIOR}. What each one means: weights.py.",
        "",
        "[weights]",
        *(f"{name} = {getattr(values, name):.4g}" for name in WEIGHTS),
    ]
    return "\n".join(lines) + "\n"


def write_weights(path: Path, theta: Vector, corpus: Corpus, source: str) -> None:
    """Write a weights file, which `weights.weights_of` reads."""
    path.write_text(weights_text(theta, corpus, source), encoding="utf-8")


def _plain(text: str) -> str:
    return " ".join(text.split())

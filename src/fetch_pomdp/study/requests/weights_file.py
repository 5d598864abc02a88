"""Writes learnt weights as a small file that says where they come from."""

from __future__ import annotations

from pathlib import Path

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.weights import WEIGHTS, Weights
from fetch_pomdp.study.requests.corpus import Corpus
from fetch_pomdp.study.requests.fit import MEANT, PRIOR


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

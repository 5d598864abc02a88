"""Whether anything that may be said, or typed, makes the reader fail or hang.

    python benchmarks/hostile.py                     # 100,000 strings, some minutes
    python benchmarks/hostile.py --count 1000 --seed 7

Strings of seven kinds, in English and German, in talks about tables of 1 to 40 items with questions between: letters of
all Unicode; words of the grammar in any order; sentences with letters changed; one phrase again and again; very long
words; nested landmarks and negations; control characters, markup and numbers. Of each it is checked that the chances of
the items are finite and sum to 1. Printed: how many of each kind, those that failed, and the slowest.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.reading.grammar import LANGUAGES, grammar
from fetch_pomdp.core.language.reading.reader import TableReader
from fetch_pomdp.core.scene import Item, Scene

TURNS = 20  # of a talk, before another table
COLOURS = ("red", "green", "blue", "white", "rot", "grün")
NOUNS = ("mug", "bowl", "plate", "becher", "schüssel", "remote")
SENTENCES = (
    "the red mug second from the left, closest to me", "no wait, the bowl between the two plates",
    "not the green one, the other one", "there are three bowls on your right. take the middle one",
    "der rote Becher links neben der Schüssel, von mir aus", "nein, nicht der, der andere",
)  # fmt: skip
LANDMARKS = ("next to", "left of", "between", "behind", "the middle of", "not", "closest to", "links von", "nicht")
ODDITIES = (
    "\x00", "\x1b[2J", "\u202e", "\ud800", "<script>", "{}", "%s", "'; drop table", "\n\n", "1e999", "-1", "²", "½",
    "🙂", "ﬁ", "ı", "ß", "İ", ".", "...", "?!", "’", "--", "#", "_", "NaN", "ŉ",
)  # fmt: skip
Kind = Callable[[Generator], str]
Member = TypeVar("Member")


@dataclass
class Outcome:
    """What became of the strings so far."""

    counts: Counter[str]
    failed: list[tuple[str, str, str]]  # kind, string and error
    slowest: tuple[float, str, str]  # s, kind and string


def _one(rng: Generator, among: Sequence[Member]) -> Member:
    return among[int(rng.integers(len(among)))]


def _letters(rng: Generator) -> str:
    return "".join(
        chr(_one(rng, (int(rng.integers(32, 127)), int(rng.integers(0x11_0000))))) for _ in range(int(rng.integers(80)))
    )


def _known_words(rng: Generator) -> str:
    words = WORDS[_one(rng, LANGUAGES)]
    return " ".join(_one(rng, (_one(rng, words), _one(rng, COLOURS + NOUNS))) for _ in range(int(rng.integers(40))))


def _changed(rng: Generator) -> str:
    text = list(_one(rng, SENTENCES))
    for _ in range(int(rng.integers(12))):
        place = int(rng.integers(len(text) + 1))
        text[place : place + int(rng.integers(2))] = _one(rng, ("", " ", ".", chr(int(rng.integers(97, 123)))))
    return "".join(text)


def _again(rng: Generator) -> str:
    return f"{_one(rng, (_one(rng, LANDMARKS), _known_words(rng)[:30], _one(rng, ODDITIES)))} " * int(rng.integers(300))


def _long(rng: Generator) -> str:
    return _one(rng, "ae'-’ß9") * int(rng.integers(20_000)) + _one(rng, SENTENCES)


def _nested(rng: Generator) -> str:
    parts = (
        f"{_one(rng, LANDMARKS)} the {_one(rng, COLOURS)} {_one(rng, NOUNS)}" for _ in range(int(rng.integers(25)))
    )
    return "the one " + " ".join(parts)


def _odd(rng: Generator) -> str:
    return " ".join(_one(rng, (_one(rng, ODDITIES), _one(rng, SENTENCES)[:20])) for _ in range(int(rng.integers(15))))


WORDS = {name: sorted({word for phrase in grammar(name).lexicon for word in phrase}) for name in LANGUAGES}
KINDS: dict[str, Kind] = {
    "letters": _letters, "known words": _known_words, "changed": _changed, "again": _again, "long": _long,
    "nested": _nested, "odd": _odd,
}  # fmt: skip


def table(rng: Generator) -> Scene:
    """Return a table of 1 to 40 items, some of which stand in the same place or have the same words."""
    items = []
    for index in range(_one(rng, (1, 2, 3, 8, 15, 40))):
        words = (_one(rng, COLOURS), _one(rng, NOUNS)) if rng.random() < 0.9 else (_one(rng, NOUNS),)
        place = (_one(rng, (0.0, 0.1, rng.uniform(-1, 1))), _one(rng, (0.5, 0.9, rng.uniform(0.3, 2))), 0.75)
        items.append(Item(id=f"{words[-1]}-{index}", position=place, vocabulary=words))
    return Scene(items=tuple(items), head=(0.0, 0.0, 1.6))


def strike(count: int, seed: int) -> Outcome:
    """Say `count` strings, and return what became of them."""
    rng = np.random.default_rng(seed)
    readers = [TableReader(language) for language in LANGUAGES]
    found = Outcome(Counter(), [], (0.0, "", ""))
    for index in range(count):
        if index % TURNS == 0:
            agent = Agent(table(rng), reader=_one(rng, readers))
        if rng.random() < 0.3:
            agent.did(Point(int(rng.integers(agent.problem.n_items))))
        kind = _one(rng, list(KINDS))
        text = KINDS[kind](rng)
        begun = time.process_time()
        try:
            agent.observe(text)
            _check(agent)
        except Exception as error:
            found.failed.append((kind, text, f"{type(error).__name__}: {error}"))
        found.slowest = max(found.slowest, (time.process_time() - begun, kind, text))
        found.counts[kind] += 1
    return found


def _check(agent: Agent) -> None:
    heard = agent.understood.heard
    if heard is not None and not np.isfinite(heard.log_likelihood).all():
        raise ValueError("found a likelihood that is not finite")
    if heard is not None and (
        abs(float(np.exp(heard.log_likelihood).sum()) - 1.0) > 1e-9 or not 0.0 <= heard.lost <= 1.0
    ):
        raise ValueError("found chances that do not sum to 1")
    if not np.isfinite(agent.belief).all() or abs(float(agent.belief.sum()) - 1.0) > 1e-9:
        raise ValueError("found a belief that is none")


def main() -> None:
    """Read the command line, strike and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    found = strike(given.count, given.seed)
    print(f"{sum(found.counts.values()):,} strings ({', '.join(f'{n:,} {kind}' for kind, n in found.counts.items())})")
    print(f"failed: {len(found.failed)}")
    for kind, text, error in found.failed[:10]:
        print(f"  {kind}: {text[:200]!r}: {error}")
    seconds, kind, text = found.slowest
    print(f"slowest: {1e3 * seconds:.0f} ms, {kind}, {text[:200]!r}")


if __name__ == "__main__":
    main()

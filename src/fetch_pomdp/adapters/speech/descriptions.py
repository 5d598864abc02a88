"""How people describe items aloud, as a language model: the reader's grammar with chances, counted exactly.

A description is what the symbol NP of the grammar (`core/language/reading/english.toml`) makes. With a probability for
every rule the grammar is a probabilistic one, and how often a word follows another in a description is a sum over the
rules: uses of the rule, times last words of its left part, times first words of its right part. Each of the three
solves linear equations (as prefixes do: Jelinek and Lafferty, Computational Linguistics 17, 1991).

Choice: the grammar knows what can be said, not how often, and every word more is a chance to mishear another. So the
rules and phrases that people use in speech are named below, with shares of our own; all are rules and phrases of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Phrase = tuple[str, ...]

DESCRIPTION, WORD, ARTICLE = "NP", "w", "the"
# How often a rule is used among those of its parent.
SHARES: Mapping[str, Mapping[str, float]] = {
    "NP": {"N": 1.0, "NP M": 0.7, "other": 0.1, "other N": 0.1},
    "N": {"w": 1.0, "w N": 0.8, "n": 0.5, "P N": 0.3, "P": 0.05},
    "P": {"S": 1.0, "ord": 0.4, "MID": 0.2, "near": 0.05},
    "M": {"R NP": 1.0, "in S": 0.5, "ord": 0.2, "from S": 0.2, "MID": 0.2, "near to person": 0.15, "near to NP": 0.1,
          "far from NP": 0.1, "between NP and NP": 0.15, "NEG": 0.1, "R person": 0.1},
    "NEG": {"not NP": 1.0},
    "R": {"rel": 1.0, "to R": 0.6, "S of": 0.6, "in R": 0.1, "dir R": 0.1},
    "S": {"side": 1.0, "poss S": 0.2, "S sidenoun": 0.1, "utmost": 0.1, "xt S": 0.1, "S of table": 0.03},
    "MID": {"mid": 1.0, "in MID": 1.0, "MID of table": 0.02},
}  # fmt: skip
# The phrases of a category that are said, each as often as the others. WORD stands for the words of the table's items.
SAID: Mapping[str, str] = {
    "n": "one", "side": "left, right, front, back", "utmost": "leftmost, rightmost", "xt": "far", "dir": "right",
    "mid": "middle, center", "ord": "first, second, third, fourth, last", "near": "closest, nearest",
    "far": "furthest, farthest", "person": "me, you", "poss": "my, your", "sidenoun": "side", "table": "table",
    "rel": "next to, beside, near, behind, in front of", "between": "between", "other": "other", "in": "in, on",
    "from": "from", "to": "to", "of": "of", "and": "and", "not": "not",
}  # fmt: skip
# Where an article is said: before a description, and between these.
AFTER = frozenset({"in", "to", "from", "of"})
DEFINITE = frozenset({"S", "MID", "R", "table"})
ARTICLES = 0.9  # how often it is said there


@dataclass(frozen=True, slots=True, eq=False)
class Followers:
    """What stands first and last in a description and what follows what, each an expected number of times in one.

    words: those of all descriptions; first, last: (words,); follows: (words, words), how often the second comes after
    the first.
    """

    words: tuple[str, ...]
    first: Floats
    last: Floats
    follows: Floats


@dataclass(frozen=True, slots=True)
class _Rule:
    """A rule of one part or two; its chance among its parent's. article: the chance of one in front of the last."""

    parent: str
    parts: Phrase
    chance: float
    article: float = 0.0


def followers(vocabulary: Sequence[str]) -> Followers:
    """Return how the words of descriptions of items follow each other. vocabulary: the items' words."""
    said = {category: [tuple(phrase.split()) for phrase in phrases.split(", ")] for category, phrases in SAID.items()}
    said[WORD] = [(word,) for word in vocabulary]
    words = dict.fromkeys(word for phrases in said.values() for phrase in phrases for word in phrase)
    return _Counts(list(_rules()), said, tuple(dict.fromkeys([ARTICLE, *words]))).followers()


def _rules() -> Iterator[_Rule]:
    """Yield the rules that are said, in pairs: the left part of one of three parts is the first two of them."""
    begun: set[str] = set()
    for parent, shares in SHARES.items():
        for text, share in shares.items():
            parts = text.split()
            yield _pair(parent, parts, share / sum(shares.values()))
            for count in range(2, len(parts)):
                if (left := "+".join(parts[:count])) not in begun:
                    begun.add(left)
                    yield _pair(left, parts[:count], 1.0)


def _pair(parent: str, parts: Sequence[str], chance: float) -> _Rule:
    if len(parts) == 1:
        return _Rule(parent, tuple(parts), chance, ARTICLES if parent == DESCRIPTION else 0.0)
    article = ARTICLES if parts[-2] in AFTER and parts[-1] in DEFINITE else 0.0
    return _Rule(parent, ("+".join(parts[:-1]), parts[-1]), chance, article)


class _Counts:
    """Words that begin and end what a symbol makes, and how often a rule is used in a description."""

    def __init__(self, rules: Sequence[_Rule], said: Mapping[str, Sequence[Phrase]], words: Phrase) -> None:
        self._rules, self._said, self._words = rules, said, words
        symbols = dict.fromkeys([DESCRIPTION, *(name for rule in rules for name in (rule.parent, *rule.parts))])
        self._place = {name: index for index, name in enumerate(symbols)}
        self._word = {name: index for index, name in enumerate(words)}

    def followers(self) -> Followers:
        """Solve for what begins, ends and is used, and count what follows what."""
        begin, end, one = self._ends(0), self._ends(-1), np.eye(len(self._place))
        uses = np.linalg.solve(one - self._parts().T, one[self._place[DESCRIPTION]])
        follows, the = np.zeros((len(self._words), len(self._words))), self._word[ARTICLE]
        for rule in self._rules:
            count, right = uses[self._place[rule.parent]] * rule.chance, begin[self._place[rule.parts[-1]]]
            follows[the] += count * rule.article * right
            if len(rule.parts) > 1:
                left = end[self._place[rule.parts[0]]]
                follows[:, the] += count * rule.article * left
                follows += count * (1 - rule.article) * np.outer(left, right)
        for category, phrases in self._said.items():
            for word, after in (pair for phrase in phrases for pair in pairwise(phrase)):
                follows[self._word[word], self._word[after]] += uses[self._place[category]] / len(phrases)
        whole = self._place[DESCRIPTION]
        return Followers(self._words, begin[whole], end[whole], follows)

    def _parts(self) -> Floats:
        """Return the expected number of each symbol among the parts of each other one, (symbols, symbols)."""
        found = np.zeros((len(self._place), len(self._place)))
        for rule in self._rules:
            for part in rule.parts:
                found[self._place[rule.parent], self._place[part]] += rule.chance
        return found

    def _ends(self, side: int) -> Floats:
        """Return the chance of each word at one end of what a symbol makes, (symbols, words). side: 0 or -1."""
        links, found = np.zeros((len(self._place), len(self._place))), np.zeros((len(self._place), len(self._words)))
        for category, phrases in self._said.items():
            for phrase in phrases:
                found[self._place[category], self._word[phrase[side]]] += 1 / len(phrases)
        for rule in self._rules:
            article = rule.article if side == 0 and len(rule.parts) == 1 else 0.0
            found[self._place[rule.parent], self._word[ARTICLE]] += rule.chance * article
            links[self._place[rule.parent], self._place[rule.parts[side]]] += rule.chance * (1 - article)
        return np.asarray(np.linalg.solve(np.eye(len(links)) - links, found))

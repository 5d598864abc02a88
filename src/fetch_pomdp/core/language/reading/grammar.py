"""A language: its words and rules, read from a grammar file (english.toml, german.toml).

Nothing here knows a language. A rule is a line `PARENT = part part part : action @ cost`; categories of words are lower
case. Rules of more than two parts are cut into pairs, so that the chart joins two neighbours at a time.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fetch_pomdp.core.language.reading.actions import ACTIONS
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError

LANGUAGES = ("english", "german")
LONGEST = 7  # words of a phrase in a lexicon
BREAKS = ("verb", "look", "more", "skip", "correct")  # categories that begin a clause


@dataclass(frozen=True, slots=True)
class Rule:
    """A way to build `parent`. action: None for the first part of a rule that goes on."""

    parent: str
    action: Callable[..., Any] | None
    cost: float = 0.0
    name: str = ""


@dataclass(frozen=True, slots=True)
class Leaf:
    """What a phrase of the lexicon may be."""

    category: str
    value: str


@dataclass(frozen=True, slots=True, eq=False)
class Grammar:
    """Words and rules of a language, ready for the chart."""

    language: str
    noise: frozenset[str]
    determiners: frozenset[str]  # those of the noise that begin a description
    endings: tuple[tuple[str, str], ...]  # of inflected words, and what stands in their place in a dictionary
    lexicon: Mapping[tuple[str, ...], tuple[Leaf, ...]]
    said_as: Mapping[Leaf, tuple[tuple[str, ...], ...]]  # of each leaf, the plainest first
    synonyms: Mapping[str, tuple[str, ...]]  # of a word, those that a table may have in its place
    colours: Mapping[str, tuple[float, ...]]
    unary: Mapping[str, tuple[Rule, ...]]
    binary: Mapping[str, Mapping[str, tuple[Rule, ...]]]
    known: frozenset[str] = field(init=False)  # every word of phrases, and the noise
    spellings: tuple[str, ...] = field(init=False)  # the words that others may be misspellings of
    longest: Mapping[str, int] = field(init=False)  # by its first word, of how many the longest phrase is
    openers: frozenset[str] = field(init=False)  # the first words of phrases that stand for a word of a table

    def __post_init__(self) -> None:
        known = self.noise | {word for phrase in self.lexicon for word in phrase}
        known |= {word for name in self.synonyms if " " in name for word in name.split()}
        longest: dict[str, int] = {}
        for phrase in self.lexicon:
            longest[phrase[0]] = max(longest.get(phrase[0], 0), len(phrase))
        for name, value in (
            ("known", known),
            ("spellings", tuple(sorted(known - self.noise))),
            ("longest", longest),
            ("openers", frozenset(name.split()[0] for name in self.synonyms if " " in name)),
        ):
            object.__setattr__(self, name, value)

    def phrases(self, words: Sequence[str], place: int) -> Iterator[tuple[int, tuple[Leaf, ...]]]:
        """Yield the length and the leaves of each phrase of the lexicon that begins there, the longest first."""
        for size in range(min(self.longest.get(words[place], 0), len(words) - place), 0, -1):
            leaves = self.lexicon.get(tuple(words[place : place + size]))
            if leaves:
                yield size, leaves


@functools.cache
def grammar(language: str) -> Grammar:
    """Return a language's grammar. Raises InputError for a file that is none."""
    data = read_toml(Path(__file__).with_name(f"{language}.toml"), InputError).data
    lexicon: dict[tuple[str, ...], list[Leaf]] = {}
    phrases_of: dict[Leaf, list[tuple[str, ...]]] = {}
    for category, values in data["lexicon"].items():
        for value, phrases in values.items():
            for phrase in phrases.split(","):
                words = tuple(phrase.split())
                if words:
                    lexicon.setdefault(words, []).append(Leaf(category, value))
                    phrases_of.setdefault(Leaf(category, value), []).append(words)
    unary, binary = _rules(data["rules"]["text"])
    return Grammar(
        data["language"],
        frozenset(data["noise"].split()),
        frozenset(data["determiners"].split()),
        tuple((ending, instead) for ending, _, instead in (each.partition("=") for each in data["endings"].split())),
        {words: tuple(dict.fromkeys(leaves)) for words, leaves in lexicon.items()},
        {leaf: tuple(dict.fromkeys(words)) for leaf, words in phrases_of.items()},
        _synonyms(data),
        {name: tuple(rgb) for name, rgb in data.get("colours", {}).items()},
        unary,
        binary,
    )


def _synonyms(data: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for line in filter(None, map(str.strip, data["words"]["alike"].splitlines())):
        alike = [" ".join(each.split()) for each in line.split(",")]
        for each in alike:
            found.setdefault(each, []).extend(other for other in alike if other != each)
    for kind, members in data["kinds"].items():
        found.setdefault(kind, []).extend(each.strip() for each in members.split(","))
    return {word: tuple(dict.fromkeys(names)) for word, names in found.items()}


def _rules(text: str) -> tuple[dict[str, tuple[Rule, ...]], dict[str, dict[str, tuple[Rule, ...]]]]:
    unary: dict[str, list[Rule]] = {}
    binary: dict[str, dict[str, list[Rule]]] = {}
    for line in filter(None, map(str.strip, text.splitlines())):
        head, _, rest = line.partition("=")
        parts_text, _, action_text = rest.partition(":")
        action, _, cost = action_text.partition("@")
        parts = parts_text.split()
        rule = Rule(head.strip(), ACTIONS[action.strip()], float(cost or 0.0), line)
        if len(parts) == 1:
            unary.setdefault(parts[0], []).append(rule)
            continue
        left = parts[0]
        for index, right in enumerate(parts[1:-1], start=2):
            joined = "+".join(parts[:index])
            rules = binary.setdefault(left, {}).setdefault(right, [])
            if all(each.parent != joined for each in rules):
                rules.append(Rule(joined, None))
            left = joined
        binary.setdefault(left, {}).setdefault(parts[-1], []).append(rule)
    return (
        {part: tuple(rules) for part, rules in unary.items()},
        {left: {right: tuple(rules) for right, rules in rest.items()} for left, rest in binary.items()},
    )

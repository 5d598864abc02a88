"""Phrases of answers: how they are spelt, when they count, and those that a scene adds to ours.

Phrases are compared as they sound: case, apostrophes and punctuation do not count, ä is ae and ß is ss, a letter three
times or more is one ("yesss"), a hyphen may be a space or nothing, and "that's" may be "that is".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from enum import Enum
from itertools import product
from typing import Any, Self

from fetch_pomdp import checks
from fetch_pomdp.core.language.words import Meaning, tokenize
from fetch_pomdp.errors import SceneError

Spelling = tuple[str, ...]

LONGEST = 8  # words of a phrase that a scene adds
_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "'": None, "’": None})
_STRETCHED = re.compile(r"(.)\1{2,}")
_SHORT = {
    "'s": " is", "'re": " are", "'m": " am", "'ll": " will", "don't": "do not", "doesn't": "does not",
    "didn't": "did not", "isn't": "is not", "wasn't": "was not", "can't": "can not", "won't": "will not",
    "haven't": "have not", "aren't": "are not",
}  # fmt: skip


class When(Enum):
    """When a phrase counts as an answer."""

    ALWAYS = 0
    ASKED = 1  # while a question is open, and not as part of a description ("the correct one")
    ALONE = 2  # while a question is open, and nothing but answers is said


@dataclass(frozen=True, slots=True)
class Entry:
    """What a phrase means, None for one that only looks like an answer ("no problem"), and when."""

    meaning: Meaning | None
    when: When = When.ALWAYS


Phrases = Mapping[Spelling, Entry]


@dataclass(frozen=True, slots=True, kw_only=True)
class Answers:
    """Phrases that a scene adds to those that are understood anyway, by meaning: the table [answers] of a scene file.

    Raises SceneError for what is no phrase, and for one with two meanings.
    """

    yes: tuple[str, ...] = ()
    no: tuple[str, ...] = ()
    unsure: tuple[str, ...] = ()
    repeat: tuple[str, ...] = ()
    cancel: tuple[str, ...] = ()
    object: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        seen: dict[Spelling, str] = {}
        for name in (field.name for field in fields(self)):
            given = getattr(self, name)
            if isinstance(given, str) or not isinstance(given, list | tuple):
                raise SceneError(f"found {checks.shown(given)}, expected a list of phrases", field=name)
            object.__setattr__(self, name, tuple(given))
            for index, phrase in enumerate(given):
                _check(phrase, name, f"{name}[{index}]", seen)

    @classmethod
    def from_mapping(cls, data: Mapping[str, Any]) -> Self:
        """Build them from the fields of a scene file's [answers]. Raises SceneError, naming the field."""
        checks.known(data, tuple(field.name for field in fields(cls)), "meaning", SceneError)
        return cls(**data)

    def to_mapping(self) -> dict[str, list[str]]:
        """Return them in the form of a scene file; meanings to which nothing is added are left out."""
        named = {field.name: list(getattr(self, field.name)) for field in fields(self)}
        return {name: phrases for name, phrases in named.items() if phrases}

    def phrases(self) -> Phrases:
        """Return every spelling of them: a yes or no counts while a question is open, the others always.

        Choice: so a phrase that a scene adds does no harm in a request, and one that stops or ends something is heard
        at any time.
        """
        found: dict[Spelling, Entry] = {}
        for meaning in Meaning:
            when = When.ASKED if meaning in {Meaning.YES, Meaning.NO} else When.ALWAYS
            for phrase in getattr(self, meaning.value):
                found |= dict.fromkeys(spellings(phrase), Entry(meaning, when))
        return found


def _check(value: object, meaning: str, path: str, seen: dict[Spelling, str]) -> None:
    phrase = checks.text(value, path, "a phrase", SceneError)
    if not 1 <= len(tokenize(phrase)) <= LONGEST:
        raise SceneError(f"found {checks.shown(phrase)}, expected a phrase of 1 to {LONGEST} words", field=path)
    for spelling in spellings(phrase):
        if seen.setdefault(spelling, meaning) != meaning:
            found = f"found {checks.shown(phrase)}, which {seen[spelling]} has, expected a phrase with one meaning"
            raise SceneError(found, field=path)


def plain(word: str) -> str:
    """Return a word as it is compared."""
    return _STRETCHED.sub(r"\1", word.translate(_LETTERS))


def spellings(phrase: str) -> Iterator[Spelling]:
    """Yield the words of a phrase as they are compared, in every way that people and recognisers write it."""
    options = [list(_written(word)) for word in tokenize(phrase)]
    for chosen in product(*options):
        yield tuple(plain(word) for part in chosen for word in part.split())


def _written(word: str) -> Iterator[str]:
    yield word
    straight = word.replace("’", "'")
    for short, long in _SHORT.items():
        if straight.endswith(short) and (short[0] == "'" or straight == short):
            yield straight.removesuffix(short) + long
            break
    if "-" in word:
        yield word.replace("-", " ")
        yield word.replace("-", "")

"""Items by name: who sees the labels "spoon-1" and "spoon-2" says "spoon 1", "spoon number two" or "spoon-2".

Choice: before live people each of several items of a kind has one word more, its name. Who says kind and number has
said two words, the kind and the name; a number that follows anything else is no name. The paper's scenes have none.
"""

from __future__ import annotations

import dataclasses
import re
from collections import Counter
from collections.abc import Collection, Sequence

from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.scene import Item, Scene

_LABEL = re.compile(r"(.*?)[-_ ]?([0-9]{1,3})")
_NAME = re.compile(r"(.+)-([0-9]{1,3})")
_SPELT = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10}
_GERMAN = {"eins": 1, "zwei": 2, "drei": 3, "vier": 4, "fünf": 5, "sechs": 6, "sieben": 7, "acht": 8, "neun": 9}
_NUMBERS = _SPELT | _GERMAN
_SPOKEN = {number: word for word, number in _SPELT.items()}
_BETWEEN = frozenset({"number", "nummer"})
_COUNTED = frozenset({"more", "of", "moment", "second", "minute"})  # after a number that is none of an item
LONGEST = 3  # words of a kind


def named(scene: Scene) -> Scene:
    """Return a scene whose items have their names, if there are several of their kind, among their words."""
    names = [_name(item) for item in scene.items]
    kinds = Counter(_kind(name) for name in names if name)
    items = tuple(
        dataclasses.replace(item, vocabulary=(*item.vocabulary, name)) if name and kinds[_kind(name)] > 1 else item
        for item, name in zip(scene.items, names, strict=True)
    )
    return dataclasses.replace(scene, items=items)


def words_besides_name(item: Item) -> tuple[str, ...]:
    """Return the words of an item without its name."""
    return tuple(word for word in item.vocabulary if word != _name(item)) or item.vocabulary


def is_name(word: str) -> bool:
    """Return whether a word has the form of a name."""
    return _NAME.fullmatch(word) is not None


def as_spoken(words: Sequence[str]) -> list[str]:
    """Return words as they sound, for a recogniser: "spoon-two"; names without a short number are left out."""
    plain = [word for word in words if not is_name(word)]
    names = [(name[1], int(name[2])) for word in words if (name := _NAME.fullmatch(word))]
    return plain + [f"{kind}-{_SPOKEN[number]}" for kind, number in names if number in _SPOKEN]


def with_names(words: Sequence[str], known: Collection[str]) -> tuple[str, ...]:
    """Return the words that were heard with the names among them. known: all words of the scene's items."""
    names = frozenset(word for word in known if is_name(word))
    if not names:
        return tuple(words)
    result: list[str] = []
    place = 0
    while place < len(words):
        size, name = _name_at(words, place, names)
        if name is None:
            result.append(words[place])
        else:
            kind = _kind(name).split("-")
            result += [name] if result[-len(kind) :] == kind else [*kind, name]
        place += size
    return tuple(result)


def _name_at(words: Sequence[str], place: int, names: frozenset[str]) -> tuple[int, str | None]:
    """Return how many words there are a name, and which; or 1 and None."""
    kind, _, number = words[place].rpartition("-")
    found = _LABEL.fullmatch(words[place])
    name = f"{found[1]}-{int(found[2])}" if found else f"{kind}-{_NUMBERS.get(number)}"
    if name in names:
        return 1, name
    for size in range(1, LONGEST + 1):
        rest = [word for word in words[place + size : place + size + 2] if word not in _BETWEEN]
        if not rest or (number_after := _number(rest[0])) is None:
            continue
        end = words.index(rest[0], place + size) + 1
        name = f"{'-'.join(words[place : place + size])}-{number_after}"
        if name in names and not (end < len(words) and words[end] in _COUNTED):
            return end - place, name
    return 1, None


def _number(word: str) -> int | None:
    return int(word) if word.isascii() and word.isdecimal() and len(word) <= 3 else _NUMBERS.get(word)


def _name(item: Item) -> str | None:
    """Return what an item is called by its label, None if that has no number."""
    found = _LABEL.fullmatch(item.id.lower())
    kind = "-".join(tokenize(found[1])) if found else ""
    return f"{kind}-{int(found[2])}" if found and kind else None


def _kind(name: str) -> str:
    return name.rpartition("-")[0]

"""How words sound that the recogniser's dictionary lacks: as the two words they are made of, or as they are spelt."""

from __future__ import annotations

from collections.abc import Callable

Lookup = Callable[[str], str | None]  # a word's phones, separated by spaces, or None

SHORTEST = 3  # letters of a part of a compound: with two, "spork" would be "spo" and "rk"
SPELLINGS = {
    "tion": "SH AH N", "igh": "AY", "tch": "CH", "ee": "IY", "ea": "IY", "oo": "UW", "ou": "AW", "ow": "OW", "oi": "OY",
    "oy": "OY", "ai": "EY", "ay": "EY", "au": "AO", "aw": "AO", "ar": "AA R", "er": "ER", "ir": "ER", "or": "AO R",
    "ur": "ER", "ch": "CH", "sh": "SH", "th": "TH", "ph": "F", "ck": "K", "qu": "K W", "ng": "NG", "wh": "W", "ce": "S",
    "ci": "S IH", "cy": "S IY", "kn": "N", "wr": "R", "a": "AE", "b": "B", "c": "K", "d": "D", "e": "EH",
    "f": "F", "g": "G", "h": "HH", "i": "IH", "j": "JH", "k": "K", "l": "L", "m": "M", "n": "N", "o": "AA", "p": "P",
    "q": "K", "r": "R", "s": "S", "t": "T", "u": "AH", "v": "V", "w": "W", "x": "K S", "y": "IY", "z": "Z",
}  # fmt: skip


def pronounce(word: str, lookup: Lookup) -> str | None:
    """Return the phones of a lower-case word, or None for one that is not spelt with the letters a to z."""
    return lookup(word) or _compound(word, lookup) or _spelt(word)


def _compound(word: str, lookup: Lookup) -> str | None:
    """Return the phones of two words of the dictionary that make this one, with or without a hyphen between them."""
    for cut in range(len(word) - SHORTEST, SHORTEST - 1, -1):
        first, second = lookup(word[:cut].rstrip("-")), lookup(word[cut:].lstrip("-"))
        if first and second:
            return f"{first} {second}"
    return None


def _spelt(word: str) -> str | None:
    if not word.isascii() or not word.isalpha():
        return None
    phones, rest = [], _without_doubles(word)
    if len(rest) > 3 and rest.endswith("e"):  # silent
        rest = rest[:-1]
    while rest:
        letters = next(rest[:size] for size in (4, 3, 2, 1) if rest[:size] in SPELLINGS)
        phones.append(SPELLINGS[letters])
        rest = rest[len(letters) :]
    return " ".join(phones)


def _without_doubles(word: str) -> str:
    """Return "zuchini" for "zucchini"; a double e or o is a sound of its own."""
    kept = word[0]
    for letter in word[1:]:
        if letter != kept[-1] or letter in "eo":
            kept += letter
    return kept

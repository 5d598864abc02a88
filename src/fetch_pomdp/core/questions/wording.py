"""How questions about words are said."""

from __future__ import annotations

from collections.abc import Sequence

from fetch_pomdp.core.language.names import is_name
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.scene import Scene

VOWELS = "aeiou"
THIS_ONE, THESE_TWO = "this one?", "one of these two?"
WHAT_LIKE, WHAT_SAID = "what is it like?", "sorry, what did you say?"


def is_noun(word: str, scene: Scene) -> bool:
    """Return whether a word is what its items are called, and not how they are.

    Choice: the scene does not say so. A word that its item's id begins with is one, and so is the first of an item's
    words that is no colour; the words of a scene stand in the order of the paper's, "marker, green".
    """
    colours = grammar("english").colours
    for item in scene.items:
        if word in item.vocabulary:
            kind = next((each for each in item.vocabulary if each not in colours), None)
            return word == kind or (item.id.rpartition("-")[0] or item.id) == word
    return False


def asks_for(words: Sequence[str], scene: Scene) -> str:
    """Return a question for words that an item has: "a marker?", "a green one?", "a big green mug?"; colours last."""
    nouns, colours = [word for word in words if is_noun(word, scene)], grammar("english").colours
    said = [
        *sorted((word for word in words if word not in nouns), key=lambda word: word in colours),
        *(nouns or ["one"]),
    ]
    article = "an" if said[0][0] in VOWELS else "a"
    return f"{article} {' '.join(said)}?"


def askable(scene: Scene) -> list[tuple[str, tuple[int, ...]]]:
    """Return the words that tell items apart, each with the items that have it: of words of the same items, one.

    Nouns come before others, then the order of the items' words; names such as "spoon-2" are left out, for who knows
    them says them.
    """
    order = dict.fromkeys(word for item in scene.items for word in item.vocabulary if not is_name(word))
    found: dict[tuple[int, ...], str] = {}
    for word in sorted(order, key=lambda word: not is_noun(word, scene)):
        owners = tuple(index for index, item in enumerate(scene.items) if word in item.vocabulary)
        if len(owners) < len(scene.items):
            found.setdefault(owners, word)
    return [(word, owners) for owners, word in found.items()]

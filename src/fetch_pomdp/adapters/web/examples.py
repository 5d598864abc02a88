"""What somebody might say who does not know what the robot understands: made from the words of the table."""

from __future__ import annotations

import re

from fetch_pomdp.core.language.names import is_name, words_besides_name
from fetch_pomdp.core.scene import Item, Scene

COLOURS = frozenset(
    """black white grey gray red green blue yellow orange purple pink brown silver golden gold clear dark light
    transparent""".split()  # noqa: SIM905
)


def examples(scene: Scene) -> list[str]:
    """Return three requests, each for another kind of item where there are so many, and understood to the last word.

    One by the noun alone, one with a colour if any item has one, and one by name where items have names.
    """
    kinds = list({_noun(item): item for item in reversed(scene.items)}.values())[::-1]
    first = kinds[0]
    coloured = next((item for item in [*kinds[1:], first] if _colour(item)), kinds[1 % len(kinds)])
    others = [item for item in scene.items if _noun(item) not in {_noun(first), _noun(coloured)}] or [*scene.items]
    last = next((item for item in reversed(others) if _name(item)), others[-1])
    return [
        f"hand me the {_noun(first)}",
        f"the {' '.join(dict.fromkeys(filter(None, (_colour(coloured), _noun(coloured)))))}, please",
        f"could I have {(_name(last) or f'the {_noun(last)}').replace('-', ' ')}",
    ]


def _noun(item: Item) -> str:
    """Return the last word of its id that is one of its words and no colour, or the first of these."""
    words = words_besides_name(item)
    plain = [word for word in words if word not in COLOURS]
    of_id = [part for part in re.split(r"[\W_]+", item.id.lower()) if part in plain]
    return [*of_id[-1:], *plain, *words][0]


def _colour(item: Item) -> str | None:
    return next((word for word in item.vocabulary if word in COLOURS), None)


def _name(item: Item) -> str | None:
    return next((word for word in item.vocabulary if is_name(word)), None)

"""Words of a text, and the response words of Section III-C."""

from __future__ import annotations

import re

POSITIVE = ("yes", "yeah", "sure", "yup")
NEGATIVE = ("no", "nope", "other", "not")
RESPONSES = frozenset(POSITIVE + NEGATIVE)
STOPS = frozenset({"stop", "wrong", "wait", "halt"})  # these stop a hand-over too, and are no responses of the model
# Words of a request that say nothing about the item: no screen need call them not understood.
COURTESY = frozenset(
    """a an and can could get give hand have i it like me of one pass please thank that the this to want would
    you""".split()  # noqa: SIM905
)

_WORD = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*")


def tokenize(text: str) -> tuple[str, ...]:
    """Return the words of a text in lower case, without punctuation; "it's" and "T-shirt" are one word each."""
    return tuple(_WORD.findall(text.lower()))

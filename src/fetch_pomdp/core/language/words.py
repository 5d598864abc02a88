"""Words of a text, the response words of Section III-C, and what an answer means."""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import Enum

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


class Meaning(Enum):
    """What a person means by an answer. Only YES and NO are evidence about the item (Eq. 6)."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"  # does not know, or does not mind
    REPEAT = "repeat"  # did not catch the question
    CANCEL = "cancel"  # wants nothing any more
    OBJECT = "object"  # stops a hand-over


# The one word that stands for each meaning among the words of an observation.
STAND_INS: Mapping[Meaning, str] = {
    Meaning.YES: POSITIVE[0],
    Meaning.NO: NEGATIVE[0],
    Meaning.UNSURE: "unsure",
    Meaning.REPEAT: "pardon",
    Meaning.CANCEL: "cancel",
    Meaning.OBJECT: "stop",
}
MEANINGS: Mapping[str, Meaning] = {
    **dict.fromkeys(POSITIVE, Meaning.YES),
    **dict.fromkeys(NEGATIVE, Meaning.NO),
    **{word: meaning for meaning, word in STAND_INS.items()},
}


def tokenize(text: str) -> tuple[str, ...]:
    """Return the words of a text in lower case, without punctuation; "it's" and "T-shirt" are one word each."""
    return tuple(_WORD.findall(text.lower()))

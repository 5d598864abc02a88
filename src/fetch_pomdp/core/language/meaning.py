"""What an answer means, and the one word that stands for each meaning among the words of an observation."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE


class Meaning(Enum):
    """What a person means by an answer. Only YES and NO are evidence about the item (Eq. 6)."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"  # does not know, or does not mind
    REPEAT = "repeat"  # did not catch the question
    CANCEL = "cancel"  # wants nothing any more
    OBJECT = "object"  # stops a hand-over


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

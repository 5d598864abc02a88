"""What every recogniser of whole utterances has in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from fetch_pomdp.adapters.speech.utterances import Utterance
from fetch_pomdp.core.ports import Word


class Transcriber(Protocol):
    """Finds the words of an utterance, or of as much of one as there is."""

    def words(self, utterance: Utterance) -> Sequence[Word]:
        """Return the words in order, lower case, with their times (s) on the clock of the utterance, and posteriors.

        Raises AudioError if it breaks; it may be asked again.
        """
        ...

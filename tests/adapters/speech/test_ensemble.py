from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.adapters.speech.ensemble import Ensemble
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.ports import Word

SOUND = SpeechSegment(0.0, np.zeros(16_000, np.int16))


class Hears:
    """A Transcriber that hears what it is made with."""

    def __init__(self, *readings: tuple[str, float], posterior: float = 1.0) -> None:
        among = tuple(Alternative(tuple(text.split()), weight) for text, weight in readings)
        texts = among[0].words if among else ()
        shared = among if len(among) > 1 else ()
        self.heard = [Word(text, k, k + 1, posterior, shared) for k, text in enumerate(texts)]

    def words(self, utterance: SpeechSegment) -> list[Word]:
        return self.heard


def readings(*members: Hears) -> dict[str, float]:
    words = Ensemble(members).words(SOUND)
    found = words[0].readings
    assert found[0].words == tuple(word.text for word in words), "the first is the words as they are given"
    return {" ".join(each.words): each.weight for each in found}


def test_what_both_hear_is_likelier_than_what_either_does() -> None:
    first, second = Hears(("one", 0.6), ("no", 0.4)), Hears(("no", 0.7), ("now", 0.3))
    assert readings(first, second) == pytest.approx({"no": 0.55, "one": 0.3, "now": 0.15})


def test_one_without_probabilities_is_taken_at_its_word() -> None:
    assert readings(Hears(("one", 0.6), ("no", 0.4)), Hears(("no", 1.0))) == pytest.approx({"no": 0.7, "one": 0.3})


def test_one_that_doubts_its_word_may_have_heard_none() -> None:
    found = readings(Hears(("no", 1.0)), Hears(("spoon", 1.0), posterior=0.4))
    assert found == pytest.approx({"no": 0.5, "spoon": 0.2, "": 0.3})


def test_one_that_hears_nothing_halves_what_the_other_hears() -> None:
    assert readings(Hears(), Hears(("no", 1.0))) == pytest.approx({"no": 0.5, "": 0.5})


def test_where_nobody_hears_anything_there_are_no_words() -> None:
    assert Ensemble([Hears(), Hears()]).words(SOUND) == []


def test_where_all_agree_there_is_one_reading() -> None:
    words = Ensemble([Hears(("no", 1.0)), Hears(("no", 1.0))]).words(SOUND)
    assert [(word.text, word.readings) for word in words] == [("no", ())]

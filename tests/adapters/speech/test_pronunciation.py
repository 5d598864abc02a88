from __future__ import annotations

import pytest

from fetch_pomdp.adapters.speech.pronunciation import pronounce

KNOWN = {"white": "W AY T", "board": "B AO R D", "marker": "M AA R K ER", "dry": "D R AY", "erase": "IH R EY S"}


@pytest.mark.parametrize(
    ("word", "phones"),
    [
        ("marker", "M AA R K ER"),
        ("whiteboard", "W AY T B AO R D"),
        ("dry-erase", "D R AY IH R EY S"),
        ("spork", "S P AO R K"),
        ("fizzle", "F IH Z L"),
        ("größe", None),
        ("7up", None),
    ],
)
def test_words_sound_as_in_the_dictionary_or_as_their_parts_or_as_they_are_spelt(word: str, phones: str | None) -> None:
    assert pronounce(word, KNOWN.get) == phones

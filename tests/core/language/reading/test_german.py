"""German beside English: the same reader with another grammar file."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.language.reading.reader import Context, TableReader
from fetch_pomdp.core.language.reading.tokens import words_of
from tests.core.language.reading.tables import scene

READER = TableReader("german")
LINE = scene(
    ("rot becher", -0.3, 0.8), ("grün becher", -0.1, 0.8), ("rot becher", 0.1, 0.8), ("weiß schüssel", 0.3, 0.8)
)


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ("gib mir den grünen Becher", 1),
        ("der rote Becher neben der Schüssel", 2),
        ("der Becher zwischen den beiden roten", 1),
        ("von mir aus links der rote Becher", 0),
        ("der rote Becher auf meiner rechten Seite", 2),
        ("der rote Becher auf deiner linken Seite", 2),
        ("nein warte, die Schüssel", 3),
        ("die Schüsel", 3),
        ("nimm den mittleren der drei Becher", 1),
        ("der Becher, der am weitesten von mir weg ist", 0),
    ],
)
def test_german_is_read(text: str, item: int) -> None:
    assert READER.read(words_of(text), LINE, Context()).log_likelihood.argmax() == item


def test_german_meanings_have_the_same_forms() -> None:
    def meaning(text: str) -> str:
        return str(READER.read(words_of(text), LINE, Context()).readings[0].meaning)

    assert meaning("der zweite von links") == "number 2 closest to left"
    assert meaning("nicht der rote") == "not rot"
    assert READER.read(words_of("nein warte, der rote"), LINE, Context()).corrects

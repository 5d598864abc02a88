"""Words of a text."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.language.words import tokenize


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ()),
        (" ...?! ", ()),
        ("The GREEN marker, please.", ("the", "green", "marker", "please")),
        ("it's a T-shirt; no—yes", ("it's", "a", "t-shirt", "no", "yes")),
        ("'quoted' -dashed- under_score", ("quoted", "dashed", "under", "score")),
        ("Löffel 7", ("löffel", "7")),
    ],
)
def test_tokenize(text: str, words: tuple[str, ...]) -> None:
    assert tokenize(text) == words

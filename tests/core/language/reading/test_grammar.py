"""Grammar files, and meanings of sentences before any table."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.language.reading.grammar import LANGUAGES, grammar
from fetch_pomdp.core.language.reading.reader import parse
from fetch_pomdp.core.language.reading.tokens import Vocabulary, words_of

VOCABULARY = Vocabulary.of([("mug", "red"), ("mug", "green"), ("bowl", "white"), ("plate", "white")])


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_category_of_a_rule_has_words_or_rules(language: str) -> None:
    found = grammar(language)
    made = {rule.parent for rules in found.unary.values() for rule in rules}
    made |= {rule.parent for rest in found.binary.values() for rules in rest.values() for rule in rules}
    made |= {leaf.category for leaves in found.lexicon.values() for leaf in leaves} | {"w"}
    made |= {"det"} if found.determiners else set()
    used = set(found.unary) | set(found.binary) | {right for rest in found.binary.values() for right in rest}
    assert used <= made


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("the red mug", "red, mug"),
        ("give me the mug on your left, please", "mug, your left"),
        ("second from the left", "number 2 closest to left"),
        ("the third mug from my right", "mug, number 3 closest to (my right)"),
        ("the mug closest to me", "mug, closest to me"),
        ("the plate farthest from you", "plate, farthest from you"),
        ("the mug next to the white bowl", "mug, next to (white, bowl)"),
        ("the mug to the left of the bowl", "mug, left of bowl"),
        ("the mug between the bowl and the plate", "mug, between bowl and plate"),
        ("not the red one", "not red"),
        ("the mug that has a bowl behind it", "mug, in front of bowl"),
        ("the middle one of the three mugs", "in the middle, one of (mug, 3 together)"),
        (
            "there are two mugs on the left. take the one closer to you",
            "closest to you, one of (mug, 2 together, left)",
        ),
        ("find the white bowl. give me the mug right behind it", "mug, directly behind (white, bowl)"),
        ("the mug. it is the one by itself", "mug, by itself"),
    ],
)
def test_sentences_mean(text: str, meaning: str) -> None:
    assert str(parse(words_of(text), VOCABULARY, grammar("english")).found[0].meaning) == meaning

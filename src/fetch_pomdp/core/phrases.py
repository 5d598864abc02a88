"""Sentences as templates and what fills them, so that another language can fill its own; and the English templates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

# English. A page has these, key by key, with those of its other languages.
TEMPLATES: Mapping[str, str] = {
    "why_sentence": "{deed}: {reason}",
    "why_reason": "{known}; {stake}",
    "why_waits": "waits",
    "why_asks": "asks about {item}",
    "why_picks": "picks {item}",
    "why_it": "it",  # has the value `item`, for languages in which no pronoun fits every item
    "why_unanswered": "the question about {item} is still unanswered",
    "why_alone": "{item} is the only item",
    "why_even": "nothing tells the {count} items apart yet",
    "why_certain": "{item} is certain",
    "why_almost_certain": "{item} is all but certain",
    "why_torn": "speech favours {said} {words} to 1, pointing {shown} {pointing} to 1",
    "why_likely": "{item} is {chance} likely",
    "why_by_words": "{known}, mostly by what was said",
    "why_by_answers": "{known}, mostly by the answers",
    "why_by_pointing": "{known}, mostly by the pointing",
    "why_equal": "{item} and {other} are equally likely",
    "why_equal_many": "{item} and {count} others are equally likely",
    "why_near": "{item} and {other} are almost equally likely",
    "why_times": "{likelier} is {ratio} times as likely as {other}",
    "why_over": "over {number}",
    "why_worth_one": "{doing} is worth {value}",
    "why_worth_two": "{doing} is worth {value} and {second}",
    "why_worth_three": "{doing} is worth {value}, {second} and {third}",
    "why_other": "{doing} {value}",
    "why_waiting": "waiting",
    "why_asking": "asking",
    "why_picking": "picking",
    "why_prices": "{wrong}, {price}",
    "why_prices_less": "{wrong}, {price}, though {doing} is worth {difference} more",
    "why_prices_more": "{wrong}, {price}, and asking is worth {difference} more than {doing}",
    "why_wrong_costs": "a wrong pick costs {cost}",
    "why_wrong_earns": "a wrong pick earns {gain}",
    "why_question_costs": "the question {cost}",
    "why_wait_costs": "the wait {cost}",
    "why_nothing": "nothing",
    "why_close": "{stake}, a close call",
}


@dataclass(frozen=True, slots=True)
class Figure:
    """A number as English writes it ("12.50", "1,000", "91%"): its digits are chosen once, for every language."""

    english: str


Value: TypeAlias = "Phrase | Figure | str"  # str: an item's id, the same in every language


@dataclass(frozen=True, slots=True)
class Phrase:
    """A template's key, and by name what fills it. Prints in English."""

    key: str
    values: Mapping[str, Value]

    def __str__(self) -> str:
        return TEMPLATES[self.key].format_map(
            {name: value.english if isinstance(value, Figure) else str(value) for name, value in self.values.items()}
        )


def phrase(key: str, **values: Value) -> Phrase:
    """Return the phrase of a template's key. Raises KeyError for an unknown key."""
    if key not in TEMPLATES:
        raise KeyError(key)
    return Phrase(key, values)

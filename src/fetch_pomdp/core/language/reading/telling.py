"""What was understood, in a sentence: "I understood: red, left of bowl; your left or mine?"."""

from __future__ import annotations

from fetch_pomdp.core.language.reading.denotation import LATERAL, WIDE
from fetch_pomdp.core.language.reading.form import Form, Person, Relation, Side, inner
from fetch_pomdp.core.language.reading.reader import Heard

UNCERTAIN = 0.15  # chance of the unlikelier view, from which on the robot would ask whose it is
LOST = 0.5  # chance of not having understood, from which on it says so


def told(heard: Heard) -> str:
    """Return what a reader understood as the robot would say it."""
    note = f" ({heard.note})" if heard.note else ""
    if heard.lost > LOST or not (heard.readings or heard.note):
        return f"I did not understand{_unknown(heard)}{note}"
    if not heard.readings:
        return f"I understood{_unknown(heard)}{note}"
    doubt = "; your left or mine?" if whose_is_open(heard) else ""
    return f"I understood: {heard.readings[0].meaning}{doubt}{_unknown(heard)}{note}"


def whose_is_open(heard: Heard) -> bool:
    """Return whether the likeliest reading names a left or right of which it is open whose it is."""
    return bool(heard.readings) and unnamed_sides(heard.readings[0].meaning) and whose(heard) is None


def whose(heard: Heard) -> Person | None:
    """Return whose left and right were meant, of the speaker (ME) and the listener (YOU); None where that is open."""
    listener = sum(chance for chance, wide in zip(heard.views, WIDE, strict=True) if wide)
    if listener > 1.0 - UNCERTAIN:
        return Person.YOU
    return Person.ME if listener < UNCERTAIN else None


def unnamed_sides(form: Form) -> bool:
    """Return whether a meaning names a left or right without saying whose."""
    if isinstance(form, Side) and form.viewer is None and LATERAL.keys() & set(form.sides):
        return True
    if isinstance(form, Relation) and set(form.name.split()) & LATERAL.keys():
        return True
    return any(map(unnamed_sides, inner(form)))


def _unknown(heard: Heard) -> str:
    words = ", ".join(f'"{word}"' for word in dict.fromkeys(heard.unknown))
    return f"; I do not know {words}" if words else ""

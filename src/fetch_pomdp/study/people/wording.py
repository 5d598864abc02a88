"""How requests are worded: as in the published studies, or by the robot's reader's own grammar, read backwards."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypeAlias

from numpy.random import Generator

from fetch_pomdp.core.language.reading.describing import describer
from fetch_pomdp.core.language.reading.saying import ARTICLE, Phrases
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.people import grammar
from fetch_pomdp.study.people.grammar import Words

if TYPE_CHECKING:
    from fetch_pomdp.study.people.traits import Traits

Wording: TypeAlias = Callable[[int, Scene, "Traits", Generator], Words]

# Words that people say where they lack one, and that no reader knows.
UNKNOWN = ("thingamajig", "doohickey", "whatsit", "gizmo", "contraption", "knickknack", "widget", "doodad")


def studied(desired: int, scene: Scene, traits: Traits, rng: Generator) -> Words:
    """Draw a request of the published studies: with `p_place`, "next to the" and another item's name."""
    place = grammar.next_to(desired, scene) if rng.random() < traits.p_place else ""
    people = traits.people
    return grammar.request(scene.items[desired], people.descriptors, people.p_name, place, rng)


def by_reader(desired: int, scene: Scene, traits: Traits, rng: Generator) -> Words:
    """Draw a request of the reader's grammar: with `p_place`, where the item is, so that it is told apart.

    With `p_unknown` a phrase of it is one of UNKNOWN instead.

    Choice: how many of the item's words are said, and which, is as in the published studies.
    """
    people = traits.people
    placed = rng.random() < traits.p_place
    words = grammar.description(scene.items[desired], people.descriptors, people.p_name, rng)
    said = describer(scene).described(desired, words, rng) if placed else ()
    said = said or (((ARTICLE,), *((word,) for word in words)) if words else (("that",), ("one",)))
    opening, closing = grammar.around(rng)
    return (*opening, *(word for phrase in _with_unknown(said, people.p_unknown, rng) for word in phrase), *closing)


def _with_unknown(said: Phrases, share: float, rng: Generator) -> Phrases:
    return tuple(
        phrase if phrase == (ARTICLE,) or rng.random() >= share else (grammar.chosen(UNKNOWN, rng),) for phrase in said
    )


WORDINGS: Mapping[str, Wording] = {"study": studied, "reader": by_reader}

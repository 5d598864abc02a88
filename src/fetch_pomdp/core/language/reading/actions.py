"""What the rules of a grammar file do: from the meanings of their parts to the meaning of the whole.

A side means a `Side`; M and P mean a tuple of forms, parts of a description; R a `Relation` without its landmark, as
(name, direct); NP a `Description` or an `Anaphor`. A word's meaning is its value in the lexicon. An action returns None
where the parts do not go together, which the parser takes for no parse.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

from fetch_pomdp.core.language.reading.form import (
    Alone,
    Anaphor,
    Between,
    Cluster,
    Count,
    Crowded,
    Description,
    Form,
    Middle,
    Near,
    Not,
    Ordinal,
    Person,
    Relation,
    Same,
    Seen,
    Select,
    Side,
    Superlative,
    Toward,
    Union,
    Within,
)

Parts = tuple[Form, ...]
Landmark = Description | Anaphor
IT = Anaphor()
SHAPES = ("row", "column")  # of groups
OF_SIDES: Mapping[str, str] = {
    "left": "left of", "right": "right of", "front": "in front of", "back": "behind", "top": "above",
    "bottom": "below", "west": "left of", "east": "right of",
}  # fmt: skip
INVERSES: Mapping[str, str] = {
    "left of": "right of", "right of": "left of", "in front of": "behind", "behind": "in front of",
    "above": "below", "below": "above",
}  # fmt: skip


def _side(sides: str) -> Side:
    return Side(tuple(sides.split()))


def _sides(first: str, second: str) -> Side:
    return Side(tuple(dict.fromkeys((*first.split(), *second.split()))))


def _extreme(first: Any, second: Any) -> Side:
    side = first if isinstance(first, Side) else second
    return dataclasses.replace(side, extreme=True)


def _extreme3(_far: str, _to: str, side: Side) -> Side:
    return dataclasses.replace(side, extreme=True)


def _viewed(person: str, side: Side) -> Side | None:
    return None if side.viewer else dataclasses.replace(side, viewer=Person(person))


def _extreme_viewed(person: str, _far: str, side: Side) -> Side | None:
    return None if side.viewer else dataclasses.replace(side, viewer=Person(person), extreme=True)


def _of_person(side: Side, _of: str, person: str) -> Side | None:
    return _viewed(person, side)


def _whom(whom: Any) -> Any:
    return Person(whom) if isinstance(whom, str) else whom


def _toward(_from: str, whom: Any) -> Parts:
    return (Toward(_whom(whom)),)


def _by(whom: Any, *, far: bool) -> Parts | None:
    if isinstance(whom, Anaphor):
        whom = Description((whom,))
    if _empty(whom):
        return None
    return (Superlative(_whom(whom), far=far),)


def _relation_name(side: Side) -> str:
    return " ".join(side.sides)


def _empty(landmark: Any) -> bool:
    return isinstance(landmark, Description) and not landmark.parts


def _relate(relation: tuple[str, bool], landmark: Any) -> Parts | None:
    if _empty(landmark):
        return None
    name, direct = relation
    return (Relation(name, _whom(landmark), None, direct),)


def _relate_same(relation: tuple[str, bool], _and: str, parts: Parts) -> Parts | None:
    """As in "behind and to the left of it": the landmark is that of the second relation."""
    last = parts[-1]
    if isinstance(last, Superlative) and isinstance(last.by, Description):
        landmark: Any = last.by
    elif isinstance(last, Relation):
        landmark = last.landmark
    else:
        return None
    related = _relate(relation, landmark)
    return None if related is None else (*related, *parts)


def _beside_it(_to: str, _its: str, side: Side) -> Parts:
    return (Relation(_relation_name(side), IT),)


def _having(_have: str, landmark: Landmark) -> Parts | None:
    """As in "has a red one behind it": what it has behind is what it is in front of."""
    if not isinstance(landmark, Description):
        return None
    found: list[Form] = []
    rest: list[Form] = []
    for part in landmark.parts:
        if isinstance(part, Union):
            both = (_having(_have, part.first), _having(_have, part.second))
            for each in both:
                found += each or ()
        elif isinstance(part, Relation) and isinstance(part.landmark, Anaphor):
            found.append(part)
        else:
            rest.append(part)
    if not found:
        return None
    what = Description(tuple(rest))
    inverted = [
        dataclasses.replace(part, name=inverse(part.name), landmark=what)
        if isinstance(part, Relation) and isinstance(part.landmark, Anaphor)
        else part
        for part in found
    ]
    return tuple(inverted)


def inverse(name: str) -> str:
    """Return the relation that holds the other way round."""
    if name in INVERSES:
        return INVERSES[name]
    opposite = {"left": "right", "right": "left", "top": "bottom", "bottom": "top", "front": "back", "back": "front"}
    return " ".join(opposite.get(side, side) for side in name.split())


def _having_both(have: str, first: Landmark, _and: str, second: Landmark) -> Parts | None:
    one, two = _having(have, first), _having(have, second)
    return None if one is None or two is None else (*one, *two)


def _several(landmark: Landmark) -> bool:
    return landmark.plural or (
        isinstance(landmark, Description) and any(isinstance(part, Within) for part in landmark.parts)
    )


def _within(_in: str, group: Landmark) -> Parts | None:
    return (Within(group),) if _several(group) else None


def _side_within(_in: str, side: Side, _of: str, group: Landmark) -> Parts | None:
    return (Within(group), dataclasses.replace(side, extreme=True)) if _several(group) else None


def _middle_in(_middle: Parts, _in: str, group: Landmark) -> Parts | None:
    return (Middle(group),) if _several(group) else None


def _middle_of(_middle: Parts, _of: str, group: Landmark) -> Parts | None:
    return None if _empty(group) else (Middle(group),)


def _between(_between: Any, *landmarks: Any) -> Parts | None:
    found = [each for each in landmarks if not isinstance(each, str)]
    return None if any(map(_empty, found)) else (Between(*found),)


def _between_person(landmark: Landmark, person: str) -> Parts | None:
    """As in "between the bowl and me": in front of the bowl, as that person sees it."""
    return None if _empty(landmark) else (Relation("in front of", landmark, Person(person)),)


def _middle_between(_middle: Parts, _of: str, group: Landmark) -> Parts | None:
    """As in "in the middle of the two bowls", which is between them."""
    if not isinstance(group, Description):
        return None
    two = any((isinstance(part, Count) and part.number == 2) or isinstance(part, Union) for part in group.parts)
    return (Between(group),) if two or (group.parts and not group.plural) else None


def _pairs_of(*parts: Any) -> Description | None:
    """As in "two pairs of bowls": any of them."""
    noun = parts[-1]
    if not isinstance(noun, Description):
        return None
    return Description(tuple(part for part in noun.parts if not isinstance(part, Count | Cluster)))


def _word_before(word: str, noun: Description) -> Description:
    return Description((Select(word), *noun.parts))


def _adjective(parts: Parts, noun: Description) -> Description:
    return Description((*parts, *noun.parts))


def _count(number: str, noun: Description) -> Description | None:
    if any(isinstance(part, Count) for part in noun.parts):
        return None
    return noun if number == "1" else noun.plus(Count(int(number)))


def _more(noun: Landmark, parts: Parts) -> Description:
    if isinstance(noun, Anaphor):
        return Description((noun, *parts))
    return noun.plus(*parts)


def _some_of(noun: Description, _of: str, group: Landmark) -> Description | None:
    return noun.plus(Within(group)) if _several(group) else None


def _negation_of(_not: str, noun: Landmark) -> Parts | None:
    """As in "not the bowl"; what is not in "not the bowl and not the pan" are two."""
    if isinstance(noun, Description) and any(isinstance(part, Not) for part in noun.parts):
        return None
    return (Not(noun),)


def _same_again(_and: str, noun: Landmark) -> Parts | None:
    """As in "the red one and also the closest one": more of the same item."""
    if not isinstance(noun, Description) or _words(noun) or noun.plural:
        return None
    return noun.parts or None


def _cluster(shape: str) -> Cluster:
    return Cluster(shape if shape in SHAPES else "")


def _cluster_of(shape: str, _of: str, noun: Landmark) -> Description | None:
    return noun.plus(_cluster(shape)) if isinstance(noun, Description) else None


def _words(landmark: Landmark) -> bool:
    return isinstance(landmark, Description) and any(isinstance(part, Select) for part in landmark.parts)


def _union(first: Landmark, _and: str, second: Landmark) -> Description | None:
    if not (_words(first) and _words(second)):
        return None
    return Description((Union(first, second),))


ACTIONS: Mapping[str, Callable[..., Any]] = {
    "first": lambda first, *_: first,
    "second": lambda _, second, *__: second,
    "third": lambda *parts: parts[2],
    "part": lambda part: part if isinstance(part, tuple) else (part,),
    "part2": lambda _, part: (part,),
    "side": _side,
    "sides": _sides,
    "utmost": lambda side: Side((side,), extreme=True),
    "extreme": _extreme,
    "extreme3": _extreme3,
    "viewed": _viewed,
    "extreme_viewed": _extreme_viewed,
    "of_person": _of_person,
    "viewed_after": lambda side, person: _viewed(person, side),
    "nearest_before": lambda whom, _near: _by(whom, far=False),
    "nearest_before3": lambda _to, whom, _near: _by(whom, far=False),
    "farthest_before3": lambda _from, whom, _far: _by(whom, far=True),
    "cluster_named": lambda shape, noun: noun.plus(_cluster(shape)),
    "toward": _toward,
    "toward_first": lambda from_, side, _to, _other: _toward(from_, side),
    "within3": lambda _, of, group: _within(of, group),
    "same_again": _same_again,
    "near": lambda _: (Near(),),
    "far": lambda _: (Near(far=True),),
    "nearest": lambda _near, _to, whom: _by(whom, far=False),
    "nearest2": lambda _near, whom: _by(whom, far=False),
    "farthest": lambda _far, _from, whom: _by(whom, far=True),
    "farthest2": lambda _far, whom: _by(whom, far=True),
    "ordinal": lambda rank: (Ordinal(int(rank)),),
    "alone": lambda _: (Alone(),),
    "alone2": lambda _, __: (Alone(),),
    "only": lambda _: (Count(1),),
    "crowd": lambda _: (Crowded(),),
    "together": lambda shape: (_cluster(shape),),
    "middle": lambda _: Middle(),
    "middle_of": _middle_of,
    "middle_between": _middle_between,
    "middle_of_two": lambda _middle, _of, first, _and, second: _between(None, first, second),
    "pairs_of": _pairs_of,
    "clusters_of": _pairs_of,
    "middle_in": _middle_in,
    "negation": lambda _, parts: (Not(parts[0] if len(parts) == 1 else Description(parts)),),
    "negation_of": _negation_of,
    "joined": lambda first, _and, second: (*first, *second),
    "neither": lambda _none, first, _and, second: (Not(first), Not(second)),
    "joined_on": lambda first, second: (*first, *second),
    "relation": lambda name: (name, False),
    "directly": lambda _, relation: (relation[0], True),
    "directly3": lambda _to, _directly, relation: (relation[0], True),
    "side_relation": lambda side, _of: (OF_SIDES.get(_relation_name(side), _relation_name(side)), False),
    "side_relation2": lambda _, side, _of: (OF_SIDES.get(_relation_name(side), _relation_name(side)), False),
    "relate": _relate,
    "relate_it": lambda relation: (Relation(relation[0], IT, None, relation[1]),),
    "relate_same": _relate_same,
    "beside_it": _beside_it,
    "having": _having,
    "having_both": _having_both,
    "between_two": _between,
    "between": _between,
    "between_person": lambda _between, landmark, _and, person: _between_person(landmark, person),
    "between_person_first": lambda _between, person, _and, landmark: _between_person(landmark, person),
    "within": _within,
    "side_within": _side_within,
    "seen": lambda person: (Seen(Person(person)),),
    "select": lambda word: Description((Select(word),)),
    "thing": lambda _: Description(),
    "word_before": _word_before,
    "word_after": lambda noun, word: noun.plus(Select(word)),
    "adjective": _adjective,
    "nameless": Description,
    "middle_among": lambda middle, group: _middle_in(middle, "", group),
    "count": _count,
    "number": lambda number: None if number == "1" else Description((Count(int(number)),)),
    "cluster": lambda shape: Description((_cluster(shape),)),
    "anaphor": lambda _: IT,
    "anaphors": lambda _: Anaphor(plural=True),
    "the_same": lambda _: Description((Same(),)),
    "not_those": lambda _none, _of, those: Description((Not(those),)),
    "not_it": lambda _: Description((Not(IT),)),
    "those_number": lambda _, __: Anaphor(plural=True),
    "the_other": lambda _: Description((Anaphor(other=True),)),
    "another": lambda _, noun: noun.plus(Anaphor(other=True)),
    "those": lambda _, noun: noun.plus(Within(Anaphor(plural=True))),
    "those_others": lambda number, _, noun: noun.plus(Count(int(number))) if number != "1" else noun,
    "those_others2": lambda _, number, noun: noun.plus(Count(int(number))) if number != "1" else noun,
    "one_of": lambda _, __, group: Description((Within(group),)),
    "some_of": _some_of,
    "cluster_of": _cluster_of,
    "cluster_after": lambda noun, shape: noun.plus(_cluster(shape)),
    "more": _more,
    "union": _union,
}

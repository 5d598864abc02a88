"""What a person says who means something: the grammar read backwards, from a meaning to words.

A chart is filled from the words that a meaning may need to all constituents whose meaning is a part of it (chart
generation: Kay 1996), with the rules and actions by which the reader puts words together. So whatever can be read can
be said, and a rule that is added to a grammar file is spoken at once.

Choice: of several ways to say the same the shorter are the likelier, and of a lexicon's phrases the first ones. Rules
that have a cost, and those of telegrams (`UNSPOKEN`), are read and not spoken. What is read as something else than what
was meant ("the right mug": directly, or on the right?) is not said either: people hear themselves.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from numpy.random import Generator

from fetch_pomdp.core.language.reading.actions import OF_SIDES
from fetch_pomdp.core.language.reading.discourse import settled, words_of
from fetch_pomdp.core.language.reading.form import Description, Form, Ordinal, Person, Relation, Select, Side, inner
from fetch_pomdp.core.language.reading.grammar import BREAKS, Grammar, Leaf, Rule
from fetch_pomdp.core.language.reading.reader import parse
from fetch_pomdp.core.language.reading.tokens import Vocabulary

LONGEST = 8  # leaves of what is said
KEPT = 3  # ways to say a constituent
ARTICLE = "the"
# Rules by which words follow each other without those that join them: "the bowl closest me", "the bowl left".
UNSPOKEN = frozenset({
    "M = S : part", "M = MID : part", "M = near person : nearest2", "M = far person : farthest2",
    "M = near from person : nearest", "M = far to person : farthest", "M = and M : second", "P = alone : alone",
    "M = in alone : alone2", "P = near to person : nearest", "R = sidenoun S of : side_relation2",
    "MID = to MID : second", "MID = from MID : second",
})  # fmt: skip
VARIED = frozenset(
    {"rel", "near", "far", "mid", "alone", "ord", "sidenoun"}
)  # categories of which two phrases are said
BEFORE_THE = frozenset({"in", "of", "to", "from"})  # categories after which a side or a middle has an article
AFTER_THE = frozenset({"side", "utmost", "mid", "table", "xt"})
UNSAID = frozenset({*BREAKS, "ignored", "seen", "it", "its", "them", "those", "none", "other", "same", "grp", "grps"})
# A leaf's value in these categories is a part of what is meant; in all others it only joins.
TELLING = frozenset({"w", "side", "utmost", "person", "poss", "ord", "rel", "num", "dir"})

MOST_WAYS = 8  # to say a description
CLEAR = 0.5  # cost by which another reading must be dearer

Leaves = tuple[Leaf | None, ...]  # None: an article
Phrases = tuple[tuple[str, ...], ...]


class Said(NamedTuple):
    """A constituent: what it means, and the leaves that say it. cost: of its rules."""

    meaning: Any
    leaves: Leaves
    cost: float

    @property
    def joins(self) -> bool:
        """Whether it only joins others."""
        return len(self.leaves) == 1 and self.leaves[0] is not None and self.leaves[0].category not in TELLING | {"xt"}


class _Begun(tuple[Any, ...]):
    """The meanings of the first parts of a rule that goes on."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Speaker:
    """Says in a language what is meant on a table with these words."""

    language: Grammar
    vocabulary: Vocabulary

    def ways(self, meant: Description) -> tuple[Phrases, ...]:
        """Return ways to say a description, as a grammar builds it, the shortest first; none if it has none."""
        said = (phrases for leaves in _Chart(meant, self.language).ways() for phrases in self._phrases(leaves))
        return tuple(itertools.islice((each for each in said if self._is_clear(each, meant)), MOST_WAYS))

    def _phrases(self, leaves: Leaves) -> Iterator[Phrases]:
        """Yield the phrases that some leaves may be said by, the plainest first."""
        choices: list[Sequence[tuple[str, ...]]] = []
        for leaf in leaves:
            if leaf is None:
                choices.append([(ARTICLE,)])
            elif leaf.category == "w":
                choices.append([tuple(leaf.value.split())])
            else:
                choices.append(self.language.said_as[leaf][: 2 if leaf.category in VARIED else 1])
        return itertools.product(*choices)

    def _is_clear(self, phrases: Phrases, meant: Description) -> bool:
        """Whether words are read as what is meant, and as nothing else nearly as likely, but a part of it."""
        words = [word for phrase in phrases for word in phrase]
        first, *others = parse(words, self.vocabulary, self.language).found
        own = alike(first.meaning)
        clear = all(other.cost - first.cost > CLEAR or alike(other.meaning) < own for other in others)
        return clear and own == alike(settled(meant))


def alike(form: Any) -> Any:
    """Return what two forms share that mean the same with their parts in another order."""
    if isinstance(form, Description):
        return frozenset(map(alike, form.parts))
    landmark = getattr(form, "landmark", getattr(form, "form", None))
    return form if landmark is None else (type(form), getattr(form, "name", ""), alike(landmark))


def earlier(count: int, rng: Generator) -> int:
    """Draw an index below `count`, the first the likeliest: the chance of the k-th falls as 1 / k^2."""
    weights = [1.0 / (place + 1) ** 2 for place in range(count)]
    left = rng.random() * math.fsum(weights)
    for place, weight in enumerate(weights):
        left -= weight
        if left < 0.0:
            return place
    return count - 1


class _Chart:
    """Constituents by length and category whose meanings are parts of one that is meant."""

    def __init__(self, meant: Description, language: Grammar) -> None:
        self._language, self._meant = language, meant
        self._forms = frozenset(_within(meant))
        sides = {form for form in self._forms if isinstance(form, Side)}
        relations = {form for form in self._forms if isinstance(form, Relation)}
        self._relations = frozenset((form.name, form.direct) for form in relations)
        self._sides = {(form.sides, form.viewer, form.extreme) for form in sides} | {
            ((side,), None, False) for side, name in OF_SIDES.items() if any(name == each.name for each in relations)
        }
        self._cells: list[dict[str, list[Said]]] = [{}]
        self._ways: dict[tuple[str, Any], int] = {}

    def ways(self) -> list[Leaves]:
        """Return the ways to say what is meant, the shortest first."""
        found: list[Leaves] = []
        for length in range(1, LONGEST + 1):
            self._cells.append({})
            if length == 1:
                for leaf in self._leaves():
                    self._add(1, leaf.category, Said(leaf.value, (leaf,), 0.0))
            for first in range(1, length):
                self._join(first, length)
            self._close(length)
            found += [
                _articled(said.leaves)
                for said in self._cells[length].get("NP", ())
                if isinstance(said.meaning, Description) and alike(said.meaning) == alike(self._meant)
                if not _stacked(said.leaves)
            ]
        return found

    def _leaves(self) -> Iterator[Leaf]:
        """Yield the leaves that may help to say it."""
        values = {
            *(form.word for form in self._forms if isinstance(form, Select)),
            *(side for sides, _, _ in self._sides for side in sides),
            *(person.value for person in self._people()),
            *(str(form.rank) for form in self._forms if isinstance(form, Ordinal)),
            *(name for name, _ in self._relations),
        }
        yield from (Leaf("w", form.word) for form in self._forms if isinstance(form, Select))
        nameless = any(isinstance(form, Description) and not words_of(form) for form in self._forms)
        for leaf in self._language.said_as:
            helps = leaf.value in values if leaf.category in TELLING else leaf.category != "n" or nameless
            if helps and leaf.category not in UNSAID:
                yield leaf

    def _people(self) -> Iterator[Person]:
        for form in self._forms:
            whom = [getattr(form, name, None) for name in ("viewer", "by", "whom", "landmark")]
            yield from (each for each in whom if isinstance(each, Person))

    def _join(self, first: int, length: int) -> None:
        left, right = self._cells[first], self._cells[length - first]
        for category, firsts in list(left.items()):
            rules = self._language.binary.get(category, {})
            for other in rules.keys() & right.keys():
                for rule in filter(_spoken, rules[other]):
                    for one in firsts:
                        for two in right[other]:
                            self._build(length, rule, one, two)

    def _build(self, length: int, rule: Rule, one: Said, two: Said) -> None:
        parts = (*one.meaning, two.meaning) if isinstance(one.meaning, _Begun) else (one.meaning, two.meaning)
        meaning = _Begun(parts) if rule.action is None else rule.action(*parts)
        for part, other in ((one, two), (two, one)):
            if meaning == part.meaning and not other.joins:
                return  # the same twice
        self._add(length, rule.parent, Said(meaning, one.leaves + two.leaves, one.cost + two.cost + rule.cost))

    def _close(self, length: int) -> None:
        agenda = list(self._cells[length])
        while agenda:
            category = agenda.pop()
            for rule in filter(_spoken, self._language.unary.get(category, ())):
                for said in list(self._cells[length][category]):
                    meaning = rule.action(said.meaning) if rule.action else None
                    article = (None,) if (rule.parent, category) == ("NP", "N") else ()
                    if self._add(length, rule.parent, Said(meaning, article + said.leaves, said.cost + rule.cost)):
                        agenda.append(rule.parent)

    def _add(self, length: int, category: str, said: Said) -> bool:
        """Add a constituent if it is a part of what is meant that can be said in few other ways; return whether."""
        if said.meaning is None or not self._helps(said.meaning):
            return False
        key, cell = (category, said.meaning), self._cells[length].setdefault(category, [])
        if self._ways.get(key, 0) >= KEPT or any(said.leaves == each.leaves for each in cell):
            return False
        self._ways[key] = self._ways.get(key, 0) + 1
        cell.append(said)
        return True

    def _helps(self, meaning: Any) -> bool:
        if isinstance(meaning, _Begun):
            return all(map(self._helps, meaning))
        if isinstance(meaning, Description):
            meaning = meaning.parts
        if isinstance(meaning, Side):
            return any(
                set(meaning.sides) <= set(sides) and meaning.viewer in (None, viewer) and meaning.extreme <= extreme
                for sides, viewer, extreme in self._sides
            )
        if isinstance(meaning, tuple):
            if len(meaning) == 2 and isinstance(meaning[0], str):
                return meaning in self._relations
            return len(set(meaning)) == len(meaning) and all(form in self._forms for form in meaning)
        return isinstance(meaning, str) or meaning in self._forms


def _spoken(rule: Rule) -> bool:
    return not rule.cost and rule.name not in UNSPOKEN


def _within(form: Any) -> Iterator[Form]:
    yield form
    for each in inner(form):
        yield from _within(each)


def _stacked(leaves: Leaves) -> bool:
    """Whether two stand together that nobody says so ("on beside the bowl", "most my left", "right right")."""
    for one, other in itertools.pairwise(leaves):
        kinds = tuple("" if leaf is None else leaf.category for leaf in (one, other))
        if one == other or kinds == ("xt", "poss") or (kinds[0] in BEFORE_THE and kinds[1] == "rel"):
            return True
    return False


def _articled(leaves: Leaves) -> Leaves:
    """Put an article before a side or a middle that follows what joins it ("on the left"), and none before "my"."""
    found: list[Leaf | None] = []
    for leaf in leaves:
        last = found[-1] if found else None
        if leaf and last and leaf.category in AFTER_THE and last.category in BEFORE_THE:
            found.append(None)
        if leaf and leaf.category == "poss" and found and last is None:
            found.pop()
        found.append(leaf)
    return tuple(found)

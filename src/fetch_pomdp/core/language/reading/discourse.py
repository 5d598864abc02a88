"""From the clauses of an utterance to what is meant as a whole: which is wanted, which are only spoken of.

"There are three bowls on the left. Take the one in the middle" wants one of the three; "it", "those" and "the other
one" are found in what came before.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.core.language.reading.chart import Cover
from fetch_pomdp.core.language.reading.form import (
    Alone,
    Anaphor,
    Cluster,
    Count,
    Crowded,
    Description,
    Form,
    Known,
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
    inner,
    rebuilt,
)

READINGS = 5  # of an utterance
MARGIN = 2.0  # cost above the best reading's, beyond which one no longer counts
LARGEST = 40  # forms of what "it" or "the same" may stand for
ANEW = 0.5  # cost of taking what is said without a word for the item for another kind of item than before
SLACK = 1e-9  # cost: sums in another order differ by less
IGNORED = 0.7  # cost of a description that is left out


@dataclass(frozen=True, slots=True)
class Before:
    """What was going on before an utterance.

    meaning: what was meant last. asked: the item that the robot asked about.
    """

    meaning: Description | None = None
    asked: int | None = None


NOTHING_BEFORE = Before()


@dataclass(frozen=True, slots=True)
class Candidate:
    """A reading before its weight is known. skipped: the cost of the words left out."""

    meaning: Description
    cost: float
    skipped: float
    nested: int = 0  # parts of landmarks beside their words


def candidates(
    kinds: Sequence[str], found: Sequence[Sequence[Cover]], before: Before = NOTHING_BEFORE
) -> list[Candidate]:
    """Return the readings of an utterance, best first. kinds, found: how each clause begins, and its covers."""
    result: dict[Description, Candidate] = {}
    for covers in itertools.islice(_cheapest(found), 3 * READINGS):
        least = sum(cover.cost for cover in covers)  # from here on all cost this and more
        if _enough(result.values(), least):
            break
        meaning, ignored = _assembled(kinds, [cover.meanings for cover in covers])
        skipped = sum(cover.skipped for cover in covers)
        for said, more in _continued(_grounded(meaning, before), before):
            cost = least + ignored + more
            if said not in result or cost < result[said].cost:
                result[said] = Candidate(said, cost, skipped, nested(said))
    ranked = sorted(result.values(), key=lambda each: each.cost)[:READINGS]
    return [each for each in ranked if each.cost <= ranked[0].cost + MARGIN]


def _enough(found: Collection[Candidate], least: float) -> bool:
    """Return whether no reading that costs `least` or more can be among the best beside those that were found."""
    if not found:
        return False
    costs = sorted(each.cost for each in found)
    return least > costs[0] + MARGIN + SLACK or (len(costs) >= READINGS and least > costs[READINGS - 1] + SLACK)


def _cheapest(found: Sequence[Sequence[Cover]]) -> Iterator[tuple[Cover, ...]]:
    """Yield combinations of covers, the cheapest first and then those that differ from it in one or two clauses."""
    if not found:
        return
    beam: list[tuple[float, tuple[Cover, ...]]] = [(0.0, ())]
    for covers in found:
        beam = [(cost + cover.cost, (*chosen, cover)) for cost, chosen in beam for cover in covers]
        beam.sort(key=lambda each: each[0])
        del beam[3 * READINGS :]
    yield from (chosen for _, chosen in beam)


def _assembled(kinds: Sequence[str], clauses: Sequence[tuple[Any, ...]]) -> tuple[Description, float]:
    state = _Discourse()
    for kind, fragments in zip(kinds, clauses, strict=True):
        state.hear(kind, fragments)
    return state.meaning(), state.ignored


class _Discourse:
    """What was said so far in an utterance."""

    def __init__(self) -> None:
        self.target: Description | None = None
        self.spoken: list[Description] = []
        self.refused: list[Description] = []
        self.ignored = 0.0

    def hear(self, kind: str, fragments: Sequence[Any]) -> None:
        """Take in the constituents of a clause."""
        said = self._joined(fragments)
        if said is None:
            return
        if kind == "correct":
            self._correct(said)
        elif kind == "skip":
            self.refused.append(self._resolved(said))
        elif kind == "more" and self.target is not None:
            self.target = self.target.plus(*self._resolved(said).parts)
        elif kind == "more" and self.spoken:
            self.spoken[-1] = self.spoken[-1].plus(*said.parts)
        elif kind == "verb":
            self._want(said)
        elif self.target is None:
            self.spoken.append(self._resolved(said))
        else:
            self.target = self._added(self.target, self._resolved(said))

    def _correct(self, said: Description) -> None:
        """Put what is said now in the place of what was said before; of that only words hold that are not replaced."""
        before = self.target or (self.spoken[-1] if self.spoken else None)
        if before is not None and not words_of(said):
            said = Description(tuple(part for part in before.parts if isinstance(part, Select))).plus(*said.parts)
        self.target, self.spoken, self.refused = said, [], []

    def _joined(self, fragments: Sequence[Any]) -> Description | None:
        """Return the first description with the parts that stand alone; another one joins it if it may be the same."""
        whole: Description | None = None
        loose: list[Form] = []
        for fragment in fragments:
            if isinstance(fragment, tuple):
                loose += fragment
                continue
            said = fragment if isinstance(fragment, Description) else Description((fragment,))
            whole = said if whole is None else self._added(whole, said)
        if whole is None:
            return Description(tuple(loose)) if loose else None
        return whole.plus(*loose)

    def _added(self, whole: Description, said: Description) -> Description:
        """Return what two descriptions side by side say of the same; the second may be one of the first."""
        if whole.plural and not said.plural and not words_of(said) and said.parts:
            return said.plus(Within(whole))
        if words_of(said) <= words_of(whole) or not words_of(whole):
            return whole.plus(*(part for part in said.parts if part not in whole.parts))
        self.ignored += IGNORED
        return whole

    def _want(self, said: Description) -> None:
        said = self._resolved(said)
        if self.target is not None:
            if words_of(said) <= words_of(self.target) and not _own(said):
                self.target = self.target.plus(*said.parts)
                return
            self.spoken.append(self.target)
        self.target = self._told_apart(said)

    def _told_apart(self, said: Description) -> Description:
        """Return what is wanted among what was spoken of last, where it may be one of those."""
        if not self.spoken:
            return said
        context, within = self.spoken[-1], any(isinstance(part, Within) for part in said.parts)
        if not words_of(context) and not context.plural:
            return said.plus(*context.parts)
        if not _own(said) and not words_of(said) and not within:
            return context.plus(*said.parts)
        if within or (words_of(said) and not (context.plural and words_of(context) == words_of(said))):
            return said
        return said.plus(Within(context)) if context.plural else said.plus(*context.parts)

    def _resolved(self, said: Description) -> Description:
        """Put what was spoken of before in the place of "it" and "those"."""
        before = ([] if self.target is None else [self.target]) or self.spoken
        return _replaced(said, before)

    def meaning(self) -> Description:
        """Return what is wanted, settled."""
        target = self.target
        if target is None:
            target = self.spoken[0] if self.spoken else Description()
            for other in self.spoken[1:]:
                if words_of(other) <= words_of(target):
                    target = target.plus(*other.parts)
                else:
                    self.ignored += IGNORED
        if self.refused:
            target = target.plus(*(Not(each) for each in self.refused))
        return settled(target)


def nested(form: Form) -> int:
    """Return how many parts of a meaning are about landmarks, beside their words and numbers."""
    if isinstance(form, Description):
        return sum(nested(part) for part in form.parts)
    return sum(_size(each) for each in inner(form))


def _size(form: Form) -> int:
    own = not isinstance(form, Select | Count | Cluster | Description | Union)
    return own + sum(_size(each) for each in inner(form))


def words_of(said: Description) -> frozenset[str]:
    """Return the words that a description says of its items themselves."""
    return frozenset(part.word for part in said.parts if isinstance(part, Select))


def _own(said: Description) -> bool:
    return any(not isinstance(part, Count | Anaphor | Cluster) for part in said.parts)


def _replaced(said: Description, before: Sequence[Description]) -> Description:
    if _means_group(said) and any(each.plural for each in before):
        return _antecedent(Anaphor(plural=True), before)
    parts: list[Form] = []
    for part in said.parts:
        if isinstance(part, Anaphor) and not part.other:
            parts += _antecedent(part, before).parts
        else:
            parts.append(_with_antecedents(part, before))
    return Description(tuple(parts))


def _with_antecedents(part: Any, before: Sequence[Description]) -> Any:
    """Return a form with every anaphor inside it replaced."""
    if isinstance(part, Anaphor):
        return part if part.other else _antecedent(part, before)
    if isinstance(part, Description):
        return _replaced(part, before)
    return rebuilt(part, lambda each: _with_antecedents(each, before))


def _means_group(said: Description) -> bool:
    """Return whether a description names only a group, as in "the middle of that row"."""
    return bool(said.parts) and all(isinstance(part, Cluster) for part in said.parts)


def _antecedent(anaphor: Anaphor, before: Sequence[Description]) -> Description:
    if not before:
        return Description((anaphor,))
    found = next((each for each in reversed(before) if each.plural or not anaphor.plural), before[-1])
    return found if _brief(found) else Description()


def _brief(said: Description) -> bool:
    """Return whether a meaning is short enough to be spoken of again: what has "it" in it grows with each time."""
    return said.extent[0] <= LARGEST


def _continued(meaning: Description, before: Before) -> Iterator[tuple[Description, float]]:
    """Yield a meaning, and what it costs more: "the one on the left" after "the mug" may be a mug, or any item."""
    words = () if before.meaning is None else tuple(part for part in before.meaning.parts if isinstance(part, Select))
    ranked = any(isinstance(part, Side | Superlative | Middle | Alone | Crowded | Relation) for part in meaning.parts)
    if words and ranked and not words_of(meaning) and not meaning.plural:
        yield Description((*words, *meaning.parts)), 0.0
        yield meaning, ANEW
    else:
        yield meaning, 0.0


def _grounded(meaning: Description, before: Before) -> Description:
    """Put what was going on before the utterance in the place of what still refers to something."""
    parts: list[Form] = []
    for part in meaning.parts:
        if isinstance(part, Same):
            parts += () if before.meaning is None or not _brief(before.meaning) else before.meaning.parts
        elif isinstance(part, Anaphor):
            parts += () if before.asked is None or not part.other else (Not(Known(before.asked)),)
        else:
            parts.append(_grounded_inside(part, before))
    return Description(tuple(dict.fromkeys(parts)))


def _grounded_inside(part: Any, before: Before) -> Any:
    if isinstance(part, Description):
        if before.asked is not None and any(isinstance(each, Anaphor) and not each.other for each in part.parts):
            return Description((Known(before.asked),))
        return _grounded(part, before)
    if isinstance(part, Anaphor):
        return Description(() if before.asked is None or part.other else (Known(before.asked),))
    return rebuilt(part, lambda each: _grounded_inside(each, before))


def settled(said: Description) -> Description:
    """Return a description whose ordinals, nears and fars have found what they count from, and so its landmarks'."""
    said = _as_seen(_one_group(said))
    parts = [_settled_inside(_with_words(part, said)) for part in said.parts]
    ranks = [part.rank for part in parts if isinstance(part, Ordinal)]
    nears = [part for part in parts if isinstance(part, Near)]
    towards = [part.whom for part in parts if isinstance(part, Toward)]
    rest: list[Form] = [part for part in parts if not isinstance(part, Ordinal | Near | Toward)]
    rank = ranks[0] if ranks else 1
    if nears:
        whom = towards[0] if towards else None
        far = nears[0].far and not isinstance(whom, Side)
        rest.append(Superlative(whom, far, rank))
    elif ranks:
        rest = _ranked(rest, towards, rank)
    else:
        rest += [each for each in towards if isinstance(each, Side)]
    return Description(tuple(dict.fromkeys(_within_group(rest))))


def _within_group(parts: list[Form]) -> list[Form]:
    """Take the side of a group for the utmost of its items: "the left one of the three"."""
    grouped = any(
        isinstance(each, Within) and isinstance(each.group, Description) and each.group.plural for each in parts
    )
    if not grouped or any(isinstance(each, Superlative | Middle) for each in parts):
        return parts
    return [dataclasses.replace(each, extreme=True) if isinstance(each, Side) else each for each in parts]


def _as_seen(said: Description) -> Description:
    """Give sides and directions that are nobody's to whom the description names as seeing them."""
    viewer = next((part.viewer for part in said.parts if isinstance(part, Seen)), None)
    if viewer is None:
        return said

    def seen(form: Any) -> Any:
        form = rebuilt(form, seen)
        own = isinstance(form, Side | Relation) and form.viewer is None
        return dataclasses.replace(form, viewer=viewer) if own else form

    parts = tuple(part for part in said.parts if not isinstance(part, Seen))
    found = seen(Description(parts))
    return Description((*parts, Seen(viewer))) if found.parts == parts else found


def _one_group(said: Description) -> Description:
    """Return "those three" of a group of three as that group: it is the same one."""
    groups = [part.group for part in said.parts if isinstance(part, Within)]
    group = next((each for each in groups if isinstance(each, Description) and each.plural), None)
    if group is None or not said.plural or words_of(said) - words_of(group):
        return said
    rest = (part for part in said.parts if not isinstance(part, Within | Count | Cluster))
    return _one_group(group).plus(*rest)


def _with_words(part: Form, said: Description) -> Form:
    """Give a group that has no words those of what is one of it: "the red one of the three"."""
    group = part.group if isinstance(part, Within) else part.of if isinstance(part, Middle) else None
    if isinstance(group, Description) and group.plural and not inner_words(group):
        named = Description((*(each for each in said.parts if isinstance(each, Select)), *group.parts))
        return Within(named) if isinstance(part, Within) else Middle(named)
    return part


def inner_words(said: Description) -> frozenset[str]:
    """Return the words of a description and of the groups that it is of."""
    found = words_of(said)
    for part in said.parts:
        if isinstance(part, Within) and isinstance(part.group, Description):
            found |= inner_words(part.group)
    return found


def _ranked(rest: list[Form], towards: Sequence[Person | Side], rank: int) -> list[Form]:
    """Give an ordinal to what it counts from: what it names, a superlative, a side, a person, or nothing said."""
    if towards:
        return [*rest, Superlative(towards[0], False, rank)]
    for index, part in enumerate(rest):
        if isinstance(part, Superlative) and part.rank == 1:
            return [*rest[:index], dataclasses.replace(part, rank=rank), *rest[index + 1 :]]
    for index, part in enumerate(rest):
        if isinstance(part, Side):  # "the last one on the left" is the utmost, "the last from the left" the other end
            ranked = dataclasses.replace(part, extreme=True) if rank == -1 else Superlative(part, False, rank)
            return [*rest[:index], ranked, *rest[index + 1 :]]
    for index, part in enumerate(rest):
        if isinstance(part, Relation) and isinstance(part.landmark, Person):
            return [*rest[:index], Superlative(part.landmark, False, rank), *rest[index + 1 :]]
    return [*rest, Superlative(None, False, rank)]


def _settled_inside(part: Any) -> Any:
    if isinstance(part, Description):
        return settled(part)
    if isinstance(part, Not) and isinstance(part.form, Near | Ordinal | Toward):
        return Not(settled(Description((part.form,))))
    return rebuilt(part, _settled_inside)

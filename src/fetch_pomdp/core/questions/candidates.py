"""The questions of a scene: from its words, its places, and its items one by one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions import wording
from fetch_pomdp.core.questions.answers import described, taken_for, understood, yes_no
from fetch_pomdp.core.questions.places import regions
from fetch_pomdp.core.questions.prices import LISTENING, POINTING, SPEAKING
from fetch_pomdp.core.questions.question import Kind, Question
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import ModelError

MOST_NAMED = 4  # words of an item that an open answer may name: each doubles the answers
MOST_DESCRIPTIONS = 128  # answers to an open question


@dataclass(frozen=True, slots=True, kw_only=True)
class Asking:
    """What is asked and how people answer. Raises ModelError for a number out of its range.

    Choice: half of what is wrong with an answer stays wrong when the question is asked again (`shared`); people name
    three of four attributes that tell items apart when asked what an item is like. Nobody has measured either here.
    """

    kinds: frozenset[Kind] = frozenset(Kind)
    misunderstood: float = 0.0  # chance that an item pointed at is taken for a neighbour, in [0, 1)
    reach: float = 0.5  # distance at which it is taken for one less often by e, in distances of neighbours, above 0
    shared: float = 0.5  # chance that a question asked again is answered as before, in [0, 1)
    names: float = 0.75  # chance that an open answer names an attribute, in (0, 1)
    slips: float = 0.01  # chance that it describes another item, in [0, 1)
    most: int = 150  # questions beside those about one item; of more, those that tell most at first are kept

    def __post_init__(self) -> None:
        object.__setattr__(self, "kinds", frozenset(Kind(kind) for kind in self.kinds))
        ranges = {
            "misunderstood": (0.0, 1.0 - 1e-9, "a probability from 0 to below 1"),
            "reach": (1e-3, 1e3, "a distance above 0"),
            "shared": (0.0, 1.0 - 1e-9, "a probability from 0 to below 1"),
            "names": (1e-9, 1.0 - 1e-9, "a probability above 0 and below 1"),
            "slips": (0.0, 1.0 - 1e-9, "a probability from 0 to below 1"),
        }
        for name, (low, high, expected) in ranges.items():
            checks.within(getattr(self, name), low, high, name, expected, ModelError)
        checks.whole(self.most, 0, 10_000, "most", ModelError)


@dataclass(frozen=True, slots=True)
class _Found:
    """What questions are made of."""

    scene: Scene
    asking: Asking
    table: Table = field(init=False)
    taken: Vector = field(init=False)

    def __post_init__(self) -> None:
        table = Table.of(self.scene)
        object.__setattr__(self, "table", table)
        object.__setattr__(self, "taken", taken_for(table.distances, self.asking.misunderstood, self.asking.reach))

    @property
    def size(self) -> int:
        return len(self.scene.items)

    @property
    def truth(self) -> float:
        return self.scene.model.p_truth

    def holding(self, members: tuple[int, ...]) -> Vector:
        holds = np.zeros(self.size)
        holds[list(members)] = 1.0
        return yes_no(holds, self.truth)


def points(scene: Scene, asking: Asking | None = None) -> tuple[Question, ...]:
    """Return the paper's questions: of each item, "this one?", which the robot points at (Section III-B, Table I).

    Without `asking` they are the paper's to the letter: everybody understands which item is meant, and answers each
    question anew.
    """
    found = _Found(scene, asking or Asking(shared=0.0))
    return tuple(
        Question(
            kind=Kind.POINT,
            said=wording.THIS_ONE,
            chances=yes_no(found.taken[item], found.truth),
            members=(item,),
            seconds=POINTING,
            shared=found.asking.shared,
        )
        for item in range(found.size)
    )


def candidates(scene: Scene, asking: Asking | None = None) -> tuple[Question, ...]:
    """Return all questions of a scene, of the kinds wanted: those about one item first, in scene order.

    Of spoken questions that divide the items alike, or the other way round, the one that tells most is kept, and of
    equals the first: attributes, places, two attributes. Questions about one item are kept whatever else there is.
    """
    found = _Found(scene, asking or Asking())
    asking = found.asking
    kept = list(points(scene, asking)) if Kind.POINT in asking.kinds else []
    spoken = [each for each in (*_attributes(found), *_regions(found), *_both(found)) if each.kind in asking.kinds]
    others = [*_without_doubles(spoken), *_pairs(found), *_open(found), *_repeat(found)]
    others = [each for each in others if each.kind in asking.kinds]
    told = np.array([_told(each) for each in others])
    best = np.sort(np.argsort(-told, kind="stable")[: asking.most])
    return (*kept, *(others[index] for index in best if told[index] > 1e-6))


def _without_doubles(questions: list[Question]) -> list[Question]:
    found: dict[bytes, Question] = {}
    for question in sorted(questions, key=lambda each: -round(_told(each), 6)):
        yes = question.chances[0] > 0.5
        found.setdefault((yes if yes[0] else ~yes).tobytes(), question)
    return [question for question in questions if any(question is kept for kept in found.values())]


def _told(question: Question) -> float:
    """Return what a question tells where nothing is known, in bits."""
    return question.information(np.full(question.n_items, 1.0 / question.n_items))


def _spoken(found: _Found, kind: Kind, said: str, words: tuple[str, ...], members: tuple[int, ...]) -> Question:
    return Question(
        kind=kind, said=said, chances=found.holding(members), members=members, words=words, seconds=SPEAKING,
        shared=found.asking.shared,
    )  # fmt: skip


def _attributes(found: _Found) -> Iterator[Question]:
    for word, owners in wording.askable(found.scene):
        yield _spoken(found, Kind.ATTRIBUTE, wording.asks_for([word], found.scene), (word,), owners)


def _both(found: _Found) -> Iterator[Question]:
    for (one, own), (other, theirs) in combinations(wording.askable(found.scene), 2):
        members = tuple(sorted(set(own) & set(theirs)))
        if members and len(members) < min(len(own), len(theirs)):
            words = (other, one) if wording.is_noun(one, found.scene) else (one, other)
            yield _spoken(found, Kind.ATTRIBUTES, wording.asks_for(words, found.scene), words, members)


def _regions(found: _Found) -> Iterator[Question]:
    for said, holds in regions(found.table):
        members = tuple(np.flatnonzero(holds > 0.5).tolist())
        if not 0 < len(members) < found.size:
            continue
        yield Question(
            kind=Kind.REGION, said=said, chances=yes_no(holds, found.truth), members=members, seconds=SPEAKING,
            shared=found.asking.shared,
        )  # fmt: skip


def _pairs(found: _Found) -> Iterator[Question]:
    """Yield a question for each item and its two nearest neighbours."""
    apart = found.table.distances + np.diag(np.full(found.size, np.inf))
    nearest = np.argsort(apart, axis=1, kind="stable")[:, : min(2, found.size - 1)]
    near = sorted({(min(one, other), max(one, other)) for one in range(found.size) for other in nearest[one].tolist()})
    for pair in near if found.size > 2 else []:
        yield Question(
            kind=Kind.PAIR, said=wording.THESE_TWO, chances=yes_no(understood(pair, found.taken), found.truth),
            members=pair, seconds=POINTING, shared=found.asking.shared,
        )  # fmt: skip


def _open(found: _Found) -> Iterator[Question]:
    """Yield "what is it like?" where words tell items apart, with those words that do so most evenly."""
    size, named = found.size, list[tuple[str, tuple[int, ...]]]()
    for word, owners in sorted(wording.askable(found.scene), key=lambda each: abs(2 * len(each[1]) - size)):
        trial = [own for _, own in (*named, (word, owners))]
        if max(sum(item in own for own in trial) for item in range(size)) <= MOST_NAMED:
            _, keys = described(trial, size, found.asking.names, found.asking.slips)
            if len(keys) <= MOST_DESCRIPTIONS:
                named.append((word, owners))
    if not named:
        return
    chances, keys = described([owners for _, owners in named], size, found.asking.names, found.asking.slips)
    texts = tuple(" ".join(word for bit, (word, _) in enumerate(named) if key >> bit & 1) for key in keys)
    yield Question(
        kind=Kind.OPEN, said=wording.WHAT_LIKE, chances=chances, answers=texts, words=tuple(word for word, _ in named),
        seconds=LISTENING, shared=found.asking.shared,
    )  # fmt: skip


def _repeat(found: _Found) -> Iterator[Question]:
    """Yield "sorry, what did you say?": a word more of the request (Eq. 5)."""
    problem = Problem(found.scene)
    if len(problem.words) < 2:
        return
    chances, texts = list[Vector](), list[str]()
    for owners, words in problem.words_by_owners().items():
        mass = np.full(found.size, problem.tables.alpha)
        mass[list(owners)] += 1.0
        chances.append(len(words) * mass * problem.tables.smoothing)
        texts.append(" ".join(problem.words[word] for word in words))
    yield Question(
        kind=Kind.REPEAT, said=wording.WHAT_SAID, chances=np.stack(chances), answers=tuple(texts), seconds=SPEAKING,
        shared=found.asking.shared,
    )  # fmt: skip

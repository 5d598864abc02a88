"""From the words that were heard to clauses of tokens: phrases of the lexicon and words of the table's items.

A word that neither knows is matched against both by its letters (a misspelling, a plural); what stays unknown is noise
that costs confidence, and is reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from fetch_pomdp.core.language.reading.chart import Token
from fetch_pomdp.core.language.reading.grammar import BREAKS, LONGEST, Grammar

MOST_WORDS = 120  # of an utterance; the rest is not read
MOST_IN_CLAUSE = 26  # words; a longer clause is cut
STOP = "."
ID = "#"  # before an id that is used as a word
UNKNOWN = 1.0  # cost of a word that nobody knows
_TEXT = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*|[.;!?]")
_HYPHEN = re.compile(r"[-’']")
_LETTER = re.compile(r"[^\W\d_]")
# The cost of leaving out a word, by what it might have been: little for those that only join others.
SKIPPED = {
    "to": 0.15, "of": 0.15, "in": 0.15, "from": 0.3, "and": 0.1, "dir": 0.2, "sidenoun": 0.3, "table": 0.2, "it": 0.4,
    "have": 0.4, "n": 0.6, "person": 1.0, "poss": 0.8, "verb": 0.1, "look": 0.2, "more": 0.1, "skip": 0.5, "away": 0.4,
    "its": 0.4, "them": 0.5, "those": 0.5,
}  # fmt: skip
ENDS = ("w", "n", "together", "alone", "crowd")  # categories of words that no "the" follows in the same description
CONTENT = 1.6  # and of any other


def words_of(text: str) -> tuple[str, ...]:
    """Return the words of a written text in lower case, with the ends of its sentences as "." between them."""
    return tuple(STOP if word in ".;!?" else word for word in _TEXT.findall(text.lower().replace("’", "'")))


@dataclass(frozen=True, slots=True)
class Clause:
    """A part of an utterance that says one thing.

    kind: how it begins: "verb" (what is wanted), "look" (what there is), "more" (about the same), "skip" (what is not
    wanted), or "" for none of these. skips: the cost of leaving out each word. unknown: words that nobody knows.
    """

    kind: str
    words: tuple[str, ...]
    tokens: tuple[Token, ...]
    skips: tuple[float, ...]
    unknown: tuple[str, ...] = field(default=())


@dataclass(frozen=True, slots=True, eq=False)
class Vocabulary:
    """The words of a table's items.

    named: the words that some of the items have; general: those that every item has, which tell nothing; ids: the names
    of items as they stand on a screen, as words.
    """

    named: frozenset[str]
    general: frozenset[str]
    ids: Mapping[tuple[str, ...], str]
    every: frozenset[str] = field(init=False)  # named and general
    openers: frozenset[str] = field(init=False)  # the first words of names of several words

    def __post_init__(self) -> None:
        every = self.named | self.general
        several = {name.split()[0] for name in every if " " in name.strip()}
        object.__setattr__(self, "every", every)
        object.__setattr__(self, "openers", frozenset(several | {words[0] for words in self.ids}))

    @classmethod
    def of(cls, vocabularies: Sequence[Iterable[str]], ids: Iterable[str] = ()) -> Vocabulary:
        """Return that of items with these vocabularies and ids; an id without a letter is none that is said."""
        sets = [frozenset(words) for words in vocabularies]
        everything = frozenset[str]().union(*sets)
        general = sets[0].intersection(*sets) if len(sets) > 1 else frozenset[str]()
        known = {tuple(_HYPHEN.sub(" ", id.lower().replace("_", " ")).split()): id for id in ids if _LETTER.search(id)}
        return cls(everything - general, general, {words: id for words, id in known.items() if len(words) > 1})

    def has(self, word: str, grammar: Grammar) -> bool:
        """Return whether some of the items may be called so: as their word, or one that stands for it."""
        if word in self.every or not self.every.isdisjoint(grammar.synonyms.get(word, ())):
            return True
        return word in grammar.colours and not self.every.isdisjoint(grammar.colours)


def clauses(words: Sequence[str], vocabulary: Vocabulary, grammar: Grammar) -> list[Clause]:
    """Return the clauses of an utterance. words: lower case; "." ends a sentence, where that is known."""
    words = _without_ignored(_split_hyphens(words[:MOST_WORDS], vocabulary, grammar), grammar)
    found: list[Clause] = []
    kind, begin, place = "", 0, 0
    while place <= len(words):
        ends = place == len(words) or words[place] == STOP
        size, broken = (1, "") if ends else _break_at(words, place, grammar, vocabulary)
        if ends or broken or place - begin >= MOST_IN_CLAUSE:
            if place > begin or kind:
                found.append(_clause(kind, words[begin:place], vocabulary, grammar))
            kind = broken
            if not (ends or broken):
                begin = place
                continue
            place += size
            begin = place
            continue
        place += size
    return [each for each in found if each.words or each.kind]


def _split_hyphens(words: Sequence[str], vocabulary: Vocabulary, grammar: Grammar) -> list[str]:
    result: list[str] = []
    for word in words:
        whole = word in vocabulary.named or (word,) in grammar.lexicon or word in grammar.known
        result += [word] if whole or not _HYPHEN.search(word) else [part for part in _HYPHEN.split(word) if part]
    return result


def _without_ignored(words: Sequence[str], grammar: Grammar) -> list[str]:
    result: list[str] = []
    place = 0
    while place < len(words):
        size = next(
            (
                size
                for size, leaves in grammar.phrases(words, place)
                if any(leaf.category == "ignored" for leaf in leaves)
            ),
            0,
        )
        result += [] if size else [words[place]]
        place += size or 1
    return result


def _break_at(words: Sequence[str], place: int, grammar: Grammar, vocabulary: Vocabulary) -> tuple[int, str]:
    """Return how many words begin a clause there, and what kind of clause that is; "" where none begins."""
    if words[place] in vocabulary.named:
        return 1, ""
    for size, leaves in grammar.phrases(words, place):
        return size, next((leaf.category for leaf in leaves if leaf.category in BREAKS), "")
    return 1, ""


def _clause(kind: str, words: Sequence[str], vocabulary: Vocabulary, grammar: Grammar) -> Clause:
    known = [_resolved(word, vocabulary, grammar) for word in words]
    here = [list(_leaves_at(known, place, vocabulary, grammar)) for place in range(len(known))]
    inside = {place for leaves in here for start, end, _, _ in leaves for place in range(start, end)}
    noise = [word in grammar.noise for word in known]
    empty = [noise[place] or place not in inside for place in range(len(known))]
    begins = [word in grammar.determiners for word in known]
    tokens = [
        Token(start, stop, category, value)
        for leaves in here
        for start, end, category, value in leaves
        for stop in _stops(end, here, empty, begins if category in ENDS else ())
    ]
    tokens += [
        Token(place, stop, "det", known[place])
        for place in sorted({token.end for token in tokens if token.category in ENDS})
        if place < len(known) and begins[place]
        for stop in _stops(place + 1, here, empty)
    ]
    # What says nothing at the beginning belongs to the first token.
    lead = next((place for place, each in enumerate(empty) if not each), 0)
    tokens += [Token(0, token.end, token.category, token.value) for token in tokens if lead and token.start == lead]
    skips = [0.1 if said and leaves else 0.0 for leaves, said in zip(here, noise, strict=True)]
    for start, end, category, value in (leaf for leaves in here for leaf in leaves):
        if (category, value) != ("num", "1"):
            said = sum(not noise[place] for place in range(start, end))
            for place in range(start, end):
                cost = SKIPPED.get(category, CONTENT) / max(said, 1)
                skips[place] = skips[place] if noise[place] else max(skips[place], cost)
    unknown = []
    for place, word in enumerate(known):
        if empty[place] and not noise[place] and word not in grammar.known and word not in vocabulary.general:
            unknown.append(words[place])
            skips[place] = UNKNOWN
    return Clause(kind, tuple(words), tuple(tokens), tuple(skips), tuple(unknown))


_Leaf = tuple[int, int, str, str]  # start, end, category, value


def _stops(end: int, here: Sequence[Sequence[_Leaf]], empty: Sequence[bool], begins: Sequence[bool] = ()) -> list[int]:
    """Return where a token that ends at `end` may end: what says nothing after it is a part of it, unless a phrase
    begins there. begins: words ("the") up to which alone it may go on.
    """
    stops = []
    place = end
    while place < len(empty) and empty[place] and not (begins and begins[place]):
        if here[place]:
            stops.append(place)
        place += 1
    return [*stops, place]


def _leaves_at(words: Sequence[str], place: int, vocabulary: Vocabulary, grammar: Grammar) -> Iterable[_Leaf]:
    word = words[place]
    for size, leaves in reversed(tuple(grammar.phrases(words, place))):
        for leaf in leaves:
            if (
                leaf.category not in BREAKS
                and leaf.category != "ignored"
                and not (size == 1 and leaf.category == "n" and _owned(word, vocabulary))
            ):
                yield place, place + size, leaf.category, leaf.value
    if word in vocabulary.general and (word,) not in grammar.lexicon:
        yield place, place + 1, "n", word
    elif word not in vocabulary.general and vocabulary.has(word, grammar):
        yield place, place + 1, "w", word
    if word not in vocabulary.openers and word not in grammar.openers:
        return
    for size in range(2, min(LONGEST, len(words) - place) + 1):
        phrase = tuple(words[place : place + size])
        if phrase in vocabulary.ids:
            yield place, place + size, "w", ID + vocabulary.ids[phrase]
        elif vocabulary.has(" ".join(phrase), grammar):
            yield place, place + size, "w", " ".join(phrase)


def _owned(word: str, vocabulary: Vocabulary) -> bool:
    return word in vocabulary.named


def _resolved(word: str, vocabulary: Vocabulary, grammar: Grammar) -> str:
    """Return the word that is meant: itself where it is known, else the known one that is spelt most like it."""
    mine = vocabulary.every
    if word in mine or word in grammar.known or vocabulary.has(word, grammar):
        return word
    stems = tuple(uninflected(word, grammar))
    for stem in stems:
        if vocabulary.has(stem, grammar):
            return stem
    if word in grammar.synonyms or word in grammar.colours:
        return word  # a word that is known, and that no item may be called
    own = sorted(mine)
    found = nearest(word, own) or nearest(word, grammar.spellings)
    return found or next(filter(None, (nearest(stem, own) for stem in stems)), word)


def uninflected(word: str, grammar: Grammar) -> Iterable[str]:
    """Yield what a word may be the plural, or another inflected form, of."""
    for ending, instead in grammar.endings:
        if word.endswith(ending) and len(word) > len(ending) + 1:
            yield word.removesuffix(ending) + instead


def nearest(word: str, among: Iterable[str]) -> str | None:
    """Return the word that differs least in its letters, by one of four to six or two of more; None if none does.

    Of several the first. Each letter that one has and the other has not is a difference.
    """
    most = 0 if len(word) < 4 else 1 if len(word) < 7 else 2
    best, found, letters = most + 1, None, set(word)
    low, high = max(len(word) - most, 4), len(word) + most
    for other in among if most else ():
        if low <= len(other) <= high and len(letters.difference(other)) <= most >= len(set(other) - letters):
            distance = _differing(word, other, best)
            if distance < best:
                best, found = distance, other
    return found


def _differing(one: str, other: str, most: int) -> int:
    """Return how many letters differ (Damerau: two exchanged count once), or `most` where they are as many or more."""
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, start=1):
        previous, before, row = before, row, [i]
        for j, against in enumerate(other, start=1):
            cost = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != against))
            if i > 1 and j > 1 and letter == other[j - 2] and one[i - 2] == against:
                cost = min(cost, previous[j - 2] + 1)
            row.append(cost)
        if min(row) >= most:
            return most
    return min(row[-1], most)

"""Answers as people give them: from the words heard to the words of Eq. 6, and to what was meant.

Phrases are looked for from left to right, and the longest wins. What says yes or no becomes a response of the paper's
lists, unless its own words are that already; another meaning becomes the one word that stands for it (`STAND_INS`),
which is no evidence about the item. So what an observation holds is read by the paper's reader alone, and a recorded
interaction does not change when more phrases are understood.

Choice: of answers that contradict each other in what is heard at once the last ones count ("yes, no" is no, "no,
that's right" is yes, "no, I don't know" is unsure): people correct themselves, and "no" often begins what is no denial.
Answers that agree are read one by one, as in Eq. 6.

Choice: words that are part of other talk too ("right", "okay", "what", "that one") are an answer only while a question
is open, and if nothing else is said; "no, that one" is a no. Words that confirm or deny ("correct", "wrong one") may
have a description after them, but are none where they are part of one ("the correct one"). A word that items of the
scene own is an answer only where nothing else is said.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

from fetch_pomdp.core.language import english, german
from fetch_pomdp.core.language.names import with_names
from fetch_pomdp.core.language.phrases import Answers, Entry, Phrases, When, plain, spellings
from fetch_pomdp.core.language.words import MEANINGS, NEGATIVE, RESPONSES, STAND_INS, STOPS, Meaning, tokenize

HESITATIONS = english.HESITATIONS | german.HESITATIONS
AROUND = HESITATIONS | english.AROUND | german.AROUND
DETERMINERS = english.DETERMINERS | german.DETERMINERS
FOLLOWERS = english.FOLLOWERS | german.FOLLOWERS | english.NOUNS | german.NOUNS
NEGATORS = english.NEGATORS | german.NEGATORS
ADVERBS = english.ADVERBS | german.ADVERBS
REQUESTS = english.REQUESTS | german.REQUESTS
OTHERS = english.OTHERS | german.OTHERS

DECISIVE = frozenset({Meaning.YES, Meaning.NO, Meaning.UNSURE, Meaning.CANCEL})
DENIALS = frozenset({Meaning.NO, Meaning.OBJECT})
EVERY = frozenset(Meaning)


class After(Enum):
    """What the words that are read follow."""

    NOTHING = "nothing"  # that is open
    QUESTION = "question"  # "this one?", not answered yet
    HANDED = "handed"  # a hand-over, done or stopped, that the person may object to


@dataclass(frozen=True, slots=True)
class Reading:
    """The words of an observation, and what an answer among them means."""

    words: tuple[str, ...]
    meaning: Meaning | None = None


class AnswerReader(Protocol):
    """What an interaction asks about the words that it hears; they are lower case, as `words` gives them."""

    def words(self, text: str) -> tuple[str, ...]:
        """Return the words of a text that was heard."""
        ...

    def read(self, words: Sequence[str], after: After) -> Reading:
        """Return them as the words of an observation."""
        ...

    def answering(self, words: Sequence[str]) -> frozenset[int]:
        """Return which of them answer a question, by index."""
        ...

    def objects(self, words: Sequence[str]) -> bool:
        """Return whether they stop a hand-over."""
        ...


class PaperAnswers:
    """The AnswerReader of the paper's two lists, word by word: for people who speak no other words."""

    def words(self, text: str) -> tuple[str, ...]:
        """Return the words of a text."""
        return tokenize(text)

    def read(self, words: Sequence[str], after: After) -> Reading:
        """Return the words as they are; after a pick that was stopped, those that stopped it as a no."""
        if after is After.HANDED:
            words = [STAND_INS[Meaning.NO] if word in STOPS else word for word in words]
        found = [MEANINGS[word] for word in words if word in RESPONSES]
        return Reading(tuple(words), found[-1] if found else None)

    def answering(self, words: Sequence[str]) -> frozenset[int]:
        """Return the indices of response words."""
        return frozenset(index for index, word in enumerate(words) if word in RESPONSES)

    def objects(self, words: Sequence[str]) -> bool:
        """Return whether there is a word that denies or stops."""
        return not STOPS.union(NEGATIVE).isdisjoint(words)


PAPER = PaperAnswers()


def asks_for_another(words: Sequence[str], answers: AnswerReader) -> bool:
    """Return whether somebody who got an item wants another beside it: "and now the other one", "give me another".

    So they ask, and nothing but "other" would stop the hand-over.
    """
    rest = [word for word in words if plain(word) not in OTHERS]
    asks = any(plain(word) in REQUESTS for word in rest)
    return asks and len(rest) < len(words) and not answers.objects(rest)


@dataclass(frozen=True, slots=True)
class _Found:
    """A phrase among the words, from `start` to before `end`."""

    start: int
    end: int
    meaning: Meaning | None


@dataclass(frozen=True, slots=True, eq=False)
class Lexicon:
    """The AnswerReader of people: phrases in English and German, those of a scene, and its items' names (`names`).

    owned: the words of the scene's items.
    """

    phrases: Phrases
    owned: frozenset[str] = frozenset()

    def words(self, text: str) -> tuple[str, ...]:
        """Return the words of a text."""
        return tokenize(text)

    def read(self, words: Sequence[str], after: After) -> Reading:
        """Return the words of an observation, and what was meant."""
        words = with_names(words, self.owned)
        found = self._found(words, after)
        if after is After.HANDED:
            found = [_Found(each.start, each.end, _denied(each.meaning)) for each in found]
        kept, meaning = _resolved(found)
        result: list[str] = []
        place = 0
        for each in found:
            result += words[place : each.start]
            if each in kept and each.meaning is not None:
                result += self._written(words[each.start : each.end], each.meaning)
            place = each.end
        return Reading((*result, *words[place:]), meaning)

    def answering(self, words: Sequence[str]) -> frozenset[int]:
        """Return the indices of words that say yes, no or unsure."""
        return self.places(words, After.QUESTION, frozenset({Meaning.YES, Meaning.NO, Meaning.UNSURE}))

    def places(self, words: Sequence[str], after: After, meanings: frozenset[Meaning]) -> frozenset[int]:
        """Return the indices of the words of phrases that have one of these meanings."""
        found = [each for each in self._found(words, after) if each.meaning in meanings]
        return frozenset(index for each in found for index in range(each.start, each.end))

    def objects(self, words: Sequence[str]) -> bool:
        """Return whether any of them denies or stops."""
        return any(each.meaning in DENIALS for each in self._found(words, After.HANDED))

    def _found(self, words: Sequence[str], after: After) -> list[_Found]:
        """Return the phrases in order. Those that count alone are first taken for answers, then weighed."""
        scan = _Scan(self, words, after)
        found = scan.phrases(EVERY)
        covered = {index for each in found for index in range(each.start, each.end)}
        if any(index not in covered and word not in AROUND for index, word in enumerate(scan.plain)):
            return scan.phrases(frozenset())
        if any(each.meaning in {Meaning.NO, Meaning.UNSURE} for each in found):
            return scan.phrases(EVERY - {Meaning.YES})
        return found

    def _written(self, words: Sequence[str], meaning: Meaning) -> list[str]:
        """Return a phrase as the paper's reader reads it: as it is, if it reads that as meant wherever it stands."""
        responses = {MEANINGS[word] for word in words if word in RESPONSES}
        anywhere = {each.meaning for each in self._found(words, After.NOTHING)}
        if responses == anywhere == {meaning} and self.owned.isdisjoint(words):
            return list(words)
        return [] if STAND_INS[meaning] in self.owned else [STAND_INS[meaning]]


class _Scan:
    """Looks for phrases in some words; in a time that grows with their number alone, for phrases have a longest."""

    def __init__(self, lexicon: Lexicon, words: Sequence[str], after: After) -> None:
        self._phrases, self._owned, self._words, self._after = lexicon.phrases, lexicon.owned, words, after
        self._longest = max(map(len, self._phrases), default=0)
        self.plain = [plain(word) for word in words]
        # A phrase may be said with hesitations in it: where the words are without them, and which comes next.
        self._fluent = [index for index, word in enumerate(self.plain) if word not in HESITATIONS]
        self._order = {index: order for order, index in enumerate(self._fluent)}

    def phrases(self, alone: frozenset[Meaning]) -> list[_Found]:
        """Return the phrases, left to right and longest first. alone: the meanings that count if said alone."""
        found: list[_Found] = []
        index = 0
        while index < len(self.plain):
            each = self._longest_at(index, alone)
            if each is not None:
                found.append(each)
            index = index + 1 if each is None else each.end
        return found

    def _longest_at(self, start: int, alone: frozenset[Meaning]) -> _Found | None:
        near = range(start, min(start + self._longest, len(self.plain)))
        found = self._matched(near, alone)
        if start in self._order:
            order = self._order[start]
            fluent = self._matched(self._fluent[order : order + self._longest], alone)
            if fluent is not None and (found is None or fluent.end > found.end):
                return fluent
        return found

    def _matched(self, places: Sequence[int], alone: frozenset[Meaning]) -> _Found | None:
        key = tuple(self.plain[place] for place in places)
        for size in range(len(key), 0, -1):
            entry = self._phrases.get(key[:size])
            if entry is not None:
                start, end = places[0], places[size - 1] + 1
                meaning = self._meaning(entry, start)
                if self._counts(Entry(meaning, entry.when), start, end, alone):
                    return _Found(start, end, meaning)
        return None

    def _meaning(self, entry: Entry, start: int) -> Meaning | None:
        """Return what a phrase means there: what confirms denies after "not"."""
        if entry.meaning is not Meaning.YES or entry.when is When.ALWAYS:
            return entry.meaning
        before = start - 1
        if before >= 0 and self.plain[before] in ADVERBS:
            before -= 1
        return Meaning.NO if before >= 0 and self.plain[before] in NEGATORS else Meaning.YES

    def _counts(self, entry: Entry, start: int, end: int, alone: frozenset[Meaning]) -> bool:
        if self._after is After.HANDED and entry.meaning in DENIALS:
            return True
        if all(word in self._owned for word in self._words[start:end]):
            return self._after is not After.NOTHING and entry.meaning in alone
        if entry.when is When.ALWAYS:
            return True
        if self._after is After.NOTHING:
            return False
        return entry.meaning in alone if entry.when is When.ALONE else not self._describes(start, end)

    def _describes(self, start: int, end: int) -> bool:
        if end - start == 1 and start and self.plain[start - 1] in DETERMINERS:
            return True
        return end < len(self.plain) and (self.plain[end] in FOLLOWERS or self._words[end] in self._owned)


def _denied(meaning: Meaning | None) -> Meaning | None:
    return Meaning.NO if meaning is Meaning.OBJECT else meaning


def _resolved(found: Sequence[_Found]) -> tuple[frozenset[_Found], Meaning | None]:
    """Return the phrases that count, and what they mean together."""
    meanings = [each.meaning for each in found if each.meaning is not None]
    decisive = [meaning for meaning in meanings if meaning in DECISIVE]
    if not decisive:
        return frozenset(found), meanings[-1] if meanings else None
    last, kept, open_ = decisive[-1], set[_Found](), True
    for each in reversed(found):
        if each.meaning in DECISIVE:
            open_ = open_ and each.meaning is last
            if not open_:
                continue
        kept.add(each)
    return frozenset(kept), last


def lexicon(answers: Answers, owned: Sequence[str] = ()) -> Lexicon:
    """Return the lexicon of a scene that adds `answers`, and whose items own the words `owned`."""
    added = answers.phrases()
    return Lexicon({**_ours(), **added} if added else _ours(), frozenset(owned))


@functools.lru_cache
def _ours() -> Phrases:
    found: dict[tuple[str, ...], Entry] = {}
    for language in (german.GERMAN, english.ENGLISH):
        for entry, phrases in language.items():
            for phrase in phrases.split(","):
                found |= dict.fromkeys(spellings(phrase), entry)
    return found

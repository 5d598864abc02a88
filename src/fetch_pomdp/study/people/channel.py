"""What is heard of what a person says: a channel that misses utterances and mistakes words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from numpy.random import Generator

from fetch_pomdp.core.language.words import COURTESY, NEGATIVE, POSITIVE, RESPONSES
from fetch_pomdp.core.ports import Word
from fetch_pomdp.study.people.grammar import chosen
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.people.traits import Mood, shifted

# In the order of a list: a set's order of words changes from run to run.
INSERTED = (*sorted(COURTESY), *POSITIVE, *NEGATIVE)
SHORTEST = 0.01  # s, an inserted word


class Channel(Protocol):
    """From what a person says at once to what a recogniser hears of it.

    A channel keeps nothing from one utterance to the next but what it has computed before, so that the same random
    numbers give the same words.
    """

    def hear(self, said: Sequence[Word], *, distance: float, voice: int, rng: Generator) -> Sequence[Word]:
        """Return the words heard, in order and none before the first word said; none if all was missed.

        said: one word or more, in order, on the clock of the stream. distance: m, from the person to the items.
        voice: a number that is the person's own.
        """
        ...


@dataclass(frozen=True, slots=True)
class MistakenWords:
    """A channel by rates: each utterance is missed by distance, each word changed by the table of confusions.

    scene_words: those that may be heard in place of each other. A word is deleted, or else changed, or else right;
    after it another may be inserted.
    """

    people: People
    mood: Mood
    scene_words: tuple[str, ...]

    def hear(self, said: Sequence[Word], *, distance: float, voice: int, rng: Generator) -> Sequence[Word]:  # noqa: ARG002
        """Return the words heard; see Channel."""
        answers = any(word.text in RESPONSES for word in said)
        at_one_metre = self.mood.p_lost if answers else self.mood.p_miss
        if rng.random() < miss_chance(at_one_metre, distance, self.people.miss_per_doubling):
            return ()
        return tuple(heard for word in said for heard in self._heard(word, rng))

    def _heard(self, word: Word, rng: Generator) -> Iterator[Word]:
        people = self.people
        inserted = rng.random() < people.p_insert
        end = max(word.start, word.end - SHORTEST) if inserted else word.end
        if rng.random() >= people.p_delete:
            yield Word(self._mistaken(word.text, rng), word.start, end)
        if inserted:
            yield Word(chosen((*INSERTED, *self.scene_words), rng), end, word.end)

    def _mistaken(self, text: str, rng: Generator) -> str:
        left = rng.random()
        for heard, chance in self.people.confusions.get(text, {}).items():
            left -= chance
            if left < 0.0:
                return heard
        if text in self.scene_words and len(self.scene_words) > 1 and rng.random() < self.people.p_substitute:
            place = self.scene_words.index(text) + 1 + int(rng.random() * (len(self.scene_words) - 1))
            return self.scene_words[place % len(self.scene_words)]
        return text


def miss_chance(at_one_metre: float, distance: float, per_doubling: float) -> float:
    """Return the chance that an utterance is missed at a distance (m): its logit grows by as much at each doubling."""
    return shifted(at_one_metre, per_doubling * math.log2(distance))

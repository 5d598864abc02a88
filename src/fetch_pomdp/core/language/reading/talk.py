"""What a reader makes of what was said in the middle of a talk: answers are recognised by the lexicon
(`language.answers`), and what is said beside them is read by the reader.

Choice: "not" and "other" before more words are no answer but belong to these: "no, not the red one" is an answer and a
description. What the reader knows and what tells the items apart by nothing ("give me something") counts as nothing
said, as in the paper, unless it is a word of the table: "the marker" is a request where all items are markers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.language import english, german
from fetch_pomdp.core.language.answers import AROUND, EVERY, After, Lexicon, Reading
from fetch_pomdp.core.language.names import with_names
from fetch_pomdp.core.language.reading.reader import Context, Reader
from fetch_pomdp.core.language.reading.tokens import STOP, words_of
from fetch_pomdp.core.language.unigram import Utterance, base_log_likelihood
from fetch_pomdp.core.language.words import COURTESY, RESPONSES, Meaning
from fetch_pomdp.core.observation import Said
from fetch_pomdp.core.problem import Problem

DESCRIBING = english.DESCRIBING | german.DESCRIBING
TELLS = 1e-3  # nats between two items, from which on words tell something of them


@dataclass(frozen=True, slots=True, eq=False)
class AsHeard:
    """The AnswerReader of words that a reader will read: they are left as they were heard."""

    lexicon: Lexicon

    def words(self, text: str) -> tuple[str, ...]:
        """Return the words of a text, with the ends of its sentences."""
        return words_of(text)

    def read(self, words: Sequence[str], after: After) -> Reading:
        """Return the words as they are, with the names of items among them (`names`), and what was meant."""
        return Reading(with_names(words, self.lexicon.owned), self.lexicon.read(_spoken(words), after).meaning)

    def answering(self, words: Sequence[str]) -> frozenset[int]:
        """Return the indices of words that say yes, no or unsure."""
        return self.lexicon.answering(words)

    def objects(self, words: Sequence[str]) -> bool:
        """Return whether any of them denies or stops."""
        return self.lexicon.objects(_spoken(words))


@dataclass(frozen=True, slots=True)
class Moment:
    """Where in a talk something is said: what it follows, the item asked about last, and what was going on."""

    after: After
    asked: int | None
    context: Context


def said_by(reader: Reader, words: tuple[str, ...], lexicon: Lexicon, moment: Moment, problem: Problem) -> Said:
    """Return what an utterance says as a reader reads it. words: lower case, as `AsHeard.words` gives them."""
    said, content = divided(words, lexicon, moment.after, asked=moment.asked is not None)
    answer, response = said.meaning, tuple(word for word in said.words if word in RESPONSES)
    if not any(word != STOP for word in content):
        return Said(Utterance((), response, (), answer), base_log_likelihood((), problem))
    heard = reader.read(content, problem.scene, moment.context.after_question(moment.asked))
    unknown = tuple(word for word in heard.unknown if word not in AROUND and word not in COURTESY)
    if not (np.ptp(heard.log_likelihood) >= TELLS or any(word in problem.word_index for word in content)):
        return Said(Utterance((), response, unknown, answer), base_log_likelihood((), problem), heard)
    known = tuple(word for word in content if word not in heard.unknown and word != STOP)
    return Said(Utterance(known, response, unknown, answer), heard.log_likelihood, heard)


def _spoken(words: Sequence[str]) -> tuple[str, ...]:
    return tuple(word for word in words if word != STOP)


def divided(
    words: tuple[str, ...], answers: Lexicon, after: After, *, asked: bool = False
) -> tuple[Reading, tuple[str, ...]]:
    """Return the answers in what was said, and the words beside them that describe an item.

    asked: whether there was a question, be it answered. Where none is open, words are an answer only if nothing else is
    said, or if they end the request.
    """
    spoken = _spoken(words)
    found = answers.places(spoken, after, EVERY) if spoken else frozenset[int]()
    kept = {
        index for index in found if spoken[index] in DESCRIBING and index + 1 < len(spoken) and index + 1 not in found
    }
    said = tuple(word for index, word in enumerate(spoken) if index in found - kept)
    if not said:
        return Reading(()), words
    answer = answers.read(said, after)
    rest = [word for index, word in enumerate(spoken) if index not in found - kept and word not in AROUND]
    if after is After.NOTHING and answer.meaning is not Meaning.CANCEL and (rest or not asked):
        return Reading(()), words
    places = [place for place, word in enumerate(words) if word != STOP]
    gone = {places[index] for index in found - kept}
    return answer, tuple(word for place, word in enumerate(words) if place not in gone)

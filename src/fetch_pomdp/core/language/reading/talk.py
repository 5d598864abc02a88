"""A talk about a table: what all that was said so far, the answers among it, say of each item.

Answers are recognised by the lexicon (`language.answers`); what is said beside them is read by a reader. A correction
("no wait, the green one", "actually the bowl") takes back what words and answers said before it.

Choice: "not" and "other" before more words are no answer but belong to these: "no, not the red one" is an answer and a
description.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language import english, german
from fetch_pomdp.core.language.answers import After, Lexicon, lexicon
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader
from fetch_pomdp.core.language.reading.tokens import STOP, words_of
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.scene import Scene

DESCRIBING = english.DESCRIBING | german.DESCRIBING


@dataclass(frozen=True, slots=True, eq=False)
class Talk:
    """What was said about a scene. Immutable.

    words, answers: (n_items,), log-likelihoods of all that was said, up to a constant. asked: the item of the question
    that is open. heard: what the reader made of the last words.
    """

    scene: Scene
    reader: Reader
    context: Context = field(default_factory=Context)
    asked: int | None = None
    words: Vector = field(default_factory=lambda: np.zeros(0))
    answers: Vector = field(default_factory=lambda: np.zeros(0))
    heard: Heard | None = None

    def __post_init__(self) -> None:
        for name in ("words", "answers"):
            if not len(getattr(self, name)):
                object.__setattr__(self, name, np.zeros(len(self.scene.items)))

    @property
    def chances(self) -> Vector:
        """The probability of each item, (n_items,), if all were as likely before."""
        log = self.words + self.answers
        chances = np.exp(log - log.max())
        return np.asarray(chances / chances.sum())

    def ask(self, item: int) -> Talk:
        """Return the talk after the robot pointed at an item and asked "this one?"."""
        return dataclasses.replace(self, asked=item, context=self.context.after_question(item))

    def say(self, text: str) -> Talk:
        """Return the talk after somebody said something."""
        answer, content = divided(words_of(text), lexicon(self.scene.answers, self.scene.words), self.asked is not None)
        talk = self._answered(answer)
        heard = self.reader.read(content, self.scene, self.context)
        if heard.corrects:
            none = np.zeros(len(self.scene.items))
            talk = dataclasses.replace(talk, words=none, answers=none)
        return dataclasses.replace(talk, words=talk.words + heard.log_likelihood, context=heard.context, heard=heard)

    def _answered(self, answer: Meaning | None) -> Talk:
        """Return the talk after an answer to the open question (Eq. 6, Table I)."""
        if self.asked is None or answer not in {Meaning.YES, Meaning.NO}:
            return self
        true = self.scene.model.p_truth
        desired, other = (true, 1.0 - true) if answer is Meaning.YES else (1.0 - true, true)
        said = np.full(len(self.scene.items), math.log(other))
        said[self.asked] = math.log(desired)
        return dataclasses.replace(self, answers=self.answers + said, asked=None)


def divided(words: tuple[str, ...], answers: Lexicon, asked: bool) -> tuple[Meaning | None, tuple[str, ...]]:
    """Return the answer in what was said, if a question is open, and the words beside it that describe an item."""
    spoken = tuple(word for word in words if word != STOP)
    if not asked or not spoken:
        return None, words
    places = [place for place, word in enumerate(words) if word != STOP]
    found = answers.answering(spoken)
    kept = {
        index for index in found if spoken[index] in DESCRIBING and index + 1 < len(spoken) and index + 1 not in found
    }
    gone = {places[index] for index in found - kept}
    content = tuple(word for place, word in enumerate(words) if place not in gone)
    said = tuple(word for index, word in enumerate(spoken) if index in found - kept)
    return answers.read(said, After.QUESTION).meaning if said else None, content

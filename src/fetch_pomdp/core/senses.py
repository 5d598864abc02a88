"""Ears and eyes, read step by step: which words and which arm belong to a step.

Choice: answers that end before the question has been asked cannot answer it; they belong to the step before, and are
read with the i_r of that step. Other words of that time mean the same in either step, and are read with the later one.
In real life the arm shows the item before the voice has ended: an answer that ends within `Timing.overlap` before the
end of the question answers it. Words that follow an early answer within `CONTINUES` are the rest of it, and no phrase
that answers the question.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fetch_pomdp.checks import FARTHEST
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.hearing import texts, understood
from fetch_pomdp.core.language.answers import After, AnswerReader
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.ports import Frame, Recognizer, SkeletonSource, UtteranceRecognizer, Word
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import nearest_angles

CONTINUES = 0.3  # s of silence after an early answer, within which what follows is the rest of it


class Pace(Protocol):
    """Where an interaction's time comes from, and who is told of a decision before it is carried out."""

    def decided(self, decision: Decision) -> None:
        """Know of a decision; its action begins now."""
        ...

    def time(self, due: float) -> float:
        """Return what time (s) it is when that is over which should take until `due` (s)."""
        ...


class StreamPace:
    """The Pace of recordings and of simulated people: everything ends when it should."""

    def decided(self, decision: Decision) -> None:
        """Tell nobody."""

    def time(self, due: float) -> float:
        """Return `due`."""
        return due


class Senses:
    """Ears and eyes, either may be missing, read step by step."""

    def __init__(self, problem: Problem, ears: Recognizer | None, eyes: SkeletonSource | None, pace: Pace) -> None:
        self._problem, self._ears, self._eyes, self._pace = problem, ears, eyes, pace
        self._kept: tuple[Word, ...] = ()
        self._answered: float | None = None  # s, when an answer of this step ended that came early

    def answers(self, time: float, reader: AnswerReader, after: After) -> Observed | None:
        """Return the answers said since the last call, if any; other words mean the same later, and are kept."""
        words = tuple(self._ears.hear(time)) if self._ears else ()
        places = [index for index, word in enumerate(words) for _ in texts([word])]
        answering = {places[index] for index in reader.answering(texts(words))}
        answers = tuple(words[index] for index in sorted(answering))
        self._kept += tuple(word for index, word in enumerate(words) if index not in answering)
        if not answers:
            return None
        self._answered = answers[-1].end
        return Observed(understood(answers, reader, after), answers, time, early=True)

    def perceive(self, due: float, reader: AnswerReader, after: After) -> Observed:
        """Listen until `due` (s), or on to the end of an utterance that goes on then; return what was said and seen
        since the last call, without early answers.
        """
        if isinstance(self._ears, UtteranceRecognizer):
            due = self._ears.utterance_end(due)
        fresh = tuple(self._ears.hear(due)) if self._ears else ()
        rest = _continuing(fresh, self._answered)
        unread, words = self._kept + fresh[len(rest) :], self._kept + fresh
        self._kept, self._answered = (), None
        time = self._pace.time(due)
        frames = self._eyes.see(time) if self._eyes else ()
        ray = median_ray(frames, self._problem)
        return Observed(understood(unread, reader, after, ray, before=texts(rest)), words, time)


def _continuing(words: Sequence[Word], end: float | None) -> tuple[Word, ...]:
    """Return the words at the beginning that go on with what ended at `end` (s), each close upon the last."""
    rest: list[Word] = []
    for word in words:
        if end is None or word.start > end + CONTINUES:
            break
        rest.append(word)
        end = word.end
    return tuple(rest)


def median_ray(frames: Sequence[Frame], problem: Problem) -> Ray | None:
    """Return the median of the frames that point at the table, or None if none does.

    Choice: in each frame the arm counts that is nearest in angle to an item, and the median is taken of each
    coordinate, of the heads and of the arms' unit directions.
    """
    if not frames:
        return None
    heads, wrists = pointing_arms(frames, problem)
    if not len(heads):
        return None
    arms = wrists - heads
    head = np.median(heads, axis=0)
    arm = np.median(arms / np.linalg.norm(arms, axis=1, keepdims=True), axis=0)
    return None if not arm.any() else Ray(tuple(head.tolist()), tuple((head + arm).tolist()))


def pointing_arms(frames: Sequence[Frame], problem: Problem) -> tuple[Vector, Vector]:
    """Return the head and wrist (m) of each arm that points at the table, (n, 3) each, at most one a frame.

    Raises ObservationError for an arm that is no Ray.
    """
    arms = [(frame.head, wrist) for frame in frames for wrist in frame.wrists]
    heads, wrists = np.array(arms, dtype=np.float64).reshape(-1, 2, 3).swapaxes(0, 1).copy()
    if not _are_rays(heads, wrists):
        for head, wrist in arms:
            Ray(head, wrist)  # raises for the first that has no length
    nearest = nearest_angles(heads, wrists, problem.positions).tolist()
    best, first = [], 0
    for frame in frames:
        after = first + len(frame.wrists)
        if after > first:
            best.append(min(range(first, after), key=nearest.__getitem__))
        first = after
    kept = [arm for arm in best if nearest[arm] <= problem.model.gesture_threshold]
    return heads[kept], wrists[kept]


def _are_rays(heads: Vector, wrists: Vector) -> bool:
    arms = wrists - heads
    near = max(np.abs(heads).max(initial=0.0), np.abs(wrists).max(initial=0.0)) <= FARTHEST
    return bool(near and np.einsum("ij,ij->i", arms, arms).min(initial=1.0) > 1e-17)

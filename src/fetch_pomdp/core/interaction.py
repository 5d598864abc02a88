"""One interaction on real input: sensors to Agent to robot, until an item is handed over.

Time is that of the sensors' streams, in seconds. A step begins with an action and ends with listening:

- A wait listens for `Timing.wait`.
- A question takes `Timing.question`, of which the last `Timing.listen` is listening.
- The words that end inside a step are its utterance; the median of its pointing frames is its gesture.
- Nothing is decided in the middle of an utterance: where the ears can tell, as with recordings, the step goes on to its
  end.

Choice: answers that end before the question has been asked cannot answer it; they belong to the step before, and are
read with the i_r of that step. Other words of that time mean the same in either step, and are read with the later one.
In real life the arm shows the item before the voice has ended: an answer that ends within `Timing.overlap` before the
end of the question answers it. Words that follow an early answer within `CONTINUES` are the rest of it, and no phrase
that answers the question.

Choice: a pick that the person stopped was shown to them like a question, and they objected: its item is i_r from then
on, and what they stopped it with that the model does not know ("stop", "wrong one") is read as "no".

Choice: after `Timing.silence` of waits without a word the robot says that it is listening: a person who has said all
there is to say cannot know that it waits for more, and the paper saw interactions come to a standstill there (Section
V).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fetch_pomdp.checks import FARTHEST
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.answers import After, AnswerReader
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.ports import Failure, Frame, Outcome, Recognizer, Robot, SkeletonSource, UtteranceRecognizer, Word
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import nearest_angles
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.errors import ModelError

LISTENING = "I am listening."
FAILED = "I could not hand it over. Please tell me again."
OBJECTED = "All right, not that one."
CONTINUES = 0.3  # s of silence after an early answer, within which what follows is the rest of it


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """How long the robot's steps last. Raises ModelError for a question shorter than the listening at its end."""

    wait: float = 1.0  # s
    question: float = 2.8  # s, asking and then listening for `listen`
    silence: float = 4.0  # s
    listen: float = 1.0  # s
    overlap: float = 0.0  # s before a question has been asked from which on an answer to it is possible
    before: float = 0.0  # s of listening before the first decision

    def __post_init__(self) -> None:
        times = (self.wait, self.listen, self.question, self.silence)
        if not (all(0 < time < float("inf") for time in times) and self.listen <= self.question):
            found = f"found wait {self.wait!r}, listen {self.listen!r}, question {self.question!r}"
            expected = "expected 0 < wait, 0 < listen <= question and 0 < silence, in seconds"
            raise ModelError(f"{found}, silence {self.silence!r}, {expected}", field="timing")
        if not 0 <= self.before < float("inf"):
            raise ModelError(f"found {self.before!r} s before the first decision, expected 0 or more", field="timing")
        if not 0 <= self.overlap <= self.question - self.listen:
            found = f"found an overlap of {self.overlap!r} s"
            raise ModelError(f"{found}, expected one from 0 to question - listen", field="timing")


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
        places = [index for index, word in enumerate(words) for _ in tokenize(word.text)]
        answering = {places[index] for index in reader.answering(texts(words))}
        answers = tuple(words[index] for index in sorted(answering))
        self._kept += tuple(word for index, word in enumerate(words) if index not in answering)
        if not answers:
            return None
        self._answered = answers[-1].end
        return Observed(Observation(reader.read(texts(answers), after).words), answers, time, early=True)

    def perceive(self, due: float, reader: AnswerReader, after: After) -> Observed:
        """Listen until `due` (s), or on to the end of an utterance that goes on then; return what was said and seen
        since the last call, without early answers.
        """
        if isinstance(self._ears, UtteranceRecognizer):
            due = self._ears.utterance_end(due)
        fresh = tuple(self._ears.hear(due)) if self._ears else ()
        rest = _continuing(fresh, self._answered)
        read = texts(rest) + reader.read(texts(self._kept + fresh[len(rest) :]), after).words
        words, self._kept, self._answered = self._kept + fresh, (), None
        time = self._pace.time(due)
        frames = self._eyes.see(time) if self._eyes else ()
        return Observed(Observation(read, median_ray(frames, self._problem)), words, time)


def _continuing(words: Sequence[Word], end: float | None) -> tuple[Word, ...]:
    """Return the words at the beginning that go on with what ended at `end` (s), each close upon the last."""
    rest: list[Word] = []
    for word in words:
        if end is None or word.start > end + CONTINUES:
            break
        rest.append(word)
        end = word.end
    return tuple(rest)


def texts(words: Sequence[Word]) -> tuple[str, ...]:
    """Return the words of an utterance as they were heard."""
    return tuple(text for word in words for text in tokenize(word.text))


def ended(observed: Observed, due: float) -> float:
    """Return when (s) a step ended that was due at a time, or went on to the end of an utterance."""
    return due if observed.time is None else max(due, observed.time)


def following(event: Event, agent: Agent) -> After:
    """Return what the words follow that are heard after an event that the agent has taken."""
    return After.STOPPED if isinstance(event, Acted) and event.objected else agent.after


def interact(
    agent: Agent,
    robot: Robot,
    ears: Recognizer | None,
    eyes: SkeletonSource | None,
    *,
    timing: Timing | None = None,
    most_steps: int = MOST_STEPS,
    pace: Pace | None = None,
    answers: AnswerReader | None = None,
) -> Iterator[Event]:
    """Run an interaction and yield what happens as it happens; it ends with a pick that was done, or after most_steps.

    A pick that failed or was stopped ends nothing: the robot says so, listens for a wait, and decides anew. pace: that
    of recordings unless given. answers: how they are read, by the scene's lexicon unless given.
    """
    timing, pace, answers = timing or Timing(), pace or StreamPace(), answers or agent.answers
    senses, now, silence = Senses(agent.problem, ears, eyes, pace), pace.time(0.0), 0.0
    if timing.before:
        observed = senses.perceive(now + timing.before, answers, agent.after)
        now = pace.time(ended(observed, now + timing.before))
        agent.take(observed)
        yield observed
    for _ in range(most_steps):
        decision, listening, asking = agent.decide(), timing.wait, 0.0
        pace.decided(decision)
        if isinstance(decision.action, Point):
            asking, listening = timing.question - timing.listen, timing.listen
        result = _carry_out(decision.action, agent, robot)
        now = pace.time(now + asking)
        if isinstance(decision.action, Point) and (early := senses.answers(now - timing.overlap, answers, agent.after)):
            agent.take(early)
            yield early
        acted = _acted(decision, result, now)
        agent.take(acted)
        yield acted
        if isinstance(acted.action, Pick):
            if acted.done:
                return
            robot.say(OBJECTED if acted.objected else FAILED)
            now = pace.time(now)
        observed = senses.perceive(now + listening, answers, following(acted, agent))
        now = pace.time(ended(observed, now + listening))
        agent.take(observed)
        silence = silence + timing.wait if isinstance(acted.action, Wait) and not observed.observation.words else 0.0
        if silence >= timing.silence:
            robot.say(LISTENING)
            silence = 0.0
        yield observed


def _carry_out(action: Action, agent: Agent, robot: Robot) -> Outcome | Failure:
    item = agent.item(action)
    if item is None:
        return Outcome.DONE
    return robot.pick(item) if isinstance(action, Pick) else robot.point(item)


def _acted(decision: Decision, result: Outcome | Failure, time: float) -> Acted:
    outcome, reason = (Outcome.FAILED, result.reason) if isinstance(result, Failure) else (result, "")
    return Acted(decision.action, outcome, decision, time, decision.passes, reason)


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

"""Interactions on real input: sensors to Agent to robot, until an item is handed over, and on if more is said then.

Time is that of the sensors' streams, in seconds. A step begins with an action and ends with listening:

- A wait listens for `Timing.wait`.
- A question takes `Timing.question`, of which the last `Timing.listen` is listening.
- The words that end inside a step are its utterance; the median of its pointing frames is its gesture (`senses`).
- Nothing is decided in the middle of an utterance: where the ears can tell, as with recordings, the step goes on to its
  end.

Choice: a pick that the person stopped was shown to them like a question, and they objected: its item is i_r from then
on, and what they stopped it with that the model does not know ("stop", "wrong one") is read as "no". So was one that
they give back: after a hand-over the robot listens on for `Timing.after`, takes back what is objected to and goes on
with what it has learnt, and begins anew with a second request.

Choice: after `Timing.silence` of waits without a word the robot says that it is listening: a person who has said all
there is to say cannot know that it waits for more, and the paper saw interactions come to a standstill there (Section
V). If nothing of what was said is understood, it says what would be. A question that is asked for the third time is
asked in other words, and what to say is said.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fetch_pomdp.checks import shown
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.agent import Agent, Understood
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.hearing import texts, understood
from fetch_pomdp.core.language.answers import After, AnswerReader, asks_for_another
from fetch_pomdp.core.language.names import is_name
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.ports import Failure, Outcome, Recognizer, Robot, SkeletonSource
from fetch_pomdp.core.senses import Pace, Senses, StreamPace
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.errors import ActionError, ModelError

LISTENING = "I am listening."
FAILED = "I could not hand it over. Please tell me again."
OBJECTED = "All right, not that one."
CANCELLED = "All right."
ASKING_AGAIN = "Is it this one that you want? Please say yes or no."
NOT_UNDERSTOOD = "I did not understand that. I know: "
MOST_KNOWN = 12  # words that the robot says it knows


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """How long the robot's steps last. Raises ModelError for a question shorter than the listening at its end."""

    wait: float = 1.0  # s
    question: float = 2.8  # s, asking and then listening for `listen`
    silence: float = 4.0  # s
    listen: float = 1.0  # s
    overlap: float = 0.0  # s before a question has been asked from which on an answer to it is possible
    before: float = 0.0  # s of listening before the first decision
    after: float = 0.0  # s of silence after a hand-over, for which the robot listens on; may be infinite

    def __post_init__(self) -> None:
        times = (self.wait, self.listen, self.question, self.silence)
        if not (all(0 < time < float("inf") for time in times) and self.listen <= self.question):
            found = f"found wait {self.wait!r}, listen {self.listen!r}, question {self.question!r}"
            expected = "expected 0 < wait, 0 < listen <= question and 0 < silence, in seconds"
            raise ModelError(f"{found}, silence {self.silence!r}, {expected}", field="timing")
        if not 0 <= self.before < float("inf"):
            raise ModelError(f"found {self.before!r} s before the first decision, expected 0 or more", field="timing")
        if not self.after >= 0:
            raise ModelError(f"found {self.after!r} s after a hand-over, expected 0 or more", field="timing")
        if not 0 <= self.overlap <= self.question - self.listen:
            found = f"found an overlap of {self.overlap!r} s"
            raise ModelError(f"{found}, expected one from 0 to question - listen", field="timing")


def ended(observed: Observed, due: float) -> float:
    """Return when (s) a step ended that was due at a time, or went on to the end of an utterance."""
    return due if observed.time is None else max(due, observed.time)


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

    A pick that failed or was stopped ends nothing: the robot says so, listens for a wait, and decides anew. With
    `Timing.after` it listens on after a hand-over; each further request has most_steps of its own. pace: that of
    recordings unless given. answers: how they are read, by the scene's lexicon unless given. Raises ActionError for a
    robot that returns no outcome.
    """
    timing, pace, answers = timing or Timing(), pace or StreamPace(), answers or agent.answers
    senses = Senses(agent.problem, ears, eyes, pace)
    return _Interaction(agent, robot, senses, timing, pace, answers).events(most_steps)


class _Interaction:
    """The loop, and what it knows from step to step."""

    def __init__(
        self, agent: Agent, robot: Robot, senses: Senses, timing: Timing, pace: Pace, answers: AnswerReader
    ) -> None:
        self._agent, self._robot, self._senses = agent, robot, senses
        self._timing, self._pace, self._answers = timing, pace, answers
        self._now, self._silence = pace.time(0.0), 0.0
        self._lowered = agent.handed is not None  # whether the arm was, since the item was handed over

    def events(self, most_steps: int) -> Iterator[Event]:
        if self._timing.before and self._agent.handed is None:
            observed = self._listened(self._timing.before, self._agent.after)
            yield self._taken(observed)
        steps = 0
        while self._agent.handed is not None or steps < most_steps:
            if self._agent.handed is None:
                steps += 1
                yield from self._step()
                continue
            if self._timing.after:
                yield from self._listen_on()
            if self._agent.handed is not None:
                return
            steps = 0

    def _step(self) -> Iterator[Event]:
        agent, timing = self._agent, self._timing
        decision, listening, asking = agent.decide(), timing.wait, 0.0
        self._pace.decided(decision)
        if isinstance(decision.action, Point):
            asking, listening = timing.question - timing.listen, timing.listen
            if agent.unanswered >= 2:
                self._robot.say(ASKING_AGAIN)
        outcome = self._carry_out(decision.action)
        self._now = self._pace.time(self._now + asking)
        if isinstance(decision.action, Point):
            early = self._senses.answers(self._now - timing.overlap, self._answers, agent.after)
            if early is not None:
                yield self._taken(early)
        acted = self._acted(decision, outcome)
        yield acted
        if isinstance(acted.action, Pick):
            if acted.done:
                self._silence, self._lowered = 0.0, False
                return
            self._robot.say(OBJECTED if acted.objected else FAILED)
            self._now = self._pace.time(self._now)
        observed = self._listened(listening, agent.after)
        taken = self._taken(observed)
        self._reply(observed, agent.understood, waited=isinstance(acted.action, Wait))
        yield taken

    def _acted(self, decision: Decision, result: Outcome | Failure) -> Acted:
        outcome, reason = (Outcome.FAILED, result.reason) if isinstance(result, Failure) else (result, "")
        acted = Acted(decision.action, outcome, decision, self._now, decision.passes, reason)
        self._agent.take(acted)
        return acted

    def _taken(self, observed: Observed) -> Observed:
        """Let the agent take in what was observed; return it with what was read in it."""
        self._agent.take(observed)
        return dataclasses.replace(observed, read=self._agent.understood.read)

    def _listened(self, seconds: float, after: After) -> Observed:
        """Listen for some time, or on to the end of an utterance."""
        observed = self._senses.perceive(self._now + seconds, self._answers, after)
        self._now = self._pace.time(ended(observed, self._now + seconds))
        return observed

    def _listen_on(self) -> Iterator[Event]:
        """Listen after a hand-over until what is said begins something, or for long enough; yield what it began."""
        handed, silence = self._agent.handed, 0.0
        while silence < self._timing.after and handed is not None:
            observed = self._listened(self._timing.wait, After.HANDED)
            words, ray = texts(observed.words), observed.observation.ray
            silence = 0.0 if words else silence + self._timing.wait
            objects = self._answers.read(words, After.HANDED).meaning is Meaning.NO
            if objects and not asks_for_another(words, self._answers):
                yield self._taken_back(handed, observed)
                yield self._taken(observed)
                return
            begun = dataclasses.replace(
                observed, observation=understood(observed.words, self._answers, After.NOTHING, ray), anew=True
            )
            more = objects or self._agent.begun().quick().understand(begun.observation).utterance.base
            if more or (ray is not None and self._lowered):
                yield self._taken(begun)
                return
            self._lowered = self._lowered or ray is None
            self._reply(observed, self._agent.quick().understand(observed.observation), waited=False)

    def _taken_back(self, item: int, objection: Observed) -> Acted:
        """Take an item back; that counts from the time of the objection, which is read after it."""
        self._robot.say(OBJECTED)
        self._robot.take_back(self._agent.scene.items[item])
        self._now = self._pace.time(self._now)
        acted = Acted(Pick(item), Outcome.RETURNED, time=objection.time)
        self._agent.take(acted)
        return acted

    def _reply(self, observed: Observed, heard: Understood, *, waited: bool) -> None:
        """Say what a person has to know who was not understood, or who is silent."""
        said = heard.utterance
        silent = waited and not observed.observation.words and self._agent.after is After.NOTHING
        self._silence = self._silence + self._timing.wait if silent else 0.0
        if said.meaning is Meaning.CANCEL and not said.base:
            self._robot.say(CANCELLED)
        elif heard.lost:
            self._robot.say(not_understood(self._agent.problem.words))
        elif self._silence >= self._timing.silence:
            self._robot.say(LISTENING)
            self._silence = 0.0

    def _carry_out(self, action: Action) -> Outcome | Failure:
        item = self._agent.item(action)
        if item is None:
            return Outcome.DONE
        result = self._robot.pick(item) if isinstance(action, Pick) else self._robot.point(item)
        if not isinstance(result, Outcome | Failure):
            name = "pick" if isinstance(action, Pick) else "point"
            raise ActionError(f"found {shown(result)}, expected an Outcome or a Failure", field=f"robot.{name}")
        return result


def not_understood(words: Sequence[str]) -> str:
    """Return what the robot says where it understands nothing. words: those that it knows; names are seen anyway."""
    plain = [word for word in words if not is_name(word)]
    return NOT_UNDERSTOOD + ", ".join(plain[:MOST_KNOWN]) + (", ..." if len(plain) > MOST_KNOWN else ".")

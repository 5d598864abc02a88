"""A simulated person before a robot: events on the clock of the stream, heard and seen through the ports of the core.

The person asks, points, answers, corrects and loses patience; the robot on the other side of these ports takes the
time that its durations say. What the person does depends on what the robot did and when, not on how often it listens.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from numpy.random import Generator

from fetch_pomdp.core.ports import Frame, Outcome, Word
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people import grammar, pointing
from fetch_pomdp.study.people.channel import Channel, MistakenWords
from fetch_pomdp.study.people.grammar import Words
from fetch_pomdp.study.people.traits import Traits, draw_mood, log_normal
from fetch_pomdp.study.people.wording import WORDINGS

Plan = tuple[float, Callable[[float], None]]  # when (s), and what


class Person:
    """Somebody who wants an item. Implements Recognizer, SkeletonSource and Robot.

    desired: index of the item. channel: what is heard of what is said; MistakenWords unless given.
    """

    def __init__(
        self,
        scene: Scene,
        desired: int,
        traits: Traits,
        clock: Durations,
        rng: Generator,
        channel: Channel | None = None,
    ) -> None:
        self._scene, self._desired, self._traits, self._clock, self._rng = scene, desired, traits, clock, rng
        self._asked: Item | None = None  # the item of the last question, as the person read it
        self._wanted = scene.items[desired]
        self._mood = draw_mood(traits, rng)
        self._channel = channel or MistakenWords(traits.people, self._mood, scene.words)
        self._distance = math.fsum(math.dist(scene.head, item.position) for item in scene.items) / len(scene.items)
        self._now = 0.0  # s, up to when the robot has listened
        self._speaks_until = self._points_until = 0.0  # s
        self._next: Plan | None = None  # people have one thing in mind at a time
        self._heard: deque[tuple[float, Word]] = deque()  # words with the time (s) at which the recogniser gives them
        self._seen: deque[Frame] = deque()
        self._request: Words = ()
        self.begun = traits.people.begin_delay * self._varied()  # s, the first word of the first request
        self._plan(self.begun, self._ask)

    def hear(self, until: float) -> Sequence[Word]:
        """Return the words that the recogniser has given by a time (s); see Recognizer."""
        self._live(until)
        words = []
        while self._heard and self._heard[0][0] <= until:
            words.append(self._heard.popleft()[1])
        return words

    def see(self, until: float) -> Sequence[Frame]:
        """Return the frames given by a time (s), which there are only while an arm is up; see SkeletonSource."""
        self._live(until)
        seen, until = [], until - self._traits.people.sight_latency
        while self._seen and self._seen[0].time <= until:
            seen.append(self._seen.popleft())
        return seen

    def point(self, item: Item) -> Outcome:
        """Be asked "this one?" by a robot that begins now; the person then has nothing in mind but the answer.

        Who has not begun to say what they want says that first, as they would have.
        """
        if not self._request:
            self._ask(self.begun)
        put = self._now + self._clock.think + self._clock.arm + self._clock.speak
        asked = self._asked = self._read(item)
        people = self._traits.people
        delay = self._traits.answer_delay * self._varied()
        if self._rng.random() < people.p_late:
            delay += people.late_delay * self._varied()
        self._plan(put + delay, lambda time: self._answer(asked, time))
        return Outcome.DONE

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Be handed an item: it is over, whatever it is."""
        self._next = None
        return Outcome.DONE

    def take_back(self, item: Item) -> Outcome:  # noqa: ARG002
        """Give an item back: these people keep what they got."""
        return Outcome.FAILED

    def say(self, text: str) -> Outcome:  # noqa: ARG002
        """Be told that the robot listens; some then say again what they want."""
        if self._rng.random() < self._traits.people.p_heed:
            self._plan(self._now + self._traits.answer_delay * self._varied(), self._ask)
        return Outcome.DONE

    def stop(self) -> None:
        """Do nothing: this robot's actions are over when they return."""

    def _live(self, until: float) -> None:
        while self._next and self._next[0] <= until:
            time, act = self._next
            self._next = None
            act(time)
        self._now = max(self._now, until)

    def _plan(self, time: float, act: Callable[[float], None]) -> None:
        """Have in mind to do something at a time (s), instead of what it was before, but not while still speaking."""
        self._next = max(time, self._speaks_until), act

    def _varied(self) -> float:
        return log_normal(self._traits.people.delay_spread, self._rng)

    def _read(self, item: Item) -> Item:
        """Return the item that the person takes the robot to point at: the nearest to where its arm seems to be."""
        people, rng = self._traits.people, self._rng
        size = people.reading * math.sqrt(1.0 - people.reading_correlation)
        right, up = (common + size * rng.standard_normal() for common in self._mood.reading)
        head = self._scene.head
        return pointing.item_at(head, item, (right, up), self._scene.items)

    def _ask(self, time: float) -> None:
        """Say what is wanted, and point."""
        traits, rng = self._traits, self._rng
        if not self._request or rng.random() < traits.people.p_reword:
            self._request = WORDINGS[traits.people.grammar](self._desired, self._scene, traits, rng)
        self._say(self._request, time)
        if rng.random() < traits.p_point:
            self._raise_arm(time)

    def _answer(self, asked: Item, time: float) -> None:
        """Answer a question about an item, or do not."""
        traits, rng = self._traits, self._rng
        if rng.random() >= traits.p_answer:
            self._lose_patience_after(time)
        elif rng.random() < traits.people.p_unsure:
            self._say(grammar.UNSURE, time)
        elif rng.random() < self._mood.p_flip:
            self._err(asked, time)
        elif asked is self._wanted:
            self._say(grammar.affirmation(rng), time)
        else:
            self._deny(asked, time)

    def _deny(self, asked: Item, time: float) -> None:
        people, rng = self._traits.people, self._rng
        words = grammar.denial(rng)
        if rng.random() < people.p_elaborate:
            words += grammar.contrast(self._wanted, asked, people.contrast, rng)
        self._say(words, time)
        if rng.random() < people.p_point_again:
            self._raise_arm(time)

    def _err(self, asked: Item, time: float) -> None:
        """Say the wrong one of yes and no; some notice, and correct it unless the robot asks on."""
        people, rng = self._traits.people, self._rng
        right = asked is self._wanted
        self._say(grammar.denial(rng) if right else grammar.affirmation(rng), time)
        if rng.random() < people.p_correct:
            again = people.correct_delay * self._varied()
            self._plan(time + again, lambda later: self._correct(asked, later))

    def _correct(self, asked: Item, time: float) -> None:
        words = ("yes", "that", "one") if asked is self._wanted else ("no", "the", "other", "one")
        self._say(words, time)

    def _say(self, words: Words, time: float) -> None:
        """Say words from a time (s) on; if the robot does nothing for long after them, ask again."""
        traits, step = self._traits, self._traits.word_time
        said = tuple(Word(word, time + k * step, time + (k + 1) * step) for k, word in enumerate(words))
        heard = tuple(self._channel.hear(said, distance=self._distance, voice=traits.voice, rng=self._rng))
        self._speaks_until = max(word.end for word in (*said, *heard))
        given = self._speaks_until + traits.people.latency
        self._heard.extend((given, word) for word in heard)
        self._lose_patience_after(self._speaks_until)

    def _lose_patience_after(self, time: float) -> None:
        self._plan(time + self._traits.patience * self._varied(), self._again)

    def _again(self, time: float) -> None:
        """Say once more what seems not to have been understood: the answer, or what is wanted."""
        if self._asked is not None and self._rng.random() < self._traits.people.p_repeat_answer:
            self._answer(self._asked, time)
        else:
            self._ask(time)

    def _raise_arm(self, time: float) -> None:
        """Point at the item some time after the first word at `time` (s), unless the arm is up."""
        people, rng = self._traits.people, self._rng
        start = time + people.point_delay * self._varied()
        if start < self._points_until:
            return
        right, up = (own + people.bias_episode * rng.standard_normal() for own in self._traits.bias)
        episode = pointing.PointingGesture(
            start=start,
            rise=people.point_rise,
            held=people.point_time * self._varied(),
            bias=(right, up),
            jitter=math.hypot(people.jitter, people.tracker_noise * self._distance**2 / people.reach),
            jitter_time=people.jitter_time,
        )
        self._points_until = episode.end
        self._seen.extend(pointing.frames(episode, self._scene.head, self._wanted.position, people.reach, rng))

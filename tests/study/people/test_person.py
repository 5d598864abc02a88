"""A person on the clock of the stream, driven by hand through the ports."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import Generator, default_rng

from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE, RESPONSES
from fetch_pomdp.core.ports import Frame, Outcome, Recognizer, Robot, SkeletonSource, Word
from fetch_pomdp.study.people.parameters import CONFUSIONS, People
from fetch_pomdp.study.people.person import Person

from .plain import AMBIGUOUS, CLOCK, share, somebody, still, within

WANTED, TWIN, SPOON = AMBIGUOUS.items[3], AMBIGUOUS.items[2], AMBIGUOUS.items[4]
# begin_delay .5, word_time .35, latency .5, sight_latency .15, answer_delay .5, patience 7, and the clock's 1.9 s for
# a question (think .1, arm 1, speak .8): the numbers that the times below are made of.


def texts(words: Sequence[Word]) -> set[str]:
    return {word.text for word in words}


def answered(ask: Callable[[Person], Any], count: int = 600, **changes: Any) -> list[list[Word]]:
    """Let many people ask for the item, put a question to each at 5 s, and return what they say until 13.5 s."""
    rng, found = default_rng(3), []
    for _ in range(count):
        person = somebody(rng=rng, **changes)
        person.hear(5.0)
        ask(person)
        found.append(list(person.hear(13.5)))
    return found


def test_a_person_is_ears_eyes_and_robot() -> None:
    ears: Recognizer = somebody()
    eyes: SkeletonSource = somebody()
    robot: Robot = somebody()
    robot.stop()
    assert not list(ears.hear(0.0))
    assert not list(eyes.see(0.0))
    assert robot.pick(WANTED) is robot.point(WANTED) is robot.say("I am listening.") is Outcome.DONE


def test_a_request_by_hand() -> None:
    person = somebody()
    assert person.begun == pytest.approx(0.5)
    words = person.hear(6.9)
    assert "marker" in texts(words)
    assert [word.start for word in words] == pytest.approx([0.5 + 0.35 * k for k in range(len(words))])
    assert [word.end for word in words] == pytest.approx([0.85 + 0.35 * k for k in range(len(words))])


def test_words_are_given_when_the_silence_after_them_has_ended_the_utterance() -> None:
    count = len(somebody().hear(6.0))
    given = 0.5 + 0.35 * count + 0.5
    person = somebody()
    assert list(person.hear(given - 0.01)) == []
    assert len(person.hear(given + 0.01)) == count


def test_pointing_by_hand() -> None:
    # Arm off at .5 + .27, up at 1.07, held till 2.63, down at 2.93; seen .15 s later.
    person = somebody()
    assert list(person.see(0.77 + 0.15)) == []
    first = person.see(0.81 + 0.15)
    assert [frame.time for frame in first] == pytest.approx([0.8])
    rest = person.see(6.0)
    assert rest[-1].time == pytest.approx(2.9)
    assert len(rest) == 63
    assert somebody(p_point=0.0).see(20.0) == []


def test_a_silent_robot_is_asked_again_after_the_patience_and_again() -> None:
    words = somebody().hear(60.0)
    count = next(k for k, (one, other) in enumerate(pairwise(words), 1) if other.start - one.end > 1.0)
    starts = [word.start for word in words[::count]]
    period = 0.35 * count + 7.0
    assert starts == pytest.approx([0.5 + k * period for k in range(len(starts))])
    assert len(starts) == math.ceil(59.0 / period)
    repeated = [word.text for word in words]
    assert repeated == repeated[:count] * len(starts), "p_reword is 0"


def test_a_repeated_request_may_be_worded_anew() -> None:
    words = somebody(p_reword=1.0, descriptors=(0.0, 0.5, 0.5)).hear(200.0)
    assert len({word.text for word in words}) > 8


def test_a_question_is_put_when_its_words_end_and_answered_after_the_delay() -> None:
    person = somebody()
    person.hear(6.0)
    assert person.point(WANTED) is Outcome.DONE
    assert list(person.hear(6.0 + 1.9)) == []
    words = person.hear(12.0)
    assert words[0].start == pytest.approx(6.0 + 1.9 + 0.5)
    assert texts(words) & RESPONSES <= {*POSITIVE}
    assert texts(words) & RESPONSES


def test_nobody_repeats_a_request_once_the_robot_moves() -> None:
    person = somebody()
    words = person.hear(6.0)
    lost_at = words[-1].end + 7.0
    person.hear(lost_at - 0.1)
    person.point(SPOON)
    assert min(word.start for word in person.hear(lost_at + 4.0)) == pytest.approx(lost_at - 0.1 + 1.9 + 0.5)


def test_an_answer_waits_for_the_end_of_what_is_being_said() -> None:
    person = somebody(answer_delay=0.0, word_time=2.0)
    person.hear(0.6)  # in the middle of the request
    person.point(WANTED)
    words = person.hear(60.0)
    first = next(k for k, word in enumerate(words) if word.text in RESPONSES)
    assert words[first].start == pytest.approx(words[first - 1].end)


def test_a_robot_that_asks_first_hears_the_request_and_then_the_answer() -> None:
    person = somebody()
    person.point(SPOON)  # at 0 s, before the request at 0.5 s
    words = person.hear(7.0)
    assert [word.text for word in words] == [word.text for word in somebody().hear(6.0)] + [words[-1].text]
    assert words[0].start == pytest.approx(person.begun)
    assert words[-1].text in NEGATIVE
    assert words[-1].start == pytest.approx(max(1.9 + 0.5, words[-2].end))


def test_a_wrong_item_is_denied() -> None:
    for words in answered(lambda person: person.point(SPOON)):
        assert texts(words) & RESPONSES <= {*NEGATIVE}
        assert texts(words) & RESPONSES


def test_denials_are_elaborated_with_words_that_tell_the_two_apart() -> None:
    found = answered(lambda person: person.point(SPOON), p_elaborate=0.4, contrast=20.0)
    told = [words for words in found if texts(words) & {*WANTED.vocabulary}]
    assert share(len(told) / 600, 0.4, 600)
    twins = answered(lambda person: person.point(TWIN), p_elaborate=1.0, contrast=20.0)
    assert all([word.text for word in words[-3:]] == ["the", "other", "one"] for words in twins)


def test_some_answers_are_wrong_and_some_are_not_given() -> None:
    flipped = answered(lambda person: person.point(WANTED), p_flip=0.2)
    assert share(sum(bool(texts(words) & {*NEGATIVE}) for words in flipped) / 600, 0.2, 600)
    silent = answered(lambda person: person.point(WANTED), p_answer=0.7)
    assert share(sum(not words for words in silent) / 600, 0.3, 600)
    unsure = answered(lambda person: person.point(WANTED), p_unsure=0.1)
    assert share(sum("don't" in texts(words) for words in unsure) / 600, 0.1, 600)


def test_a_flip_comes_back_within_a_trial_as_its_correlation_says() -> None:
    rng, count, both = default_rng(4), 1500, 0
    for _ in range(count):
        person = somebody(rng=rng, p_flip=0.3, flip_correlation=0.5)
        person.hear(5.0)
        said = []
        for until in (12.0, 19.0):
            person.point(WANTED)
            said.append(texts(person.hear(until)))
        both += all(words & {*NEGATIVE} for words in said)
    assert share(both / count, 0.3**2 + 0.5 * 0.3 * 0.7, count)


def test_some_answers_are_late() -> None:
    found = answered(lambda person: person.point(WANTED), p_late=0.3, late_delay=1.5)
    starts = [words[0].start for words in found]
    assert set(np.round(starts, 6)) == {7.4, 8.9}
    assert share(sum(start > 8.0 for start in starts) / 600, 0.3, 600)


def test_some_notice_a_wrong_answer_and_correct_it() -> None:
    found = answered(lambda person: person.point(TWIN), p_flip=1.0, p_correct=0.6, correct_delay=1.2)
    corrected = [words for words in found if "no" in texts(words)]
    assert share(len(corrected) / 600, 0.6, 600)
    for words in corrected:
        assert words[0].text in POSITIVE
        assert words[-4].start >= 7.4 + 1.2 - 1e-9
        assert [word.text for word in words[-4:]] == ["no", "the", "other", "one"]


def test_a_correction_is_dropped_when_the_robot_asks_on() -> None:
    person = somebody(p_flip=1.0, p_correct=1.0, correct_delay=3.0)
    person.hear(5.0)
    person.point(TWIN)
    person.hear(9.0)  # it would come at 10.4 s
    person.point(WANTED)
    assert person.hear(14.0)[0].start == pytest.approx(9.0 + 1.9 + 0.5)


def test_patience_lost_after_a_question_repeats_the_answer_or_the_request() -> None:
    for chance, expected in ((1.0, {*POSITIVE}), (0.0, {*WANTED.vocabulary})):
        person = somebody(p_repeat_answer=chance)
        person.hear(5.0)
        person.point(WANTED)
        person.hear(10.0)
        assert texts(person.hear(18.0)) & expected


def test_being_told_that_the_robot_listens_helps_only_who_heeds_it() -> None:
    for p_heed, start in ((1.0, 5.0 + 0.5), (0.0, None)):
        person = somebody(p_heed=p_heed)
        person.hear(5.0)
        person.say("I am listening.")
        again = person.hear(8.5)
        assert (again[0].start if again else None) == (start if start is None else pytest.approx(start))


def test_pointing_is_done_again_while_denying_as_often_as_told() -> None:
    rng, count, again = default_rng(6), 600, 0
    for _ in range(count):
        person = somebody(rng=rng, p_point_again=0.7)
        person.hear(5.0)
        person.see(5.0)
        person.point(SPOON)
        again += bool(person.see(11.0))
    assert share(again / count, 0.7, count)


def test_the_misheard_yes() -> None:
    found = answered(lambda person: person.point(WANTED), confusions=CONFUSIONS, count=2000)
    said = sum(word.text in ("yes", *CONFUSIONS["yes"]) for words in found for word in words[:1])
    hands = sum(words[0].text == "hand" for words in found)
    assert share(hands / said, CONFUSIONS["yes"]["hand"], said)


def test_an_arm_is_misread_with_its_spread_and_correlation() -> None:
    # Half the way to a neighbour is 0.0226 rad: P(|N(0, 0.02)| > 0.0226) = 0.258.
    found = answered(lambda person: person.point(WANTED), reading=0.02, count=1500)
    denied = sum(bool(texts(words) & {*NEGATIVE}) for words in found)
    chance = math.erfc(0.5 * 0.15 / math.dist(AMBIGUOUS.head, WANTED.position) / 0.02 / math.sqrt(2))
    assert within(denied / 1500, chance, 0.44, 1500)


def test_errors_of_reading_that_are_all_of_the_trial_come_back() -> None:
    rng = default_rng(9)
    for _ in range(100):
        person = somebody(rng=rng, reading=0.05, reading_correlation=1.0)
        person.hear(5.0)
        answers = []
        for until in (12.0, 19.0, 26.0):
            person.point(WANTED)
            answers.append(bool(texts(person.hear(until)) & {*NEGATIVE}))
        assert len(set(answers)) == 1


# Whatever the steps in which a robot listens.

LIVELY = People(
    p_flip=0.3, p_correct=0.7, p_late=0.3, p_heed=0.5, p_insert=0.2, p_delete=0.2, patience=2.0, p_miss=0.2, p_lost=0.1
)


def lived(seed: int, steps: Sequence[float]) -> tuple[list[Word], list[Frame]]:
    """Listen and look in steps, with two questions put at 6 s and 14 s, until 30 s."""
    rng = default_rng(seed)
    person = Person(AMBIGUOUS, 3, LIVELY.traits(rng), CLOCK, rng)
    words, frames = list[Word](), list[Frame]()
    for until in sorted({*steps, 6.0, 14.0, 30.0}):
        words += person.hear(until)
        frames += person.see(until)
        if until in (6.0, 14.0):
            person.point(SPOON if until == 6.0 else WANTED)
    return words, frames


@given(st.integers(0, 10**6), st.lists(st.floats(0.0, 30.0), max_size=20))
def test_words_and_frames_come_in_order_once_each_however_they_are_asked_for(seed: int, steps: list[float]) -> None:
    words, frames = lived(seed, steps)
    assert (words, frames) == lived(seed, [])
    times = [time for word in words for time in (word.start, word.end)]
    assert times == sorted(times)
    seen = [frame.time for frame in frames]
    assert all(one < other for one, other in pairwise(seen))


def test_nothing_is_given_before_it_was_said_or_shown() -> None:
    rng = default_rng(2)
    person = Person(AMBIGUOUS, 3, LIVELY.traits(rng), CLOCK, rng)
    for step in range(300):
        until = 0.1 * step
        assert all(word.end <= until for word in person.hear(until))
        assert all(frame.time <= until for frame in person.see(until))


def test_the_channel_handed_in_hears_what_is_said() -> None:
    class Deaf:
        said: list[tuple[str, ...]] = []  # noqa: RUF012

        def hear(self, said: Sequence[Word], *, distance: float, voice: int, rng: Generator) -> Sequence[Word]:
            del rng
            assert distance == pytest.approx(3.321, abs=0.01)
            assert voice >= 0
            self.said.append(tuple(word.text for word in said))
            return ()

    channel, rng = Deaf(), default_rng(0)
    person = Person(AMBIGUOUS, 3, still().traits(rng), CLOCK, rng, channel)
    assert list(person.hear(20.0)) == []
    assert len(channel.said) in (2, 3)
    assert "marker" in channel.said[0]

"""Utterances through real synthesis and real recognition."""

from __future__ import annotations

import math
import pickle
import shutil
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.adapters.speech import spoken as module
from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.adapters.speech.espeak import spoken
from fetch_pomdp.adapters.speech.spoken import AFTER, BEFORE, SpokenWords, in_noise
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import AudioError, MissingExtraError
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.encounter import encounter
from fetch_pomdp.study.people.channel import Channel
from fetch_pomdp.study.people.parameters import People

SCENE = Scene.load("ambiguous")
needs_sound = pytest.mark.skipif(
    not shutil.which("espeak-ng"), reason="espeak-ng is not installed: apt install espeak-ng"
)


def said(text: str, start: float = 3.0) -> tuple[Word, ...]:
    return tuple(Word(word, start + 0.35 * k, start + 0.35 * (k + 1)) for k, word in enumerate(text.split()))


def heard(channel: Channel, text: str, start: float = 3.0, distance: float = 1.0) -> Sequence[Word]:
    return channel.hear(said(text, start), distance=distance, voice=0, rng=default_rng(0))


@needs_sound
@pytest.mark.parametrize("text", ["yes", "no", "no the other one"])
def test_near_clear_answers_are_heard_at_their_time(text: str) -> None:
    pytest.importorskip("pocketsphinx")
    words = heard(SpokenWords(SCENE.words), text)
    assert words[0].text in ("yes", "no", "nope")
    assert [word.text for word in words[1:]] == text.split()[1:]
    times = [time for word in words for time in (word.start, word.end)]
    assert times == sorted(times)
    assert 3.0 <= times[0] < 3.2
    assert times[-1] < 3.0 + 0.35 * len(words) + 0.5


@needs_sound
def test_what_was_heard_once_is_looked_up_and_moves_with_the_utterance(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pocketsphinx")
    channel = SpokenWords(SCENE.words)
    first = heard(channel, "yes")
    copied = pickle.loads(pickle.dumps(channel))
    monkeypatch.setattr(module, "spoken", None)
    for again in (channel, copied):
        later = heard(again, "yes", start=7.0)
        assert [word.text for word in later] == [word.text for word in first]
        assert [word.start for word in later] == pytest.approx([word.start + 4.0 for word in first])


@needs_sound
def test_far_away_nothing_is_left_of_it() -> None:
    pytest.importorskip("pocketsphinx")
    assert "marker" in {word.text for word in heard(SpokenWords(SCENE.words), "give me the green marker")}
    far = heard(SpokenWords(SCENE.words), "give me the green marker", distance=40.0)
    assert "marker" not in {word.text for word in far}


@needs_sound
def test_a_study_takes_it_as_its_channel() -> None:
    pytest.importorskip("pocketsphinx")
    traits = People(descriptors=(0.0, 1.0), p_name=1.0).traits(default_rng(3))
    found = [
        encounter(
            Agent(SCENE, PaperAlwaysAsk()), 3, traits, Durations(), default_rng(1), channel=SpokenWords(SCENE.words)
        )
        for _ in range(2)
    ]
    words = [[event.words for event in one.events if hasattr(event, "words")] for one in found]
    assert words[0] == words[1]
    assert any(words[0])


@needs_sound
def test_a_voice_that_is_none() -> None:
    with pytest.raises(AudioError, match=r"^klingon-low: found .*expected a voice of espeak-ng"):
        spoken("yes", "klingon-low", 150)


@needs_sound
def test_faster_talk_is_shorter() -> None:
    slow, fast = (len(spoken("hand me the marker", "en-us", speed)) / RATE for speed in (100, 200))
    assert 1.5 * fast < slow < 2.5 * fast


def test_without_espeak_the_line_that_installs_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(MissingExtraError, match=r"apt install espeak-ng$"):
        heard(SpokenWords(SCENE.words), "yes")


@pytest.mark.parametrize("snr", [20.0, 5.0])
def test_noise_is_as_far_below_the_speech_as_told_and_all_around_it(snr: float) -> None:
    tone = np.asarray(4000 * np.sin(np.arange(2 * RATE)), np.int16)
    mixed = in_noise(tone, snr, 1).astype(float)
    assert len(mixed) == len(tone) + int(BEFORE * RATE) + int(AFTER * RATE)
    before, after = mixed[: int(BEFORE * RATE)], mixed[-int(AFTER * RATE) :]
    expected = 4000 / math.sqrt(2) * 10 ** (-snr / 20)
    for quiet in (before, after):
        assert np.sqrt(np.mean(quiet**2)) == pytest.approx(expected, rel=4 / math.sqrt(2 * len(quiet)))

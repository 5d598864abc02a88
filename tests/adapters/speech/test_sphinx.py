from __future__ import annotations

import io
import logging
import shutil
import subprocess
import wave
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE, open_raw, open_wav
from fetch_pomdp.adapters.speech.espeak import spoken
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.ports import Recognizer, Word
from tests.adapters.speech.sounds import DATA, VOCABULARY, samples_of, with_noise

pytest.importorskip("pocketsphinx")


def ears(samples: NDArray[np.int16]) -> SphinxRecognizer:
    return SphinxRecognizer(open_raw(io.BytesIO(samples.astype("<i2").tobytes())), VOCABULARY)


def aloud(text: str) -> SphinxRecognizer:
    """Return ears that hear a text as espeak-ng says it, in a quiet room."""
    return ears(with_noise(np.pad(spoken(text, "en-us", 150), RATE // 2), 30.0))


def texts(words: list[Word]) -> list[str]:
    return [word.text for word in words]


@pytest.fixture(scope="module")
def story() -> NDArray[np.int16]:
    """Return a request and an answer, with half a second of the room before, between and after."""
    return with_noise(np.concatenate([samples_of(DATA / "marker.wav"), samples_of(DATA / "no.wav")]))


@pytest.mark.parametrize("snr", [None, 20.0])
@pytest.mark.parametrize(("name", "said"), [("marker.wav", "hand me the marker"), ("no.wav", "no")])
def test_words_are_heard_in_order_where_they_were_said(name: str, said: str, snr: float | None) -> None:
    samples = samples_of(DATA / name)
    words = ears(samples if snr is None else with_noise(samples, snr)).hear(10.0)
    assert texts(words) == said.split()
    times = [time for word in words for time in (word.start, word.end)]
    assert times == sorted(times)
    assert times[0] > 0.4  # the file begins and ends with half a second of silence
    assert times[-1] < len(samples) / RATE - 0.3
    assert all(0 <= word.posterior <= 1 for word in words)


def test_many_small_steps_give_the_words_of_one_big_step_each_by_its_time(story: NDArray[np.int16]) -> None:
    at_once = ears(story).hear(60.0)
    assert texts(at_once) == ["hand", "me", "the", "marker", "no"]
    stepwise = ears(story)
    heard: list[Word] = []
    for step in range(80):
        until = step * 0.07
        words = stepwise.hear(until)
        assert all(word.end <= until for word in words)
        heard += words
    assert heard == at_once


def test_a_word_is_given_as_soon_as_asked_for_though_its_utterance_goes_on(story: NDArray[np.int16]) -> None:
    hand, *_, marker, _ = ears(story).hear(60.0)
    recognizer = ears(story)
    assert recognizer.hear(hand.end) == [hand]
    assert recognizer.hear(hand.end) == []
    assert recognizer.hear(marker.end)[-1] == marker


def test_after_the_end_there_is_silence(story: NDArray[np.int16]) -> None:
    recognizer: Recognizer = ears(story)
    assert len(recognizer.hear(60.0)) == 5
    assert list(recognizer.hear(120.0)) == []


def test_a_file_and_a_pipe_give_the_same_words() -> None:
    path = DATA / "marker.wav"
    assert SphinxRecognizer(open_wav(path), VOCABULARY).hear(10.0) == ears(samples_of(path)).hear(10.0)


@pytest.mark.parametrize("loudness", [0.0, 3.0, 300.0])
def test_zeros_and_noise_are_no_words(loudness: float) -> None:
    noise = np.random.default_rng(4).standard_normal(5 * RATE) * loudness
    assert ears(noise.astype(np.int16)).hear(10.0) == []


def test_other_talk_is_not_taken_for_a_request() -> None:
    words = ears(with_noise(samples_of(DATA / "weather.wav"))).hear(10.0)
    assert words
    assert not set(texts(words)) & {*VOCABULARY, "yes", "no", "not", "other"}


def test_a_word_without_a_pronunciation_is_warned_of_once(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        SphinxRecognizer(open_wav(DATA / "no.wav"), [*VOCABULARY, "größe", "spork"])
    (record,) = caplog.records
    assert "größe" in record.getMessage()
    assert "spork" not in record.getMessage()


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed: apt install espeak-ng")
def test_a_voice_at_another_rate_is_understood(tmp_path: Path) -> None:
    path = tmp_path / "spoon.wav"
    subprocess.run(["espeak-ng", "-v", "en-us", "-s", "150", "-w", str(path), "hand me the silver spoon"], check=True)
    with wave.open(str(path)) as file:
        assert file.getframerate() == 22050
    assert texts(SphinxRecognizer(open_wav(path), VOCABULARY).hear(10.0))[-2:] == ["silver", "spoon"]


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed: apt install espeak-ng")
@pytest.mark.parametrize(
    "said", ["the spoon to the left of the bowl", "give me the second one from the right", "the one next to the marker"]
)
def test_where_an_item_is_is_heard(said: str) -> None:
    heard = texts(aloud(said).hear(10.0))
    assert ["the" if word == "that" else word for word in heard] == said.split()  # the two say the same here


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed: apt install espeak-ng")
def test_what_is_no_sentence_to_the_robot_is_nothing_to_its_reader() -> None:
    words = texts(aloud("traffic is moving slowly on the bridge into town").hear(10.0))
    assert not set(words) & {*VOCABULARY, *grammar("english").known}


@pytest.mark.skipif(not shutil.which("flite"), reason="flite is not installed: apt install flite")
@pytest.mark.parametrize("item", ["meat", "phone"])
def test_an_item_that_is_or_sounds_like_a_common_word_is_heard_as_the_item(tmp_path: Path, item: str) -> None:
    path = tmp_path / "item.wav"
    subprocess.run(["flite", "-voice", "slt", "-t", f"give me the {item}", "-o", str(path)], check=True)
    assert texts(SphinxRecognizer(open_wav(path), [*VOCABULARY, item]).hear(10.0)) == ["give", "me", "the", item]

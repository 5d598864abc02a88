"""Sound that is pushed: with a transcriber written here, and with the real parts."""

from __future__ import annotations

import io
import threading
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE, open_raw
from fetch_pomdp.adapters.speech.stream import Hypothesis, Stream, StreamingRecognizer, unmuted
from fetch_pomdp.adapters.speech.utterances import Detector, SpeechSegment, loud
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from tests.adapters.speech.sounds import DATA, VOCABULARY, samples_of, with_noise

Samples = NDArray[np.int16]
CHUNK = 1600


class Lengths:
    """A Transcriber whose one word says how many tenths of a second it was given."""

    def __init__(self) -> None:
        self.asked = 0

    def words(self, utterance: SpeechSegment) -> Sequence[Word]:
        self.asked += 1
        seconds = len(utterance.samples) / RATE
        return [Word(f"{seconds:.1f}", utterance.start, utterance.start + seconds, 0.5)]


class Ears:
    """A Stream, and what it told in order."""

    def __init__(self, transcriber: object, detector: Detector = loud) -> None:
        self.told: list[Hypothesis | Word] = []
        self.stream = Stream(transcriber, detector, self.told.append, self.told.append)  # type: ignore[arg-type]

    def feed(self, samples: Samples, begin: float = 0.0, chunk: int = CHUNK) -> None:
        for first in range(0, len(samples), chunk):
            self.stream.feed(samples[first : first + chunk], begin + first / RATE)
            self.stream.guess()

    @property
    def words(self) -> list[Word]:
        return [told for told in self.told if isinstance(told, Word)]

    @property
    def guesses(self) -> list[tuple[str, ...]]:
        return [tuple(word.text for word in told) for told in self.told if isinstance(told, tuple)]


def burst(*seconds: float) -> Samples:
    """Silence and noise by turns, in seconds."""
    rng = np.random.default_rng(0)
    loudness = [3000.0 if index % 2 else 10.0 for index in range(len(seconds))]
    parts = [rng.standard_normal(round(s * RATE)) * level for s, level in zip(seconds, loudness, strict=True)]
    return np.asarray(np.concatenate(parts), np.int16)


def test_hypotheses_come_while_somebody_speaks_and_words_at_the_end() -> None:
    ears = Ears(Lengths())
    ears.feed(burst(1.0, 1.0, 1.0))
    assert ears.told[0] == ()
    assert ears.told[-1] is None
    assert isinstance(ears.told[-2], Word)
    lengths = [float(guess[0]) for guess in ears.guesses if guess]
    assert lengths == sorted(lengths)
    assert 4 <= len(set(lengths)) <= 10, "one for every 150 ms and more"
    (word,) = ears.words
    assert word.start == pytest.approx(0.7, abs=0.06)
    assert word.end == pytest.approx(2.3, abs=0.06)


def test_a_hypothesis_that_is_not_due_is_said_again_so_that_nobody_takes_the_stream_for_hung() -> None:
    transcriber = Lengths()
    ears = Ears(transcriber)
    ears.feed(burst(1.0, 1.0), chunk=160)
    assert len(ears.guesses) >= 90
    assert transcriber.asked <= 8


def test_silence_tells_nothing() -> None:
    ears = Ears(Lengths())
    ears.feed(burst(3.0))
    assert ears.told == []


def test_times_are_those_of_who_feeds_it() -> None:
    ears = Ears(Lengths())
    ears.feed(burst(1.0, 1.0, 1.0), begin=100.0)
    assert ears.words[0].start == pytest.approx(100.7, abs=0.06)


def test_sound_after_a_gap_is_no_part_of_what_was_said_before() -> None:
    ears = Ears(Lengths())
    ears.feed(burst(1.0, 0.5), begin=0.0)
    ears.feed(burst(0.0, 0.5, 1.0), begin=10.0)
    first, second = ears.words
    assert first.end == pytest.approx(1.5, abs=0.06)
    assert second.start == pytest.approx(10.0, abs=0.06)


@given(st.lists(st.floats(0, 0.9), min_size=31, max_size=31))
def test_chunks_that_come_late_cut_nothing_and_the_earliest_tells_the_time(late: list[float]) -> None:
    late[3] = 0.0
    sound, ears = burst(1.0, 1.0, 1.1), Ears(Lengths())
    for index, lateness in enumerate(late):
        ears.stream.feed(sound[index * CHUNK : (index + 1) * CHUNK], index * 0.1 + lateness)
    (word,) = ears.words
    assert word.start == pytest.approx(0.7, abs=0.06)


def test_the_end_of_the_stream_ends_the_utterance() -> None:
    ears = Ears(Lengths())
    ears.feed(burst(1.0, 1.0))
    ears.stream.end()
    assert len(ears.words) == 1
    assert ears.told[-1] is None


def test_a_transcriber_that_breaks_is_asked_again() -> None:
    class Broken(Lengths):
        def words(self, utterance: SpeechSegment) -> Sequence[Word]:
            if not self.asked:
                self.asked = 1
                raise AudioError("broken")
            return super().words(utterance)

    ears = Ears(Broken())
    ears.feed(burst(1.0, 1.0, 1.0))
    assert len(ears.words) == 1


@given(
    st.integers(0, 50),
    st.floats(-1, 1),
    st.lists(st.tuples(st.floats(-1, 2), st.floats(0, 1)), max_size=4),
)
def test_what_is_not_muted_is_left(count: int, begin: float, spans: list[tuple[float, float]]) -> None:
    samples = np.arange(count, dtype=np.int16)
    scale = 1000 / RATE  # a sample is taken for a millisecond, so that few make a second
    muted = [(first * scale, (first + length) * scale) for first, length in spans]
    parts = unmuted(samples, begin * scale, muted)
    left = [int(sample) for part, _ in parts for sample in part]
    times = [begin * scale + index / RATE for index in range(count)]
    half = 0.5 / RATE
    for index, time in enumerate(times):
        if any(first + half < time < last - half for first, last in muted):
            assert index not in left
        if not any(first - half <= time <= last + half for first, last in muted):
            assert index in left
    for part, start in parts:
        assert start == pytest.approx(times[int(part[0])])
    for (before, start), (_, following) in pairwise(parts):
        assert following > start + (len(before) - 0.5) / RATE


class Waiting:
    """A Transcriber that hangs until it is let go."""

    def __init__(self) -> None:
        self.asked, self.go = threading.Event(), threading.Event()

    def words(self, utterance: SpeechSegment) -> Sequence[Word]:
        self.asked.set()
        self.go.wait(30)
        return [Word("late", utterance.start, utterance.start, 1.0)]


def test_a_recogniser_that_hangs_gives_no_sign_of_life_and_holds_nobody_up() -> None:
    transcriber, over, signs = Waiting(), threading.Event(), list[int]()
    heard: list[Word] = []

    def partial(hypothesis: Hypothesis) -> None:
        if hypothesis is None:
            over.set()

    ears = StreamingRecognizer(
        transcriber, loud, partial, heard.append, on_alive=lambda: signs.append(1), clock=lambda: 0.0
    )
    sound = burst(1.0, 1.0, 12.0)
    ears.feed(sound[: 2 * RATE].tobytes(), begin=0.0)
    assert transcriber.asked.wait(30)
    before = len(signs)
    for first in range(2 * RATE, len(sound), RATE):
        ears.feed(sound[first : first + RATE].tobytes(), begin=first / RATE)
    assert ears.dropped == pytest.approx(2.0)
    assert len(signs) == before
    transcriber.go.set()
    assert over.wait(30)
    assert [word.text for word in heard] == ["late"]
    ears.close()


def test_half_a_sample_is_refused() -> None:
    ears = StreamingRecognizer(
        Lengths(), loud, lambda _: None, lambda _: None, on_alive=lambda: None, clock=lambda: 0.0
    )
    with pytest.raises(AudioError, match="found 3 bytes, expected two for each sample"):
        ears.feed(b"abc")
    ears.close()


def test_what_the_robot_says_itself_is_not_heard() -> None:
    heard: list[Word] = []
    over = threading.Event()

    def partial(hypothesis: Hypothesis) -> None:
        if hypothesis is None:
            over.set()

    ears = StreamingRecognizer(Lengths(), loud, partial, heard.append, on_alive=lambda: None, clock=lambda: 0.0)
    ears.mute(0.9, 2.1)
    ears.feed(burst(1.0, 1.0, 1.0, 0.5, 1.0).tobytes(), begin=0.0)
    assert over.wait(30)
    ears.close()
    (word,) = heard
    assert word.start == pytest.approx(2.7, abs=0.06)
    assert word.end == pytest.approx(3.8, abs=0.06)


# With the real parts.


def test_the_words_are_those_of_the_recogniser_of_recordings() -> None:
    pytest.importorskip("pocketsphinx")
    pytest.importorskip("onnxruntime")
    from fetch_pomdp.adapters.speech.foreground import Foreground
    from fetch_pomdp.adapters.speech.silero import Silero, model
    from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer, SphinxTranscriber

    request = with_noise(samples_of(DATA / "marker.wav"))
    request = request[: len(request) // 160 * 160]
    ears = Ears(SphinxTranscriber(VOCABULARY), Foreground(Silero(model())))
    ears.feed(request)
    ears.stream.end()
    recorded = SphinxRecognizer(open_raw(io.BytesIO(request.tobytes())), VOCABULARY).hear(60.0)
    assert [(word.text, word.posterior) for word in ears.words] == [(word.text, word.posterior) for word in recorded]
    assert [word.end for word in ears.words] == pytest.approx([word.end for word in recorded])
    assert [word.text for word in ears.words] == ["hand", "me", "the", "marker"]
    assert all(0 < word.posterior <= 1 for word in ears.words)
    assert len({word.posterior for word in ears.words}) > 1, "the decoder's own, and not all the same"
    said = ears.told.index(ears.words[0])
    assert ("hand", "me", "the", "marker") in [
        tuple(word.text for word in told) for told in ears.told[:said] if isinstance(told, tuple)
    ], "shown before they are final"


@pytest.mark.parametrize("snr", [None, 20.0, 10.0, 5.0])
def test_silero_hears_speech_where_it_is(snr: float | None) -> None:
    pytest.importorskip("onnxruntime")
    from fetch_pomdp.adapters.speech.silero import Silero, model

    clean = samples_of(DATA / "marker.wav")
    ears = Ears(Lengths(), Silero(model()))
    ears.feed(clean if snr is None else with_noise(clean, snr))
    ears.stream.end()
    (word,) = ears.words
    assert word.start < 0.6, "before the first word"
    assert word.end > len(clean) / RATE - 0.5


def test_silero_does_not_take_other_sounds_for_speech() -> None:
    pytest.importorskip("onnxruntime")
    from fetch_pomdp.adapters.speech.silero import Silero, model

    rng = np.random.default_rng(0)
    sound = rng.standard_normal(10 * RATE) * 30
    for second in (1, 2, 3):  # clicks of 50 ms
        sound[second * RATE : second * RATE + 800] += np.exp(-np.arange(800) / 120) * rng.standard_normal(800) * 6000
    sound[4 * RATE : 5 * RATE] += np.exp(-np.arange(RATE) / 2000) * rng.standard_normal(RATE) * 9000  # a door
    sound[6 * RATE :] += rng.standard_normal(4 * RATE) * 600  # a fan is switched on
    samples = np.asarray(np.clip(sound, -32768, 32767), np.int16)
    silero, energy = Ears(Lengths(), Silero(model())), Ears(Lengths())
    silero.feed(samples)
    energy.feed(samples)
    assert silero.told == []
    assert len(energy.words) >= 4, "which is why there is Silero"

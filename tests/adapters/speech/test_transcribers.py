"""What every transcriber promises. Of Vosk and faster-whisper no model can be had here: their objects are stand-ins of
the libraries' own interface."""

from __future__ import annotations

import json
import sys
import types
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from fetch_pomdp.adapters.speech.utterances import SpeechSegment, Transcriber
from fetch_pomdp.adapters.speech.vosk import VoskTranscriber
from fetch_pomdp.adapters.speech.whisper import WhisperTranscriber, bounded
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError, MissingExtraError
from tests.adapters.speech.sounds import DATA, VOCABULARY, samples_of, with_noise


class KaldiRecognizer:
    """As vosk.KaldiRecognizer: finds an end after the second chunk, and the rest at the end."""

    def __init__(self, grammar: str) -> None:
        self.grammar, self.detailed, self.chunks = json.loads(grammar), False, 0

    def SetWords(self, enable_words: bool) -> None:  # noqa: N802
        self.detailed = enable_words

    def AcceptWaveform(self, data: bytes) -> int:  # noqa: N802
        assert isinstance(data, bytes)
        assert len(data) % 2 == 0
        self.chunks += 1
        return int(self.chunks == 2)

    def Result(self) -> str:  # noqa: N802
        return self._said(("hand", 0.5, 0.8, 0.9), ("[unk]", 0.8, 0.9, 0.3))

    def FinalResult(self) -> str:  # noqa: N802
        return self._said(("marker", 1.2, 1.6, 1.0000001))

    def _said(self, *words: tuple[str, float, float, float]) -> str:
        result = [{"word": word, "start": start, "end": end, "conf": conf} for word, start, end, conf in words]
        text = " ".join(word[0] for word in words)
        return json.dumps({"result": result, "text": text} if self.detailed else {"text": text})


@dataclass
class Spoken:
    """As faster_whisper's Word."""

    start: float
    end: float
    word: str
    probability: float


@dataclass
class Segment:
    """As faster_whisper's Segment, as far as it is read."""

    words: list[Spoken] | None
    avg_logprob: float = -0.3
    no_speech_prob: float = 0.1
    compression_ratio: float = 1.0


class WhisperModel:
    """As faster_whisper.WhisperModel; transcribe takes only options that the real one has."""

    def transcribe(
        self,
        audio: object,
        *,
        language: str,
        beam_size: int,
        temperature: tuple[float, ...],
        compression_ratio_threshold: float,
        log_prob_threshold: float,
        no_speech_threshold: float,
        no_repeat_ngram_size: int,
        max_new_tokens: int,
        condition_on_previous_text: bool,
        word_timestamps: bool,
        hotwords: str,
    ) -> tuple[list[Segment], None]:
        assert isinstance(audio, np.ndarray)
        assert audio.dtype == np.float32
        assert np.abs(audio).max() <= 1
        assert word_timestamps
        assert "marker" in hotwords
        assert max_new_tokens < 30 * len(audio) / 16_000 + 10
        del language, beam_size, temperature, condition_on_previous_text
        del compression_ratio_threshold, log_prob_threshold, no_speech_threshold, no_repeat_ngram_size
        words = [Spoken(0.5, 0.8, " Hand", 0.9), Spoken(0.8, 1.0, " me,", 0.8), Spoken(1.2, 1.6, " Marker.", 0.99)]
        return [Segment(words), Segment(None)], None


def sphinx() -> Transcriber:
    pytest.importorskip("pocketsphinx")
    from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber

    return SphinxTranscriber(VOCABULARY)


TRANSCRIBERS: dict[str, Callable[[], Transcriber]] = {
    "sphinx": sphinx,
    "vosk": lambda: VoskTranscriber(KaldiRecognizer, VOCABULARY),
    "whisper": lambda: WhisperTranscriber(WhisperModel(), VOCABULARY),
}


@pytest.mark.parametrize("name", TRANSCRIBERS)
def test_the_contract(name: str) -> None:
    transcriber = TRANSCRIBERS[name]()
    samples = with_noise(samples_of(DATA / "marker.wav"))
    words = list(transcriber.words(SpeechSegment(100.0, samples)))
    assert {"hand", "marker"} <= {word.text for word in words}
    assert all(word.text == word.text.lower() and word.text.isalpha() for word in words)
    times = [time for word in words for time in (word.start, word.end)]
    assert times == sorted(times)
    assert 100.4 < times[0] < times[-1] <= 100 + len(samples) / 16_000
    assert all(0 < word.posterior <= 1 for word in words)
    later = list(transcriber.words(SpeechSegment(200.0, samples)))
    assert [(word.text, word.posterior) for word in later] == [(word.text, word.posterior) for word in words]
    assert [word.start for word in later] == pytest.approx([word.start + 100 for word in words])


def test_what_was_said_before_changes_nothing() -> None:
    transcriber, no = sphinx(), with_noise(samples_of(DATA / "no.wav"))
    first = transcriber.words(SpeechSegment(0.0, no))
    transcriber.words(SpeechSegment(0.0, with_noise(samples_of(DATA / "marker.wav"), 5.0)))
    assert transcriber.words(SpeechSegment(0.0, no)) == first


def test_vosk_listens_for_words_of_the_scene_and_answers() -> None:
    made: list[KaldiRecognizer] = []

    def recognizer(grammar: str) -> KaldiRecognizer:
        made.append(KaldiRecognizer(grammar))
        return made[-1]

    VoskTranscriber(recognizer, VOCABULARY).words(SpeechSegment(0.0, np.zeros(1600, np.int16)))
    assert {*VOCABULARY, "yes", "no", "[unk]"} <= set(made[0].grammar)


@pytest.mark.parametrize(("adapter", "extra"), [(VoskTranscriber, "vosk"), (WhisperTranscriber, "whisper")])
def test_without_the_library_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, adapter: type[VoskTranscriber | WhisperTranscriber], extra: str, tmp_path: Path
) -> None:
    for module in ("vosk", "faster_whisper"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=rf'pip install "fetch-pomdp\[{extra}\]"'):
        adapter.open(tmp_path, VOCABULARY)


def test_a_folder_that_is_no_model(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def none(*_: object, **__: object) -> None:
        raise RuntimeError("Unable to open file 'model.bin'")

    monkeypatch.setitem(
        sys.modules, "faster_whisper", types.SimpleNamespace(WhisperModel=none, available_models=lambda: ["tiny.en"])
    )
    monkeypatch.setitem(sys.modules, "vosk", types.SimpleNamespace(Model=none))
    for adapter in (WhisperTranscriber, VoskTranscriber):
        with pytest.raises(AudioError, match=r"found no model \(Unable to open file 'model.bin'\)"):
            adapter.open(tmp_path, VOCABULARY)
    with pytest.raises(AudioError, match="found no folder"):
        WhisperTranscriber.open(tmp_path / "none", VOCABULARY)


# Whisper says what there is no end of.


def said(text: str) -> list[Word]:
    return [Word(word, 0.3 * k, 0.3 * k + 0.2) for k, word in enumerate(text.split())]


@pytest.mark.parametrize(
    ("heard", "kept"),
    [
        ("hand me the marker", "hand me the marker"),
        ("no no", "no no"),
        ("no no no no no no no", "no"),
        ("the spoon the spoon the spoon the spoon please", "the spoon please"),
        ("hand me the cup " * 12, "hand me the cup"),
        ("a b a b c", "a b a b c"),
        ("", ""),
    ],
)
def test_what_is_repeated_without_end_is_said_once(heard: str, kept: str) -> None:
    assert [word.text for word in bounded(said(heard), 50)] == kept.split()


def test_nobody_says_fifty_words_in_two_seconds() -> None:
    words = bounded(said(" ".join(f"word{k}" for k in range(50))), 14)
    assert [word.text for word in words] == [f"word{k}" for k in range(14)]


class Endless:
    """As faster_whisper.WhisperModel, in noise."""

    def __init__(self, *segments: object) -> None:
        self.segments = segments

    def transcribe(self, audio: object, **options: object) -> tuple[list[object], None]:
        assert options["temperature"] == (0.0, 0.2, 0.4, 0.6), "it decodes anew what loops"
        return list(self.segments), None


def test_whispers_words_are_bounded_in_the_librarys_own_types() -> None:
    own = pytest.importorskip("faster_whisper.transcribe")

    def segment(text: str, *, likely: float = -0.4, silent: float = 0.1, ratio: float = 1.2) -> object:
        words = [own.Word(0.1 * k, 0.1 * k + 0.1, f" {word}", 0.5) for k, word in enumerate(text.split())]
        return own.Segment(0, 0, 0.0, 2.0, text, [], likely, ratio, silent, words, 0.6)

    utterance = SpeechSegment(0.0, np.zeros(32_000, np.int16))

    def heard(*segments: object) -> list[str]:
        return [word.text for word in WhisperTranscriber(Endless(*segments), VOCABULARY).words(utterance)]

    assert heard(segment("no the marker " * 20)) == ["no", "the", "marker"]
    assert heard(segment("thank you", likely=-1.4, silent=0.9), segment("no")) == ["no"]
    assert heard(segment("the the the the", ratio=3.0)) == []
    assert len(heard(segment(" ".join(f"word{k}" for k in range(60))))) == 14

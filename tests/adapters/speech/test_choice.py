"""Ears by name."""

from __future__ import annotations

import io
import sys
import types

import numpy as np
import pytest

from fetch_pomdp.adapters.speech.audio import open_raw
from fetch_pomdp.adapters.speech.choice import recognizer, transcribers
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.core.ports import UtteranceRecognizer
from fetch_pomdp.errors import AudioError, InputError
from tests.adapters.speech.sounds import DATA, VOCABULARY, samples_of, with_noise
from tests.adapters.speech.test_transcribers import KaldiRecognizer, WhisperModel

pytest.importorskip("onnxruntime")
LIBRARIES = {
    "whisper": types.SimpleNamespace(
        WhisperModel=lambda *_, **__: WhisperModel(), available_models=lambda: ["tiny.en"]
    ),
    "vosk": types.SimpleNamespace(
        Model=lambda *_, **__: "model", KaldiRecognizer=lambda _model, _rate, words: KaldiRecognizer(words)
    ),
}


@pytest.mark.parametrize("ears", ["whisper:tiny.en", "vosk:vosk-model-small-en-us-0.15"])
def test_a_recording_is_heard_by_the_one_named(monkeypatch: pytest.MonkeyPatch, ears: str) -> None:
    kind = ears.split(":", maxsplit=1)[0]
    monkeypatch.setitem(sys.modules, {"whisper": "faster_whisper"}.get(kind, kind), LIBRARIES[kind])
    sound = open_raw(io.BytesIO(with_noise(samples_of(DATA / "marker.wav")).astype("<i2").tobytes()))
    found = recognizer(ears, sound, VOCABULARY)
    assert isinstance(found, UtteranceRecognizer)
    words = found.hear(60.0)
    assert {"hand", "marker"} <= {word.text for word in words}
    assert all(word.start > 0.4 for word in words), "on the clock of the recording"


def test_a_server_loads_a_model_once(monkeypatch: pytest.MonkeyPatch) -> None:
    loaded: list[str] = []

    def load(name: str, **_: object) -> WhisperModel:
        loaded.append(name)
        return WhisperModel()

    library = types.SimpleNamespace(WhisperModel=load, available_models=lambda: ["tiny.en"])
    monkeypatch.setitem(sys.modules, "faster_whisper", library)
    source = transcribers("whisper:tiny.en")
    for vocabulary in (["marker"], ["marker", "spoon"]):
        source.transcriber(vocabulary)
    source.close()
    assert loaded == ["tiny.en"]


@pytest.mark.parametrize("ears", ["", "whisper", "whisper:", "vosk", "kaldi:en", "sphinx:en"])
def test_other_names_are_answered_with_the_known_ones(ears: str) -> None:
    with pytest.raises(InputError, match="expected sphinx, whisper:MODEL or vosk:DIR"):
        transcribers(ears)


def test_two_are_heard_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "faster_whisper", LIBRARIES["whisper"])
    monkeypatch.setitem(sys.modules, "vosk", LIBRARIES["vosk"])
    words = (
        transcribers("whisper:tiny.en+vosk:a+b")
        .transcriber(VOCABULARY)
        .words(SpeechSegment(0.0, np.zeros(32_000, np.int16)))
    )
    readings = {each.words: each.weight for each in words[0].readings}
    assert set(readings) == {("hand", "me", "marker"), ("hand", "marker"), ()}
    assert sum(readings.values()) == pytest.approx(1.0)


def test_a_model_that_cannot_be_fetched_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def offline(*_: object, **__: object) -> None:
        raise ConnectionError("no route to host")

    library = types.SimpleNamespace(WhisperModel=offline, available_models=lambda: ["tiny.en"])
    monkeypatch.setitem(sys.modules, "faster_whisper", library)
    with pytest.raises(AudioError, match=r"tiny.en: found no model \(no route to host\)"):
        transcribers("whisper:tiny.en")


def test_silence_is_no_words() -> None:
    pytest.importorskip("pocketsphinx")
    sound = open_raw(io.BytesIO(np.zeros(32_000, "<i2").tobytes()))
    assert recognizer("sphinx", sound, VOCABULARY).hear(5.0) == []

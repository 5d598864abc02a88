"""Transcriber over Vosk (Kaldi), with a model that you bring, or that it fetches: vosk-model-small-en-us-0.15, say."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Self

from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.adapters.speech.bigram import own_words
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load

FETCHED = "vosk-model-"  # how the names begin of models that Vosk fetches by itself
UNKNOWN = "[unk]"  # how Vosk writes a sound that is not one of the words
CHUNK = RATE // 5  # samples; Vosk may find an end after each, and then gives what came before it


class VoskTranscriber:
    """Finds the words of an utterance, among those of the scene, requests and answers; others are left out.

    recognizer: makes a vosk.KaldiRecognizer from a list of words as JSON. Models with a fixed graph ignore the list.
    """

    def __init__(self, recognizer: Callable[[str], Any], vocabulary: Sequence[str]) -> None:
        self._recognizer = recognizer
        self._known = json.dumps([*own_words(vocabulary), UNKNOWN])

    @classmethod
    def open(cls, model: str | Path, vocabulary: Sequence[str]) -> Self:
        """Load a model: see `load_model`."""
        loaded = load_model(model)
        return cls(_recognizers(loaded), vocabulary)

    def words(self, utterance: SpeechSegment) -> list[Word]:
        """Return the words of an utterance; see Transcriber."""
        recognizer = self._recognizer(self._known)
        recognizer.SetWords(True)
        parts = [
            recognizer.Result()
            for first in range(0, len(utterance.samples), CHUNK)
            if recognizer.AcceptWaveform(utterance.samples[first : first + CHUNK].astype("<i2").tobytes())
        ]
        parts.append(recognizer.FinalResult())
        found = [word for part in parts for word in json.loads(part).get("result", [])]
        start = utterance.start
        return [
            Word(word["word"], start + word["start"], start + word["end"], min(1.0, word["conf"]))
            for word in found
            if word["word"] != UNKNOWN
        ]


def load_model(model: str | Path) -> Any:
    """Load a model: its folder, or a name such as vosk-model-small-en-us-0.15, fetched where there is a network.

    Raises MissingExtraError without vosk, AudioError for a folder that is no model, or a model that cannot be fetched.
    """
    vosk = load("vosk", "vosk")
    by_name = not Path(model).exists() and str(model).startswith(FETCHED)
    try:
        return vosk.Model(model_name=str(model)) if by_name else vosk.Model(str(model))
    except (Exception, SystemExit) as error:  # Vosk raises no kind of its own, and exits where it knows no such name
        raise AudioError(f"found no model ({error}), expected the folder of one", source=str(model)) from None


def transcriber(model: Any, vocabulary: Sequence[str]) -> VoskTranscriber:
    """Return a Transcriber over a model that is loaded."""
    return VoskTranscriber(_recognizers(model), vocabulary)


def _recognizers(model: Any) -> Callable[[str], Any]:
    vosk = load("vosk", "vosk")
    return lambda words: vosk.KaldiRecognizer(model, RATE, words)

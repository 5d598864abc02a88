"""Transcriber over Vosk (Kaldi), with a model that you bring: a folder of vosk-model-small-en-us, say."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Self

from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.adapters.speech.bigram import every_word
from fetch_pomdp.adapters.speech.utterances import Utterance
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load

UNKNOWN = "[unk]"  # how Vosk writes a sound that is not one of the words
CHUNK = RATE // 5  # samples; Vosk may find an end after each, and then gives what came before it


class VoskTranscriber:
    """Finds the words of an utterance, among those of the scene, requests and answers; others are left out.

    recognizer: makes a vosk.KaldiRecognizer from a list of words as JSON. Models with a fixed graph ignore the list.
    """

    def __init__(self, recognizer: Callable[[str], Any], vocabulary: Sequence[str]) -> None:
        self._recognizer = recognizer
        self._known = json.dumps([*every_word(vocabulary, ()), UNKNOWN])

    @classmethod
    def open(cls, model: str | Path, vocabulary: Sequence[str]) -> Self:
        """Load a model's folder. Raises MissingExtraError without vosk, AudioError for a folder that is no model."""
        vosk = load("vosk", "vosk")
        try:
            loaded = vosk.Model(str(model))
        except Exception as error:  # Vosk raises no kind of its own
            raise AudioError(f"found no model ({error}), expected the folder of one", source=str(model)) from None
        return cls(lambda words: vosk.KaldiRecognizer(loaded, RATE, words), vocabulary)

    def words(self, utterance: Utterance) -> list[Word]:
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

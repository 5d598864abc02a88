"""Transcriber over faster-whisper, with a model that you bring: the folder of a converted one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from fetch_pomdp.adapters.speech.utterances import Utterance
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load


class WhisperTranscriber:
    """Finds the words of an utterance, with a preference for those of the scene.

    model: a faster_whisper.WhisperModel.
    """

    def __init__(self, model: Any, vocabulary: Sequence[str]) -> None:
        self._model = model
        self._hotwords = " ".join(vocabulary)

    @classmethod
    def open(cls, model: str | Path, vocabulary: Sequence[str]) -> Self:
        """Load a model's folder. Raises MissingExtraError without faster-whisper, AudioError for no such folder."""
        whisper = load("faster_whisper", "whisper")
        if not Path(model).is_dir():
            raise AudioError("found no folder, expected one with a converted model", source=str(model))
        try:
            return cls(whisper.WhisperModel(str(model), device="cpu", compute_type="int8"), vocabulary)
        except (RuntimeError, ValueError, OSError) as error:
            raise AudioError(f"found no model ({error}), expected a converted one", source=str(model)) from None

    def words(self, utterance: Utterance) -> list[Word]:
        """Return the words of an utterance; see Transcriber."""
        segments, _ = self._model.transcribe(
            utterance.samples.astype(np.float32) / 32768,
            language="en",
            beam_size=1,
            temperature=0.0,
            condition_on_previous_text=False,
            word_timestamps=True,
            hotwords=self._hotwords,
        )
        start = utterance.start
        return [
            Word(text, start + word.start, start + word.end, min(1.0, word.probability))
            for segment in segments
            for word in segment.words or ()
            for text in tokenize(word.word)
        ]

"""Transcriber over faster-whisper, with a model that you bring, or that it fetches by name.

Whisper goes on after the words there are: in noise it says them again and again. So what it may say is bounded four
times: it decodes anew, less surely, what is likelier a loop or no speech (temperature fallback); no run of three words
comes twice in one decoding; its words are no more than people can say in the time; and of what is repeated without end
a single time is kept.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load

TEMPERATURES = (0.0, 0.2, 0.4, 0.6)
FASTEST = 6.0  # words a second that people say, at most
SPARE = 2  # words more than that, for short utterances
TOKENS = 3  # of a word, at most
LOOPING = 2.4  # compression ratio from which on a text is the same again and again: Whisper's own
UNLIKELY = -1.0  # mean log-probability of a token below which a text is nonsense: Whisper's own
NO_SPEECH = 0.6  # probability from which on nonsense is no speech: Whisper's own
LONGEST_LOOP = 4  # words
MOST_TIMES = 2  # that anybody says the same in a row: "no no"


class WhisperTranscriber:
    """Finds the words of an utterance, with a preference for those of the scene.

    model: a faster_whisper.WhisperModel.
    """

    def __init__(self, model: Any, vocabulary: Sequence[str]) -> None:
        self._model = model
        self._hotwords = " ".join(vocabulary)

    @classmethod
    def open(cls, model: str | Path, vocabulary: Sequence[str]) -> Self:
        """Load a model: see `load_model`."""
        return cls(load_model(model), vocabulary)

    def words(self, utterance: SpeechSegment) -> list[Word]:
        """Return the words of an utterance; see Transcriber."""
        most = math.ceil(len(utterance.samples) / RATE * FASTEST) + SPARE
        segments, _ = self._model.transcribe(
            utterance.samples.astype(np.float32) / 32768,
            language="en",
            beam_size=1,
            temperature=TEMPERATURES,
            compression_ratio_threshold=LOOPING,
            log_prob_threshold=UNLIKELY,
            no_speech_threshold=NO_SPEECH,
            no_repeat_ngram_size=3,
            max_new_tokens=most * TOKENS,
            condition_on_previous_text=False,
            word_timestamps=True,
            hotwords=self._hotwords,
        )
        start = utterance.start
        found = [
            Word(text, start + word.start, start + word.end, min(1.0, word.probability))
            for segment in segments
            if not _is_nonsense(segment)
            for word in segment.words or ()
            for text in tokenize(word.word)
        ]
        return bounded(found, most)


def load_model(model: str | Path) -> Any:
    """Load a model: the folder of a converted one, or a name such as tiny.en, fetched where there is a network.

    Raises MissingExtraError without faster-whisper, AudioError for what is no model or cannot be fetched.
    """
    whisper = load("faster_whisper", "whisper")
    if not Path(model).is_dir() and str(model) not in whisper.available_models():
        expected = f"a folder with a converted model, or one of {', '.join(whisper.available_models())}"
        raise AudioError(f"found no folder, expected {expected}", source=str(model))
    try:
        return whisper.WhisperModel(str(model), device="cpu", compute_type="int8")
    except Exception as error:  # the hub's client raises errors of the libraries under it
        raise AudioError(f"found no model ({error}), expected a converted one", source=str(model)) from None


def bounded(words: Sequence[Word], most: int) -> list[Word]:
    """Return the words with each loop said once, and no more than `most` of them.

    A loop is up to LONGEST_LOOP words, said more than MOST_TIMES in a row.
    """
    kept: list[Word] = []
    place = 0
    while place < len(words):
        size, times = _loop_at(words, place)
        kept += words[place : place + size]
        place += size * times
    return kept[:most]


def _loop_at(words: Sequence[Word], place: int) -> tuple[int, int]:
    """Return how many words are said again from a place on, and how often; one word once where none are."""
    texts = [word.text for word in words[place:]]
    for size in range(1, LONGEST_LOOP + 1):
        times = 1
        while texts[times * size : (times + 1) * size] == texts[:size]:
            times += 1
        if times > MOST_TIMES:
            return size, times
    return 1, 1


def _is_nonsense(segment: Any) -> bool:
    """Return whether the last and hottest decoding of a segment is a loop or no speech, still."""
    silent = segment.no_speech_prob > NO_SPEECH and segment.avg_logprob < UNLIKELY
    return bool(silent or segment.compression_ratio > LOOPING)

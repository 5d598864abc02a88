"""Recognizer over PocketSphinx: a Sound, cut into utterances, each decoded with a bigram model of the scene's words."""

from __future__ import annotations

import os
import re
import tempfile
from collections import deque
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fetch_pomdp.adapters.extras import load
from fetch_pomdp.adapters.speech.audio import Samples, Sound
from fetch_pomdp.adapters.speech.bigram import language_model
from fetch_pomdp.adapters.speech.utterances import Utterance, Utterances
from fetch_pomdp.core.ports import Word

FRAMES = 100.0  # decoder frames a second
NOISE = -30.0  # dB under the utterance's mean power: the decoder was trained on rooms, and hears badly without one
SEED = 0
FILLER = ("<", "[", "+")  # how silence and noises are spelt in the decoder's dictionary


class SphinxRecognizer:
    """Ears over a Sound. Implements Recognizer.

    A word is given when its utterance has ended, so `hear` may listen on past its time while someone is speaking (11 s at
    the most); words that end later than that time are kept for the next call.
    Raises MissingExtraError without pocketsphinx.
    """

    def __init__(self, sound: Sound, vocabulary: Iterable[str]) -> None:
        self._utterances = Utterances(sound)
        self._decoder = _decoder(vocabulary)
        self._heard: deque[Word] = deque()

    def hear(self, until: float) -> list[Word]:
        """Listen until the stream's time `until` (s); see Recognizer. Raises AudioError for a stream that breaks."""
        utterances = self._utterances
        while not utterances.ended and (utterances.time < until or utterances.speaking):
            if utterance := utterances.step():
                self._heard.extend(self._words(utterance))
        words = []
        while self._heard and self._heard[0].end <= until:
            words.append(self._heard.popleft())
        return words

    def _words(self, utterance: Utterance) -> Iterator[Word]:
        decoder = self._decoder
        decoder.start_utt()
        decoder.process_raw(_roomy(utterance.samples).tobytes(), full_utt=True)
        decoder.end_utt()
        for segment in decoder.seg() or ():
            if not segment.word.startswith(FILLER):
                start = utterance.start + segment.start_frame / FRAMES
                end = utterance.start + (segment.end_frame + 1) / FRAMES
                yield Word(re.sub(r"\(\d+\)$", "", segment.word), start, end, min(1.0, segment.prob))


def _decoder(vocabulary: Iterable[str]) -> Any:
    pocketsphinx = load("pocketsphinx", "speech")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.arpa"
        path.write_text(language_model(vocabulary))
        return pocketsphinx.Decoder(lm=str(path), loglevel="FATAL", logfn=os.devnull)


def _roomy(samples: Samples) -> Samples:
    """Add white noise, the same every time: digital silence ruins decoding, and a little noise helps clean speech."""
    noise = np.random.default_rng(SEED).standard_normal(len(samples))
    loudness = np.sqrt(np.mean(np.square(samples, dtype=float)))
    mixed = samples + noise * max(1.0, loudness * 10 ** (NOISE / 20))
    return np.asarray(np.clip(np.round(mixed), -32768, 32767), np.int16)

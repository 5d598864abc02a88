"""Tells speech from other sounds with Silero's voice activity detector, version 6 (silero_vad_16k.onnx, MIT, LICENSE).

Choice: the model's file is part of this package, because the package it comes in requires torch and this needs only
onnxruntime. It hears speech in noise of 5 dB SNR, and none in clicks, a door, or noise that sets in, all of which the
energy over the floor takes for speech (docs/live.md).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE, Samples
from fetch_pomdp.extras import load

MODEL = Path(__file__).with_name("silero_vad_16k.onnx")
CHUNK, CONTEXT = 512, 64  # samples the model takes, and of those before them
SPEECH, STILL_SPEECH = 0.5, 0.35  # probability from which on it is speech, and still is: the model's own advice


def model() -> Any:
    """Load the model; one serves any number of detectors, from any thread. Raises MissingExtraError."""
    runtime = load("onnxruntime", "speech")
    options = runtime.SessionOptions()
    options.inter_op_num_threads = options.intra_op_num_threads = 1
    return runtime.InferenceSession(str(MODEL), sess_options=options, providers=["CPUExecutionProvider"])


class Silero:
    """A Detector. loaded: what `model` returned."""

    def __init__(self, loaded: Any) -> None:
        self._model = loaded
        self._state = np.zeros((2, 1, 128), np.float32)
        self._samples = np.zeros(CONTEXT, np.float32)  # those before the chunk, and what has come of it
        self._probability = 0.0

    def __call__(self, frame: Samples, above: float, speaking: bool) -> bool:  # noqa: ARG002
        """Whether there is speech, by the last 32 ms that are complete. See Detector."""
        self._samples = np.concatenate([self._samples, frame.astype(np.float32) / 32768])
        if len(self._samples) >= CONTEXT + CHUNK:
            chunk, self._samples = self._samples[: CONTEXT + CHUNK], self._samples[CHUNK:]
            fed = {"input": chunk[None], "state": self._state, "sr": np.array(RATE, np.int64)}
            probability, self._state = self._model.run(None, fed)
            self._probability = float(probability[0, 0])
        return self._probability > (STILL_SPEECH if speaking else SPEECH)

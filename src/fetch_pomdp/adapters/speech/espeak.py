"""The robot's voice: text to sound with espeak-ng."""

from __future__ import annotations

import io
import subprocess
import wave
from functools import lru_cache

import numpy as np

from fetch_pomdp.adapters.extras import load
from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.errors import AudioError, MissingExtraError

LONGEST = 500  # letters of a text: about half a minute


class Voice:
    """Speaks with a voice of espeak-ng at a speed (words a minute). Texts are spoken once and kept.

    Raises MissingExtraError without espeak-ng, AudioError for a voice that it does not have.
    """

    def __init__(self, name: str = "en-us", speed: int = 150) -> None:
        self._name, self._speed = name, speed
        self.wav = lru_cache(maxsize=256)(self._wav)
        self.wav("yes")

    def seconds(self, text: str) -> float:
        """Return how long a text takes (s)."""
        with wave.open(io.BytesIO(self.wav(text))) as sound:
            return float(sound.getnframes() / sound.getframerate())

    def _wav(self, text: str) -> bytes:
        """Return a text as a WAV file: 16 bit, mono, 16 kHz. Raises AudioError for one that is too long."""
        if len(text) > LONGEST:
            raise AudioError(f"found a text of {len(text)} letters, expected at most {LONGEST}", source="espeak-ng")
        command = ["espeak-ng", "-v", self._name, "-s", str(self._speed), "--stdin", "--stdout"]
        try:
            done = subprocess.run(command, input=text.encode(), capture_output=True, check=False)
        except FileNotFoundError:
            raise MissingExtraError("espeak-ng is not installed; install it with: apt install espeak-ng") from None
        if done.returncode or not done.stdout.startswith(b"RIFF"):
            reason = done.stderr.decode(errors="replace").strip() or "no sound"
            raise AudioError(f"found {reason}, expected the voice {self._name!r}", source="espeak-ng")
        return _at_our_rate(done.stdout)


def _at_our_rate(data: bytes) -> bytes:
    """Return a WAV file at 16 kHz. The sizes in the header of what espeak-ng writes to a pipe are no sizes."""
    with wave.open(io.BytesIO(data)) as spoken:
        rate = spoken.getframerate()
    samples = np.frombuffer(data[data.index(b"data") + 8 :], "<i2")
    resampled = load("soxr", "speech").resample(samples, rate, RATE)
    made = io.BytesIO()
    with wave.open(made, "wb") as sound:
        sound.setparams((1, 2, RATE, 0, "NONE", ""))
        sound.writeframes(resampled.astype("<i2").tobytes())
    return made.getvalue()

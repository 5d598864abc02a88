"""Text to sound with espeak-ng."""

from __future__ import annotations

import io
import shutil
import subprocess
import tempfile
import wave
from functools import lru_cache
from pathlib import Path

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE, Samples, open_wav
from fetch_pomdp.errors import AudioError, MissingExtraError

LONGEST = 60  # s
MOST_LETTERS = 500  # that the robot says at a time: about half a minute


def spoken(text: str, voice: str, speed: int) -> Samples:
    """Say a text with espeak-ng, at `speed` words a minute; return it as 16 kHz mono without silence around it.

    Raises MissingExtraError without espeak-ng, AudioError if it has no such voice.
    """
    if shutil.which("espeak-ng") is None:
        raise MissingExtraError("espeak-ng is not installed; install it with: apt install espeak-ng")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "said.wav"
        command = ["espeak-ng", "-v", voice, "-s", str(speed), "-z", "-w", str(path), "--", text]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode or not path.exists():
            found = done.stderr.strip() or f"code {done.returncode}"
            raise AudioError(f"found {found}, expected a voice of espeak-ng", field=voice)
        samples = open_wav(path).read(LONGEST * RATE)
    loud = np.flatnonzero(np.abs(samples) > 30)
    return samples[loud[0] : loud[-1] + 1] if len(loud) else samples


class Voice:
    """The robot's: a voice of espeak-ng at a speed (words a minute). Texts are spoken once and kept.

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
        if len(text) > MOST_LETTERS:
            found = f"found a text of {len(text)} letters"
            raise AudioError(f"{found}, expected at most {MOST_LETTERS}", source="espeak-ng")
        made = io.BytesIO()
        with wave.open(made, "wb") as sound:
            sound.setparams((1, 2, RATE, 0, "NONE", ""))
            sound.writeframes(spoken(text, self._name, self._speed).astype("<i2").tobytes())
        return made.getvalue()

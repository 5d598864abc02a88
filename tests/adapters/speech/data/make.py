"""Makes the recordings beside it with flite: 16 kHz mono WAV, half a second of digital silence before and after."""

from __future__ import annotations

import subprocess
import tempfile
import wave
from pathlib import Path

SENTENCES = {
    "marker.wav": ("slt", "hand me the marker"),
    "no.wav": ("rms", "no"),
    "weather.wav": ("slt", "what is the weather today"),
}

for name, (voice, text) in SENTENCES.items():
    with tempfile.NamedTemporaryFile(suffix=".wav") as scratch:
        subprocess.run(["flite", "-voice", voice, "-t", text, "-o", scratch.name], check=True)
        with wave.open(scratch.name) as spoken, wave.open(str(Path(__file__).with_name(name)), "wb") as padded:
            padded.setparams(spoken.getparams())
            silence = bytes(spoken.getframerate())  # two bytes a sample: half a second
            padded.writeframes(silence + spoken.readframes(spoken.getnframes()) + silence)

"""Spoken sentences as 16 kHz WAV files by espeak-ng, flite, festival and sox: clean, or in white noise."""

from __future__ import annotations

import shutil
import subprocess
import wave
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

RATE = 16_000  # Hz
BEFORE, AFTER = 0.4, 0.7  # s of silence around a sentence
TOOLS = ("espeak-ng", "flite", "sox")

ESPEAK = [(voice, speed) for speed in (130, 175) for voice in ("en-us", "en-gb", "en-us+f3", "en-us+m3", "en-us+f2")]
FLITE = ("slt", "rms", "awb", "kal16")
VOICES = (*(f"espeak-{voice}-{speed}" for voice, speed in ESPEAK), *(f"flite-{voice}" for voice in FLITE))
SNRS = (None, 20, 10, 5)  # dB; None is clean
# No parameter of the ears was chosen on these, nor were they listened to while one was: for the last measurement alone.
UNHEARD = (
    "espeak-en-gb-scotland-140", "espeak-en-gb-x-rp-155", "espeak-en-us-nyc-165", "espeak-en-029-150",
    "espeak-en-gb-x-gbclan-160", "espeak-en-us+f4-150", "espeak-en-us+m7-190", "espeak-en-gb+m1-120",
    "espeak-en-gb+f5-165", "espeak-en-us+m6-145", "festival-ked_diphone", "festival-cmu_us_slt_arctic_hts",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Recording:
    """One sentence, said by one voice, at one signal-to-noise ratio."""

    text: str
    voice: str
    snr: int | None  # dB
    path: Path


def missing_tools(tools: Sequence[str] = TOOLS) -> list[str]:
    """Return the apt packages that are not installed."""
    return [tool for tool in tools if shutil.which(tool) is None]


def record(
    texts: Sequence[str], folder: Path, voices: Sequence[str] = VOICES, snrs: Sequence[int | None] = SNRS
) -> list[Recording]:
    """Make, or find in `folder`, every text by every voice at every SNR (dB)."""
    folder.mkdir(parents=True, exist_ok=True)
    return [recording for text in texts for voice in voices for recording in _said(text, voice, folder, snrs)]


def read(path: Path) -> NDArray[np.int16]:
    """Return the samples of a 16-bit mono WAV file."""
    with wave.open(str(path)) as sound:
        return np.frombuffer(sound.readframes(sound.getnframes()), np.int16)


def _said(text: str, voice: str, folder: Path, snrs: Sequence[int | None]) -> Iterator[Recording]:
    name = f"{text.replace(' ', '-')}_{voice}"
    clean = folder / f"{name}_clean.wav"
    if not clean.exists():
        _write(clean, _padded(speak(text, voice, folder / "voice.wav")))
    for snr in snrs:
        path = clean if snr is None else folder / f"{name}_{snr}dB.wav"
        if not path.exists():
            _write(path, _noisy(read(clean), float(snr or 0), seed=zlib.crc32(path.name.encode())))
        yield Recording(text, voice, snr, path)


def speak(text: str, voice: str, scratch: Path) -> NDArray[np.int16]:
    """Return a text as a voice says it, 16 kHz; `scratch` is overwritten."""
    engine, name = voice.split("-", 1)
    if engine == "flite":
        command = ["flite", "-voice", name, "-t", text, "-o", str(scratch)]
    elif engine == "festival":
        command = ["text2wave", "-eval", f"(voice_{name})", "-o", str(scratch)]
    else:
        name, speed = name.rsplit("-", 1)
        command = ["espeak-ng", "-v", name, "-s", speed, "-w", str(scratch), text]
    subprocess.run(command, check=True, capture_output=True, input=text.encode())
    resampled = scratch.with_name("resampled.wav")
    # -G keeps resampling from clipping, -D leaves out sox's own random dither: the same file every time
    command = ["sox", "-G", "-D", str(scratch), "-r", str(RATE), "-b", "16", "-c", "1", str(resampled)]
    subprocess.run(command, check=True)
    return read(resampled)


def said(text: str, voice: str, folder: Path) -> NDArray[np.int16]:
    """Return a text as a voice says it, 16 kHz, without silence around it; made once and kept in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{zlib.crc32(text.encode()):08x}_{voice}.wav"
    if not path.exists():
        samples = speak(text, voice, folder / "voice.wav")
        loud = np.flatnonzero(np.abs(samples) > 30)
        _write(path, samples[loud[0] : loud[-1] + 1])
    return read(path)


def _padded(samples: NDArray[np.int16]) -> NDArray[np.int16]:
    return np.pad(samples, (int(BEFORE * RATE), int(AFTER * RATE)))


def _noisy(samples: NDArray[np.int16], snr: float, seed: int) -> NDArray[np.int16]:
    """Add white noise `snr` dB under the mean power of the sentence, its padding left out."""
    speech = samples[int(BEFORE * RATE) : -int(AFTER * RATE)].astype(float)
    loudness = np.sqrt(np.mean(speech**2))
    noise = np.random.default_rng(seed).standard_normal(len(samples)) * loudness * 10 ** (-snr / 20)
    mixed = samples + noise
    return np.asarray(np.round(mixed * min(1.0, 32767 / np.abs(mixed).max())), np.int16)


def _write(path: Path, samples: NDArray[np.int16]) -> None:
    with wave.open(str(path), "wb") as sound:
        sound.setparams((1, 2, RATE, 0, "NONE", ""))
        sound.writeframes(samples.tobytes())

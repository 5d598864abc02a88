"""Make the recording that `make demo` plays: marker.wav and marker.jsonl beside this file.

    python examples/make_recording.py

A synthetic person (Debian's package flite) stands before the ambiguous layout, says "hand me the green marker" while
pointing between the two markers, and answers "no" when the robot asks about one of them.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
import wave
from pathlib import Path

import numpy as np

from fetch_pomdp import Scene

HERE = Path(__file__).parent
RATE = 16_000  # Hz
LENGTH = 6.0  # s
SAID = ((0.2, "hand me the green marker"), (4.1, "no"))  # s, text
POINTING = (0.6, 2.0)  # s
FRAMES = 30.0  # a second
NOISE = 30.0  # amplitude of the room, of 32768


def speak(text: str) -> np.ndarray:
    """Return a text as flite says it, int16 at 16 kHz."""
    with tempfile.NamedTemporaryFile(suffix=".wav") as file:
        subprocess.run(["flite", "-voice", "slt", "-t", text, "-o", file.name], check=True)
        with wave.open(file.name) as sound:
            return np.frombuffer(sound.readframes(sound.getnframes()), dtype="<i2")


def make_wav(path: Path, rng: np.random.Generator) -> None:
    """Write the speech over the quiet noise of a room."""
    samples = rng.normal(0.0, NOISE, int(LENGTH * RATE))
    for start, text in SAID:
        spoken = speak(text)
        first = int(start * RATE)
        samples[first : first + len(spoken)] += spoken
    with wave.open(str(path), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(RATE)
        sound.writeframes(np.clip(samples, -32768, 32767).astype("<i2").tobytes())


def make_skeleton(path: Path, rng: np.random.Generator) -> None:
    """Write head and wrists: the right arm points between the markers, the left one hangs."""
    scene = Scene.load("ambiguous")
    head = np.array(scene.head)
    markers = np.array([item.position for item in scene.items if "marker" in item.vocabulary])
    target = markers.mean(axis=0) - head
    raised = head + 0.6 * target / np.linalg.norm(target)
    hanging = head + np.array([0.25, 0.05, -0.8])
    lines = []
    for frame in range(int(LENGTH * FRAMES)):
        time = frame / FRAMES
        right = raised if POINTING[0] <= time < POINTING[1] else hanging
        points = {"head": head, "left_wrist": head + np.array([-0.25, 0.05, -0.8]), "right_wrist": right}
        shaken = {name: (point + rng.normal(0.0, 0.01, 3)).round(3).tolist() for name, point in points.items()}
        lines.append(json.dumps({"t": round(time, 3), **shaken}))
    path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    generator = np.random.default_rng(4)
    make_wav(HERE / "marker.wav", generator)
    make_skeleton(HERE / "marker.jsonl", generator)

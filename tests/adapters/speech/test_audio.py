from __future__ import annotations

import io
import math
import os
import struct
import threading
import time
import wave
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fetch_pomdp.adapters.speech.audio import RATE, Samples, Sound, open_microphone, open_raw, open_wav
from fetch_pomdp.errors import AudioError, MissingExtraError

pytest.importorskip("soxr")

TONE = 440.0  # Hz

Callback = Callable[[bytes, int, None, None], None]


def tone(rate: int, seconds: float = 1.0) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.asarray(0.5 * np.sin(math.tau * TONE * np.arange(int(rate * seconds)) / rate))


def pcm(values: np.ndarray[Any, np.dtype[np.float64]], width: int) -> bytes:
    whole = np.round(values * (2 ** (8 * width - 1) - 1)).astype(np.int64)
    if width == 1:
        return bytes((whole + 128).tolist())
    return b"".join(int(value).to_bytes(width, "little", signed=True) for value in whole)


def write(path: Path, data: bytes, rate: int = RATE, width: int = 2, channels: int = 1) -> Path:
    with wave.open(str(path), "wb") as file:
        file.setparams((channels, width, rate, 0, "NONE", ""))
        file.writeframes(data)
    return path


def everything(sound: Sound) -> Samples:
    parts = []
    while len(part := sound.read(1000)):
        parts.append(part)
    return np.concatenate(parts)


def loudest_frequency(samples: Samples) -> float:
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return float(np.argmax(spectrum) * RATE / len(samples))


@pytest.mark.parametrize("rate", [8000, 16000, 22050, 44100, 48000])
@pytest.mark.parametrize("width", [1, 2, 3, 4])
@pytest.mark.parametrize("channels", [1, 2, 3])
def test_a_tone_keeps_its_pitch_length_and_loudness(tmp_path: Path, rate: int, width: int, channels: int) -> None:
    data = pcm(np.repeat(tone(rate), channels), width)
    samples = everything(open_wav(write(tmp_path / "tone.wav", data, rate, width, channels)))
    assert samples.dtype == np.int16
    assert abs(len(samples) - RATE) <= 2
    assert loudest_frequency(samples) == pytest.approx(TONE, abs=1.0)
    assert np.sqrt(np.mean(np.square(samples, dtype=float))) == pytest.approx(0.5 * 32768 / np.sqrt(2), rel=0.02)


def test_16_bit_samples_at_16_khz_arrive_as_they_are(tmp_path: Path) -> None:
    values = np.random.default_rng(1).integers(-32768, 32768, 5000).astype("<i2")
    assert np.array_equal(everything(open_wav(write(tmp_path / "noise.wav", values.tobytes()))), values)


def test_channels_are_averaged(tmp_path: Path) -> None:
    stereo = np.array([[1000, 3000], [-500, 100]], "<i2")
    samples = everything(open_wav(write(tmp_path / "stereo.wav", stereo.tobytes(), channels=2)))
    assert samples.tolist() == [2000, -200]


def header(tag: int = 1, channels: int = 1, rate: int = RATE, bits: int = 16, data: bytes = bytes(200)) -> bytes:
    align = channels * bits // 8
    fmt = struct.pack("<4sIHHIIHH", b"fmt ", 16, tag, channels, rate, rate * align, align, bits)
    chunks = fmt + struct.pack("<4sI", b"data", len(data)) + data
    return struct.pack("<4sI4s", b"RIFF", 4 + len(chunks), b"WAVE") + chunks


def test_an_extensible_header_and_other_chunks_are_understood(tmp_path: Path) -> None:
    guid = struct.pack("<H", 1) + bytes.fromhex("000000001000800000aa00389b71")
    fmt = struct.pack("<4sIHHIIHHHHI", b"fmt ", 40, 0xFFFE, 1, RATE, 2 * RATE, 2, 16, 22, 16, 4) + guid
    data = np.arange(100, dtype="<i2").tobytes()
    chunks = b"LIST" + struct.pack("<I", 3) + b"abc\0" + fmt + struct.pack("<4sI", b"data", len(data)) + data
    path = tmp_path / "extensible.wav"
    path.write_bytes(struct.pack("<4sI4s", b"RIFF", 4 + len(chunks), b"WAVE") + chunks)
    assert everything(open_wav(path)).tolist() == list(range(100))


BAD = {
    "empty file": (b"", "an empty file"),
    "not a WAV": (b"ID3\x04" + bytes(100), "begins with"),
    "compressed": (header(tag=0x11), "ADPCM"),
    "floating point": (header(tag=3, bits=32), "floating point"),
    "an unknown format": (header(tag=0x1234), "0x1234"),
    "12 bits": (header(bits=12), "12 bits"),
    "cut short": (header()[:-60], "140 bytes of samples, expected 200"),
    "cut in the header": (header()[:30], "a fmt chunk of 10 bytes"),
    "no fmt chunk": (header()[:12] + header()[36:], "no fmt chunk"),
    "no samples": (header(data=b""), "no samples"),
    "half a sample": (header(data=b"a"), "no samples"),
    "no data chunk": (header()[:36], "no samples, expected a data chunk"),
    "zero channels": (header(channels=0), "0 channels"),
    "zero rate": (header(rate=0), "0 Hz"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_refused_when_it_is_opened(tmp_path: Path, name: str) -> None:
    data, words = BAD[name]
    path = tmp_path / "bad.wav"
    path.write_bytes(data)
    with pytest.raises(AudioError) as caught:
        open_wav(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert words in message
    assert "expected" in message
    assert "\n" not in message


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(AudioError, match="no such file"):
        open_wav(tmp_path / "missing.wav")
    with pytest.raises(AudioError, match="directory"):
        open_wav(tmp_path)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=300) | st.binary(max_size=100).map(lambda rest: header() + rest))
def test_random_bytes_raise_nothing_but_audio_errors(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "random.wav"
    path.write_bytes(data)
    with suppress(AudioError):
        everything(open_wav(path))


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    changes=st.dictionaries(st.integers(0, 47), st.integers(0, 255), min_size=1, max_size=4), cut=st.integers(0, 250)
)
def test_a_mutated_file_raises_nothing_but_audio_errors(tmp_path: Path, changes: dict[int, int], cut: int) -> None:
    data = bytearray(header())
    for place, value in changes.items():
        data[place] = value
    path = tmp_path / "mutated.wav"
    path.write_bytes(bytes(data[: max(cut, 1)]))
    with suppress(AudioError):
        everything(open_wav(path))


def test_raw_samples_arrive_as_they_are() -> None:
    values = np.random.default_rng(2).integers(-32768, 32768, 5000).astype("<i2")
    assert np.array_equal(everything(open_raw(io.BytesIO(values.tobytes() + b"x"))), values)


@pytest.mark.parametrize("rate", [8000, 44100])
def test_raw_samples_of_another_rate_are_resampled(rate: int) -> None:
    samples = everything(open_raw(io.BytesIO(pcm(tone(rate), 2)), rate))
    assert abs(len(samples) - RATE) <= 2
    assert loudest_frequency(samples) == pytest.approx(TONE, abs=1.0)


def test_a_pipe_is_heard_before_it_ends() -> None:
    source, sink = os.pipe()
    with open(source, "rb") as reading, open(sink, "wb", buffering=0) as writing:  # noqa: PTH123 - a pipe has no path
        sound = open_raw(reading)
        writing.write(bytes(3200))
        heard: list[int] = []
        listener = threading.Thread(target=lambda: heard.append(len(sound.read(1600))))
        listener.start()
        listener.join(timeout=5.0)
        assert heard == [1600]


def test_an_unbuffered_pipe_that_writes_little_at_a_time_loses_nothing() -> None:
    source, sink = os.pipe()
    values = np.arange(2000, dtype="<i2").tobytes()

    def write_slowly() -> None:
        with open(sink, "wb", buffering=0) as writing:  # noqa: PTH123
            for start in range(0, len(values), 333):
                writing.write(values[start : start + 333])
                time.sleep(0.001)

    writer = threading.Thread(target=write_slowly)
    writer.start()
    with open(source, "rb", buffering=0) as reading:  # noqa: PTH123
        assert everything(open_raw(reading)).tolist() == list(range(2000))
    writer.join()


@pytest.mark.parametrize(("data", "words"), [(b"", "no sound"), (b"x", "no sound"), (header(), "WAV")])
def test_a_bad_pipe_is_refused_at_the_first_read(data: bytes, words: str) -> None:
    with pytest.raises(AudioError, match=f"^standard input: .*{words}"):
        open_raw(io.BytesIO(data), name="standard input").read(1)


def test_a_pipe_that_breaks_and_a_rate_that_is_none_are_audio_errors() -> None:
    class Broken(io.BytesIO):
        def read(self, _size: int | None = -1, /) -> bytes:
            raise OSError("gone")

    with pytest.raises(AudioError, match="gone"):
        open_raw(Broken()).read(1)
    with pytest.raises(AudioError, match="0 Hz"):
        open_raw(io.BytesIO(), rate=0)


class FakeDevices:
    """What sounddevice has, as far as it is used."""

    PortAudioError = RuntimeError

    def __init__(self, blocks: int = 0, error: str = "") -> None:
        self.blocks, self.error, self.closed = blocks, error, False

    def RawInputStream(self, rate: int, frames: int, *rest: object, callback: Callback) -> FakeDevices:  # noqa: N802
        assert (rate, *rest) == (RATE, None, 1, "int16")
        self.frames, self.callback = frames, callback
        if self.error:
            raise self.PortAudioError(self.error)
        return self

    def start(self) -> None:
        for _ in range(self.blocks):
            self.callback(np.full(self.frames, 7, "<i2").tobytes(), self.frames, None, None)

    def close(self) -> None:
        self.closed = True


def test_a_microphone_gives_what_it_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fetch_pomdp.adapters.speech.audio.load", lambda *_: FakeDevices(blocks=10))
    assert open_microphone().read(1000).tolist() == [7] * 1000


def test_a_microphone_nobody_listens_to_breaks(monkeypatch: pytest.MonkeyPatch) -> None:
    devices = FakeDevices(blocks=40_000)
    monkeypatch.setattr("fetch_pomdp.adapters.speech.audio.load", lambda *_: devices)
    with pytest.raises(AudioError, match="600 s of sound nobody read"):
        open_microphone().read(1000)
    assert devices.closed


def test_no_microphone_and_no_portaudio_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fetch_pomdp.adapters.speech.audio.load", lambda *_: FakeDevices(error="no device"))
    with pytest.raises(AudioError, match=r"^microphone: .*no device"):
        open_microphone()

    def without_library(*_: str) -> None:
        raise OSError("PortAudio library not found")

    monkeypatch.setattr("fetch_pomdp.adapters.speech.audio.load", without_library)
    with pytest.raises(MissingExtraError, match="apt install libportaudio2"):
        open_microphone()

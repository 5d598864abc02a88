from __future__ import annotations

import io
import math
import os
import shutil
import struct
import subprocess
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
    "GSM": (header(tag=0x31), "GSM"),
    "floating point of 16 bits": (header(tag=3), "floating point of 16 bits"),
    "A-law of 16 bits": (header(tag=6), "A-law of 16 bits"),
    "no number": (header(tag=3, bits=32, channels=2, data=np.array([0, np.nan], "<f4").tobytes()), "no numbers"),
    "an extensible format of its own": (header(tag=0xFFFE), "0xfffe"),
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


def test_a_format_that_is_not_read_says_how_to_convert_it(tmp_path: Path) -> None:
    for data in (header(tag=0x11), header(bits=12), header(tag=3), header(tag=0x1234)):
        (tmp_path / "in.wav").write_bytes(data)
        with pytest.raises(AudioError, match=r"; convert it with: sox in.wav -b 16 -e signed-integer out.wav$"):
            open_wav(tmp_path / "in.wav")


@pytest.mark.parametrize("width", [4, 8])
def test_floating_point_arrives_as_it_is_and_is_cut_off_beyond_one(tmp_path: Path, width: int) -> None:
    values = np.array([0.0, 0.5, -0.25, 1.0, -1.0, 7.0, -np.inf, 1 / 32768], f"<f{width}")
    path = tmp_path / "float.wav"
    path.write_bytes(header(tag=3, bits=8 * width, data=values.tobytes()))
    assert everything(open_wav(path)).tolist() == [0, 16384, -8192, 32767, -32768, 32767, -32768, 1]


# Values of ITU-T G.711 on a scale of 16 bits: the least and largest of each sign, and one in between.
@pytest.mark.parametrize(
    ("tag", "codes", "values"),
    [
        (6, [0xD5, 0x55, 0xAA, 0x2A, 0x80, 0x00], [8, -8, 32256, -32256, 5504, -5504]),
        (7, [0xFF, 0x7F, 0x80, 0x00, 0xBF, 0x3F], [0, 0, 32124, -32124, 1980, -1980]),
    ],
)
def test_a_law_and_mu_law_by_hand(tmp_path: Path, tag: int, codes: list[int], values: list[int]) -> None:
    path = tmp_path / "law.wav"
    path.write_bytes(header(tag=tag, bits=8, data=bytes(codes)))
    assert everything(open_wav(path)).tolist() == values


@pytest.mark.parametrize("length", [0, 0x7FFFF000, 0xFFFFFFFF])
def test_sizes_that_a_pipe_left_open(tmp_path: Path, length: int) -> None:
    data = bytearray(header(data=np.arange(100, dtype="<i2").tobytes() + b"x"))
    data[4:8] = data[40:44] = struct.pack("<I", length)
    path = tmp_path / "streamed.wav"
    path.write_bytes(bytes(data))
    assert everything(open_wav(path)).tolist() == list(range(100))


def test_a_chunk_after_no_samples_is_no_sound(tmp_path: Path) -> None:
    data = bytearray(header(data=b"") + b"LIST" + struct.pack("<I", 4) + bytes(4))
    data[4:8] = struct.pack("<I", len(data) - 8)
    (tmp_path / "none.wav").write_bytes(bytes(data))
    with pytest.raises(AudioError, match="no samples"):
        open_wav(tmp_path / "none.wav")


SOX = pytest.mark.skipif(shutil.which("sox") is None, reason="sox is not installed")
KINDS = [
    "-b 8",
    "-b 16",
    "-b 24",
    "-b 32",
    "-e floating-point -b 32",
    "-e floating-point -b 64",
    "-e a-law",
    "-e mu-law",
]


@SOX
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("piped", [False, True])
@pytest.mark.parametrize("channels", [1, 2])
def test_what_sox_writes(tmp_path: Path, kind: str, piped: bool, channels: int) -> None:
    values = np.round(tone(RATE) * 32767).astype("<i2")
    given = write(tmp_path / "tone.wav", np.repeat(values, channels).tobytes(), channels=channels)
    path = tmp_path / "sox.wav"
    command = ["sox", "-D", "-V1", str(given), *kind.split(), "-t", "wav", "-" if piped else str(path)]
    out = subprocess.run(command, capture_output=True, check=True).stdout
    if piped:
        path.write_bytes(out)
    samples = everything(open_wav(path))
    assert len(samples) == RATE
    off = np.abs(samples.astype(float) - values).max()
    assert off <= (
        128
        if kind == "-b 8"
        else 520
        if "law" in kind  # half of the widest step, and what they leave out of 16 bits
        else 0
    )


@SOX
@pytest.mark.parametrize("tag", [6, 7])
def test_every_code_is_what_it_is_for_sox(tmp_path: Path, tag: int) -> None:
    path = tmp_path / "law.wav"
    path.write_bytes(header(tag=tag, bits=8, data=bytes(range(256))))
    command = ["sox", "-D", "-V1", str(path), "-b", "16", "-e", "signed-integer", "-t", "raw", "-"]
    out = subprocess.run(command, capture_output=True, check=True).stdout
    assert everything(open_wav(path)).tolist() == np.frombuffer(out, "<i2").tolist()


@SOX
@pytest.mark.parametrize("kind", ["-e ima-adpcm", "-e ms-adpcm", "-e gsm-full-rate"])
def test_what_sox_writes_and_we_refuse(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "sox.wav"
    given = write(tmp_path / "tone.wav", pcm(tone(RATE), 2))
    subprocess.run(["sox", "-V1", str(given), *kind.split(), str(path)], capture_output=True, check=True)
    with pytest.raises(AudioError, match="convert it with: sox"):
        open_wav(path)


@pytest.mark.parametrize(
    ("left", "right", "heard"),
    [(1.0, -1.0, 1.0), (-0.99, 1.0, 1.0), (1.0, 0.0, 0.5), (1.0, 1.0, 1.0), (0.5, -1.0, -0.25)],
)
def test_of_channels_that_cancel_the_loudest_is_taken(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, left: float, right: float, heard: float
) -> None:
    stereo = np.round(np.outer(tone(RATE), [left, right]) * 20000).astype("<i2")
    path = write(tmp_path / "stereo.wav", stereo.tobytes(), channels=2)
    samples = everything(open_wav(path))
    assert np.abs(samples - tone(RATE) * 20000 * heard).max() <= 2
    cancel = left + right < 0.02
    said = f"{path}: the channels cancel each other when mixed: only channel {1 if left == 1.0 else 2} is heard"
    assert [record.getMessage() for record in caplog.records] == ([said] if cancel and heard == 1.0 else [])


def test_silence_in_two_channels_is_silence(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    assert not everything(open_wav(write(tmp_path / "silence.wav", bytes(400), channels=2))).any()
    assert not caplog.records


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

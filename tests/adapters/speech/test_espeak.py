from __future__ import annotations

import io
import shutil
import wave

import numpy as np
import pytest

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.errors import AudioError, MissingExtraError

pytest.importorskip("soxr")
needs_espeak = pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed")


@needs_espeak
def test_a_text_is_sound_at_our_rate_and_is_kept() -> None:
    voice = Voice()
    data = voice.wav("this one?")
    with wave.open(io.BytesIO(data)) as sound:
        assert (sound.getnchannels(), sound.getsampwidth(), sound.getframerate()) == (1, 2, 16_000)
        samples = np.frombuffer(sound.readframes(sound.getnframes()), "<i2")
    assert 0.5 < len(samples) / 16_000 < 1.5
    assert voice.seconds("this one?") == pytest.approx(len(samples) / 16_000)
    assert np.abs(samples).max() > 3000
    assert voice.wav("this one?") is data


@needs_espeak
def test_a_text_is_never_an_option_nor_markup() -> None:
    assert Voice().seconds("--version") > 0.3


@needs_espeak
def test_what_cannot_be_said() -> None:
    with pytest.raises(AudioError, match=r"^klingonisch: found .*, expected a voice of espeak-ng"):
        Voice("klingonisch")
    with pytest.raises(AudioError, match="found a text of 501 letters"):
        Voice().wav("a" * 501)


def test_without_espeak_the_line_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(MissingExtraError, match="apt install espeak-ng"):
        Voice()

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.adapters.speech.denoise import denoise


def test_noise_is_taken_out_and_a_tone_stays() -> None:
    noise = np.random.default_rng(0).standard_normal(32_000) * 100
    tone = np.zeros(32_000)
    tone[12_000:20_000] = 1000 * np.sin(np.arange(8000) * 0.3)
    cleaned = denoise(tone + noise)
    assert np.std(cleaned[:10_000]) < 0.25 * np.std(noise)
    middle = slice(13_000, 19_000)
    assert np.std(cleaned[middle] - tone[middle]) < 0.5 * np.std(noise)


@pytest.mark.parametrize("length", [0, 1, 160, 2048, 4097])
def test_the_length_stays_and_silence_stays_silent(length: int) -> None:
    assert np.array_equal(denoise(np.zeros(length)), np.zeros(length))
    assert np.isfinite(denoise(np.random.default_rng(0).standard_normal(length))).all()

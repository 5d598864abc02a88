from __future__ import annotations

import io
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE, open_raw
from fetch_pomdp.adapters.speech.utterances import SpeechSegment, Utterances


def noise(seconds: float, loudness: float, seed: int = 0) -> NDArray[np.float64]:
    return np.random.default_rng(seed).standard_normal(round(seconds * RATE)) * loudness


def utterances(samples: NDArray[np.float64]) -> list[SpeechSegment]:
    heard = Utterances(open_raw(io.BytesIO(samples.astype("<i2").tobytes())))
    found = []
    while not heard.ended:
        if utterance := heard.step():
            found.append(utterance)
    return found


@pytest.mark.parametrize("loudness", [0.0, 1.0, 30.0, 3000.0])
def test_silence_and_steady_noise_hold_no_utterance(loudness: float) -> None:
    assert utterances(noise(8.0, loudness)) == []


@pytest.mark.parametrize("background", [0.0, 100.0, 1000.0])
def test_a_sound_is_found_where_it_is(background: float) -> None:
    samples = noise(4.0, background)
    samples[RATE : 2 * RATE] += noise(1.0, 3000.0, seed=1)
    (found,) = utterances(samples)
    assert found.start == pytest.approx(1.0 - 0.3, abs=0.05)
    assert found.start + len(found.samples) / RATE == pytest.approx(2.0 + 0.3, abs=0.06)


def test_two_sounds_are_two_utterances_that_do_not_overlap() -> None:
    samples = noise(5.0, 10.0)
    samples[RATE : RATE + 8000] += 100 * noise(0.5, 30.0, seed=1)
    samples[2 * RATE + 4000 : 3 * RATE] += 100 * noise(0.75, 30.0, seed=2)
    first, second = utterances(samples)
    assert first.start + len(first.samples) / RATE <= second.start


def test_a_sound_without_end_is_cut_into_pieces_that_lose_nothing() -> None:
    bursts = np.tile(np.concatenate([noise(0.4, 3000.0), noise(0.2, 10.0)]), 60)  # 36 s, no pause long enough to end it
    found = utterances(bursts)
    assert len(found) >= 4
    for before, after in pairwise(found):
        assert before.start + len(before.samples) / RATE == pytest.approx(after.start)
        assert np.abs(before.samples[-160:]).max() < 100  # cut where it is quiet
    assert max(len(utterance.samples) for utterance in found) <= 10 * RATE

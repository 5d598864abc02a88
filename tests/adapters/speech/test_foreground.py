"""Speech over that of others, with Silero's place taken by one that calls everything speech."""

from __future__ import annotations

import io

import numpy as np
import pytest
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE, Samples, open_raw
from fetch_pomdp.adapters.speech.foreground import Foreground
from fetch_pomdp.adapters.speech.utterances import Utterances


def everything(frame: Samples, above: float, speaking: bool) -> bool:  # noqa: ARG001
    return True


def found(samples: NDArray[np.float64]) -> list[tuple[float, float]]:
    """Return where utterances begin and end (s)."""
    heard = Utterances(open_raw(io.BytesIO(samples.astype("<i2").tobytes())), Foreground(everything))
    utterances = []
    while not heard.ended:
        if utterance := heard.step():
            utterances.append((utterance.start, utterance.start + len(utterance.samples) / RATE))
    return utterances


def babble(seconds: float, level: float, seed: int = 0) -> NDArray[np.float64]:
    """Return noise whose power varies from syllable to syllable as that of six voices together does."""
    rng = np.random.default_rng(seed)
    syllables = np.repeat(rng.chisquare(6, round(seconds * 5)) / 6, RATE // 5)
    return rng.standard_normal(len(syllables)) * np.sqrt(syllables) * level


@pytest.mark.parametrize("background", [0.0, 30.0, 300.0])
def test_over_others_who_talk_the_one_who_is_nearer_is_found(background: float) -> None:
    samples = babble(12.0, background)
    samples[8 * RATE : 9 * RATE] += babble(1.0, 1000.0, seed=1)
    near = [(begin, end) for begin, end in found(samples) if end > 8.0 and begin < 9.0]
    assert len(near) == 1
    ((begin, end),) = near
    assert begin == pytest.approx(7.65, abs=0.15)
    assert end == pytest.approx(9.35, abs=0.15)


def test_others_alone_are_seldom_taken_for_it() -> None:
    assert sum(end - begin for begin, end in found(babble(60.0, 300.0))) < 12.0


def test_somebody_who_talks_from_the_beginning_is_heard() -> None:
    samples = np.concatenate([babble(1.5, 1000.0, seed=1), babble(3.0, 10.0)])
    assert found(samples)[0][0] == pytest.approx(0.0, abs=0.2)


def test_somebody_who_talks_on_and_on_is_heard_to_the_end() -> None:
    words = np.tile(np.concatenate([babble(0.8, 1000.0, seed=2), babble(0.2, 10.0)]), 8)
    samples = np.concatenate([babble(2.0, 10.0, seed=3), words, babble(2.0, 10.0, seed=4)])
    spans = found(samples)
    assert spans[0][0] < 2.1
    assert spans[-1][1] > 9.7
    assert sum(end - begin for begin, end in spans) > 7.5

"""What the robot says is taken out of what is heard: by a filter that knows the way back, and by the real ones."""

from __future__ import annotations

import io
from collections import deque

import numpy as np
import pytest
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE, Samples, open_raw
from fetch_pomdp.adapters.speech.echo import AHEAD, Played, WithoutEcho
from fetch_pomdp.adapters.speech.utterances import FRAME
from fetch_pomdp.errors import AudioError

QUIET = 20.0  # root mean square of the room
LOUD = 2000.0


class KnownEcho:
    """An exact canceller of an echo that comes 30 ms later, told what is played 20 ms early. left: what it leaves."""

    def __init__(self, gain: float, left: float) -> None:
        self._gain, self._left = gain, left
        self._before = deque([np.zeros(FRAME)] * (3 + AHEAD))

    def __call__(self, heard: Samples, played: Samples) -> Samples:
        self._before.append(played.astype(float))
        echo = self._gain * self._before.popleft()
        return np.asarray(np.round(heard - (1 - self._left) * echo), np.int16)


def noise(seconds: float, level: float, seed: int) -> NDArray[np.float64]:
    return np.random.default_rng(seed).standard_normal(round(seconds * RATE)) * level


def delayed(samples: NDArray[np.float64], frames: int, gain: float) -> NDArray[np.float64]:
    return gain * np.concatenate([np.zeros(frames * FRAME), samples])[: len(samples)]


def raw(samples: NDArray[np.float64]) -> io.BytesIO:
    return io.BytesIO(np.round(samples).astype("<i2").tobytes())


def level(samples: Samples, begin: float, end: float) -> float:
    """Return the root mean square from one time (s) to another."""
    return float(np.sqrt(np.mean(np.square(samples[round(begin * RATE) : round(end * RATE)], dtype=float))))


@pytest.fixture
def robot() -> NDArray[np.float64]:
    """Three seconds; the robot plays in the second."""
    return np.concatenate([np.zeros(RATE), noise(1.0, LOUD, seed=1), np.zeros(RATE)])


def played(robot: NDArray[np.float64]) -> Played:
    known = Played()
    known.play(np.round(robot[RATE : 2 * RATE]).astype(np.int16), 1.0)
    return known


def test_the_robot_alone_is_silence_and_what_is_heard_otherwise_is_as_it_was(robot: NDArray[np.float64]) -> None:
    room = noise(3.0, QUIET, seed=2)
    heard = raw(room + delayed(robot, 3, 0.5))
    cleaned = WithoutEcho(open_raw(heard), played(robot), KnownEcho(0.5, left=0.1)).read(10 * RATE)
    assert len(cleaned) == 3 * RATE
    assert level(cleaned, 1.0, 2.0) == 0
    before = RATE - AHEAD * FRAME
    assert np.array_equal(cleaned[:before], np.round(room)[:before])
    assert np.array_equal(cleaned[-RATE // 2 :], np.round(room)[-RATE // 2 :])


def test_who_speaks_over_the_robot_is_heard(robot: NDArray[np.float64]) -> None:
    person = np.concatenate([np.zeros(round(1.4 * RATE)), noise(0.3, LOUD, seed=3), np.zeros(round(1.3 * RATE))])
    heard = raw(noise(3.0, QUIET, seed=2) + delayed(robot, 3, 0.5) + person)
    cleaned = WithoutEcho(open_raw(heard), played(robot), KnownEcho(0.5, left=0.1)).read(3 * RATE)
    assert level(cleaned, 1.4, 1.7) == pytest.approx(LOUD, rel=0.05)
    assert level(cleaned, 1.05, 1.2) == 0


@pytest.mark.parametrize("count", [1, 159, 160, 1000])
def test_it_is_read_in_any_pieces(count: int) -> None:
    sound = noise(1.005, LOUD, seed=4)
    whole = WithoutEcho(open_raw(raw(sound)), Played(), KnownEcho(0.0, left=0.0))
    pieces = []
    while len(piece := whole.read(count)):
        pieces.append(piece)
    assert np.array_equal(np.concatenate(pieces), np.round(sound))


def test_what_is_played_lies_at_its_time_and_adds_up() -> None:
    known = Played()
    known.play(np.full(4, 30_000, np.int16), 2 / RATE)
    known.play(np.full(2, 5_000, np.int16), 4 / RATE)
    assert known.read(3).tolist() == [0, 0, 30_000]
    assert known.read(5).tolist() == [30_000, 32_767, 32_767, 0, 0]
    with pytest.raises(AudioError, match=r"robot's voice: found sound that began at 0.000 s, expected it"):
        known.play(np.zeros(1, np.int16), 0.0)


def test_the_real_cancellers_leave_nothing_of_the_robot(robot: NDArray[np.float64]) -> None:
    pytest.importorskip("livekit.rtc", reason="needs fetch-pomdp[echo]")
    pytest.importorskip("pyaec", reason="needs fetch-pomdp[echo]")
    heard = noise(3.0, QUIET, seed=2) + delayed(robot, 1, 0.6) + delayed(robot, 4, 0.2)
    cleaned = WithoutEcho(open_raw(raw(heard)), played(robot)).read(3 * RATE)
    assert level(cleaned, 1.0, 2.0) < 2 * QUIET
    assert level(cleaned, 2.6, 3.0) > QUIET / 2

"""What is recorded of a trial: its clock, and its sound."""

from __future__ import annotations

import pytest

from fetch_pomdp.user_study.recorder import NOTED, TrialRecorder

FRAME = 1_280  # bytes: 40 ms


class Trial:
    """A trial that remembers what it was told to keep."""

    def __init__(self) -> None:
        self.clocks, self.sounds = list[float](), list[tuple[float, bytes]]()

    def note_clock(self, time: float) -> None:
        self.clocks.append(time)

    def keep_sound(self, start: float, pcm: bytes) -> None:
        self.sounds.append((start, pcm))


class Hand:
    """A clock that shows what it is set to."""

    time = 0.0

    def now(self) -> float:
        return self.time


@pytest.fixture
def trial() -> Trial:
    return Trial()


@pytest.fixture
def hand() -> Hand:
    return Hand()


@pytest.fixture
def recorder(trial: Trial, hand: Hand) -> TrialRecorder:
    return TrialRecorder(trial, hand)  # type: ignore[arg-type]


def test_sound_is_written_a_second_at_a_time(recorder: TrialRecorder, trial: Trial) -> None:
    frames = [bytes([number]) * FRAME for number in range(60)]
    for number, frame in enumerate(frames):
        recorder.add_sound(2.0 + 0.04 * number, frame)
    recorder.flush()
    recorder.flush()
    assert [len(pcm) for _, pcm in trial.sounds] == [32_000, 32_000, 12_800]
    assert [start for start, _ in trial.sounds] == pytest.approx([2.0, 3.0, 4.0])
    assert b"".join(pcm for _, pcm in trial.sounds) == b"".join(frames)


def test_sound_after_a_silence_is_a_piece_of_its_own(recorder: TrialRecorder, trial: Trial) -> None:
    for start in (1.0, 1.04 + 0.09, 3.0):  # the second is late, the third comes after a silence
        recorder.add_sound(start, bytes(FRAME))
    recorder.flush()
    assert [(start, len(pcm)) for start, pcm in trial.sounds] == [(1.0, 2 * FRAME), (3.0, FRAME)]


def test_the_clock_is_noted_now_and_then(recorder: TrialRecorder, trial: Trial, hand: Hand) -> None:
    for hand.time in (0.1, NOTED - 0.1, NOTED, NOTED + 1, 2 * NOTED + 0.5):
        recorder.note_clock()
    assert trial.clocks == [NOTED, 2 * NOTED + 0.5]

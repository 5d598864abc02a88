"""What is recorded of a trial besides its events: its clock, and its sound.

Choice: a trial's clock stands still while nobody is there and runs while somebody is, even if nothing happens, so that
the time of an interrupted trial includes all of its person's thinking and none of their absence. It is noted every
NOTED seconds, which is the most that is lost of it when a server is killed.
"""

from __future__ import annotations

from fetch_pomdp.core.live.clock import Clock
from fetch_pomdp.user_study.store.exporting import JITTER
from fetch_pomdp.user_study.store.trials import SECOND, StoredTrial

NOTED = 5.0  # s


class TrialRecorder:
    """Records a trial's clock and, a second at a time, its sound."""

    def __init__(self, trial: StoredTrial, clock: Clock) -> None:
        self._trial, self._clock = trial, clock
        self._noted = clock.now()
        self._start, self._pcm = 0.0, bytearray()

    def note_clock(self) -> None:
        """Note the clock, if it is time to."""
        if (now := self._clock.now()) - self._noted >= NOTED:
            self._trial.note_clock(now)
            self._noted = now

    def add_sound(self, start: float, pcm: bytes) -> None:
        """Add sound that began at a time (s) of the clock."""
        if start - (self._start + len(self._pcm) / SECOND) > JITTER:
            self.flush()
        if not self._pcm:
            self._start = start
        self._pcm += pcm
        if len(self._pcm) >= SECOND:
            self.flush()

    def flush(self) -> None:
        """Write the sound that was gathered."""
        if self._pcm:
            pcm, self._pcm = bytes(self._pcm), bytearray()
            self._trial.keep_sound(self._start, pcm)

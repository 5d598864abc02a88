"""What is kept of a trial besides its events: what its clock showed, and its sound.

Choice: a trial's clock stands still while nobody is there and runs while somebody is, though nothing happens, so that
the time of a trial that was left holds all that its person thought and none in which they were away. It is noted every
NOTED seconds, which is the most that a server that is killed forgets of it.
"""

from __future__ import annotations

from fetch_pomdp.adapters.store.journal import SECOND, TrialJournal
from fetch_pomdp.adapters.store.sound import JITTER
from fetch_pomdp.core.live.clock import Clock

NOTED = 5.0  # s


class Keeping:
    """Keeps a trial's clock and, a second at a time, its sound."""

    def __init__(self, trial: TrialJournal, clock: Clock) -> None:
        self._trial, self._clock = trial, clock
        self._noted = clock.now()
        self._start, self._pcm = 0.0, bytearray()

    def look(self) -> None:
        """Note the clock, if it is time to."""
        if (now := self._clock.now()) - self._noted >= NOTED:
            self._trial.note_clock(now)
            self._noted = now

    def sound(self, start: float, pcm: bytes) -> None:
        """Keep sound that began at a time (s) of the clock."""
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

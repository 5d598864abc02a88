"""A person at the keyboard: ears and eyes for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fetch_pomdp.core.ports import Frame, Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import SceneError

ARM = 0.6  # m, how far the wrist of a typed gesture is from the head
POINTS = "@"  # before the id of an item that is pointed at


class TypedPerson:
    """A Recognizer and a SkeletonSource whose person types, once a step: words to say, and @item to point at an item.

    ask: returns a line, and raises EOFError when the person has left; complain: is told what could not be understood.
    """

    def __init__(self, scene: Scene, ask: Callable[[], str], complain: Callable[[str], None]) -> None:
        self._scene, self._ask, self._complain = scene, ask, complain
        self._time = 0.0
        self._gesture: Frame | None = None

    def hear(self, until: float) -> Sequence[Word]:
        """Ask for a line once in every stretch of time; its words all end at `until`."""
        if until <= self._time:
            return []
        start, self._time = self._time, until
        while True:
            parts = self._ask().split()
            try:
                self._gesture = self._frame([part[1:] for part in parts if part.startswith(POINTS)], until)
            except SceneError as error:
                self._complain(str(error))
                continue
            return [Word(part, start, until) for part in parts if not part.startswith(POINTS)]

    def see(self, until: float) -> Sequence[Frame]:  # noqa: ARG002
        """Return the gesture of the last line, once."""
        gesture, self._gesture = self._gesture, None
        return [] if gesture is None else [gesture]

    def _frame(self, ids: list[str], time: float) -> Frame | None:
        if not ids:
            return None
        head, target = self._scene.head, self._scene.items[self._scene.index(ids[-1])].position
        arm = tuple(there - here for here, there in zip(head, target, strict=True))
        length = sum(part * part for part in arm) ** 0.5
        x, y, z = (here + part * ARM / length for here, part in zip(head, arm, strict=True))
        return Frame(time, head, ((x, y, z),))

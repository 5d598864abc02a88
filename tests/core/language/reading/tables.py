"""Tables that the tests of the reader talk about."""

from __future__ import annotations

from fetch_pomdp.core.language.reading.reader import Context, Heard, TableReader
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.scene import Item, Scene

READER = TableReader()


def scene(*items: tuple[str, float, float], **more: object) -> Scene:
    """Items (words, x, y) before a person at the origin who looks along y; an id is all words joined, and a number."""
    made = [
        Item(id=f"{words.replace(' ', '-')}-{number}", position=(x, y, 0.75), vocabulary=tuple(words.split()))
        for number, (words, x, y) in enumerate(items, start=1)
    ]
    return Scene(items=tuple(made), head=(0.0, 0.0, 1.6), **more)  # type: ignore[arg-type]


# In a line from the person's left to their right; the robot faces them.
LINE = scene(("red mug", -0.3, 0.8), ("green mug", -0.1, 0.8), ("red mug", 0.1, 0.8), ("white bowl", 0.3, 0.8))
# Three bowls in a row on the person's right, a lone bowl on their left, plates near and far.
ROOM = scene(
    ("blue bowl", 0.2, 0.9), ("blue bowl", 0.3, 0.9), ("blue bowl", 0.4, 0.9), ("blue bowl", -0.4, 0.7),
    ("white plate", 0.0, 0.5), ("white plate", 0.0, 1.2), ("black pan", -0.3, 0.95),
)  # fmt: skip


def heard(text: str, table: Scene = LINE, context: Context | None = None) -> Heard:
    """Read a text about a table."""
    return READER.read(words_of(text), table, context or Context())


def meant(text: str, table: Scene = LINE, context: Context | None = None) -> int:
    """Return the index of the likeliest item."""
    return int(heard(text, table, context).log_likelihood.argmax())

"""What a language model is told of a table and asked about it, and the labels that it may answer with."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from fetch_pomdp.core.language.reading.reader import Context
from fetch_pomdp.core.language.reading.table import SPEAKER, Table
from fetch_pomdp.core.language.reading.tokens import STOP
from fetch_pomdp.core.scene import Scene

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
UNCLEAR = "?"  # what a model says that cannot tell
TASK = (
    "You hear what a person at a table asks a robot for, and are told what stands on the table. Say which item the "
    f"person means: its label alone, or {UNCLEAR} if nobody could tell."
)


def labels(count: int) -> tuple[str, ...]:
    """Return a label for each item: letters, which models have as one token, or numbers where these do not suffice."""
    return tuple(LETTERS[:count]) if count <= len(LETTERS) else tuple(str(index + 1) for index in range(count))


def messages(words: Sequence[str], scene: Scene, context: Context) -> list[dict[str, str]]:
    """Return the chat that asks which item of a scene was meant. Places are as the person sees them, in metres."""
    table, names = Table.of(scene), labels(len(scene.items))
    right, away = table.axes[SPEAKER]

    def place(point: Sequence[float]) -> str:
        offset = np.asarray(point) - table.people[SPEAKER]
        return f"x {offset @ right:.2f}, y {offset @ away:.2f}"

    lines = ["x is metres to the person's right, y metres away from the person, who looks along y."]
    for name, item, point, front in zip(names, scene.items, table.points, table.facing, strict=True):
        facing = f", its front towards x {front @ right:+.2f}, y {front @ away:+.2f}" if front.any() else ""
        lines.append(f"{name}: {' '.join(item.vocabulary)} ({json.dumps(item.id)}), {place(point)}{facing}")
    lines.append(f"The robot is at {place(table.people[1])}, and looks at the items.")
    if context.before.asked is not None:
        lines.append(f'The robot pointed at {names[context.before.asked]} and asked "this one?".')
    if context.before.meaning is not None:
        lines.append(f"Before, the person asked for: {context.before.meaning}.")
    said = " ".join(words).replace(f" {STOP}", STOP)
    lines.append(f"The person says: {json.dumps(said, ensure_ascii=False)}. Which item is meant?")
    return [{"role": "system", "content": TASK}, {"role": "user", "content": "\n".join(lines)}]

"""Tables of trials made up for tests of their analysis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas

ITEMS = ("bowl-1", "bowl-2", "marker-1", "marker-2", "spoon-1", "spoon-2")
PAPER = {  # mean time (s) and accuracy of each cell, Section IV-D solved
    "ambiguous": {"never": (8.57, 0.826), "always": (10.21, 0.89), "fetch": (9.16, 0.937)},
    "unambiguous": {"never": (5.20, 0.982), "always": (7.83, 0.98), "fetch": (4.55, 0.975)},
}
Cells = Mapping[str, Mapping[str, tuple[float, float]]]


def drawn(people: int, seed: int, means: Cells = PAPER, spread: float = 0.3, repeats: int = 3) -> Any:
    """Draw a study with `people` in each layout.

    The logarithm of a time is normal: the cell's level, a person's offset (sd 0.15), an offset of the person with this
    paradigm (sd 0.05), a trial's (sd `spread`). A trial is right with the person's own chance, beta-distributed around
    the cell's with 30 pseudo-trials. So the means of the cells are those given, exactly.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for place, (layout, cells) in enumerate(means.items()):
        for person in range(place * people, (place + 1) * people):
            offset = rng.normal(0, 0.15)
            orders = iter(rng.permutation(len(cells) * len(ITEMS) * repeats))
            for paradigm, (time, accuracy) in cells.items():
                level = offset + rng.normal(0, 0.05) - (0.15**2 + 0.05**2 + spread**2) / 2
                chance = rng.beta(30 * accuracy, 30 * (1 - accuracy)) if 0 < accuracy < 1 else accuracy
                for desired in ITEMS * repeats:
                    right = bool(rng.random() < chance)
                    rows.append(
                        {
                            "person": person,
                            "layout": layout,
                            "paradigm": paradigm,
                            "desired": desired,
                            "order": int(next(orders)),
                            "time": float(time * np.exp(level + rng.normal(0, spread))),
                            "correct": right,
                            "picked": desired if right else "other",
                            "questions": int(paradigm == "always") + int(rng.random() < 0.2),
                            "waits": int(rng.integers(4)),
                        }
                    )
    return pandas.DataFrame(rows)


def table(rows: Sequence[tuple[int, str, float, bool]], layout: str = "unambiguous") -> Any:
    """Make a table of (person, paradigm, time, correct); trials are of one item, in the order given."""
    return pandas.DataFrame(
        [
            {
                "person": person,
                "layout": layout,
                "paradigm": paradigm,
                "desired": "cup",
                "order": order,
                "time": time,
                "correct": correct,
                "picked": "cup" if correct else "mug",
                "questions": 0,
                "waits": 1,
            }
            for order, (person, paradigm, time, correct) in enumerate(rows)
        ]
    )

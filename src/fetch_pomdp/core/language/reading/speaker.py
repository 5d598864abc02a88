"""What a person who wants an item might have said instead: how well a few short descriptions tell each item apart.

Rational speech acts: of several descriptions a person says one the more often, the better it tells the item apart and
the shorter it is. So what was said speaks less for an item that something short and plain would have told apart: what
was not said counts. The paper's implicature [21] is the special case of one word more.

Choice: the alternatives are each word of the table alone and with one of ten plain additions (an utmost side of
somebody's, nearest and farthest, in the middle, by itself), not all that a grammar can say.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fetch_pomdp.core.language.reading.degrees import Array
from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.form import Alone, Description, Form, Middle, Person, Select, Side, Superlative

LEAST = 1e-12
ADDITIONS: tuple[Form, ...] = (
    *(Side((side,), viewer, extreme=True) for side in ("left", "right") for viewer in Person),
    *(Superlative(whom, far) for whom in Person for far in (False, True)),
    Middle(),
    Alone(),
)


def alternatives(words: frozenset[str]) -> list[tuple[Description, int]]:
    """Return what may be said of items with these words, and how many additions it has."""
    plain = [Description((Select(word),)) for word in sorted(words)] or [Description()]
    return [(each, 0) for each in plain] + [(each.plus(addition), 1) for each in plain for addition in ADDITIONS]


def ease(denotation: Denotation) -> Array:
    """Return how easily each item is told apart, (..., n): the logarithm of the sum over what might be said of it."""
    w: Any = denotation.w
    table, logs = denotation.table, []
    for said, additions in alternatives(table.vocabulary.named):
        degree = np.maximum(denotation.of(said), LEAST)
        chances = (degree / degree.sum(axis=-1, keepdims=True)).mean(axis=-2, keepdims=True)
        logs.append(w.speaker_sharpness * np.log(chances) - w.speaker_length * additions)
    return np.logaddexp.reduce(np.stack(np.broadcast_arrays(*logs)), axis=0)[..., 0, :]

"""Which reader reads what people say: our grammar unless another is named, as "words" or "table:german"."""

from __future__ import annotations

from pathlib import Path

from fetch_pomdp.core.language.reading.grammar import LANGUAGES
from fetch_pomdp.core.language.reading.reader import Reader, TableReader
from fetch_pomdp.core.language.reading.weights import Weights, weights_of
from fetch_pomdp.errors import InputError

WORDS, TABLE = "words", "table"
DEFAULT = TABLE
EXPECTED = f"expected {WORDS}, {TABLE} or {TABLE}:LANGUAGE, of {' and '.join(LANGUAGES)}"


def reader_named(name: str = DEFAULT, *, weights: Path | None = None) -> Reader | None:
    """Return a reader by name, as `Agent(reader=...)` takes it: None is the paper's, word by word (Eq. 4, 5).

    name: words, table or table:LANGUAGE. weights: a file of `fit-reader`, in place of what comes with the package.
    Raises InputError for another name, or for weights that the reader has no use for.
    """
    kind, _, rest = name.partition(":")
    if name == WORDS:
        if weights is not None:
            raise InputError(f"found a file, expected none with {WORDS}, which has no weights", field="weights")
        return None
    if name == TABLE or (kind == TABLE and rest in LANGUAGES):
        learnt = None if weights is None else Weights.of(weights_of(weights))
        return TableReader(rest or LANGUAGES[0], learnt)
    raise InputError(f"found {name!r}, {EXPECTED}", field="reader")

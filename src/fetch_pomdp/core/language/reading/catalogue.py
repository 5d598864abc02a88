"""Our readers by name: "words" is the paper's, word by word (Eq. 4, 5), and "table:LANGUAGE" reads with a grammar."""

from __future__ import annotations

import functools

from fetch_pomdp.core.language.reading.grammar import LANGUAGES
from fetch_pomdp.core.language.reading.reader import Reader, TableReader
from fetch_pomdp.core.language.reading.weights import Weights
from fetch_pomdp.errors import InputError

WORDS, TABLE = "words", "table"
OWN = (WORDS, TABLE)
DEFAULT = TABLE  # where people are real
OWN_EXPECTED = f"{WORDS}, {TABLE}, {TABLE}:LANGUAGE (of {', '.join(LANGUAGES)})"


def own_reader(name: str, weights: Weights | None = None) -> Reader | None:
    """Return a reader of ours, as `Agent(reader=...)` takes it: None is the paper's.

    name: words, table or table:LANGUAGE; one of a name is shared. weights: in place of what comes with the package.
    Raises InputError for another name, or for weights that the reader has no use for.
    """
    kind, _, language = name.partition(":")
    if name == WORDS:
        if weights is not None:
            raise InputError(f"found a file, expected none with {WORDS}, which has no weights", field="weights")
        return None
    if name != TABLE and (kind != TABLE or language not in LANGUAGES):
        raise InputError(f"found {name!r}, expected {OWN_EXPECTED}", field="reader")
    language = language or LANGUAGES[0]
    return _table_reader(language) if weights is None else TableReader(language, weights)


def recorded_reader(name: str) -> Reader | None:
    """Return what a record is read with whose reader had a name: ours, and our grammar where it was another's."""
    return own_reader(name if name.partition(":")[0] in OWN else TABLE)


@functools.cache
def _table_reader(language: str) -> TableReader:
    return TableReader(language)

"""Our readers by name: "words" is the paper's, word by word (Eq. 4, 5), and "table:LANGUAGE" reads with a grammar."""

from __future__ import annotations

import functools

from fetch_pomdp.core.language.reading.grammar import LANGUAGES
from fetch_pomdp.core.language.reading.reader import Reader, TableReader
from fetch_pomdp.errors import InputError

WORDS, TABLE = "words", "table"
DEFAULT = TABLE  # where people are real
EXPECTED = f"{WORDS}, {TABLE} or {TABLE}:LANGUAGE, of {' and '.join(LANGUAGES)}"


def own_reader(name: str) -> Reader | None:
    """Return a reader of ours, as `Agent(reader=...)` takes it: None is the paper's.

    name: words, table or table:LANGUAGE; one of a name is shared. Raises InputError for another name.
    """
    kind, _, language = name.partition(":")
    if name == WORDS:
        return None
    if name == TABLE or (kind == TABLE and language in LANGUAGES):
        return _table_reader(language or LANGUAGES[0])
    raise InputError(f"found {name!r}, expected {EXPECTED}", field="reader")


def recorded_reader(name: str) -> Reader | None:
    """Return what a record is read with whose reader had a name: ours, and our grammar where it was another's."""
    return own_reader(name if name == WORDS or name.partition(":")[0] == TABLE else TABLE)


@functools.cache
def _table_reader(language: str) -> TableReader:
    return TableReader(language)

"""Readings of an utterance as a whole."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from fetch_pomdp.core.language.reading import discourse
from fetch_pomdp.core.language.reading.reader import Context, TableReader, parse
from fetch_pomdp.core.language.reading.tokens import words_of
from tests.core.language.reading.dialogues import HELD_BACK, LOOKED_AT, TABLES
from tests.core.language.reading.tables import READER

TURNS = [
    (table.strip(), turn.strip())
    for table, turns, _ in (line.split("|") for line in (LOOKED_AT + HELD_BACK).strip().splitlines() if line)
    for turn in turns.split(";")
    if not turn.strip().startswith("?")
]


def test_the_search_for_readings_stops_only_where_no_better_one_can_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    def read() -> list[object]:
        vocabularies = {name: READER._place(scene).table.vocabulary for name, scene in TABLES.items()}
        return [parse(words_of(turn), vocabularies[table], READER.grammar).found for table, turn in TURNS]

    stopped = read()
    monkeypatch.setattr(discourse, "_enough", lambda *_: False)
    assert read() == stopped


def test_a_reader_may_be_shared_by_threads() -> None:
    reader, failed = TableReader(), list[BaseException]()
    alone = [READER.read(words_of(turn), TABLES[table], Context()).log_likelihood for table, turn in TURNS]

    def read() -> None:
        try:
            for (table, turn), expected in zip(TURNS, alone, strict=True):
                found = reader.read(words_of(turn), TABLES[table], Context()).log_likelihood
                np.testing.assert_array_equal(found, expected)
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []

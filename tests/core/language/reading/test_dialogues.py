"""The dialogues of `dialogues.py`: what is meant is the likeliest item at the end of nearly all of them."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.action import Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.reading.reader import TableReader
from tests.core.language.reading.dialogues import HELD_BACK, LOOKED_AT, TABLES
from tests.core.language.reading.rooms import ROOMS, UNSEEN
from tests.core.language.reading.tables import READER

GERMAN = TableReader("german")


def ends_well(line: str) -> bool:
    table, turns, item = (part.strip() for part in line.split("|"))
    agent = Agent((TABLES | ROOMS)[table], reader=GERMAN if table == "tisch" else READER)
    for turn in (each.strip() for each in turns.split(";")):
        if turn.startswith("?"):
            agent.did(Point(int(turn[1:])))
        else:
            agent.observe(turn)
    return int(agent.belief.argmax()) == int(item)


PARTS = {"looked at": (LOOKED_AT, 0.9), "held back": (HELD_BACK, 0.75), "rooms": (UNSEEN, 0.8)}


@pytest.mark.parametrize(("part", "least"), PARTS.values(), ids=PARTS.keys())
def test_most_dialogues_end_with_what_is_meant(part: str, least: float) -> None:
    lines = part.strip().splitlines()
    wrong = [line for line in lines if not ends_well(line)]
    assert len(wrong) <= (1.0 - least) * len(lines), "\n".join(wrong)


def test_there_are_three_hundred_dialogues() -> None:
    assert len(set(UNSEEN.strip().splitlines())) == 100
    lines = [*LOOKED_AT.strip().splitlines(), *HELD_BACK.strip().splitlines()]
    assert len(set(lines)) == len(lines) >= 200
    assert len(HELD_BACK.strip().splitlines()) >= len(lines) // 3

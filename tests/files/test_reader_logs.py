"""Logs of talks that a reader read: what it said is on record, so that a replay needs no reader."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from fetch_pomdp.adapters.robot.console import ConsoleRobot
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.interaction import interact
from fetch_pomdp.core.language.reading.catalogue import own_reader
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.events import event_from_json, event_to_json
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import EventLog, read_recording
from tests.core.language.reading.tables import LINE, READER

TURNS = {0.5: "the mug to the left of the bowl.", 2.5: "no, the green one."}


class Speaker:
    """Says each of TURNS once its time has come."""

    def __init__(self) -> None:
        self._left = dict(TURNS)

    def hear(self, until: float) -> Sequence[Word]:
        due = [time for time in self._left if time <= until]
        return [Word(text, time - 0.4, time) for time in due for text in self._left.pop(time).split()]


@dataclasses.dataclass(frozen=True)
class Sphinx:
    """A slow reader that is sure of the item that it was made for, and counts what it is asked."""

    item: int
    asked: list[tuple[str, ...]] = dataclasses.field(default_factory=list)
    meanwhile: Reader = READER

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        self.asked.append(tuple(words))
        likelihood = np.full(len(scene.items), -5.0)
        likelihood[self.item] = 0.0
        return dataclasses.replace(self.meanwhile.read(words, scene, context), log_likelihood=likelihood, lost=0.0)


def lived(reader: Reader, path: Path, name: str = "openai:m@https://example.org/v1") -> tuple[Agent, list[Event]]:
    """An interaction that was recorded: the agent at its end, and what happened."""
    header = Header(scene=LINE, reader=name)
    agent = header.agent(reader=reader)
    with EventLog.create(path, header) as log:
        events = list(interact(agent, ConsoleRobot(list[str]().append), Speaker(), None, most_steps=5))
        for event in events:
            log.write(event)
    return agent, events


def test_a_replay_believes_what_a_reader_said_that_is_not_there(tmp_path: Path) -> None:
    reader = Sphinx(item=3)
    agent, _ = lived(reader, tmp_path / "log.jsonl")
    asked = len(reader.asked)
    recording = read_recording(tmp_path / "log.jsonl")
    again = recording.header.agent()
    for event in recording.events:
        if isinstance(event, Acted):
            assert again.decide().action == event.action
        again.take(event)
    assert again.belief == pytest.approx(agent.belief, abs=1e-12)
    assert again.belief.argmax() == 3, "our own reader would have read something else"
    assert len(reader.asked) == asked > 0


def test_the_grammar_reads_a_log_as_it_did(tmp_path: Path) -> None:
    agent, events = lived(READER, tmp_path / "log.jsonl", "table")
    recording = read_recording(tmp_path / "log.jsonl")
    assert recording.header.reader == "table"
    assert [event.read for event in recording.events if isinstance(event, Observed)] == [
        event.read for event in events if isinstance(event, Observed)
    ]
    again = recording.header.agent()
    for event in recording.events:
        again.take(event)
    assert again.belief == pytest.approx(agent.belief, abs=1e-12)
    assert str(again.understood.heard) == str(agent.understood.heard)


def test_every_reading_of_an_utterance_is_on_record() -> None:
    agent = Agent(LINE, reader=READER)
    words = ("the", "red", "mug")
    observation = Observation(words, None, (Alternative(words, 0.75), Alternative(("the", "bowl"), 0.25)))
    agent.update(observation)
    observed = Observed(observation, read=agent.understood.read)
    found = event_from_json(json.loads(json.dumps(event_to_json(observed, LINE))), LINE)
    assert found == observed
    assert len(observed.read) == 2
    assert np.argmax(observed.read[1]) == 3, "the bowl"


def test_a_slow_reader_reads_the_words_as_they_stand_and_a_quick_one_the_rest() -> None:
    slow = Sphinx(item=0)
    agent = Agent(LINE, reader=slow)
    words = ("the", "red", "mug")
    agent.update(Observation(words, None, (Alternative(words, 0.75), Alternative(("the", "bowl"), 0.25))))
    assert slow.asked == [words]
    agent.quick().observe("the bowl")
    assert slow.asked == [words]


def test_silence_is_no_reading() -> None:
    agent = Agent(LINE, reader=own_reader("table"))
    agent.update(Observation())
    assert agent.understood.read == ()

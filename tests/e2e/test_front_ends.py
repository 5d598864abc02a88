"""The same talk at every door: "hand me the marker", then silence.

The robot asks within three seconds of the sentence's end, whatever planner decides that asks at all; what was handed
over is taken back, and the other one brought; a second request is served. Times are the sessions' own.
"""

from __future__ import annotations

import contextlib
import json
import re
import wave
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, expect

from fetch_pomdp.adapters.robot.console import ConsoleRobot
from fetch_pomdp.adapters.speech.audio import RATE, Samples, open_wav
from fetch_pomdp.adapters.speech.espeak import spoken
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.adapters.typed import TypedPerson
from fetch_pomdp.adapters.web.conversation import TIMING
from fetch_pomdp.cli.interact import RECORDED, TYPED
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.interaction import OBJECTED, interact
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.language.reading.catalogue import DEFAULT, own_reader
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.planners.catalogue import planner_named
from fetch_pomdp.files.events import event_to_json
from tests.e2e.conftest import PATIENCE, Person, Server

MARKERS, SPOONS = {"marker-1", "marker-2"}, {"spoon-1", "spoon-2"}
REQUEST, OBJECTION, SECOND = "hand me the marker", "no, wrong one", "hand me the silver spoon"
# The others never ask: they hand something over at once (docs/serve.md).
ASKING = ("fitted", "exact", "sparse", "threshold", "always", "chai", "williams-young", "doshi-roy", "information-gain")
OFFERED = ("fitted", "threshold", "always")  # by the page's settings
SOON = 3.0  # s

Line = dict[str, Any]


@dataclass(frozen=True)
class Story:
    """What happened, as the lines of a log. asking: s that a question takes before it has been asked."""

    lines: Sequence[Line]
    asking: float

    def check(self) -> None:
        """The robot asked in time, took back what was not wanted, brought the other, and served the next request."""
        assert self.asked_after() <= SOON
        picks = [(line["item"], line.get("outcome", "done")) for line in self.lines if line.get("action") == "pick"]
        (first, _), returned, *others = picks
        assert first in MARKERS
        assert returned == (first, "returned")
        done = [item for item, outcome in others if outcome == "done"]
        assert {done[0]} == MARKERS - {first}
        assert done[1] in SPOONS
        assert sum(bool(line.get("anew")) for line in self.lines) == 1

    def asked_after(self) -> float:
        """How long (s) after the end of the first request the robot began to ask."""
        request = next(line for line in self.lines if "marker" in str(line.get("observation", {}).get("utterance")))
        end: float = request["observation"]["words"][-1]["end"]
        question: float = next(line["t"] for line in self.lines if line.get("action") == "point")
        return question - self.asking - end


class Mind:
    """What somebody says next who wants a marker, then the other one, and then a spoon."""

    def __init__(self) -> None:
        self._wishes = [REQUEST, OBJECTION, SECOND]
        self.refused = ""  # what they gave back

    def next(self, robot: str) -> str | None:
        """Return an answer to what the robot said last, "" for silence, and None when all was served."""
        if not robot or "Here you are" in robot:
            if len(self._wishes) == 2:
                self.refused = re.findall(r"hands over (\S+)\)", robot)[0]
            return self._wishes.pop(0) if self._wishes else None
        about = re.findall(r"points at (\S+)\)", robot)
        return ("no" if about[0] == self.refused else "yes") if about else ""


@pytest.mark.parametrize("planner", ASKING)
def test_at_the_terminal(planner: str) -> None:
    agent, mind = Agent(named(live_scene("ambiguous")), planner_named(planner), reader=own_reader(DEFAULT)), Mind()
    said = [""]

    def line() -> str:
        words, said[-1] = mind.next(said[-1]), " "
        if words is None:
            raise EOFError
        return words

    person = TypedPerson(agent.scene, line, said.append)
    lines: list[Line] = []
    with contextlib.suppress(EOFError):
        for event in interact(agent, ConsoleRobot(said.append), person, person, timing=TYPED, most_steps=100):
            lines.append(event_to_json(event, agent.scene))
    Story(lines, 0.0).check()
    assert OBJECTED in said


@pytest.mark.parametrize(
    "planner", [name if name in OFFERED[:2] else pytest.param(name, marks=pytest.mark.long) for name in ASKING]
)
def test_on_a_recording(planner: str, tmp_path: Path) -> None:
    """Made as it goes on: each time it is played from the beginning, and what is said next is added to it."""
    path, mind, talk = tmp_path / "story.wav", Mind(), [(0.5, REQUEST)]
    mind.next("")
    while True:
        write(path, talk)
        agent = Agent(named(live_scene("ambiguous")), planner_named(planner), reader=own_reader(DEFAULT))
        said: list[str] = []
        ears = SphinxRecognizer(open_wav(path), listened_for(agent.scene))
        lines: list[Line] = []
        words: str | None = ""
        for event in interact(agent, ConsoleRobot(said.append), ears, None, timing=RECORDED, most_steps=100):
            lines.append(event_to_json(event, agent.scene))
            robot, said[:] = " ".join(said), []
            if robot and isinstance(event, Acted) and (event.time or 0.0) > talk[-1][0]:
                words = mind.next(robot)
                if words != "":
                    break
        if words is None:
            break
        assert words, "the robot has nothing to ask, and nothing to hand over"
        talk.append((lines[-1]["t"] + (0.3 if words in ("yes", "no") else 2.0), words))
    Story(lines, RECORDED.question - RECORDED.listen).check()


def write(path: Path, lines: Sequence[tuple[float, str]]) -> None:
    """Write what espeak-ng says at some times (s), in the noise of a quiet room."""
    room = np.random.default_rng(0).normal(0, 20, int((lines[-1][0] + 5.0) * RATE))
    for begin, text in lines:
        said: Samples = spoken(text, "en-us", 140)
        start = int(begin * RATE)
        room[start : start + len(said)] += said
    with wave.open(str(path), "wb") as made:
        made.setparams((1, 2, RATE, 0, "NONE", ""))
        made.writeframes(np.clip(room, -32768, 32767).astype("<i2").tobytes())


def newest(server: Server) -> Story:
    """What the conversation came to that was written to last."""
    log = max(server.data.iterdir(), key=lambda path: path.stat().st_mtime)
    return Story([json.loads(line) for line in log.read_text().splitlines()[1:]], TIMING.question - TIMING.listen)


@pytest.mark.browser
@pytest.mark.parametrize("planner", OFFERED)
def test_on_the_page(visit: Callable[..., Person], server: Server, planner: str) -> None:
    person = visit()
    choose(person, planner)
    person.say(REQUEST)
    first = brought(person, "")
    person.say(OBJECTION)
    second = brought(person, first)
    person.say(SECOND)
    brought(person, second)
    newest(server).check()


def choose(person: Person, planner: str) -> None:
    """Choose how the robot decides, also in a way that the settings do not offer."""
    if planner not in OFFERED:
        person.page.evaluate("name => document.querySelector('#planner').append(new Option(name, name))", planner)
    person.find("#options").click()
    person.find("#planner").select_option(planner)
    person.find("#options").click()
    expect(person.find("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)


def brought(person: Person, before: str) -> str:
    """Answer whatever is asked until another item is there than before, which was not wanted; return it."""
    got = "(!document.querySelector('#end').hidden && document.querySelector('#outcome').textContent)"
    asks = "!document.querySelector('#answers').hidden"
    while True:
        person.page.wait_for_function(f"before => ({got} || before) !== before || {asks}", arg=sentence(before))
        if not person.find("#answers").is_visible():
            return person.got()
        about = person.find("#items .about button").get_attribute("data-item")
        answers = person.log().count("You:")
        person.find(f"[data-say={'no' if about == before else 'yes'}]").click()
        person.page.wait_for_function(
            "answers => document.querySelector('#log').innerText.split('You:').length > answers + 1", arg=answers
        )


def sentence(item: str) -> str:
    return f"You got {item}."


@pytest.mark.browser
@pytest.mark.parametrize("planner", OFFERED[:1])
def test_by_microphone(server: Server, chromium: Callable[..., Browser], tmp_path: Path, planner: str) -> None:
    """Chromium's microphone plays a recording, from when it is opened."""
    path = tmp_path / "story.wav"
    talk = [(8.0, REQUEST), (15.0, "yes"), (23.0, OBJECTION), (34.0, "yes"), (44.0, SECOND), (53.0, "yes")]
    write(path, talk)
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with chromium(*flags, f"--use-file-for-fake-audio-capture={path}%noloop") as browser:
        person = Person(browser.new_context(permissions=["microphone"], locale="en"), server.address)
        choose(person, planner)
        person.let_the_server_listen()
        person.find("#microphone").click()
        expect(person.find("#outcome")).to_contain_text("spoon", timeout=PATIENCE)
        assert person.errors == []
    newest(server).check()

"""Sound to belief and log, with every part real but the clock, the robot and the planner."""

from __future__ import annotations

import shutil
import wave
from io import BytesIO

import numpy as np
import pytest
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.audio import RATE
from fetch_pomdp.adapters.speech.stream import Stream, listened_for, unmuted
from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.ports import Outcome
from tests.adapters.speech.sounds import DATA, samples_of, with_noise
from tests.core.live.stepped import Stage

pytest.importorskip("pocketsphinx")
pytest.importorskip("onnxruntime")
CHUNK = RATE // 10


def listen(stage: Stage, sound: NDArray[np.int16], muted: list[tuple[float, float]] | None = None) -> None:
    """Let the stage's ears hear the sound, a chunk each tenth of a second, from time 0 on."""
    from fetch_pomdp.adapters.speech.silero import Silero, model
    from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber

    transcriber = SphinxTranscriber(listened_for(stage.agent.scene))
    # A recogniser that takes no time: a slow machine would give fewer hypotheses.
    inbox = stage.inbox
    stream = Stream(transcriber, Silero(model()), inbox.push_partial, inbox.push_word, timer=lambda: 0.0)

    def hear(chunk: NDArray[np.int16], begin: float) -> None:
        for part, start in unmuted(chunk, begin, muted or []):
            stream.feed(part, start)
        stream.guess()

    for first in range(0, len(sound), CHUNK):
        chunk, begin = sound[first : first + CHUNK], first / RATE
        stage.clock.at(begin + 0.1, lambda chunk=chunk, begin=begin: hear(chunk, begin))  # type: ignore[misc]


def story(*parts: tuple[float, NDArray[np.int16]], seconds: float) -> NDArray[np.int16]:
    """Place recordings at their times (s) in a room with a little noise."""
    sound = np.random.default_rng(0).standard_normal(round(seconds * RATE)) * 20
    for at, part in parts:
        first = round(at * RATE)
        sound[first : first + len(part)] += part
    return np.asarray(np.clip(sound, -32768, 32767), np.int16)


def test_a_request_a_question_and_an_answer() -> None:
    stage = Stage(Wait(), Wait(), Point(2))
    marker, no = (with_noise(samples_of(DATA / name)) for name in ("marker.wav", "no.wav"))
    listen(stage, story((0.0, marker), (4.2, no), seconds=8.0))
    stage.run()
    words = [word for event in stage.observed for word in event.words]
    assert [word.text for word in words] == ["hand", "me", "the", "marker", "no"]
    assert all(0 < word.posterior <= 1 for word in words)
    assert stage.agent.belief[3] > 0.5
    assert stage.agent.belief[2] < 0.05
    heard = next(at for at, belief in stage.beliefs if belief.provisional and "marker" in belief.words)
    committed = next(at for at, belief in stage.beliefs if not belief.provisional and "marker" in belief.words)
    assert heard <= words[3].end + 0.3, "the bar moves when the word ends"
    assert heard < committed


def test_a_spoken_no_stops_a_pick() -> None:
    stage = Stage(Pick(2), Pick(3))
    listen(stage, story((0.2, samples_of(DATA / "no.wav")), seconds=4.0))
    stage.run()
    assert [event.outcome for event in stage.acted] == [Outcome.STOPPED, Outcome.DONE]
    assert stage.agent.belief[2] < 0.05
    assert stage.ended == ["marker-2"]


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed")
def test_the_robot_does_not_hear_itself() -> None:
    from fetch_pomdp.adapters.speech.espeak import Voice

    voice = Voice()
    with wave.open(BytesIO(voice.wav("this one?"))) as file:
        question = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    ends = 1.0 + voice.seconds("this one?")
    sound = story((1.0, question), (ends + 0.1, samples_of(DATA / "no.wav")), seconds=6.0)
    heard = []
    for muted in ([], [(1.0, ends)]):
        stage = Stage(Point(2), Wait(), Wait())
        listen(stage, sound, muted)
        stage.run()
        heard.append([word.text for event in stage.observed for word in event.words])
    assert len(heard[0]) > 1, "unmuted, it hears more than the answer"
    assert heard[1] == ["no"]

"""The command fetch: one whole interaction, on recordings, streams or at the terminal."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from fetch_pomdp.adapters.reading.choice import reader_named
from fetch_pomdp.adapters.robot.console import ConsoleRobot
from fetch_pomdp.adapters.typed import TypedPerson
from fetch_pomdp.adapters.vision.recorded import RecordedSkeleton
from fetch_pomdp.cli.options import (
    Budget,
    Depth,
    Ears,
    Json,
    ModelFile,
    PlannerName,
    ReaderName,
    RobotName,
    SceneName,
    Seed,
    Video,
    Width,
    loaded,
)
from fetch_pomdp.cli.show import show_event
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.interaction import Timing, interact
from fetch_pomdp.core.language.names import named, words_besides_name
from fetch_pomdp.core.language.reading.catalogue import DEFAULT as READER
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import DEFAULT
from fetch_pomdp.core.ports import Recognizer, Robot, SkeletonSource
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.errors import InputError
from fetch_pomdp.files.decisions import belief_to_json, decision_to_json
from fetch_pomdp.files.events import event_to_json
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import EventLog

STREAM = "-"
TYPED = Timing(wait=1.0, question=1.0, after=1.0)  # a line a step; an empty one after a hand-over ends it
RECORDED = Timing(after=8.0)
MICROPHONE = "mic"

Audio = Annotated[
    str | None,
    typer.Option(metavar="F.wav", help="Speech: a WAV file, - for raw PCM on standard input, or mic."),
]
Rate = Annotated[int, typer.Option(min=8000, max=192_000, help="Hz, of raw PCM: 16 bit, little-endian, mono.")]
Played = Annotated[
    str | None,
    typer.Option(metavar="F.wav", help="What the robot's loudspeaker played during --audio; its echo is taken out."),
]
Skeleton = Annotated[
    str | None, typer.Option(metavar="F.jsonl", help="Head and wrists, JSON Lines; - for standard input.")
]
Log = Annotated[Path | None, typer.Option(metavar="OUT.jsonl", help="Write what happens to a new file, as it happens.")]

Target = Annotated[str | None, typer.Option(metavar="ID", help="For the log: the item that the person wants.")]
Person = Annotated[int | None, typer.Option(min=0, help="For the log: number of the person.")]
Order = Annotated[int | None, typer.Option(min=0, help="For the log: place among the person's trials, from 0.")]
Paradigm = Annotated[str | None, typer.Option(metavar="NAME", help="For the log: the study's name of this robot.")]


def fetch(
    scene: SceneName,
    audio: Audio = None,
    skeleton: Skeleton = None,
    rate: Rate = 16_000,
    ears: Ears = None,
    reader: ReaderName = READER,
    played: Played = None,
    planner: PlannerName = None,
    depth: Depth = None,
    width: Width = None,
    budget: Budget = None,
    seed: Seed = None,
    model: ModelFile = None,
    log: Log = None,
    target: Target = None,
    person: Person = None,
    order: Order = None,
    paradigm: Paradigm = None,
    robot: RobotName = None,
    video: Video = None,
    json_lines: Json = False,
) -> None:
    """Run one whole interaction: hear, see, decide, until an item is handed over.

    With --audio or --skeleton the person is a recording or a stream. With neither you are the person: type what you
    would say, with @item for an item that you point at. With --robot the arms move in MuJoCo.
    """
    table = named(loaded(scene, model, live_scene))
    parameters = {
        name: value for name, value in (("depth", depth), ("width", width), ("budget_ms", budget)) if value is not None
    }
    if video is not None and robot is None:
        raise InputError("a film needs a body; add --robot baxter", field="--video")
    if target is not None:
        table.index(target, "target")
    header = Header(
        scene=table, scene_name=scene if scene in LAYOUTS else None, planner=planner or DEFAULT, parameters=parameters,
        seed=seed or 0, reader=reader, target=target, person=person, order=order, paradigm=paradigm,
    )  # fmt: skip
    agent = header.agent(reader=reader_named(reader))
    console = Terminal(stderr=json_lines)
    with contextlib.ExitStack() as open_files:
        typed = audio is None and skeleton is None
        sensors = _sensors(table, audio, skeleton, rate=rate, ears=ears, played=played)
        record = open_files.enter_context(EventLog.create(log, header)) if log else None
        words, eyes = _typed(table, console) if typed else sensors
        prepare(agent.planner, agent.problem)
        said: list[str] = []
        timing, steps = (TYPED, sys.maxsize) if typed else (RECORDED, MOST_STEPS)
        body: Robot = ConsoleRobot(said.append)
        if robot is not None:
            from fetch_pomdp.cli.robot import Stage, opened_robot, timing_of

            timing = timing if typed else dataclasses.replace(timing_of(robot), after=RECORDED.after)
            live = STREAM in {audio, skeleton} or audio == MICROPHONE
            stage = Stage(scene=table, say=said.append, console=console, video=video, live=live)
            body = open_files.enter_context(opened_robot(robot, stage))
        events = _recorded(interact(agent, body, words, eyes, timing=timing, most_steps=steps), record)
        _follow(_with_hint(events, console) if typed else events, agent, said, console, json_lines=json_lines)


def _typed(scene: Scene, console: Console) -> tuple[Recognizer, SkeletonSource]:
    console.print("On the table:")
    for item in scene.items[:20]:
        console.print(f"  {escape(item.id)}  [dim]{escape(', '.join(words_besides_name(item)))}[/dim]")
    points = f"@{escape(scene.items[0].id)} points at it"
    console.print(f"Say what you want, as to a person. {points}; an empty line is silence; Ctrl-D leaves.\n")
    person = TypedPerson(scene, lambda: console.input("[bold]you:[/bold] "), lambda line: console.print(escape(line)))
    return person, person


def _sensors(
    scene: Scene, audio: str | None, skeleton: str | None, *, rate: int, ears: str | None, played: str | None
) -> tuple[Recognizer | None, SkeletonSource | None]:
    if audio == skeleton == STREAM:
        raise InputError("found - for both --audio and --skeleton, expected one of them from standard input")
    for name, value in (("--ears", ears), ("--played", played)):
        if audio is None and value is not None:
            raise InputError("found it without --audio, expected something to hear", field=name)
    eyes: SkeletonSource | None = None
    if skeleton is not None:
        opened = RecordedSkeleton.stream(sys.stdin.buffer) if skeleton == STREAM else RecordedSkeleton.open(skeleton)
        eyes = opened
    return None if audio is None else _hearing(scene, audio, rate, ears=ears or "sphinx", played=played), eyes


def _hearing(scene: Scene, audio: str, rate: int, *, ears: str, played: str | None) -> Recognizer:
    from fetch_pomdp.adapters.speech.audio import Sound, open_microphone, open_raw, open_wav
    from fetch_pomdp.adapters.speech.choice import recognizer
    from fetch_pomdp.adapters.speech.echo import WithoutEcho
    from fetch_pomdp.adapters.speech.stream import listened_for

    sound: Sound
    if audio == MICROPHONE:
        sound = open_microphone()
    elif audio == STREAM:
        sound = open_raw(sys.stdin.buffer, rate, "standard input")
    else:
        sound = open_wav(audio)
    if played is not None:
        sound = WithoutEcho(sound, open_wav(played))
    return recognizer(ears, sound, listened_for(scene))


def _with_hint(events: Iterator[Event], console: Console) -> Iterator[Event]:
    """Yield events; say how the talk goes on once a hand-over has been shown."""
    for event in events:
        yield event
        if isinstance(event, Acted) and event.done and isinstance(event.action, Pick):
            console.print("[dim]Say what is wrong with it, or what else you want; an empty line ends.[/dim]")


def _recorded(events: Iterator[Event], record: EventLog | None) -> Iterator[Event]:
    for event in events:
        if record is not None:
            record.write(event)
        yield event


def _follow(events: Iterator[Event], agent: Agent, said: list[str], console: Console, *, json_lines: bool) -> None:
    """Show events, and what the robot said in each, until the interaction ends or the person leaves."""
    picked: str | None = None
    with contextlib.suppress(EOFError):
        for event in events:
            if isinstance(event, Acted) and event.done and isinstance(event.action, Pick):
                picked = agent.scene.items[event.action.item].id
            if json_lines:
                print(json.dumps(_as_line(event, agent), ensure_ascii=False), flush=True)
            else:
                show_event(event, agent, console)
                for line in said:
                    console.print(f"[green]         robot: {escape(line)}[/green]", soft_wrap=True)
            said.clear()
    if json_lines:
        print(json.dumps({"picked": picked}, ensure_ascii=False))
    elif picked is None:
        console.print("\nNothing was handed over.")


def _as_line(event: Event, agent: Agent) -> dict[str, object]:
    fields = {**event_to_json(event, agent.scene), **belief_to_json(agent)}
    if isinstance(event, Acted) and event.decision is not None:
        fields = {**decision_to_json(event.decision, agent.scene), **fields}
    return fields

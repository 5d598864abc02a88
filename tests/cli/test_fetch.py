"""The command fetch: on the recording of the demo, and with a person at the keyboard."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from fetch_pomdp.cli.main import main
from fetch_pomdp.files.recordings import read_recording

EXAMPLES = Path(__file__).parents[2] / "examples"


def fetch(monkeypatch: pytest.MonkeyPatch, typed: str, *arguments: object) -> None:
    monkeypatch.setattr(sys, "argv", ["fetch-pomdp", "fetch", *map(str, arguments)])
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(typed.encode()), encoding="utf-8"))
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


def test_the_demo_asks_about_one_marker_and_hands_over_the_other(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    log = tmp_path / "log.jsonl"
    recording = ("--audio", EXAMPLES / "marker.wav", "--skeleton", EXAMPLES / "marker.jsonl")
    fetch(monkeypatch, "", "ambiguous", *recording, "--log", log, "--json")
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    asked = [line["item"] for line in lines if line.get("action") == "point"]
    heard = " ".join(line["observation"]["utterance"] or "" for line in lines if "observation" in line)
    assert heard.split() == ["hand", "me", "the", "green", "marker", "no"]
    assert len(asked) == 1
    assert {asked[0], lines[-1]["picked"]} == {"marker-1", "marker-2"}
    replayed = read_recording(log)
    assert replayed.over
    agent = replayed.header.agent()
    decisions = 0
    for event in replayed.events:
        if hasattr(event, "action"):
            assert agent.decide().action == event.action
            decisions += 1
        agent.take(event)
    assert decisions == len([line for line in lines if "action" in line])
    assert dict(zip([item.id for item in agent.scene.items], agent.belief, strict=True)) == pytest.approx(
        lines[-2]["belief"], abs=1e-9
    )


def test_a_person_at_the_keyboard(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    fetch(monkeypatch, "the green marker @marker-1\n@cup\nyes\n", "ambiguous")
    out = capsys.readouterr().out
    assert "I understood: green, marker" in out
    assert "found 'cup', expected one of bowl-1" in out
    assert "hands over marker-1" in out


def test_a_person_who_leaves_gets_nothing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    fetch(monkeypatch, "marker\n", "ambiguous")
    assert "Nothing was handed over." in capsys.readouterr().out


def test_a_log_never_overwrites_a_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    log = tmp_path / "log.jsonl"
    log.write_text("mine\n")
    arguments = ["fetch-pomdp", "fetch", "ambiguous", "--skeleton", str(EXAMPLES / "marker.jsonl"), "--log", str(log)]
    monkeypatch.setattr(sys, "argv", arguments)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert "found an existing file" in capsys.readouterr().err
    assert log.read_text() == "mine\n"

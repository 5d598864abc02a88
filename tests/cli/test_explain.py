"""Explanations as a user of the command line meets them."""

from __future__ import annotations

import io
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from fetch_pomdp.cli import offline
from fetch_pomdp.cli.explain import show_decision
from fetch_pomdp.cli.main import main
from fetch_pomdp.core.action import Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.files.decisions import decision_to_json, explanation_to_json
from tests.cli.conftest import ASKED
from tests.tables import table


def run(monkeypatch: pytest.MonkeyPatch, *arguments: object, typed: str = "") -> None:
    monkeypatch.setattr(sys, "argv", ["fetch-pomdp", *map(str, arguments)])
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(typed.encode()), encoding="utf-8"))
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


@pytest.fixture
def asked(tmp_path: Path) -> Path:
    path = tmp_path / "e.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in ASKED))
    return path


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(offline, "as_json", lambda asked: asked)
    monkeypatch.setenv("COLUMNS", "200")


def twice(agent: Agent) -> tuple[dict[str, Any], dict[str, Any]]:
    """A decision as JSON, before and after it was text."""
    fields = decision_to_json(agent.decide(), agent.scene)
    return fields, json.loads(json.dumps(fields, allow_nan=False))


def test_json_of_decide_explains(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], asked: Path
) -> None:
    run(monkeypatch, "decide", asked)
    found = json.loads(capsys.readouterr().out)
    why, values, errors = found["explanation"], found["values"], found["errors"]
    best = max(values["point"], key=values["point"].get)
    assert why["values"]["wait"] == {"value": values["wait"], "error": errors["wait"]}
    assert why["values"]["point"] == {"item": best, "value": values["point"][best], "error": errors["point"][best]}
    assert why["values"]["pick"] == {"item": "marker-2", "value": values["pick"]["marker-2"], "error": 0.0}
    assert why["gain"] == values["point"][best] - max(values["wait"], *values["pick"].values())
    assert why["gain_error"] == pytest.approx(math.hypot(errors["wait"], errors["point"][best]))
    # marker-2 against a bowl or spoon: 6 to 1 by the word, and "no" says the same of both.
    assert (why["item"], why["rival"]) == ("marker-2", "bowl-1")
    assert why["log_odds"] == pytest.approx(
        {"prior": 0.0, "words": math.log(6), "answers": 0.0, "pointing": 0.0, "total": math.log(6)}
    )
    assert why["unanswered"] is None
    assert why["sentence"].startswith("waits: marker-2 is 6 times as likely as bowl-1; waiting is worth ")


def test_json_comes_back_as_it_was() -> None:
    agent = Agent("ambiguous")
    agent.observe("hand me the marker", head=(0, 0, 1.6), wrist=(-0.01, 0.5, 1.47))
    fields, back = twice(agent)
    assert back == fields
    why = agent.decide().explanation
    assert why is not None
    assert why.rival is not None
    found = back["explanation"]
    assert found == explanation_to_json(why, agent.scene)
    assert found["sentence"] == str(why)
    assert (found["gain"], found["margin"], found["margin_error"]) == (why.gain, why.margin, why.margin_error)
    assert found["log_odds"]["pointing"] == why.rival.log_odds.pointing


def test_json_has_null_for_what_is_not_valued_or_not_finite() -> None:
    agent = Agent(table([["cup"], ["cup"]], p_truth=1.0).scene, PaperAlwaysAsk())
    agent.did(Point(0))
    agent.observe("no")
    found = twice(agent)[1]
    why = found["explanation"]
    assert why["log_odds"]["answers"] is None
    assert why["log_odds"]["total"] is None
    assert (why["gain"], why["margin"], why["margin_error"]) == (None, None, None)
    assert why["values"]["wait"] == {"value": None, "error": None}
    assert why["values"]["point"] == {"item": "item-1", "value": None, "error": None}
    assert found["errors"] == {"wait": None, "point": {"item-0": None, "item-1": None}}
    alone = twice(Agent(table([["cup"]]).scene))[1]["explanation"]
    assert (alone["rival"], alone["rival_belief"], alone["log_odds"]) == (None, None, None)


@pytest.mark.usefixtures("terminal")
def test_decide_explains_on_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], asked: Path
) -> None:
    run(monkeypatch, "decide", asked, "--json")
    data = json.loads(capsys.readouterr().out)
    run(monkeypatch, "decide", asked)
    short = capsys.readouterr().out
    assert short.strip() == data["explanation"]["sentence"]
    run(monkeypatch, "decide", asked, "--explain")
    out = capsys.readouterr().out
    assert out.startswith(short.rstrip())
    lines = {line.split()[0]: line.split() for line in reversed(out.splitlines())}  # the first line of each name
    values, errors = data["values"], data["errors"]
    for item, value in values["point"].items():
        worth = [f"{value:.2f}", "±", f"{errors['point'][item]:.2f}", f"{values['pick'][item]:.2f}"]
        assert [part.replace("-0.00", "0.00") for part in lines[item][2:]] == worth
    assert f"waiting is worth {values['wait']:.2f} ± {errors['wait']:.2f}" in out
    assert f"expected to gain {data['explanation']['gain']:.2f} ± " in out
    # "no" about marker-1: 99 to 1 for the other.
    odds = next(line.split() for line in reversed(out.splitlines()) if line.split()[0] == "marker-1")
    assert odds[1:] == ["+0.00", "+0.00", "+4.60", "+0.00", "+4.60"]


@pytest.mark.usefixtures("terminal")
def test_decide_explains_a_rule_without_values(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], asked: Path
) -> None:
    run(monkeypatch, "decide", asked, "--explain", "--planner", "paper-always")
    out = capsys.readouterr().out
    expected = "asks about marker-2: it is 6 times as likely as bowl-1; a wrong pick costs 12.5, the question 6"
    assert out.splitlines()[0].strip() == expected
    assert "nan" not in out
    assert "gain" not in out


def test_a_thousand_items_are_a_short_page() -> None:
    agent = Agent(table([["cup"]] * 1000, p_g=0.0).scene, PaperAlwaysAsk(), prior=np.arange(1.0, 1001.0) / 500_500)
    shown = io.StringIO()
    show_decision(agent.decide(), agent, Console(file=shown, width=100), explained=True)
    assert len(shown.getvalue().splitlines()) < 25
    assert "item-999" in shown.getvalue()
    assert "item-5 " not in shown.getvalue()
    assert len(json.dumps(explanation_to_json(agent.decide().explanation, agent.scene))) < 1000  # type: ignore[arg-type]


def test_a_person_at_the_keyboard_reads_why(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    run(monkeypatch, "fetch", "ambiguous", typed="the green marker @marker-1\nyes\n")
    out = capsys.readouterr().out
    assert "  0.0 s  waits: nothing tells the 6 items apart yet; waiting is worth " in out
    assert "picks marker-1: it is " in out


def test_json_of_fetch_explains(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run(monkeypatch, "fetch", "ambiguous", "--json", typed="the green marker\n")
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    acted = [line for line in lines if "action" in line]
    assert acted
    for line in acted:
        assert line["explanation"]["sentence"].startswith(
            {"wait": "waits", "point": "asks about", "pick": "picks"}[line["action"]]
        )
        assert line["values"]["wait"] == line["explanation"]["values"]["wait"]["value"]

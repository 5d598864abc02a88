"""The command explain, as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run


def test_explain_prints_what_was_understood(run: Run) -> None:
    code, out, _ = run(
        "explain", "ambiguous", "--says", "the bowl on my left", "--says", "no wait, the spoon", "--json"
    )
    first, second = map(json.loads, out.splitlines())
    assert code == 0
    assert first["understood"] == "I understood: bowl, my left"
    assert max(first["items"], key=first["items"].get) == "bowl-1"
    assert sum(first["items"].values()) == pytest.approx(1.0)
    assert second["readings"][0]["meaning"] == "spoon"


def test_explain_asks_whose_left(run: Run) -> None:
    code, out, _ = run("explain", "ambiguous", "--says", "the left bowl, the zorgon one")
    assert code == 0
    assert "your left or mine?" in out
    assert 'I do not know \\"zorgon\\"' in out


def test_fit_reader_writes_weights_that_explain_takes(run: Run, tmp_path: Path) -> None:
    pytest.importorskip("scipy")
    blocks = [{"id": 1, "colour": "red", "x": -0.2, "y": 0.2}, {"id": 2, "colour": "blue", "x": 0.2, "y": 0.2}]
    (tmp_path / "tables.json").write_text(json.dumps({"scenes": [{"configuration": 1, "blocks": blocks}]}))
    (tmp_path / "requests.csv").write_text("table,target,request\n1,1,the red one\n1,2,the block on my right\n")
    path = tmp_path / "weights.toml"
    assert run("fit-reader", tmp_path, "--out", path, "--steps", 1, "--source", "made up")[0] == 0
    assert path.read_text().startswith("# Learnt from 2 requests about 1 tables: made up")
    assert run("explain", "ambiguous", "--says", "the spoon", "--weights", path)[0] == 0
    path.write_text("[weights]\nrank_blurr = 1.0\n")
    code, _, error = run("explain", "ambiguous", "--says", "the spoon", "--weights", path)
    assert code == 2
    assert "rank_blurr" in error


def test_explain_knows_its_languages(run: Run) -> None:
    code, _, error = run("explain", "ambiguous", "--says", "hola", "--language", "spanish")
    assert code == 2
    assert "expected one of english" in error

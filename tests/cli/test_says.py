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


def test_explain_knows_its_readers(run: Run) -> None:
    code, _, error = run("explain", "ambiguous", "--says", "hola", "--reader", "table:spanish")
    assert code == 2
    assert "expected words, table, table:LANGUAGE (of english" in error
    code, _, error = run("explain", "ambiguous", "--says", "hello", "--reader", "words")
    assert code == 2
    assert "expected a reader of more than single words" in error


WORDS = ("red", "blue", "green", "yellow")


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    """Requests about four blocks that the served model reads well, and in which every eighth person errs."""
    blocks = [{"id": n, "colour": word, "x": 0.2 * n, "y": 0.3} for n, word in enumerate(WORDS)]
    (tmp_path / "tables.json").write_text(json.dumps({"scenes": [{"configuration": 1, "blocks": blocks}]}))
    rows = [f"1,{(n + (n % 8 == 0)) % 4},the {WORDS[n % 4]} block number {n}" for n in range(64)]
    (tmp_path / "requests.csv").write_text("\n".join(["table,target,request", *rows]))
    return tmp_path


def test_how_far_to_believe_a_model_is_learnt_from_requests(run: Run, corpus: Path, served: str) -> None:
    pytest.importorskip("scipy")
    path, name = corpus / "calibration.toml", f"openai:words@{served}"
    code, out, _ = run("fit-reader", corpus, "--out", path, "--reader", name, "--source", "made up")
    assert code == 0
    before, after, _ = (float(line.split(": ")[1].split()[0]) for line in out.splitlines())
    assert after < before
    assert path.read_text().startswith("# Fitted to 64 requests: made up")
    code, out, _ = run("explain", "ambiguous", "--says", "the spoon", "--reader", name, "--weights", path, "--json")
    assert code == 0
    assert json.loads(out)["understood"] == "I understood (read by words)"


def test_of_a_model_that_reads_nothing_nothing_is_learnt(run: Run, corpus: Path, served: str) -> None:
    path = corpus / "calibration.toml"
    code, _, error = run("fit-reader", corpus, "--out", path, "--reader", f"openai:failing@{served}")
    assert code == 2
    assert "64 of 64 requests not read: failing answered with status 500" in error
    assert "found no request that failing read" in error
    assert not path.exists()

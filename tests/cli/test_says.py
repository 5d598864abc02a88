"""The command explain, as a user calls it."""

from __future__ import annotations

import json

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


def test_explain_knows_its_languages(run: Run) -> None:
    code, _, error = run("explain", "ambiguous", "--says", "hola", "--language", "spanish")
    assert code == 2
    assert "expected one of english" in error

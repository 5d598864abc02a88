"""The commands of robustness curves and price lists, as a user calls them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pandas
import pytest

from fetch_pomdp.study import curves, prices
from tests.cli.conftest import Run

CONFIG = """
layouts = ["unambiguous"]
[paradigms]
quick = {planner = "threshold", pick = 0.8}
"""


def test_curves_are_drawn_and_drawn_again(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(curves.CURVES, "items", dataclasses.replace(curves.CURVES["items"], values=(2.0, 3.0)))
    (tmp_path / "study.toml").write_text(CONFIG)
    command = ("study", "curves", "--config", tmp_path / "study.toml", "--curve", "items", "--trials", 2,
               "--out", tmp_path / "out", "--workers", 1)  # fmt: skip
    code, printed, _ = run(*command)
    assert code == 0
    assert printed.splitlines() == [
        f"wrote {tmp_path}/out/curves.csv", f"wrote {tmp_path}/out/items.svg and {tmp_path}/out/items.png",
    ]  # fmt: skip
    table = pandas.read_csv(tmp_path / "out" / "curves.csv")
    assert list(table["value"]) == [2.0, 3.0] * 5
    assert list(table["trials"]) == [16, 24] * 5
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").glob("items.*")}
    assert run(*command)[:2] == (0, printed)
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").glob("items.*")} == before
    code, _, told = run(*command[:4], "--curve", "noise")
    assert code == 2
    assert "curve: found 'noise', expected one of speech, sigma, items" in told


def test_prices_are_searched_and_checked(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, factors in (("WAITS", (1.0, 3.0)), ("POINTS", (1.0,)), ("WRONGS", (1.0,))):
        monkeypatch.setattr(prices, name, factors)
    (tmp_path / "study.toml").write_text('layouts = ["unambiguous"]')
    out = tmp_path / "out"
    command = ("study", "prices", "--config", tmp_path / "study.toml", "--trials", 2, "--fresh", 2, "--out", out,
               "--workers", 1)  # fmt: skip
    for found, last in (
        (None, "and more accurate in one."),
        (prices.Prices(3.0, 1.0, 1.0).name, "more accurate than fetch."),
    ):
        monkeypatch.setattr(prices, "best", lambda *_, found=found: found)
        code, printed, _ = run(*command)
        assert code == 0
        assert printed.splitlines()[-1].endswith(last)
    table = pandas.read_csv(out / "prices.csv")
    assert list(table["trials"]) == [48] * 5
    assert list(pandas.read_csv(out / "check.csv")["paradigm"]) == ["fetch", "wait x 3, point x 1, wrong x 1"]
    assert (out / "prices.png").stat().st_size > 1000

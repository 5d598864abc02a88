"""The command export, as a user calls it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from fetch_pomdp.cli.main import main
from tests.files.formats import read_pomdp, read_pomdpx


def run(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr(sys, "argv", ["fetch-pomdp", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        main()
    return int(ended.value.code or 0)


def test_export_writes_both_formats(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "out.pomdp"
    assert run(monkeypatch, "export", "ambiguous", path, "--discount", 0.95, "--rings", 2) == 0
    assert capsys.readouterr().out == f"wrote {path}\n"
    file = read_pomdp(path)
    assert (file.discount, len(file.states), len(file.actions), len(file.observations)) == (
        0.95,
        43,
        13,
        4 * 3 * 13 + 1,
    )
    assert run(monkeypatch, "export", "unambiguous", tmp_path / "out.pomdpx") == 0
    assert len(read_pomdpx(tmp_path / "out.pomdpx")[0]["gesture"]) == 7


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("there.pomdp", [], "found an existing file"),
        ("scene.xml", [], "expected a name that ends in .pomdp or .pomdpx"),
        ("scene.pomdp", ["--discount", 1.5], "discount: found 1.5"),
    ],
)
def test_what_is_refused_is_one_line_and_code_2(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    name: str,
    options: list[object],
    message: str,
) -> None:
    (tmp_path / "there.pomdp").write_text("mine")
    assert run(monkeypatch, "export", "ambiguous", tmp_path / name, *options) == 2
    err = capsys.readouterr().err
    assert message in err
    assert len(err.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["there.pomdp"]

"""The numbers in README.md and docs/ agree with each other, and the cheapest of them with what is measured now."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]
SCRIPT: dict[str, Any] = runpy.run_path(str(ROOT / "docs" / "make_numbers.py"))
README, PLANNERS, GAP = (
    (ROOT / place).read_text(encoding="utf-8") for place in ("README.md", "docs/planners.md", "docs/gap.md")
)
# A planner's name at the command line, as the table calls it.
NAMES = {"fitted": "FittedValue()", "sparse": "SparseSampling(2, 10)", "never": "NeverAsk()", "always": "AlwaysAsk()"}


def rows(page: str) -> dict[str, list[str]]:
    """The cells of the table of returns, by planner."""
    lines = SCRIPT["marked"](page, "returns").splitlines()[2:]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {re.findall(r"`(.+?)`", name)[0]: more for name, *more in cells}


def test_two_pages_have_one_table() -> None:
    assert SCRIPT["marked"](README, "returns") == SCRIPT["marked"](PLANNERS, "returns")
    assert len(rows(README)) == len(SCRIPT["PLANNERS"])


@pytest.mark.parametrize("name", NAMES)
def test_gap_has_the_returns_of_the_readme(name: str) -> None:
    found = re.findall(rf"\| `{name}` \| (\S+) ± (\S+) \| (\S+%) \|", SCRIPT["marked"](GAP, "gap"))
    assert len(found) == 2
    for column, (earned, error, right) in zip((0, 3), found, strict=True):
        stated, most = rows(README)[NAMES[name]][column].split(" ± ")
        assert float(stated) == pytest.approx(float(earned), abs=0.0051)  # 2 digits beside 3
        assert float(most) == pytest.approx(1.96 * float(error), abs=0.0061)
        assert rows(README)[NAMES[name]][column + 1] == right


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [pytest.param("`FittedValue()`, the default", marks=pytest.mark.long), "`Threshold()`, three numbers"],
)
def test_the_cheapest_rows_are_what_is_measured_now(name: str) -> None:
    """Another processor rounds otherwise, which may turn a few of 50,000 interactions."""
    planner = re.findall(r"`(.+?)`", name)[0]
    measured = SCRIPT["row"](name, SCRIPT["PLANNERS"][name]).strip("|").split("|")[1:]
    for found, stated in zip(measured, rows(README)[planner], strict=False):
        number, expected = (float(re.findall(r"-?[\d.]+", cell)[0]) for cell in (found, stated))
        assert number == pytest.approx(expected, abs=0.2 if "%" in found else 0.021)

"""What is installed for the tests is what is pinned, and what is pinned satisfies the package."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parent.parent
FILES = {
    name: (ROOT / "requirements" / f"{name}.txt").read_text(encoding="utf-8")
    for name in ("core", "run", "test", "bench", "docs")
}
PIN = re.compile(
    r"([a-z0-9][a-z0-9-]*)(?:\[[a-z0-9,-]+\])?==([0-9][0-9a-z.!+-]*)(?: ; (.+?))?((?: --hash=sha256:[0-9a-f]{64})+)"
)


def pins(name: str) -> dict[str, list[tuple[str, str | None, str]]]:
    """The versions of each package, the markers under which they hold, and the hashes of their files."""
    found: dict[str, list[tuple[str, str | None, str]]] = {}
    for line in FILES[name].replace(" \\\n   ", "").splitlines():
        match = PIN.fullmatch(line)
        assert match, f"requirements/{name}.txt: {line}"
        found.setdefault(match[1], []).append((match[2], match[3], match[4]))
    return found


def pinned(name: str) -> set[tuple[str, ...]]:
    """The pins of a file, whole."""
    return {(package, *map(str, pin)) for package, all_ in pins(name).items() for pin in all_}


def wanted(*extras: str) -> Iterator[Requirement]:
    """What pyproject.toml asks for."""
    data: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = data["project"]
    for line in (
        *project["dependencies"],
        *(line for extra in extras for line in project["optional-dependencies"][extra]),
    ):
        yield Requirement(line)


@pytest.mark.parametrize("name", FILES)
def test_each_line_pins_one_version_by_its_files_hashes_from_any_registry(name: str) -> None:
    assert pins(name)


def test_what_runs_is_tested_at_the_same_versions() -> None:
    core, run, test, bench = (pinned(file) for file in ("core", "run", "test", "bench"))
    assert core <= run <= test <= bench
    for name, versions in pins("docs").items():
        if name in pins("bench"):
            assert {found for found, *_ in versions} <= {found for found, *_ in pins("bench")[name]}, name


def test_pins_satisfy_the_package() -> None:
    versions = pins("run")
    for requirement in wanted("speech", "serve"):
        for found, *_ in versions[canonicalize_name(requirement.name)]:
            assert requirement.specifier.contains(found), f"{requirement}: {found}"


def test_the_tests_run_with_the_pinned_versions() -> None:
    other = []
    for package, versions in pins("test").items():
        here = [found for found, marker, _ in versions if marker is None or Marker(marker).evaluate()]
        try:
            installed = version(package)
        except PackageNotFoundError:
            installed = "none"
        if here and installed not in here:
            other.append(f"{package}: found {installed}, expected {here[0]}")
    assert other == []

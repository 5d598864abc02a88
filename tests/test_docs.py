"""The documentation keeps its promises: examples run, names exist, the list of choices is complete."""

from __future__ import annotations

import importlib
import re
import runpy
import subprocess
import sys
import types
from pathlib import Path

import pytest

import fetch_pomdp

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
EXAMPLES = [
    pytest.param(block, id=f"{page.name}-{number}")
    for page in PAGES
    for number, block in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL))
]


@pytest.mark.parametrize("code", EXAMPLES)
def test_examples_run(code: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each in a module of its own, as if it were a file; a process of its own would spend its time importing."""
    monkeypatch.chdir(ROOT)
    module = types.ModuleType("__main__")
    monkeypatch.setitem(sys.modules, "__main__", module)
    exec(compile(code, "<example>", "exec"), vars(module))  # noqa: S102


def test_the_notebook_is_the_tutorial() -> None:
    script = runpy.run_path(str(ROOT / "docs" / "make_notebook.py"))
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    assert (ROOT / "examples" / "tutorial.ipynb").read_text(encoding="utf-8") == script["written"](page)
    assert sum(cell["cell_type"] == "code" for cell in script["notebook"](page)["cells"]) == page.count("```python")


def test_the_readme_example_is_short_and_asks() -> None:
    block = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[0]
    assert len(block.strip().splitlines()) <= 12
    done = subprocess.run([sys.executable, "-c", block], cwd=ROOT, capture_output=True, text=True, check=True)
    asked, picked = done.stdout.splitlines()
    assert {asked.split()[-1], picked.split()[3]} == {"marker-1", "marker-2"}


def test_the_list_of_choices_is_that_of_the_source() -> None:
    page = (ROOT / "docs" / "choices.md").read_text()
    script = runpy.run_path(str(ROOT / "docs" / "make_choices.py"))
    assert script["page_with_choices"](page) == page
    written = sum(path.read_text().count("Choice:") for path in (ROOT / "src").rglob("*.py"))
    assert written == len(list(script["choices"]())), "a Choice: must begin a paragraph of a docstring"


def core_module(name: str) -> str:
    """The dotted name of a module of the core, in whichever folder it is."""
    (path,) = (ROOT / "src" / "fetch_pomdp" / "core").rglob(f"{name}.py")
    return ".".join(path.relative_to(ROOT / "src").with_suffix("").parts)


def test_every_name_in_the_table_of_the_model_exists() -> None:
    table = [line for line in (ROOT / "docs" / "model.md").read_text().splitlines() if line.startswith("| ")]
    names = [name for line in table for name in re.findall(r"`([A-Za-z]+)\.(\w+)`", line)]
    assert len(names) > 10
    for holder, name in names:
        public = getattr(fetch_pomdp, holder, None)
        owner = public if public is not None else importlib.import_module(core_module(holder))
        known = {*dir(owner), *getattr(owner, "__dataclass_fields__", {})}
        assert name in known | set(vars(fetch_pomdp.Agent("ambiguous"))), (holder, name)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
        assert target.startswith("https://github.com/") or (page.parent / target).exists(), target

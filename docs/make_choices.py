"""Copy every "Choice:" of the source into docs/choices.md, between its markers.

python docs/make_choices.py
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
SOURCE = ROOT / "src" / "fetch_pomdp"
PAGE = ROOT / "docs" / "choices.md"
BEGIN, END = "<!-- choices -->\n", "<!-- end of choices -->\n"


def choices() -> Iterator[tuple[str, str]]:
    """Yield the place of each choice, as a dotted name, and its text on one line."""
    for path in sorted(SOURCE.rglob("*.py")):
        module = ".".join(path.relative_to(SOURCE).with_suffix("").parts)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                name = module if isinstance(node, ast.Module) else f"{module}.{node.name}"
                for paragraph in (ast.get_docstring(node) or "").split("\n\n"):
                    if paragraph.startswith("Choice:"):
                        yield name, re.sub(r"\s+", " ", paragraph.removeprefix("Choice:")).strip()


def page_with_choices(page: str) -> str:
    """Return the page with the list of choices brought up to date."""
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    return before + BEGIN + "".join(f"- `{name}`: {text}\n" for name, text in choices()) + END + after


if __name__ == "__main__":
    PAGE.write_text(page_with_choices(PAGE.read_text()))

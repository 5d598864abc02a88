"""Make examples/tutorial.ipynb of docs/tutorial.md, or run it: the two say the same.

python docs/make_notebook.py          # write it
python docs/make_notebook.py --run    # run it, every cell; needs the `docs` dependencies (`make docs`)
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
PAGE, NOTEBOOK = ROOT / "docs" / "tutorial.md", ROOT / "examples" / "tutorial.ipynb"
LINK = re.compile(r"\[([^]]+)\]\((\w[\w-]*\.md)\)")


def notebook(page: str) -> dict[str, Any]:
    """Return the notebook of a page: a code cell for each block of Python, the text between as Markdown."""
    cells: list[dict[str, Any]] = []
    for number, piece in enumerate(re.split(r"```python\n(.*?)```\n", page, flags=re.DOTALL)):
        code, source = number % 2 == 1, LINK.sub(r"[\1](../docs/\2)", piece.strip())
        more: dict[str, Any] = {"execution_count": None, "outputs": []} if code else {}
        kind = "code" if code else "markdown"
        cells.append({"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": source, **more})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def written(page: str) -> str:
    """Return the notebook of a page as its file has it."""
    return json.dumps(notebook(page), indent=1, ensure_ascii=False) + "\n"


def run(path: Path) -> None:
    """Run a notebook in its folder, and print what its cells print. Raises CellExecutionError where one fails."""
    import nbformat
    from nbclient import NotebookClient

    found = nbformat.read(path, as_version=4)
    NotebookClient(found, timeout=600, kernel_name="python3", resources={"metadata": {"path": path.parent}}).execute()
    for cell in found.cells:
        for output in cell.get("outputs", []):
            print(output.get("text", ""), end="")


if __name__ == "__main__":
    if "--run" in sys.argv:
        run(NOTEBOOK)
    else:
        NOTEBOOK.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

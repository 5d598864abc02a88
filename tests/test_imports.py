"""What a folder may import, and how long files and functions may be."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

import pytest

import fetch_pomdp
import fetch_pomdp.api

PACKAGE = Path(__file__).parent.parent / "src" / "fetch_pomdp"
FILES = sorted(PACKAGE.rglob("*.py"))
NAMES = [str(path.relative_to(PACKAGE)) for path in FILES]

GROUND = {"errors"}
UP_TO_STUDIES = GROUND | {"extras", "checks", "documents", "core", "files", "adapters", "study", "user_study"}
CORE_LIBRARIES = {"numpy", "numba"}
# A folder or module: what it may use of the package, and of third parties at module level (None: anything).
ALLOWED: dict[str, tuple[set[str], set[str] | None]] = {
    "errors": (set(), set()),
    "checks": (GROUND, set()),
    "extras": (GROUND, set()),
    "documents": (GROUND | {"checks"}, set()),
    "core": (GROUND | {"checks", "documents", "core"}, CORE_LIBRARIES),
    "files": (GROUND | {"checks", "documents", "core", "files"}, CORE_LIBRARIES),
    "adapters": (GROUND | {"extras", "checks", "documents", "core", "files", "adapters"}, CORE_LIBRARIES),
    "study": (GROUND | {"extras", "checks", "documents", "core", "files", "study"}, CORE_LIBRARIES),
    "user_study": (UP_TO_STUDIES, CORE_LIBRARIES | {"sqlalchemy", "alembic"}),
    "cli": (UP_TO_STUDIES | {"cli", "__version__"}, None),
    "api": (GROUND | {"core"}, set()),
    "__init__": ({"api"}, set()),
    "__main__": ({"cli"}, set()),
}


def part_of(path: Path) -> str:
    """The folder or top-level module that a file belongs to."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def modules(node: ast.Import | ast.ImportFrom) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    assert node.level == 0, "imports are absolute"
    if node.module == "fetch_pomdp":
        return [f"fetch_pomdp.{alias.name}" for alias in node.names]
    return [node.module or ""]


def for_types(node: ast.AST) -> bool:
    """Whether a node is what only a type checker reads."""
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def imports(tree: ast.AST) -> Iterator[tuple[str, bool]]:
    """Yield each imported module, and whether it is imported at module level when the program runs."""

    def walk(node: ast.AST, top: bool) -> Iterator[tuple[str, bool]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import | ast.ImportFrom):
                yield from ((module, top) for module in modules(child))
            inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) or for_types(child)
            yield from walk(child, top and not inside)

    yield from walk(tree, top=True)


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_imports_are_allowed(path: Path) -> None:
    part = part_of(path)
    assert part in ALLOWED, f"no rule for {part}"
    inside, libraries = ALLOWED[part]
    for module, top in imports(ast.parse(path.read_text(encoding="utf-8"))):
        root, _, rest = module.partition(".")
        if root == "fetch_pomdp":
            assert rest.partition(".")[0] in inside, f"{module} in {part}"
        elif root not in sys.stdlib_module_names:
            free = libraries is None or (part in {"adapters", "user_study"} and not top)
            assert free or root in (libraries or set()), f"{module} in {part}"


def test_the_walk_sees_what_is_not_allowed() -> None:
    source = """
import torch.nn
from fetch_pomdp import cli
def f():
    import sounddevice
if True:
    from a import b
if TYPE_CHECKING:
    import typed
"""
    assert list(imports(ast.parse(source))) == [
        ("torch.nn", True),
        ("fetch_pomdp.cli", True),
        ("sounddevice", False),
        ("a", True),
        ("typed", False),
    ]


def test_errors_import_nothing_that_needs_installing() -> None:
    loaded = list(imports(ast.parse((PACKAGE / "errors.py").read_text(encoding="utf-8"))))
    assert {module for module, _ in loaded} <= {"__future__", "typing"}


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_files_and_functions_are_short(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 500
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            assert (node.end_lineno or 0) - node.lineno < 60, node.name


def test_importing_the_package_loads_nothing_yet() -> None:
    code = "import sys, fetch_pomdp; print([name for name in sys.modules if name.startswith(('fetch_pomdp.', 'num'))])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() in ("[]", "['numbers']")


def test_the_package_has_the_names_of_its_api() -> None:
    assert fetch_pomdp.__all__ == fetch_pomdp.api.__all__
    for name in fetch_pomdp.__all__:
        assert getattr(fetch_pomdp, name) is getattr(fetch_pomdp.api, name)
    assert set(fetch_pomdp.__all__) < set(dir(fetch_pomdp))
    with pytest.raises(AttributeError, match="no attribute 'Agend'"):
        _ = fetch_pomdp.Agend


def test_the_version_is_that_of_the_installed_package() -> None:
    assert fetch_pomdp.__version__ == metadata.version("fetch-pomdp")


def test_the_library_loads_neither_adapters_nor_a_command_line() -> None:
    code = """
import sys, fetch_pomdp.api
outside = ("fetch_pomdp.adapters", "fetch_pomdp.cli", "fetch_pomdp.files")
libraries = {"typer", "rich", "pocketsphinx", "soxr", "sounddevice"}
print([name for name in sys.modules if name.startswith(outside) or name in libraries])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_core_prints_nothing_and_opens_no_file() -> None:
    for path in (PACKAGE / "core").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in {"print", "open", "input"}, path.name
            if isinstance(node, ast.Attribute):
                assert node.attr not in {"read_text", "read_bytes", "write_text", "open"}, path.name
            assert not isinstance(node, ast.Assert), f"an assert guards input in {path.name}"

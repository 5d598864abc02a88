"""Compilation and its cache."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fetch_pomdp.core import compiled


def test_without_a_writable_cache_functions_are_compiled_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bool] = []

    def njit(*, cache: bool = False, **_: object) -> Callable[[object], object]:
        asked.append(cache)
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return lambda function: function

    monkeypatch.setattr(compiled, "njit", njit)
    assert compiled.compiled(abs) is abs
    assert asked == [True, False]


def test_a_cache_folder_that_cannot_be_made_is_no_failure(tmp_path: Path) -> None:
    occupied = tmp_path / "file"
    occupied.touch()
    code = "from fetch_pomdp.core.compiled import random_state, uniform; print(0 <= uniform(random_state(1)) < 1)"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(occupied / "cache")}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=environment)
    assert done.stdout == "True\n", done.stderr

"""What is read does not depend on how Python happens to order its sets in a process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent.parent.parent
PROGRAM = """
from tests.core.language.reading.tables import ROOM, heard
for text in ("take the bowl in front of them to their top left corner", "the plate behind them to your left"):
    print([(str(each.meaning), each.chance.hex()) for each in heard(text, ROOM).readings])
"""


def read(seed: int) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": str(seed)}
    command = [sys.executable, "-c", PROGRAM]
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout


def test_every_process_reads_the_same() -> None:
    first = read(0)
    assert first.count("[(") == 2
    assert {read(seed) for seed in (1, 2, 3)} == {first}

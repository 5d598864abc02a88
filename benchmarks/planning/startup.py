"""Compile time and import time: the first decision after installation, and that of every later process.

The steps are in processor time, the whole process on the wall.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

PROGRAM = """
import json, time
start = time.process_time()
import numba
numba_imported = time.process_time()
import fetch_pomdp.api
imported = time.process_time()
agent = fetch_pomdp.Agent("ambiguous")
agent.observe("marker", head=(0.0, 0.0, 1.6), wrist=(0.0, 0.6, 1.4))
observed = time.process_time()
agent.act()
first = time.process_time()
agent.decide()
second = time.process_time()
print(json.dumps({
    "import_numba_s": numba_imported - start, "import_rest_s": imported - numba_imported,
    "first_observation_s": observed - imported, "first_decision_s": first - observed,
    "second_decision_s": second - first,
}))
"""


def startup_times(warm_runs: int, say: Callable[[str], None]) -> dict[str, dict[str, float]]:
    """Return times (s) of a process with an empty compile cache, and the best of later ones."""
    with tempfile.TemporaryDirectory() as folder:
        cold = _process(Path(folder))
        say("  empty cache measured")
        warm = [_process(Path(folder)) for _ in range(warm_runs)]
    return {"empty cache": cold, "warm cache": {key: min(run[key] for run in warm) for key in cold}}


def _process(cache: Path) -> dict[str, float]:
    start = time.perf_counter()
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    done = subprocess.run([sys.executable, "-c", PROGRAM], env=environment, check=True, capture_output=True, text=True)
    times: dict[str, float] = json.loads(done.stdout)
    return {**times, "whole_process_s": time.perf_counter() - start}

"""Settings that must be in force before any test module is imported."""

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).parent.parent


def _source_hash() -> str:
    digest = hashlib.sha256()
    for path in sorted((ROOT / "src").rglob("*.py")):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def _choose_numba_cache() -> None:
    """Give each state of the source a cache of its own.

    Numba's cache compares a file's time stamp: it does not notice a change in a function that another file inlines.
    """
    caches = ROOT / ".numba-cache"
    current = caches / _source_hash()
    for old in caches.glob("*"):
        if old != current:
            shutil.rmtree(old, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = str(current)


_choose_numba_cache()
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")


def _fit_quickly_without_compilation() -> None:
    """In plain Python a fit takes minutes; the coverage run is about lines, so it fits on few beliefs."""
    from fetch_pomdp.core.planners.baselines import paradigms
    from fetch_pomdp.core.planners.fitted import fit, selection

    whole = fit.fitted
    vars(paradigms).update(MOST_PLAYED=4, LIMITS=(0.5, 0.8), OPENINGS=(0.0, 1.1))
    vars(fit).update(ROUNDS=2, SWEEPS=1, REHEARSED=2)
    vars(selection).update(
        MOST_REHEARSED=4,
        fitted=lambda problem, distinct, count, seed: whole(problem, distinct, min(count, 20), seed),
    )


if os.environ.get("NUMBA_DISABLE_JIT") == "1":
    _fit_quickly_without_compilation()


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "slow: takes long when Numba is off; left out of the coverage run")
    config.addinivalue_line("markers", "browser: needs Chromium and the packages of requirements/browser.txt")
    config.addinivalue_line("markers", "postgres: needs a PostgreSQL server (tests/with_postgres.sh)")
    config.addinivalue_line(
        "markers", "long: by many samples, voices or processes; left to `make check-all`, as `make proofs`"
    )
    config.addinivalue_line("markers", "load: many people at once on a server, half a minute; Linux")
    # Without compilation SplitMix64 wraps around in NumPy scalars, which warn.
    config.addinivalue_line("filterwarnings", "ignore:overflow encountered:RuntimeWarning")


@pytest.fixture(scope="session")
def served() -> Iterator[str]:
    """The URL of a language model's server, a process of its own: `tests.adapters.reading.served_model`."""
    command = [sys.executable, "-m", "tests.adapters.reading.served_model"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stdout is not None
        yield f"http://127.0.0.1:{int(process.stdout.readline())}/v1"
        process.kill()

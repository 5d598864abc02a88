"""How long the database of participants takes to commit an event.

    python benchmarks/store.py [--sessions 50] [--rate 4] [--seconds 20] [--json]                  # SQLite
    tests/with_postgres.sh sh -c 'python benchmarks/store.py --database "$FETCH_POMDP_TEST_DATABASE"'

First one session writes as fast as it can, then all do, then each writes `rate` events a second at moments drawn at
random, as live sessions do. The file of SQLite is in the folder for temporary files: give it the disk that a study
would have with TMPDIR.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from fetch_pomdp.core.events import Event, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header
from fetch_pomdp.user_study.store.participants import Agreement
from fetch_pomdp.user_study.store.store import Store
from fetch_pomdp.user_study.store.trials import StoredTrial

EVENT: Event = Observed(  # as long as those of a person who speaks and points
    Observation(("hand", "me", "the", "marker"), Ray((0.0, 0.0, 1.6), (0.0123, 0.4567, 1.4321))),
    tuple(Word(word, 1.25, 1.5, 0.987654321) for word in ("hand", "me", "the", "marker")),
    12.345,
)


@dataclass(frozen=True, slots=True)
class Timed:
    """What writers saw: commits a second in all, and how long a commit took (ms)."""

    database: str
    writers: str
    commits: int
    per_second: float
    median: float
    p99: float
    longest: float


def measured(writers: str, trials: list[StoredTrial], seconds: float, pause: Callable[[], float]) -> Timed:
    """Let each trial have a writer of its own, in a thread, for some seconds."""
    took: list[list[float]] = [[] for _ in trials]
    begun = time.perf_counter()

    def write(trial: StoredTrial, mine: list[float]) -> None:
        while time.perf_counter() - begun < seconds:
            if (rest := pause()) > 0:
                time.sleep(rest)
            start = time.perf_counter()
            trial.write(EVENT)
            mine.append(time.perf_counter() - start)

    threads = [threading.Thread(target=write, args=pair) for pair in zip(trials, took, strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    whole = time.perf_counter() - begun
    each = 1e3 * np.array([one for mine in took for one in mine])
    middle, late, last = map(float, np.quantile(each, (0.5, 0.99, 1)))
    return Timed("", writers, len(each), len(each) / whole, middle, late, last)


def run(url: str, sessions: int, rate: float, seconds: float) -> list[Timed]:
    """Measure a database."""
    store, rng = Store.open(url), np.random.default_rng(0)
    header = Header(scene=Scene.load("ambiguous"), scene_name="ambiguous", target="bowl-1", person=0)
    agreed, trials = Agreement(language="en", given={}, text=""), []
    for number in range(sessions):
        someone = store.enrol("benchmark", "none", sessions, agreed, secret=f"secret {number}", trials=lambda _: 1)
        trials.append(store.trial(someone.id, "trial", 0, header))
    lock = threading.Lock()

    def now_and_then() -> float:
        with lock:
            return float(rng.exponential(1 / rate))

    found = [
        measured("1, as fast as it can", trials[:1], seconds / 2, lambda: 0.0),
        measured(f"{sessions}, as fast as they can", trials, seconds / 2, lambda: 0.0),
        measured(f"{sessions}, {rate:g} a second each", trials, seconds, now_and_then),
    ]
    store.close()
    return found


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--database", help="URL of an empty PostgreSQL database")
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--rate", type=float, default=4.0)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        url = given.database or f"sqlite:///{Path(folder) / 'participants.db'}"
        found = run(url, given.sessions, given.rate, given.seconds)
    name = "PostgreSQL" if given.database else "SQLite"
    if given.json:
        print(*(json.dumps({**asdict(one), "database": name}) for one in found), sep="\n")
        return
    print("| database | writers | commits a second | median | 99% | longest |\n|---|---|---:|---:|---:|---:|")
    for one in found:
        times = " | ".join(f"{value:.1f} ms" for value in (one.median, one.p99, one.longest))
        print(f"| {name} | {one.writers} | {one.per_second:,.0f} | {times} |")


if __name__ == "__main__":
    main()

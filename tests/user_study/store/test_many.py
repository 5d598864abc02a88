"""Many writers at once, and one that is killed."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.events import Acted
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import enrolled, header

ROOT = Path(__file__).parents[3]
ENROL = """
import sys
from concurrent.futures import ThreadPoolExecutor
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import enrolled
store = Store.open(sys.argv[1])
def come(_):
    return enrolled(store, people=1000)[0].person
with ThreadPoolExecutor(20) as crowd:
    print(*crowd.map(come, range(40)))
"""
WRITE = """
import itertools, sys
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import WAITED, enrolled, header
store = Store.open(sys.argv[1])
someone, secret = enrolled(store)
trial = store.trial(someone.id, "trial", 0, header(0, 0))
print(secret, flush=True)
for number in itertools.count(1):
    trial.write(WAITED)
    print(number, flush=True)
"""


def started(code: str, url: str) -> subprocess.Popen[str]:
    return subprocess.Popen([sys.executable, "-c", code, url], cwd=ROOT, stdout=subprocess.PIPE, text=True)


def test_two_processes_give_no_number_twice(url: str) -> None:
    processes = [started(ENROL, url) for _ in range(2)]
    given = [int(number) for one in processes for number in one.communicate()[0].split()]
    assert [one.returncode for one in processes] == [0, 0]
    assert sorted(given) == list(range(80))


def test_a_killed_writer_loses_nothing_that_was_written(url: str) -> None:
    process = started(WRITE, url)
    assert process.stdout is not None
    secret = process.stdout.readline().strip()
    written = [process.stdout.readline() for _ in range(200)]
    process.send_signal(signal.SIGKILL)
    written += process.communicate()[0].split()
    store = Store.open(url)
    someone = store.returning("pilot", secret)
    assert someone is not None
    trial = store.trial(someone.id, "trial", 0, header(0, 0))
    assert len(trial.events) - int(written[-1]) in (0, 1), "at most one that was committed and not yet told"
    store.close()


def test_sessions_write_while_others_read_and_delete(store: Store) -> None:
    """Nobody is told that the database is locked, and each finds their own events."""
    people = [enrolled(store, people=12)[0] for _ in range(12)]
    events = [Acted(Wait(), time=float(second)) for second in range(25)]
    done = threading.Event()

    def act(place: int) -> int:
        trial = store.trial(people[place].id, "trial", 0, header(place, 0))
        for event in events:
            trial.write(event)
        return len(store.trial(people[place].id, "trial", 0, header(place, 0)).events)

    def watch() -> None:
        while not done.is_set():
            store.progress("pilot")

    with ThreadPoolExecutor(13) as crowd:
        watching = crowd.submit(watch)
        acting = [crowd.submit(act, place) for place in range(10)]
        for gone in people[10:]:
            store.forget(gone.code)
        found = [one.result() for one in acting]
        done.set()
        watching.result()
    assert found == [len(events)] * 10

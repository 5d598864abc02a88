"""A study played: the same file whoever does the work and however often it was killed."""

from __future__ import annotations

import dataclasses
import gc
import json
import os
import signal
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.random import Generator

from fetch_pomdp.core.action import Pick, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.checking import differences
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.study import experiment
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import assignments
from fetch_pomdp.study.encounter import Encounter
from fetch_pomdp.study.experiment import play, run
from fetch_pomdp.study.from_logs import trials_of
from fetch_pomdp.study.record import NAME, read_trials
from tests.study.small import small

LOGGED = small(logs=True)


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("whole")
    run(LOGGED, folder)
    return files(folder)


def test_the_trials_are_those_assigned(whole: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / NAME).write_bytes(whole[NAME])
    trials = list(read_trials(tmp_path / NAME))
    rows = [(t.person, t.layout, t.paradigm, t.desired, t.order) for t in trials]
    assert rows == [(a.person, a.layout, a.paradigm, a.desired, a.order) for a in assignments(LOGGED)]
    assert all(trial.correct == (trial.picked == trial.desired) for trial in trials)
    assert all(trial.time > 0 for trial in trials)


def test_the_overhead_is_added_to_every_time_and_changes_nothing_else() -> None:
    study = small()
    late = dataclasses.replace(study, clock=dataclasses.replace(study.clock, overhead=study.clock.overhead + 2.5))
    for assignment in assignments(study):
        one, other = (play(of, None, assignment).trial for of in (study, late))
        assert other.time == pytest.approx(one.time + 2.5)
        assert dataclasses.replace(other, time=one.time) == one


def test_the_logs_give_the_trials_again(whole: dict[str, bytes], tmp_path: Path) -> None:
    """But for times, which a log has to the millisecond."""
    (tmp_path / NAME).write_bytes(whole[NAME])
    for trial in read_trials(tmp_path / NAME):
        path = tmp_path / "log.jsonl"
        path.write_bytes(whole[f"logs/{trial.person:04}-{trial.order:03}.jsonl"])
        (again,) = trials_of([(str(path), read_recording(path))])
        assert again.time == pytest.approx(trial.time, abs=2e-3)
        assert dataclasses.replace(again, time=trial.time) == trial


def test_a_log_tells_of_its_trial_and_replays_the_same_decisions(whole: dict[str, bytes], tmp_path: Path) -> None:
    trials = [json.loads(line) for line in whole[NAME].splitlines()[1:]]
    assert len(whole) == 1 + len(trials)
    for trial in trials:
        path = tmp_path / "log.jsonl"
        path.write_bytes(whole[f"logs/{trial['person']:04}-{trial['order']:03}.jsonl"])
        recording = read_recording(path)
        assert recording.header.target == trial["desired"]
        assert not list(differences(recording))
        items = recording.header.scene.items
        picks = [event.action.item for event in recording.events if isinstance(event, Acted)
                 and isinstance(event.action, Pick)]  # fmt: skip
        assert [items[item].id for item in picks] == ([] if trial["picked"] is None else [trial["picked"]])


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_whatever_a_kill_leaves_is_completed_to_the_same_bytes(
    data: st.DataObject, whole: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory
) -> None:
    """A kill leaves a beginning of the record, the logs of its trials, and perhaps that of the next, in part."""
    folder = tmp_path_factory.mktemp("cut")
    left = whole[NAME][: data.draw(st.integers(0, len(whole[NAME])), label="bytes left")]
    (folder / NAME).write_bytes(left)
    (folder / "logs").mkdir()
    logs = [name for name in whole if name != NAME]
    kept = max(0, left.count(b"\n") - 1)
    for name in logs[:kept]:
        (folder / name).write_bytes(whole[name])
    for name in logs[kept : kept + 1]:
        (folder / f"{name}.part").write_bytes(whole[name][:50])
    counts: list[int] = []
    run(LOGGED, folder, told=counts.append)
    assert files(folder) == whole
    assert counts == list(range(kept, LOGGED.size + 1))


CODE = """
import sys
from pathlib import Path
from fetch_pomdp.study.experiment import play, run
from tests.study.small import small
run(small(people=30, trials=2), Path(sys.argv[1]))
"""


def test_killed_at_any_moment_and_started_again_it_comes_to_the_same_file(tmp_path: Path) -> None:
    run(small(people=30, trials=2), tmp_path / "whole")
    expected = (tmp_path / "whole" / NAME).read_bytes()
    there = tmp_path / "killed" / NAME
    rng = np.random.default_rng(0)
    command = [sys.executable, "-c", CODE, str(there.parent)]
    for share in np.sort(rng.random(2)):
        process = subprocess.Popen(command, cwd=Path(__file__).parents[2])
        while process.poll() is None and (there.stat().st_size if there.exists() else 0) < share * len(expected):
            time.sleep(0.002)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        left = there.read_bytes()
        assert expected.startswith(left)
        assert left.count(b"\n") > 1
    run(small(people=30, trials=2), there.parent)
    assert there.read_bytes() == expected


@pytest.mark.parametrize("crew", [Crew(workers=2), Crew(workers=3, backend="threading")], ids=["loky", "threading"])
def test_who_does_the_work_changes_nothing(crew: Crew, whole: dict[str, bytes], tmp_path: Path) -> None:
    run(LOGGED, tmp_path, crew)
    assert files(tmp_path) == whole


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same(whole: dict[str, bytes], tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        run(LOGGED, tmp_path, Crew(backend="dask", address=cluster.scheduler_address))
    assert files(tmp_path) == whole


@pytest.mark.slow
def test_a_ray_cluster_gives_the_same(whole: dict[str, bytes], tmp_path: Path) -> None:
    pytest.importorskip("ray.util.joblib")
    run(LOGGED, tmp_path, Crew(workers=2, backend="ray"))
    assert files(tmp_path) == whole


class Mumbled:
    """A channel through which every utterance is heard as its last word's time of "thing"."""

    def __init__(self, words: tuple[str, ...]) -> None:
        self.thing = next(word for word in words if word == "thing")

    def hear(self, said: Sequence[Word], **_: object) -> Sequence[Word]:
        return [dataclasses.replace(said[-1], text=self.thing)]


def test_real_speech_goes_through_the_channel_that_is_handed_in(tmp_path: Path) -> None:
    study = small(real_speech=True, logs=True)
    with pytest.raises(StudyError, match="found none, expected a channel"):
        run(study, tmp_path / "none")
    with pytest.raises(StudyError, match="in a study of simulated words"):
        run(small(), tmp_path / "one", speech=Mumbled)
    assert not list(tmp_path.iterdir())
    run(study, tmp_path, speech=Mumbled)
    heard = [
        word
        for path in (tmp_path / "logs").iterdir()
        for event in read_recording(path).events
        if isinstance(event, Observed)
        for word in event.words
    ]
    assert {word.text for word in heard} == {"thing"}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"workers": -1}, "workers: found -1"),
        ({"backend": "spark"}, "backend: found 'spark', expected one of loky, threading, dask, ray"),
        ({"address": "tcp://localhost:8786"}, "backend: found 'loky' with an address, expected dask or ray"),
    ],
)
def test_a_crew_that_cannot_be_is_refused(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        Crew(**fields)


def test_another_study_is_refused_by_what_differs(tmp_path: Path) -> None:
    run(small(), tmp_path)
    before = files(tmp_path)
    with pytest.raises(StudyError, match=r"found another study there \(seed 0, not 1\)"):
        run(small(seed=1), tmp_path)
    with pytest.raises(StudyError, match="paradigms in another order"):
        run(small(paradigms=dict(reversed(list(small().paradigms.items())))), tmp_path)
    assert files(tmp_path) == before


def test_a_finished_study_is_left_alone(whole: dict[str, bytes], tmp_path: Path) -> None:
    run(LOGGED, tmp_path)
    counts: list[int] = []
    run(LOGGED, tmp_path, told=counts.append)
    assert counts == [LOGGED.size]
    assert files(tmp_path) == whole


def test_a_second_run_in_the_same_folder_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("fcntl")

    def told(count: int) -> None:
        if count == 1:
            with pytest.raises(StudyError, match="another run writing there"):
                run(small(), tmp_path)

    run(small(), tmp_path, told=told)


def test_a_record_that_is_not_of_the_assignments_is_refused(tmp_path: Path) -> None:
    run(small(), tmp_path)
    lines = (tmp_path / NAME).read_bytes().splitlines(keepends=True)
    (tmp_path / NAME).write_bytes(b"".join([*lines[:2], *lines[1:]]))
    with pytest.raises(StudyError, match=f"{NAME}:3: found Trial.*sure.*expected Assignment.*quick"):
        run(small(), tmp_path)
    (tmp_path / NAME).write_bytes(b'{"scene": "ambiguous"}\n')
    with pytest.raises(StudyError, match=f"{NAME}:1: found .*expected a first line"):
        run(small(), tmp_path)


def test_memory_does_not_grow_with_the_trials(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From 300 to 2,000 trials it grows by less than 60 bytes a trial; keeping the trials would take 140 each."""

    def at_once(_: Agent, desired: int, *__: object, **___: object) -> Encounter:
        return Encounter((Acted(Wait(), time=1.0), Acted(Pick(desired), time=2.0)), 0.5)

    monkeypatch.setattr(experiment, "encounter", at_once)
    sizes: dict[int, int] = {}

    def told(count: int) -> None:
        if count in (300, 2_000):
            gc.collect()
            sizes[count] = tracemalloc.get_traced_memory()[0]

    tracemalloc.start()
    run(small(people=2_000 // 25, trials=5), tmp_path, told=told)
    tracemalloc.stop()
    assert sizes[2_000] - sizes[300] < 60 * 1_700


def test_the_same_person_comes_to_all_their_trials(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    met: list[tuple[Any, float]] = []

    def noted(_: Agent, desired: int, traits: Any, __: Any, rng: Generator, **___: object) -> Encounter:
        met.append((traits, float(rng.random())))
        return Encounter((Acted(Pick(desired), time=1.0),), 0.0)

    monkeypatch.setattr(experiment, "encounter", noted)
    run(small(people=3), tmp_path)
    persons = [row.person for row in assignments(small(people=3))]
    assert [met[persons.index(person)][0] for person in persons] == [traits for traits, _ in met]
    assert len({repr(traits) for traits, _ in met}) == 3
    assert len({draw for _, draw in met}) == len(met)

"""Who does the work: this process, others on this machine, or a cluster that is there already."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, get_args

from fetch_pomdp.checks import shown
from fetch_pomdp.errors import StudyError
from fetch_pomdp.extras import load

Task = TypeVar("Task")
Result = TypeVar("Result")
WAVE = 32  # tasks a worker
Backend = Literal["loky", "threading", "dask", "ray"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Crew:
    """Workers, through joblib.

    workers: how many; 0 for one a core. A Dask or Ray cluster at `address` brings its own number; without an address
    one of so many processes is started on this machine. Raises StudyError for a backend that does not exist, or an
    address without a cluster.
    """

    workers: int = 1
    backend: Backend = "loky"
    address: str | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.workers, int) or self.workers < 0:
            raise StudyError(f"found {shown(self.workers)}, expected a whole number from 0", field="workers")
        if self.backend not in get_args(Backend):
            names = ", ".join(get_args(Backend))
            raise StudyError(f"found {shown(self.backend)}, expected one of {names}", field="backend")
        if self.address is not None and self.backend not in ("dask", "ray"):
            raise StudyError(f"found {self.backend!r} with an address, expected dask or ray", field="backend")

    def results(self, work: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Result]:
        """Yield `work(task)` of each task in their order; tasks are taken as they are needed.

        Ray's backend gives nothing back before all it was given is done: it gets a wave of tasks at a time.
        """
        joblib = load("joblib", "study")
        count = self.workers or joblib.cpu_count()
        with contextlib.ExitStack() as stack:
            stack.enter_context(self._config(joblib, count, stack))
            in_waves = self.backend == "ray"
            parallel = stack.enter_context(joblib.Parallel(return_as="list" if in_waves else "generator"))
            for wave in _waves(tasks, WAVE * joblib.effective_n_jobs(-1)) if in_waves else (tasks,):
                yield from parallel(joblib.delayed(work)(task) for task in wave)

    def _config(self, joblib: Any, count: int, stack: contextlib.ExitStack) -> Any:
        if self.backend == "dask":
            client = load("distributed", "dask").Client
            if self.address is None:
                cluster = {"n_workers": count, "threads_per_worker": 1, "dashboard_address": None}
                return joblib.parallel_config("dask", client=stack.enter_context(client(**cluster)))
            return joblib.parallel_config("dask", client=stack.enter_context(client(self.address)))
        if self.backend == "ray":
            ray = load("ray", "ray")
            load("ray.util.joblib", "ray").register_ray()
            where = {"num_cpus": count} if self.address is None else {"address": self.address}
            ray.init(**where, include_dashboard=False)
            stack.callback(ray.shutdown)
            return joblib.parallel_config("ray", n_jobs=count if self.address is None else -1)
        return joblib.parallel_config(self.backend, n_jobs=count)


def _waves(tasks: Iterable[Task], size: int) -> Iterator[list[Task]]:
    rest = iter(tasks)
    while wave := list(itertools.islice(rest, size)):
        yield wave

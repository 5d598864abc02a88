"""A `fetch-pomdp serve` process as a user starts it, and what it takes of the machine (Linux)."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

PROC = Path("/proc")
TICKS = os.sysconf("SC_CLK_TCK")  # a second


@dataclass(frozen=True, slots=True)
class Spent:
    """What a server and the processes it started have taken so far."""

    memory: float  # MB; pages that processes share count once (Pss)
    cpu: float  # s
    threads: int
    files: int  # that are open, connections too


class Served:
    """A server on a free port of loopback; to be used in a `with`."""

    def __init__(self, *options: str) -> None:
        with socket.create_server(("127.0.0.1", 0)) as door:
            self.host = f"127.0.0.1:{door.getsockname()[1]}"
        program = Path(sys.executable).with_name("fetch-pomdp")
        command = [str(program), "serve", "--port", self.host.partition(":")[2], *options]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)

    def __enter__(self) -> Served:
        """Wait until pages may come. Raises RuntimeError if the server ends before."""
        said = self._process.stdout.readline() if self._process.stdout else ""
        if self.host not in said:
            raise RuntimeError(f"the server did not start: {said}")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the server as Ctrl-C does."""
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.communicate(timeout=15)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()

    @property
    def alive(self) -> bool:
        """Whether the server still runs."""
        return self._process.poll() is None

    def spent(self) -> Spent:
        """Return what the server and its children have taken so far."""
        family = [self._process.pid, *_children(self._process.pid)]
        folders = [PROC / str(pid) for pid in family]
        threads, files = (sum(len(list((at / kind).iterdir())) for at in folders) for kind in ("task", "fd"))
        return Spent(sum(map(_memory, folders)), sum(map(_cpu, folders)), threads, files)


def _children(pid: int) -> list[int]:
    tasks = (PROC / str(pid) / "task").iterdir()
    return [int(child) for task in tasks for child in (task / "children").read_text().split()]


def _memory(folder: Path) -> float:
    lines = (folder / "smaps_rollup").read_text().splitlines()
    return sum(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024


def _cpu(folder: Path) -> float:
    fields = (folder / "stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS

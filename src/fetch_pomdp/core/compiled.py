"""How functions are compiled and put on all cores, and the random numbers that compiled code draws."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit

GOLDEN = 0x9E3779B97F4A7C15  # step of SplitMix64
_SHARE = 256  # decisions, below which a second thread does not pay

Function = TypeVar("Function", bound=Callable[..., Any])
Vector = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
RandomState = npt.NDArray[np.uint64]  # (1,): the state of `uniform`


def compiled(function: Function) -> Function:
    """Compile with Numba on first call; the result is cached on disk where a folder for it can be written."""
    return _compiled(function)


def lean(function: Function) -> Function:
    """Compile like `compiled` a function that makes no array, and so need not count references to any."""
    return _compiled(function, _nrt=False)


def inlined(function: Function) -> Function:
    """Compile like `lean`, into the caller: a call that hands over a `Tables` costs more than a small function."""
    return _compiled(function, _nrt=False, forceinline=True)


def _compiled(function: Function, **more: bool) -> Function:
    jit: Any = njit
    # Nothing here computes with NaN, so loops over a max may be vectorised.
    options = {
        "nogil": True,
        "error_model": "numpy",
        "fastmath": {"nnan", "nsz", "contract"},
        **more,
    }
    try:
        return cast("Function", jit(cache=True, **options)(function))
    except RuntimeError:  # no folder for the cache can be written: each process compiles anew
        return cast("Function", jit(**options)(function))


def random_state(seed: int) -> RandomState:
    """Return a generator's state for compiled code; `seed` below 2**63."""
    return np.array([seed], dtype=np.uint64)


@inlined
def mixed(z: Any) -> Any:
    """Return 64 bits that look random, of 64 bits: the mixing of SplitMix64."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@inlined
def uniform(state: RandomState) -> float:
    """Return a number in [0, 1) and advance the state: SplitMix64 (Steele, Lea and Flood 2014).

    Choice: a generator of one word, since a planner starts one for every decision.
    """
    state[0] += np.uint64(GOLDEN)
    return float(mixed(state[0]) >> np.uint64(11)) * 2.0**-53


@inlined
def standard_normal(state: RandomState) -> float:
    """Return a number from N(0, 1): Box and Muller 1958."""
    radius = np.sqrt(-2.0 * np.log(1.0 - uniform(state)))
    return float(radius * np.cos(2.0 * np.pi * uniform(state)))


def on_all_cores(work: Callable[[int, int], None], count: int) -> None:
    """Call `work(begin, end)` on shares of `count`, one a core, in threads: for work that releases the GIL."""
    workers = max(1, min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
                         count // _SHARE))  # fmt: skip
    if workers == 1:
        work(0, count)
        return
    edges = np.linspace(0, count, workers + 1).astype(int).tolist()
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work, edges[:-1], edges[1:]))

"""Compile what most tests need, once, before two processes begin and both compile it: `make test`.

python -m tests.compile
"""

from __future__ import annotations

import tests.conftest  # noqa: F401  chooses Numba's cache before Numba is imported
from fetch_pomdp.core.bounding.bounds import upper_bound
from fetch_pomdp.core.live.person import LIVE_MODEL
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import PLANNERS
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import simulate


def main() -> None:
    """Decide with each planner, play with the paper's people and with live ones, and bound a return."""
    problem = Problem(Scene.load("ambiguous"))
    for make in PLANNERS.values():
        prepare(make(), problem)
    for name in ("fitted", "threshold"):
        simulate(problem, PLANNERS[name](), 600, seed=0)
    live = Problem(Scene.load("ambiguous", LIVE_MODEL))
    prepare(PLANNERS["fitted"](), live)
    upper_bound(problem, scenarios=2, seed=0)


if __name__ == "__main__":
    main()

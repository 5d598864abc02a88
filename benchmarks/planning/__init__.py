"""The parts of the planner benchmarks, `benchmarks/planners.py` and `benchmarks/scenes.py`."""

from typing import Any, TypeAlias

Record: TypeAlias = dict[str, Any]  # a row of results, as it is written to JSON; names that end in _s are seconds
DEFAULT = "FittedValue, default"  # the planner that all others are compared with

"""FETCH-POMDP: decide online whether to wait, to point at an item and ask "this one?", or to pick it."""

# ruff: noqa: F403, F405 (the names are those of api.py, which type checkers see and a test compares)
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fetch_pomdp.api import *

__version__: str
__all__ = [
    "Acted",
    "Action",
    "Agent",
    "AlwaysAsk",
    "Belief",
    "Bound",
    "Decision",
    "Event",
    "Evidence",
    "ExactAnswers",
    "Explanation",
    "Failure",
    "FetchPomdpError",
    "FittedValue",
    "Frame",
    "InputError",
    "Item",
    "MissingExtraError",
    "Model",
    "NeverAsk",
    "Observation",
    "Observed",
    "Outcome",
    "PaperAlwaysAsk",
    "PaperNeverAsk",
    "Pick",
    "Planner",
    "Point",
    "Problem",
    "Ray",
    "Recognizer",
    "Rewards",
    "Robot",
    "Scene",
    "SkeletonSource",
    "SparseSampling",
    "State",
    "Summary",
    "TableReader",
    "Threshold",
    "Timing",
    "Wait",
    "Word",
    "decide_many",
    "explain",
    "interact",
    "live_scene",
    "simulate",
    "step",
    "tuned",
    "upper_bound",
]


def __getattr__(name: str) -> Any:
    """Load the library when one of its names is first asked for.

    So the command line begins before anything is imported that takes long, and ends quietly on Ctrl-C.
    """
    from importlib import import_module, metadata

    if name in __all__:
        return getattr(import_module("fetch_pomdp.api"), name)
    if name == "__version__":
        try:
            return metadata.version("fetch-pomdp")
        except metadata.PackageNotFoundError:  # only its folder is on the path
            return "unknown"
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, "__version__"})

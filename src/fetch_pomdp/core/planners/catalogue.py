"""Planners by name."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

from fetch_pomdp.checks import known
from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.planners.baselines.paradigms import AlwaysAsk, NeverAsk
from fetch_pomdp.core.planners.baselines.rules import ChaiRule, InformationGain, OneShot, PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import DoshiRoy, PaperNeverAsk, WilliamsYoung
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.errors import PlannerError

DEFAULT = "fitted"
PLANNERS: Mapping[str, Callable[..., Planner]] = {
    "fitted": FittedValue,
    "exact": ExactAnswers,
    "sparse": SparseSampling,
    "threshold": Threshold,
    "never": NeverAsk,
    "always": AlwaysAsk,
    "paper-never": PaperNeverAsk,
    "paper-always": PaperAlwaysAsk,
    "chai": ChaiRule,
    "williams-young": WilliamsYoung,
    "doshi-roy": DoshiRoy,
    "information-gain": InformationGain,
    "one-shot": OneShot,
}


def planner_named(name: str, **parameters: Any) -> Planner:
    """Return a planner by its name in `PLANNERS`, with the parameters that are not None.

    Raises PlannerError for an unknown name, or a parameter that this planner does not have.
    """
    if name not in PLANNERS:
        raise PlannerError(f"found {name!r}, expected one of {', '.join(PLANNERS)}", field="planner")
    given = {key: value for key, value in parameters.items() if value is not None}
    fields = [field.name for field in dataclasses.fields(PLANNERS[name])]  # type: ignore[arg-type]
    known(given, fields, f"parameter of planner {name!r}", PlannerError)
    return PLANNERS[name](**given)

"""The belief over the desired item, updated by Bayes' rule."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.compiled import Vector, compiled
from fetch_pomdp.core.observation import Observation, Parts
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.turns import StepChances, constant_chances
from fetch_pomdp.errors import BeliefError

MOST_ITEMS = 2**31  # 16 GiB of probabilities


class Belief:
    """A distribution over the items, kept as logarithms so that no amount of evidence makes it invalid. Immutable.

    Raises BeliefError for a prior that is not a distribution: negative, not finite, or a sum that is not 1 within 1e-6.
    """

    __slots__ = ("_log",)

    _log: Vector

    def __init__(self, probabilities: npt.ArrayLike) -> None:
        given = _reals(probabilities)
        if given.ndim != 1 or not len(given) or not np.isfinite(given).all() or (given < 0).any():
            found = shown(probabilities)
            raise BeliefError(f"found {found}, expected a list of probabilities, one an item", field="belief")
        if abs(given.sum() - 1.0) > 1e-6:
            raise BeliefError(f"found a sum of {given.sum():.6g}, expected 1", field="belief")
        with np.errstate(divide="ignore"):
            self._log = np.log(given / given.sum())
        self._log.flags.writeable = False

    @classmethod
    def uniform(cls, n_items: int) -> Belief:
        """Return the belief an interaction starts with. Raises BeliefError for a number of items below 1."""
        n_items = checks.whole(n_items, 1, MOST_ITEMS, "n_items", BeliefError)
        return cls(np.full(n_items, 1.0 / n_items))

    @classmethod
    def of_logs(cls, logs: Vector) -> Belief:
        """Return the belief in proportion to the exponentials of logs, (n_items,)."""
        belief = cls.__new__(cls)
        belief._log = logs - np.logaddexp.reduce(logs)
        belief._log.flags.writeable = False
        return belief

    @property
    def log_probabilities(self) -> Vector:
        """Logarithms of the probabilities, (n_items,), read-only."""
        return self._log

    @property
    def probabilities(self) -> Vector:
        """The probabilities in scene order, (n_items,); they sum to 1."""
        return np.asarray(np.exp(self._log))

    def updated(
        self,
        observation: Observation,
        asked: int | None,
        problem: Problem,
        *,
        chances: StepChances | None = None,
        parts: Parts | None = None,
    ) -> Belief:
        """Return the belief after an observation (Bayes' rule with Eq. 1-7). asked: index of i_r, or None.

        chances: of the step where people are live (`Problem.step_chances`). parts: the observation's log-likelihoods,
        from whoever has them already.

        What scales all items alike cancels; so under constant chances the action before does not matter here, and
        responses are read by Table I. Raises BeliefError if the observation is impossible for every item that the
        belief allows.
        """
        if parts is None:
            parts = observations.log_likelihoods(
                observation, asked, problem, chances or constant_chances(problem.model.p_l, problem.model.p_g)
            )
        log, possible = _posterior(self._log, parts.together())
        if not possible:
            about = "no question" if asked is None else f"a question about {problem.scene.items[asked].id!r}"
            found = f"found {shown(observation)} after {about}, expected an observation with a chance above 0"
            raise BeliefError(found, field="observation")
        log.flags.writeable = False
        belief = Belief.__new__(Belief)
        belief._log = log
        return belief


def _reals(given: npt.ArrayLike) -> Vector:
    """Return real numbers as an array of any shape; an empty one for anything else, such as truth values and texts."""
    if isinstance(given, list | tuple) and any(isinstance(one, bool | np.bool_) for one in given):
        return np.empty(0)
    try:
        found = np.asarray(given)
    except ValueError:  # rows of different lengths
        return np.empty(0)
    return np.array(found, dtype=np.float64) if found.dtype.kind in "iuf" else np.empty(0)


@compiled
def _posterior(prior: Vector, likelihood: Vector) -> tuple[Vector, bool]:
    """Return the normalised sum of two log vectors, and whether any of it is possible."""
    log = prior + likelihood
    largest = log.max()
    if largest == -np.inf:
        return log, False
    total = 0.0
    for item in range(len(log)):
        log[item] -= largest
        total += np.exp(log[item])
    return log - np.log(total), True

"""A problem as plans are made for it: few outcomes of words and pointing, and the rows of all questions.

Outcomes are those of `discrete`: classes of words where nobody points, and of rays, whatever is said with them. Where
there are more than MOST_OUTCOMES, those that lose least are taken for one. Both are coarser than what is heard, so that
what a plan earns on them it earns at least on the whole (Blackwell 1951).
"""

from __future__ import annotations

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.core.planners.pointbased.backup import Steps
from fetch_pomdp.core.problem import Problem, nobody_live
from fetch_pomdp.core.questions.rows import Rows

MOST_OUTCOMES = 24


def steps_of(problem: Problem, rows: Rows) -> Steps:
    """Return the steps of a problem. Raises ModelError for live people, SceneError for over 200 items."""
    tables = problem.tables
    return Steps(
        rows=rows.chances,
        starts=rows.starts,
        prices=rows.prices,
        outcomes=outcomes_of(problem),
        answered=tables.p_answer,
        again=tables.p_again,
        wait=tables.wait,
        right=tables.pick_correct,
        wrong=tables.pick_wrong,
    )


def outcomes_of(problem: Problem) -> Vector:
    """Return the chances of what may be heard and seen in a step given the desired item, (m, n_items).

    The first is silence, with what tells as little; columns sum to 1.
    """
    nobody_live(problem, "a plan of questions")
    classes = Discrete(Problem(problem.scene))
    still, pointing = classes.gestures[:, :1], classes.gestures[:, 1:]
    return merged(np.concatenate([(classes.words * still).T, pointing.T]), MOST_OUTCOMES)


def merged(rows: Vector, most: int) -> Vector:
    """Return rows of chances, of which those that lose least information are added up until there are at most `most`.

    Rows that say the same lose nothing, and are always added up. Items are alike likely, as before anything is known.
    """
    rows = rows[rows.sum(axis=1) > 0.0]
    loss = np.full((len(rows), len(rows)), np.inf)
    for index in range(len(rows)):
        _fill(loss, rows, index)
    while len(rows) > 1:
        one, other = sorted(divmod(int(loss.argmin()), len(rows)))
        if loss[one, other] > 1e-9 and len(rows) <= most:
            break
        rows[one] += rows[other]
        rows = np.delete(rows, other, axis=0)
        loss = np.delete(np.delete(loss, other, axis=0), other, axis=1)
        _fill(loss, rows, one)
    return np.ascontiguousarray(rows)


def _fill(loss: Vector, rows: Vector, index: int) -> None:
    """Fill in what adding a row to each of the others loses (nats)."""
    both = rows + rows[index]
    lost = _told(rows) + _told(rows[index : index + 1]) - _told(both)
    lost[index] = np.inf
    loss[index], loss[:, index] = lost, lost


def _told(rows: Vector) -> Vector:
    """Return the mutual information of each row with the item, times its chance (nats)."""
    mean = rows.mean(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(rows > 0.0, rows * np.log(rows / mean), 0.0).mean(axis=1))

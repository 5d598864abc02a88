"""A node whose observations are sampled, answers included (Section III-D-1)."""

from __future__ import annotations

from fetch_pomdp.core.compiled import inlined, lean, uniform
from fetch_pomdp.core.planners.kernels import answered, draw_item, largest, pick_value, select_answer, turn_of
from fetch_pomdp.core.planners.search.tree import Search, Work, draw, following_phase, row_of
from fetch_pomdp.core.problem import Tables


@lean
def next_observation(level: int, search: Search, work: Work, tables: Tables) -> bool:
    """Move a node's cursor to its next sample and action and put the belief then one level down; False at the end."""
    cursor = work.cursor
    sample, branch = divmod(cursor["branch"][level], search.questions + 1)
    if sample == search.width:
        return False
    belief, state = work.beliefs[level], work.state
    if branch == 0:
        cursor["desired"][level] = draw_item(belief, (sample + cursor["offset"][level]) / search.width)
        draw(level, cursor["desired"][level], work, tables)
        if sample == 0:
            cursor["speaks"][level], cursor["means"][level] = uniform(state), uniform(state)
        cursor["speaks"][level], cursor["means"][level] = spread(cursor["speaks"][level], cursor["means"][level])
    cursor["branch"][level] += 1
    turn = turn_of(cursor["asked"][level], cursor["phase"][level], branch - 1)
    answer = select_answer(cursor["desired"][level], turn, cursor["speaks"][level], cursor["means"][level], tables)
    answered(work.heard[level, row_of(turn, tables)], turn, answer, work.beliefs[level + 1], tables)
    cursor["asked"][level + 1] = turn.about
    cursor["phase"][level + 1] = following_phase(level, turn, answer, work, tables)
    return True


@lean
def last_two_sampled(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left, the last of them by leaf `pick`."""
    belief, following, state = work.beliefs[level], work.beliefs[level + 1], work.state
    totals, squares = work.totals[level], work.squares[level]
    asked, phase, offset = work.cursor["asked"][level], work.cursor["phase"][level], work.cursor["offset"][level]
    speaks, means = uniform(state), uniform(state)
    for sample in range(search.width):
        desired = draw_item(belief, (sample + offset) / search.width)
        draw(level, desired, work, tables)
        speaks, means = spread(speaks, means)
        for action in range(-1, search.questions):
            turn = turn_of(asked, phase, action)
            answer = select_answer(desired, turn, speaks, means, tables)
            answered(work.heard[level, row_of(turn, tables)], turn, answer, following, tables)
            value = max(tables.wait, pick_value(largest(following), tables))
            totals[action] += value
            squares[action] += value * value


@inlined
def add_observation(level: int, value: float, search: Search, work: Work) -> None:
    """Add the value of the belief that the node's cursor is at."""
    action = (work.cursor["branch"][level] - 1) % (search.questions + 1) - 1
    work.totals[level, action] += value
    work.squares[level, action] += value * value


@inlined
def spread(speaks: float, means: float) -> tuple[float, float]:
    """Return the next point of a sequence that fills the unit square evenly (Roberts 2018, the R2 sequence)."""
    return (speaks + 0.7548776662466927) % 1.0, (means + 0.5698402909980532) % 1.0

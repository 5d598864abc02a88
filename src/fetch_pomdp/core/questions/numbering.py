"""One numbering of actions: the wait is 0, then come the questions, then the picks, each in their order.

With the paper's questions these are the numbers of `discrete.all_actions`.
"""

from __future__ import annotations

from fetch_pomdp.core.action import AnyAction, Ask, Pick, Point, Wait
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import ActionError

WAIT = 0


def number_of(action: AnyAction, problem: Problem) -> int:
    """Return an action's number. Raises ActionError for an action that the problem does not have."""
    number = WAIT
    if isinstance(action, Ask):
        number = 1 + action.question if 0 <= action.question < len(problem.questions) else -1
    elif isinstance(action, Point):
        number = 1 + _question_about(action.item, problem)
    elif isinstance(action, Pick):
        number = 1 + problem.n_questions + action.item if 0 <= action.item < problem.n_items else -1
    if number < 0:
        size = f"{problem.n_items} items and {problem.n_questions} questions"
        raise ActionError(f"found {action!r}, expected an action on {size}", field="action")
    return number


def action_at(number: int, problem: Problem) -> AnyAction:
    """Return the action of a number. Raises ActionError for one out of range."""
    most = problem.n_questions + problem.n_items
    if not 0 <= number <= most:
        raise ActionError(f"found {number}, expected 0 to {most}", field="action")
    if number == WAIT:
        return Wait()
    if number > problem.n_questions:
        return Pick(number - 1 - problem.n_questions)
    return action_of_question(number - 1, problem)


def action_of_question(question: int, problem: Problem) -> AnyAction:
    """Return the action that asks a question: `Point` at its item where it is about one."""
    if not problem.questions:
        return Point(question)
    item = problem.questions[question].item
    return Ask(question) if item is None else Point(item)


def all_actions(problem: Problem) -> tuple[AnyAction, ...]:
    """Return every action in the order of their numbers."""
    return tuple(action_at(number, problem) for number in range(1 + problem.n_questions + problem.n_items))


def _question_about(item: int, problem: Problem) -> int:
    """Return the number of the question that points at an item, or one below -1."""
    if not problem.questions:
        return item if 0 <= item < problem.n_items else -2
    return next((index for index, each in enumerate(problem.questions) if each.item == item), -2)

"""A scene in Cassandra's .pomdp format, for offline solvers; core/discrete.py says what its observations are.

States are the pairs (i_d, i_r) and `end`, which a pick leads to; there every action is free and nothing is seen but
`end`. Names are numbers of items (want0-unasked, want0-asked1, ask1, pick1, word2-yes-at0), as a format of bare words
cannot hold every id; comments say which items and words they are. The initial belief is uniform, with nothing asked.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.discrete import Discrete, all_actions
from fetch_pomdp.errors import ExportError, ModelError

MOST_NUMBERS = 5_000_000  # in a file: about 50 MB
DISCOUNT = 0.999
END = "end"
UNASKED = "unasked"
RESPONSES = ("silent", "yes", "no")


def checked_discount(value: object) -> float:
    """Return a discount above 0 and at most 1. Raises ModelError for any other.

    Choice: 0.999 unless given. The paper discounts nothing, but solvers of these formats divide by 1 - discount. A
    fetch takes some four steps, so that 0.999 changes its value by about 0.05.
    """
    return checks.within(value, 1e-9, 1.0, "discount", "a number above 0 and at most 1", ModelError)


def action_name(action: Action) -> str:
    """Return the name of an action in a file."""
    if isinstance(action, Wait):
        return "wait"
    return f"{'ask' if isinstance(action, Point) else 'pick'}{action.item}"


def word_names(model: Discrete) -> list[str]:
    """Return the names of the classes of words."""
    return ["silence", *(f"word{index}" for index in range(1, len(model.word_classes)))]


def gesture_names(model: Discrete) -> list[str]:
    """Return the names of the classes of gestures."""
    columns = range(model.gestures.shape[1] - 1)
    places = [divmod(column, model.rings) for column in columns]
    return ["still", *(f"at{item}" if model.rings == 1 else f"at{item}ring{ring}" for item, ring in places)]


def explained(model: Discrete) -> Iterator[str]:
    """Yield lines of plain ASCII that say which items and words the names mean."""
    problem = model.problem
    yield "The FETCH-POMDP of a scene, written by fetch-pomdp."
    for index, item in enumerate(problem.scene.items):
        yield f"item {index}: {json.dumps(item.id)}"
    for index, words in enumerate(model.word_classes[1:], start=1):
        owners = [str(i) for i, item in enumerate(problem.scene.items) if words[0] in item.vocabulary]
        yield f"word{index}: {', '.join(map(json.dumps, words))} (items {' '.join(owners)})"
    if model.gestures.shape[1] > 1:
        degrees = np.degrees(problem.model.gesture_threshold)
        yield f"at0: a pointing ray nearest to item 0, at most {degrees:.4g} degrees off; ring0, ring1, ...: how near"


def pomdp_lines(model: Discrete, discount: float = DISCOUNT) -> Iterator[str]:
    """Yield the lines of a .pomdp file, without line ends.

    Raises ModelError for a discount out of its range, ExportError if the file would hold over MOST_NUMBERS numbers.
    """
    discount = checked_discount(discount)
    n_items = model.problem.n_items
    # A later line overrides an earlier one: after a wait answers may be rarer than after anything else.
    tables: dict[str, Action] = {"*": Point(0)}
    if model.problem.model.p_answer_again != 1.0:
        tables["wait"] = Wait()
    size = len(tables) * (n_items * (n_items + 1) + 1) * (math.prod(model.n_classes) + 1)
    too_large(size, model)
    return _lines(model, discount, tables)


def too_large(size: int, model: Discrete) -> None:
    """Raise ExportError if a file of `size` numbers would be too large."""
    if size > MOST_NUMBERS:
        words, responses, gestures = model.n_classes
        what = f"{model.problem.n_items} items and {words} x {responses} x {gestures} observations"
        found = f"found {what}, which make {size:,} numbers, expected at most {MOST_NUMBERS:,}"
        raise ExportError(f"{found}; use fewer items, words or rings, or write a .pomdpx file, which is smaller")


def _state(desired: int, asked: int | None) -> str:
    return f"want{desired}-{UNASKED if asked is None else f'asked{asked}'}"


def _questions(n_items: int) -> list[int | None]:
    return [None, *range(n_items)]


def _lines(model: Discrete, discount: float, tables: dict[str, Action]) -> Iterator[str]:
    n_items = model.problem.n_items
    states = [_state(desired, asked) for asked in _questions(n_items) for desired in range(n_items)]
    # An observation that no state can give (items in one direction) is left out: solvers divide by its chance.
    kept = np.flatnonzero(sum(_observations(model, None, action).sum(axis=0) for action in tables.values()) > 0.0)
    pairs = [f"{word}-{response}" for word in word_names(model) for response in RESPONSES]
    names = [f"{pair}-{gesture}" for pair in pairs for gesture in gesture_names(model)]
    yield from (f"# {line}" for line in explained(model))
    yield f"discount: {discount!r}"
    yield "values: reward"
    yield f"states: {' '.join(states)} {END}"
    yield f"actions: {' '.join(map(action_name, all_actions(n_items)))}"
    yield f"observations: {' '.join(names[index] for index in kept)} {END}"
    yield f"start: {_row([1.0 / n_items] * n_items + [0.0] * (len(states) + 1 - n_items))}"
    yield from _transitions(n_items)
    for name, action in tables.items():
        yield from _observation_rows(model, name, action, kept)
    yield from _rewards(model)


def _row(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.12g}" for number in numbers)


def _observations(model: Discrete, asked: int | None, action: Action) -> Vector:
    return model.likelihood(asked, action).reshape(model.problem.n_items, -1)


def _transitions(n_items: int) -> Iterator[str]:
    yield "T: wait"
    yield "identity"
    for about in range(n_items):
        for asked in _questions(n_items):
            for desired in range(n_items):
                yield f"T: ask{about} : {_state(desired, asked)} : {_state(desired, about)} 1.0"
        yield f"T: ask{about} : {END} : {END} 1.0"
    for item in range(n_items):
        yield f"T: pick{item} : * : {END} 1.0"


def _observation_rows(model: Discrete, name: str, action: Action, kept: Integers) -> Iterator[str]:
    for asked in _questions(model.problem.n_items):
        for desired, row in enumerate(_observations(model, asked, action)[:, kept]):
            yield f"O: {name} : {_state(desired, asked)}"
            yield f"{_row(row)} 0"
    yield f"O: {name} : {END}"
    yield f"{_row([0.0] * len(kept))} 1"


def _rewards(model: Discrete) -> Iterator[str]:
    rewards, n_items = model.problem.rewards, model.problem.n_items
    for action in all_actions(n_items):
        name = action_name(action)
        if isinstance(action, Pick):
            yield f"R: {name} : * : * : * {rewards.pick_wrong!r}"
            for asked in _questions(n_items):
                yield f"R: {name} : {_state(action.item, asked)} : * : * {rewards.pick_correct!r}"
        else:
            yield f"R: {name} : * : * : * {rewards.wait if isinstance(action, Wait) else rewards.point!r}"
        yield f"R: {name} : {END} : * : * 0.0"

"""A scene as POMDPX (XML), in factors: i_d hidden, i_r fully observed, and words, response and gesture independent.

This is the mixed observability of Section III-B written down, and far smaller than the flat table of a .pomdp file. A
pick leads i_r to `over`, where no action earns anything; what is seen there does not matter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.discrete import Discrete, all_actions
from fetch_pomdp.files.pomdp import (
    DISCOUNT,
    RESPONSES,
    UNASKED,
    action_name,
    checked_discount,
    explained,
    gesture_names,
    too_large,
    word_names,
)

OVER = "over"  # the value of i_r after a pick
Entry = tuple[str, str]  # values of the parents and the variable, and the numbers for them


def pomdpx_lines(model: Discrete, discount: float = DISCOUNT) -> Iterator[str]:
    """Yield the lines of a .pomdpx file, without line ends.

    Raises ModelError for a discount out of its range, ExportError if the file would hold over MOST_NUMBERS numbers.
    """
    discount = checked_discount(discount)
    n_items, (words, _, gestures) = model.problem.n_items, model.n_classes
    answers = 3 * n_items * (n_items + 2) * (1 if _alike(model) else 2 * n_items + 1)
    too_large(2 * n_items * n_items * (n_items + 2) + n_items * (words + gestures) + answers, model)
    return _lines(model, discount)


def _alike(model: Discrete) -> bool:
    """Whether people answer as often after a wait as after anything else."""
    return model.problem.model.p_answer_again == 1.0


def _lines(model: Discrete, discount: float) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="ASCII"?>'
    yield '<pomdpx version="1.0" id="fetch_pomdp">'
    yield f"<Description>{escape(chr(10).join(explained(model)))}</Description>"
    yield f"<Discount>{discount!r}</Discount>"
    yield from _variables(model)
    yield "<InitialStateBelief>"
    yield from _table("desired_0", "null", [("-", "uniform")])
    yield from _table("asked_0", "null", [("-", _row([1.0] + [0.0] * (model.problem.n_items + 1)))])
    yield "</InitialStateBelief>"
    yield "<StateTransitionFunction>"
    yield from _table("desired_1", "action desired_0", [("* - -", "identity")])
    yield from _table("asked_1", "action asked_0", _asked_after(model))
    yield "</StateTransitionFunction>"
    yield "<ObsFunction>"
    for name, chances in (("words", model.words), ("gesture", model.gestures)):
        entries = ((f"* want{desired} -", _row(row)) for desired, row in enumerate(chances))
        yield from _table(name, "action desired_1", entries)
    yield from _table("response", "action desired_1 asked_1", _responses(model))
    yield "</ObsFunction>"
    yield "<RewardFunction>"
    yield from _table("reward", "action desired_0 asked_0", _rewards(model), kind="Func", numbers="ValueTable")
    yield "</RewardFunction>"
    yield "</pomdpx>"


def _variables(model: Discrete) -> Iterator[str]:
    n_items = model.problem.n_items
    desired = " ".join(f"want{item}" for item in range(n_items))
    yield "<Variable>"
    for name, seen, values in (("desired", "false", desired), ("asked", "true", " ".join([*_asked(model), OVER]))):
        yield f'<StateVar vnamePrev="{name}_0" vnameCurr="{name}_1" fullyObs="{seen}">'
        yield f"<ValueEnum>{values}</ValueEnum></StateVar>"
    for name, names in (("words", word_names(model)), ("response", RESPONSES), ("gesture", gesture_names(model))):
        yield f'<ObsVar vname="{name}"><ValueEnum>{" ".join(names)}</ValueEnum></ObsVar>'
    actions = " ".join(map(action_name, all_actions(n_items)))
    yield f'<ActionVar vname="action"><ValueEnum>{actions}</ValueEnum></ActionVar>'
    yield '<RewardVar vname="reward"/>'
    yield "</Variable>"


def _asked(model: Discrete) -> list[str]:
    return [UNASKED, *(f"asked{item}" for item in range(model.problem.n_items))]


def _table(
    variable: str, parents: str, entries: Iterable[Entry], kind: str = "CondProb", numbers: str = "ProbTable"
) -> Iterator[str]:
    yield f'<{kind}><Var>{variable}</Var><Parent>{parents}</Parent><Parameter type="TBL">'
    for instance, table in entries:
        yield f"<Entry><Instance>{instance}</Instance><{numbers}>{table}</{numbers}></Entry>"
    yield f"</Parameter></{kind}>"


def _row(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.12g}" for number in numbers)


def _asked_after(model: Discrete) -> Iterator[Entry]:
    for action in all_actions(model.problem.n_items):
        name = action_name(action)
        if isinstance(action, Wait):
            yield f"{name} - -", "identity"
        elif isinstance(action, Pick):
            yield f"{name} * {OVER}", "1"
        else:
            for asked in _asked(model):
                yield f"{name} {asked} asked{action.item}", "1"
            yield f"{name} {OVER} {OVER}", "1"


def _responses(model: Discrete) -> Iterator[Entry]:
    actions: dict[str, Action] = {"*": Point(0)}
    if not _alike(model):
        actions = {action_name(action): action for action in all_actions(model.problem.n_items)}
    for name, action in actions.items():
        for index, asked in enumerate(_asked(model)):
            for desired, row in enumerate(model.responses(index - 1 if index else None, action)):
                yield f"{name} want{desired} {asked} -", _row(row)
        yield f"{name} * {OVER} -", "1 0 0"


def _rewards(model: Discrete) -> Iterator[Entry]:
    rewards = model.problem.rewards
    for action in all_actions(model.problem.n_items):
        for asked in _asked(model):  # no entry, no reward: over
            if isinstance(action, Pick):
                for desired in range(model.problem.n_items):
                    earned = rewards.pick_correct if desired == action.item else rewards.pick_wrong
                    yield f"{action_name(action)} want{desired} {asked}", repr(earned)
            else:
                earned = rewards.wait if isinstance(action, Wait) else rewards.point
                yield f"{action_name(action)} * {asked}", repr(earned)

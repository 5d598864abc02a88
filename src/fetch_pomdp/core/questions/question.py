"""A question as data: what it is about, how it is said, how long it takes, and what people answer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from fetch_pomdp.checks import shown
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.errors import ModelError

YES, NO = range(2)  # answers of a question that is answered by yes or no
YES_NO = ("yes", "no")
TOLERANCE = 1e-9


class Kind(Enum):
    """What a question is about."""

    POINT = "point"  # one item, which the robot points at: "this one?"
    ATTRIBUTE = "attribute"  # "a green one?"
    ATTRIBUTES = "attributes"  # two at once: "a big green one?"
    REGION = "region"  # a part of the table: "on your left?"
    PAIR = "pair"  # two items, which the robot points at: "one of these two?"
    OPEN = "open"  # "what is it like?"
    REPEAT = "repeat"  # "sorry, what did you say?"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Question:
    """A question, and p(answer | desired item, question).

    A question of kind POINT about one item is `Point(item)`, that of the paper (Section III-B). Raises ModelError for
    chances that are none, or do not sum to 1 for each item.
    """

    kind: Kind
    said: str
    chances: Vector  # (n_answers, n_items), of each answer given the desired item and that one comes; columns sum to 1
    answers: tuple[str, ...] = YES_NO  # what the answers are called
    members: tuple[int, ...] = ()  # items that it is about, to be shown; none where it is about all alike
    words: tuple[str, ...] = ()  # of the scene, which it asks about
    seconds: float = 0.0  # s, of the robot's step: asking, and listening at its end
    shared: float = 0.0  # chance that who is asked it again answers as before, whatever is right, in [0, 1)

    def __post_init__(self) -> None:
        chances = np.array(self.chances, dtype=np.float64)
        if chances.ndim != 2 or len(chances) != len(self.answers) or not len(chances):
            found = f"found shape {chances.shape}, expected ({len(self.answers)}, items): a row for each answer"
            raise ModelError(found, field="chances")
        if not (np.isfinite(chances).all() and (chances >= 0.0).all()):
            raise ModelError("found a negative or infinite number, expected probabilities", field="chances")
        sums = chances.sum(axis=0)
        if np.abs(sums - 1.0).max(initial=0.0) > TOLERANCE:
            item = int(np.abs(sums - 1.0).argmax())
            raise ModelError(f"found a sum of {sums[item]:.6g} for item {item}, expected 1", field="chances")
        _check_members(self.members, chances.shape[1])
        for name, low, high in (("seconds", 0.0, 1e6), ("shared", 0.0, 1.0 - 1e-9)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise ModelError(f"found {shown(value)}, expected a number from {low:g} to {high:g}", field=name)
        chances.flags.writeable = False
        object.__setattr__(self, "chances", chances)

    @property
    def n_items(self) -> int:
        """How many items there are on its table."""
        return int(self.chances.shape[1])

    @property
    def item(self) -> int | None:
        """The item of a question of kind POINT; None for another."""
        return self.members[0] if self.kind is Kind.POINT else None

    def after(self, answer: int | None) -> Vector:
        """Return the chances where the same question was answered before, (n_answers, n_items).

        answer: the last one's number, None if it never was.

        Choice: with a chance of `shared` people say again what they said, for who has misunderstood a question once, or
        is unsure where "left" ends, is so when it is asked again; else they answer anew. So a second answer tells less
        than the first, and a third as much as the second.
        """
        if answer is None or self.shared == 0.0:
            return self.chances
        same = np.zeros_like(self.chances)
        same[answer] = 1.0
        return self.shared * same + (1.0 - self.shared) * self.chances

    def information(self, belief: Vector) -> float:
        """Return what its answer tells about the desired item, in bits (mutual information). belief: (n_items,)."""
        joint = self.chances * belief
        answer = joint.sum(axis=1, keepdims=True)
        with np.errstate(divide="ignore", invalid="ignore"):
            told = np.where(joint > 0.0, joint * np.log(self.chances / answer), 0.0)
        return max(float(told.sum()) / math.log(2.0), 0.0)


def _check_members(members: Sequence[int], n_items: int) -> None:
    if len(set(members)) != len(members) or any(not 0 <= member < n_items for member in members):
        found = f"found {shown(tuple(members))}, expected different items from 0 to {n_items - 1}"
        raise ModelError(found, field="members")

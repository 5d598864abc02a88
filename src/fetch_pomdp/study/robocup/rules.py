"""The rules of RoboCup@Home's "Hand Me That", and its score.

An operator walks up to each of five groups of objects and points at one, without knowing its name. The robot asks, and
says which one it was, until it is right. Source: the RoboCup@Home rulebook of 2019, Section "Hand Me That", and its
rule "Minimum score": teams cannot receive negative points.

Choice: "this one?" counts as a clarifying question, and a pick as a guess.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core.model import Rewards
from fetch_pomdp.errors import StudyError

MOST_POINTS = 1_000_000


def whole(value: object, least: int, most: int, field: str) -> None:
    """Check a whole number. Raises StudyError for one that is out of range."""
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
        raise StudyError(f"found {shown(value)}, expected a whole number from {least} to {most}", field=field)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rules:
    """The numbers of the rulebook; points are whole. Raises StudyError where they cannot be played by."""

    groups: int = 5
    least_items: int = 2  # in a group
    most_items: int = 5
    least_gap: float = 0.025  # m, between neighbours
    most_gap: float = 0.10  # m
    least_distance: float = 0.5  # m along the floor, between the operator and a group
    most_distance: float = 1.5  # m
    right: int = 500  # an object determined at the first guess
    question: int = -150
    most_questions: int = 3  # of a group that are charged
    description: int = -400  # asking for the colour or category, once a group
    wrong: int = -200  # a wrong guess, off the right one's points
    most_wrong: int = 2  # of a group that are charged
    last_guess: int = 4  # a right guess after that many earns nothing

    def __post_init__(self) -> None:
        whole(self.groups, 1, 1000, "groups")
        whole(self.least_items, 1, 100, "least_items")
        whole(self.most_items, self.least_items, 100, "most_items")
        for least, most in (("least_gap", "most_gap"), ("least_distance", "most_distance")):
            low = checks.within(getattr(self, least), 1e-3, 100.0, least, "a length from 0.001 to 100 m", StudyError)
            checks.within(getattr(self, most), low, 100.0, most, f"a length from {low} to 100 m", StudyError)
        whole(self.right, 1, MOST_POINTS, "right")
        for name in ("question", "description", "wrong"):
            whole(getattr(self, name), -MOST_POINTS, 0, name)
        for name in ("most_questions", "most_wrong", "last_guess"):
            whole(getattr(self, name), 0, 100, name)

    def earned(self, guess: int) -> int:
        """Return the points of a right guess that is the first, the second, ..."""
        return self.right + self.wrong * min(guess - 1, self.most_wrong) if guess <= self.last_guess else 0

    def rewards(self, wait: float = -5.0) -> Rewards:
        """Return the prices of a group for a planner, to whom a pick is the end. Raises ModelError where a wrong guess
        costs nothing.

        Choice: a wrong pick is worth what later right guesses earn on average, (300 + 100 + 100) / 3 points: the robot
        goes on, so its price is the difference. Told that it earns -200, planners that ask do so five to ten times as
        often and score less (docs/robocup.md).

        Choice: a wait costs 5 points. The rules give time no price until it has run out; ten minutes of waits of a
        second are then somewhat dearer than five right guesses.
        """
        later = [self.earned(guess) for guess in range(2, self.last_guess + 1)]
        following = sum(later) / len(later) if later else 0.0
        return Rewards(pick_correct=self.right, pick_wrong=following, point=min(self.question, wait), wait=wait)


@dataclass(frozen=True, slots=True)
class GroupRecord:
    """What happened at one group; the last guess was the right one, or none was."""

    right: bool
    guesses: int
    questions: int
    waits: int = 0
    described: bool = False  # whether the robot asked for the colour or category


def group_score(record: GroupRecord, rules: Rules) -> int:
    """Return the points of a group, which penalties may leave below 0.

    Choice: wrong guesses "reduce the value of the correct guess", so they cost nothing where there is none; questions
    and descriptions cost what they cost in any case.
    """
    points = rules.question * min(record.questions, rules.most_questions)
    points += rules.description if record.described else 0
    if record.right:
        points += rules.earned(record.guesses)
    return points


def game_score(records: Sequence[GroupRecord], rules: Rules) -> int:
    """Return the points of a game, at least 0."""
    return max(0, sum(group_score(record, rules) for record in records))

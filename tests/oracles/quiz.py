"""The value of asking, from the model's definition alone: slow, with answers in the step of their question only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Quiz:
    """Questions with a price and p(answer | item), before people who say and show nothing else."""

    chances: Sequence[Sequence[Sequence[float]]]  # of each question, answer and item
    prices: Sequence[float]
    answered: float  # chance of an answer
    right: float = 10.0
    wrong: float = -12.5


def value(belief: Sequence[float], depth: int, quiz: Quiz) -> float:
    """The most that can be earned with so many questions at most, and then a pick."""
    best = max(quiz.right * p + quiz.wrong * (1.0 - p) for p in belief)
    if depth == 0:
        return best
    return max(best, *(question_value(belief, k, depth, quiz) for k in range(len(quiz.prices))))


def question_value(belief: Sequence[float], k: int, depth: int, quiz: Quiz) -> float:
    """The most that can be earned by a question, and then by what is left."""
    total = quiz.prices[k] + (1.0 - quiz.answered) * value(belief, depth - 1, quiz)
    for row in quiz.chances[k]:
        joint = [p * chance for p, chance in zip(belief, row, strict=True)]
        if sum(joint) > 0.0:
            total += quiz.answered * sum(joint) * value([p / sum(joint) for p in joint], depth - 1, quiz)
    return total

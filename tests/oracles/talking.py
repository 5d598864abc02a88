"""Where a talk stands, in words instead of numbers, and what a robot earns in it: from the docstring of `core.turns`.

Slow and plain. Items that lie in one place, so that pointing tells nothing, and people of whom it is certain in every
step whether they speak and whether they point: only words and answers are left to chance.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from tests.oracles.model import World, class_chance, word_chance
from tests.oracles.value import Values, pick_leaf, picks

Question = Literal["none", "denied", "open", "open long"]
Answer = Literal["silence", "yes", "no"]
QUESTIONS: tuple[Question, ...] = ("none", "denied", "open", "open long")
ANSWERS: tuple[Answer, ...] = ("silence", "yes", "no")


@dataclass(frozen=True)
class Talk:
    said: bool = False  # whether words of the request have come
    pointed: bool = False
    quiet: int = 0  # steps without words since they came; before any came, since pointing began (1, or 2 for more)
    question: Question = "none"


@dataclass(frozen=True)
class Person:
    chances: Mapping[str, Sequence[float]]  # by the names that `core.turns` gives them
    patience: int
    question: int  # quiet steps that a question counts for


@dataclass(frozen=True)
class Step:
    asked: bool
    words: bool
    pointing: bool
    answer: Answer


def all_talks(patience: int) -> list[Talk]:
    """Every talk, in the order of the phases' numbers."""
    silent = [Talk(), Talk(pointed=True, quiet=1), Talk(pointed=True, quiet=2)]
    spoken = [Talk(True, pointed, quiet) for pointed in (True, False) for quiet in range(patience + 1)]
    return [replace(talk, question=question) for talk in silent + spoken for question in QUESTIONS]


def talk_after(talk: Talk, step: Step, person: Person) -> Talk:
    question: Question = "none"
    if step.answer == "no":
        question = "denied"
    elif step.answer == "silence" and step.asked:
        question = "open"
    elif step.answer == "silence" and talk.question in ("open", "open long"):
        question = "open long"
    pointed = talk.pointed or step.pointing
    if step.words:
        return Talk(True, pointed, 0, question)
    if not talk.said:
        return Talk(False, pointed, 2 if talk.pointed else 1 if pointed else 0, question)
    if step.pointing and talk.quiet == person.patience:
        return Talk(False, True, 2, question)
    quiet = talk.quiet + (person.question if step.asked else 1)
    return Talk(True, pointed, min(quiet, person.patience), question)


def group(talk: Talk, patience: int) -> str:
    """What the chances of words and of pointing are called."""
    if talk.question == "denied":
        return "denied"
    if not talk.said:
        return ("unbegun", "pointed", "due")[talk.quiet]
    if talk.quiet == patience:
        return "silent"
    return "heard" if talk.pointed else "said"


def answer_chance(talk: Talk, asked: bool, desired: bool, person: Person) -> float:
    """Chance of an answer, by whether the item asked about is the desired one."""
    is_open = talk.question in ("open", "open long")
    if not asked and not is_open:
        return person.chances["answers_settled"][0]
    ages = person.chances["answers_desired" if desired else "answers_other"]
    if asked:
        return ages[1 if is_open else 0]
    return ages[2 if talk.question == "open" else 3]


def likelihood(answer: Answer, item: int, about: int | None, speaks: float, world: World) -> float:
    if about is None:
        return float(answer == "silence")
    if answer == "silence":
        return 1 - speaks
    return speaks * class_chance(answer == "yes", item, about, world)


def heard(belief: Sequence[float], speaks: bool, world: World) -> list[tuple[float, list[float]]]:
    """The chance of every word, and the belief after it."""
    if not speaks:
        return [(1.0, list(belief))]
    found = []
    for word in world.words:
        joint = [chance * word_chance(word, item, world) for item, chance in enumerate(belief)]
        found.append((sum(joint), [share / sum(joint) for share in joint]))
    return found


def action_values(
    belief: Sequence[float], asked: int | None, talk: Talk, depth: int, world: World, person: Person
) -> Values:
    """Depth counts actions and is at least 2: the last of them is a pick, or a wait."""

    def ahead(about: int | None, *, question: bool) -> float:
        name = group(talk, person.patience)
        words, points = (person.chances[f"{kind}_{name}"][question] > 0.5 for kind in ("words", "points"))
        total = 0.0
        for (said, before), answer in itertools.product(heard(belief, words, world), ANSWERS):
            joint = []
            for item, chance in enumerate(before):
                speaks = answer_chance(talk, question, item == about, person)
                joint.append(said * chance * likelihood(answer, item, about, speaks, world))
            if not sum(joint):
                continue
            following = [share / sum(joint) for share in joint]
            then = talk_after(talk, Step(question, words, points, answer), person)
            if depth == 2:
                total += sum(joint) * pick_leaf(following, about, world)
            else:
                total += sum(joint) * action_values(following, about, then, depth - 1, world, person).best
        return total

    wait = world.wait + ahead(asked, question=False)
    point = [world.ask + ahead(item, question=True) for item in range(len(belief))]
    return Values(wait, point, picks(belief, world))

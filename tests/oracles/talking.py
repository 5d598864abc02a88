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

Answer = Literal["silence", "yes", "no", "unsure", "what?"]
ANSWERS: tuple[Answer, ...] = ("silence", "yes", "no")  # of the model's people
EVERY_ANSWER: tuple[Answer, ...] = (*ANSWERS, "unsure", "what?")
MOST_ASKED = 3  # once, then again, then in other words


@dataclass(frozen=True)
class Question:
    state: Literal["none", "denied", "open"] = "none"
    asked: int = 0  # while it is open: how often, not counting what was asked before people could have answered
    quiet: int = 0  # steps without an answer since it was asked last


@dataclass(frozen=True)
class Talk:
    said: bool = False  # whether words of the request have come
    pointed: bool = False
    quiet: int = 0  # steps without words since they came; before any came, since pointing began, that step too
    question: Question = Question()


@dataclass(frozen=True)
class Person:
    chances: Mapping[str, Sequence[float]]  # by the names that `core.turns` gives them, and the widths of a held arm
    patience: int
    question: int  # quiet steps that a question counts for
    gesturing: int  # steps after the first of pointing in which words are due
    hesitation: int  # quiet steps that an open question is given


@dataclass(frozen=True)
class Step:
    asked: bool
    words: bool
    pointing: bool
    answer: Answer


def all_talks(person: Person) -> list[Talk]:
    """Every talk, in the order of the phases' numbers."""
    silent = [Talk(), *(Talk(pointed=True, quiet=steps + 1) for steps in range(person.gesturing + 2))]
    spoken = [Talk(True, pointed, quiet) for pointed in (True, False) for quiet in range(person.patience + 1)]
    times = itertools.product(range(1, MOST_ASKED + 1), range(person.hesitation + 1))
    questions = [Question(), Question("denied"), *(Question("open", asked, quiet) for asked, quiet in times)]
    return [replace(talk, question=question) for talk in silent + spoken for question in questions]


def is_late(question: Question, person: Person) -> bool:
    return question.state == "open" and question.quiet == person.hesitation


def unanswered(question: Question, step: Step, person: Person) -> Question:
    """The question after a step in which nobody answered."""
    late = is_late(question, person)
    if step.asked:
        if late and question.asked == MOST_ASKED:
            return question  # who has not answered three times is not expected to any more
        return Question("open", question.asked + 1 if late else max(question.asked, 1))
    if question.state != "open" or (late and step.words):
        return Question()
    return replace(question, quiet=min(question.quiet + 1, person.hesitation))


def question_after(question: Question, step: Step, person: Person) -> Question:
    if step.answer == "yes":
        return Question()
    if step.answer == "no":
        return Question("denied")
    after = unanswered(question, step, person)
    if step.answer == "silence" or after.state == "none":
        return after
    gives_up = step.answer == "unsure" and not step.words
    return Question("open", MOST_ASKED if gives_up else after.asked, person.hesitation)


def talk_after(talk: Talk, step: Step, person: Person) -> Talk:
    question = question_after(talk.question, step, person)
    pointed, passed = talk.pointed or step.pointing, person.question if step.asked else 1
    if step.words:
        return Talk(True, pointed, 0, question)
    if talk.said and step.pointing and talk.quiet == person.patience:
        return Talk(False, True, 2, question)
    if talk.said:
        return Talk(True, pointed, min(talk.quiet + passed, person.patience), question)
    quiet = min(talk.quiet + passed, person.gesturing + 2) if talk.pointed else int(pointed)
    return Talk(False, pointed, quiet, question)


def group(talk: Talk, person: Person) -> str:
    """What the chances of words and of pointing are called."""
    if talk.question.state == "denied":
        return "denied"
    return talking(talk, person)


def talking(talk: Talk, person: Person) -> str:
    """The same, whatever became of a question."""
    if not talk.said:
        due = "due" if talk.quiet <= person.gesturing + 1 else "mute"
        return "unbegun" if not talk.pointed else "pointed" if talk.quiet == 1 else due
    if talk.quiet == person.patience:
        return "silent"
    return "heard" if talk.pointed else "said"


def answer_chance(talk: Talk, asked: bool, desired: bool, person: Person) -> float:
    """Chance of an answer, by whether the item asked about is the desired one."""
    question, is_open = talk.question, talk.question.state == "open"
    if is_late(question, person):
        return person.chances["answers_again"][question.asked - 1] if asked else person.chances["answers_late"][0]
    if not asked and not is_open:
        return person.chances["answers_settled"][0]
    ages = person.chances["answers_desired" if desired else "answers_other"]
    if asked:
        return ages[1 if is_open else 0]
    return ages[2 if question.quiet == 0 else 3]


def ray_width(talk: Talk, person: Person) -> float:
    """How much wider than sigma a ray is read: an arm that goes on pointing says little more."""
    name = group(talk, person)
    if name == "pointed":
        return person.chances["held"][0]
    return person.chances["held"][1] if name in ("due", "mute", "heard") else 1.0


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
        name = group(talk, person)
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

"""A scene and its model as arrays: built once, handed to everything that computes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.action import Action, Wait
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.questions.question import Question
from fetch_pomdp.core.rays import LARGEST_EXACT, miss_chances, unit_directions
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import POINTS, StepChances, constant_phases, phases_of
from fetch_pomdp.errors import ModelError


class Tables(NamedTuple):
    """What compiled code reads of a problem; n items, m words in all their vocabularies together.

    Words of an item: `item_words[item_starts[i] : item_starts[i + 1]]`; items of a word likewise.
    """

    directions: Vector  # (n, 3), unit vectors from the scene's head to the items
    smoothing: Vector  # (n,), 1 / (|vocab| + alpha |words|) of Eq. 5
    null_chance: Vector  # (n,), chance of no pointing (Eq. 7; with the exact likelihood it depends on the item)
    item_starts: Integers  # (n + 1,)
    item_words: Integers
    word_starts: Integers  # (m + 1,)
    word_items: Integers
    alpha: float
    p_l: float
    p_answer: float  # chance of a response in the step of a question, whatever is desired: p_l in the paper
    p_again: float  # chance of one in a step after a wait: p_l times p_answer_again in the paper
    p_g: float
    sigma: float  # rad
    threshold: float  # rad
    exact: bool  # whether rays are judged by the density of their sampler
    p_truth: float
    pick_correct: float
    pick_wrong: float
    point: float
    wait: float
    chances: Vector  # (phases, 2, 5), and the next two: see `turns.Phases`
    following: Integers  # (phases, 2, 2, 2, 5)
    alike: Integers  # (phases,)
    begun: Integers  # (phases,)
    awaited: Integers  # (phases,)
    late: Integers  # (phases,)


def constant_only(problem: Problem, what: str) -> None:
    """Refuse live people, and questions of other kinds, for what knows the paper's model alone. Raises ModelError."""
    nobody_live(problem, what)
    points_only(problem, what)


def nobody_live(problem: Problem, what: str) -> None:
    """Refuse live people for what knows the paper's constant chances alone. Raises ModelError."""
    if problem.model.turns is not None:
        found = f"found live people, expected none: {what} knows the paper's constant chances of speaking and pointing"
        raise ModelError(found, field="turns")


def points_only(problem: Problem, what: str) -> None:
    """Refuse questions of other kinds for what knows the paper's alone. Raises ModelError."""
    if not problem.asks_points:
        raise ModelError(
            f'found questions of other kinds, expected none: {what} knows "this one?" alone', field="questions"
        )


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Problem:
    """A scene ready to compute with, and what the robot may ask there.

    questions: of whatever kind (`questions.candidates`); none stands for the paper's, `Point` at each item. Raises
    ModelError if the exact gesture likelihood is asked for too many items, or for questions of another table.
    """

    scene: Scene
    questions: tuple[Question, ...] = ()
    words: tuple[str, ...] = field(init=False)  # all words of the scene, sorted: the "words" of Eq. 5
    word_index: Mapping[str, int] = field(init=False, repr=False)
    positions: Vector = field(init=False, repr=False)  # (n, 3), m
    log_smoothing: Vector = field(init=False, repr=False)  # (n,), log of alpha / (|vocab| + alpha |words|)
    tables: Tables = field(init=False, repr=False)
    asks_points: bool = field(init=False)  # whether its questions are the paper's: Table I of each item in scene order

    def __post_init__(self) -> None:
        items, model = self.scene.items, self.scene.model
        if model.gesture_likelihood == "exact" and len(items) > LARGEST_EXACT:
            found = f"found 'exact' with {len(items)} items, expected at most {LARGEST_EXACT}, or 'eq7'"
            raise ModelError(found, field="gesture_likelihood")
        for index, question in enumerate(self.questions):
            if question.n_items != len(items):
                found = f"found a question about {question.n_items} items, expected the {len(items)} of the scene"
                raise ModelError(found, field=f"questions[{index}]")
        words = self.scene.words
        positions = np.array([item.position for item in items], dtype=np.float64)
        object.__setattr__(self, "words", words)
        object.__setattr__(self, "word_index", {word: index for index, word in enumerate(words)})
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "tables", self._tables())
        object.__setattr__(self, "log_smoothing", np.log(model.alpha * self.tables.smoothing))
        object.__setattr__(self, "asks_points", self._asks_points())

    @property
    def model(self) -> Model:
        """The parameters of Section III-C."""
        return self.scene.model

    @property
    def rewards(self) -> Rewards:
        """The table R(s, a) of Section III-B."""
        return self.scene.rewards

    @property
    def n_items(self) -> int:
        """How many items there are, |I|."""
        return len(self.scene.items)

    @property
    def n_questions(self) -> int:
        """How many questions there are to ask; the paper's, one an item, where none are given."""
        return len(self.questions) or self.n_items

    def step_chances(self, action: Action, phase: int = 0) -> StepChances:
        """Return the chances of the step after an action, begun in a phase (`turns`).

        Choice: Eq. 6 lets the person answer anew at every step once something was asked; real people answer once. So
        under the paper's constant chances, in a step after a wait p_l is multiplied by p_answer_again (1 by default:
        the paper to the letter).
        """
        return StepChances(*self.tables.chances[phase, int(not isinstance(action, Wait))].tolist())

    def with_exact_rays(self) -> Problem:
        """Return the problem under the likelihood of the rays' sampler. Raises ModelError for too many items."""
        if self.model.gesture_likelihood == "exact":
            return self
        model = self.model.with_changes({"gesture_likelihood": "exact"})
        return Problem(dataclasses.replace(self.scene, model=model), self.questions)

    def words_by_owners(self) -> dict[tuple[int, ...], list[int]]:
        """Return the words, by index, of each set of items that own them: words of the same owners say the same."""
        found: dict[tuple[int, ...], list[int]] = {}
        for word in range(len(self.words)):
            owners = self.tables.word_items[self.tables.word_starts[word] : self.tables.word_starts[word + 1]]
            found.setdefault(tuple(owners.tolist()), []).append(word)
        return found

    def _asks_points(self) -> bool:
        if not self.questions:
            return True
        if [question.item for question in self.questions] != list(range(self.n_items)):
            return False
        truth, own = self.model.p_truth, np.eye(self.n_items)
        yes = truth * own + (1.0 - truth) * (1.0 - own)
        given = np.stack([question.chances[0] for question in self.questions])
        return bool(np.array_equal(given, yes)) and not any(question.shared for question in self.questions)

    def _tables(self) -> Tables:
        model, rewards, items = self.model, self.rewards, self.scene.items
        sizes = np.array([len(item.vocabulary) for item in items])
        item_words = np.array([self.word_index[word] for item in items for word in item.vocabulary], dtype=np.int64)
        owners = np.repeat(np.arange(len(items)), sizes)
        directions = unit_directions(np.array(self.scene.head), self.positions)
        exact = model.gesture_likelihood == "exact"
        p_answer, p_again = model.p_l, model.p_l * model.p_answer_again
        if model.turns:
            phases = phases_of(model.turns)
            if model.p_g == 0.0:  # nobody points, live people neither: a ray is then null to the filter
                phases = phases._replace(chances=phases.chances.copy())
                phases.chances[..., POINTS] = 0.0
            p_answer, _, p_again, _ = (sum(pair) / 2 for pair in zip(
                model.turns.answers_desired, model.turns.answers_other, strict=True))  # fmt: skip
        else:
            phases = constant_phases(p_answer, p_again, model.p_g)
        missed = miss_chances(directions, model.sigma, model.gesture_threshold) if exact else np.zeros(len(items))
        return Tables(
            directions=directions,
            smoothing=1.0 / (sizes + model.alpha * len(self.words)),
            null_chance=1.0 - model.p_g * (1.0 - missed),
            item_starts=np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
            item_words=item_words,
            word_starts=np.searchsorted(np.sort(item_words), np.arange(len(self.words) + 1)).astype(np.int64),
            word_items=owners[np.argsort(item_words, kind="stable")].astype(np.int64),
            alpha=model.alpha,
            p_l=model.p_l,
            p_answer=p_answer,
            p_again=p_again,
            p_g=model.p_g,
            sigma=model.sigma,
            threshold=min(model.gesture_threshold, math.pi),
            exact=exact,
            p_truth=model.p_truth,
            pick_correct=rewards.pick_correct,
            pick_wrong=rewards.pick_wrong,
            point=rewards.point,
            wait=rewards.wait,
            chances=phases.chances,
            following=phases.following,
            alike=phases.alike,
            begun=phases.begun,
            awaited=phases.awaited,
            late=phases.late,
        )

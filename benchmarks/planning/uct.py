"""POUCT and POMCP of pomdp_py on our model, as fast as we can make them: the tree search is theirs, the rest ours.

What is handed to it, so that only the planning differs:
- the belief: desired items are drawn from our exact Bayes filter at every decision, and a new tree is grown. For POMCP,
  which is POUCT with a particle belief, so are its particles: with its own update it fails as soon as the robot hears
  what no simulation had heard;
- observations: drawn by our compiled sampler, thousands for every desired item and kind of question, before the clock
  starts; a simulated step takes the next of them. Those that say the same about every item are one node of the tree: a
  word counts as the set of items it may refer to, an answer as yes, no or silence, and as silence if nothing was asked.
  This loses nothing. A ray counts as the item it points at most closely: here the tree is coarser than the model;
- one call a simulated step (a black-box model) instead of three, and a pick that ends the simulation at once.

Three styles, each with more help than the one before:
- random: simulations end in random actions, as with the library's own rollout;
- greedy: they end in the pick that the exact belief of the simulated history holds best, our leaf `pick`;
- aided: moreover a node offers four actions alone: a wait, the best pick, and questions about the two leading items.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pomdp_py
from numpy.random import Generator

from fetch_pomdp import Action, Belief, Decision, Pick, Point, Problem, Wait
from fetch_pomdp.core.compiled import Integers, Vector, compiled, random_state, standard_normal, uniform
from fetch_pomdp.core.gesture import ray_likelihood
from fetch_pomdp.core.language.unigram import draw_word
from fetch_pomdp.core.planners.base import pick_values, unvalued
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.rays import turned
from fetch_pomdp.core.turns import NO, SILENT, YES

Style = Literal["random", "greedy", "aided"]
MOST_ACTIONS = 10  # the longest look ahead
DRAWN = 8192  # observations a stream; a power of 2
BLOCK = 512  # desired items drawn at once
ROUND = 32  # simulations between two looks at the clock
END = 1000  # steps that a pick takes: beyond the longest look ahead, where the library stops
NOT_ASKED, RIGHT, OTHER = 0, 1, 2  # what was asked about: nothing, the desired item, another


class Hidden(pomdp_py.State):  # type: ignore[misc]
    """The desired item, the last question and, for the greedy rollout, the belief that this history leads to."""

    __slots__ = ("asked", "desired", "weights")
    __hash__ = object.__hash__
    __eq__ = object.__eq__

    def __init__(self, desired: int, asked: int, weights: Vector | None) -> None:
        self.desired, self.asked, self.weights = desired, asked, weights


class Seen(pomdp_py.Observation):  # type: ignore[misc]
    """A node's observation; there is one object of each, so that identity is equality."""

    __hash__ = object.__hash__
    __eq__ = object.__eq__


class Move(pomdp_py.Action):  # type: ignore[misc]
    """An action, and what the simulation needs of it."""

    __hash__ = object.__hash__
    __eq__ = object.__eq__

    def __init__(self, action: Action) -> None:
        self.action = action
        self.picks, self.waits = isinstance(action, Pick), isinstance(action, Wait)
        self.item = getattr(action, "item", -1)


class Drawn(pomdp_py.GenerativeDistribution):  # type: ignore[misc]
    """Desired items drawn from the belief."""

    def __init__(self, states: list[Hidden], weights: Vector, rng: Generator) -> None:
        self._states, self._sums, self._rng = states, np.cumsum(weights), rng
        self._next = self._drawn().__next__

    def _drawn(self) -> Iterator[Hidden]:
        while True:
            yield from self.some(BLOCK)

    def some(self, count: int) -> list[Hidden]:
        """Return that many states."""
        found = np.searchsorted(self._sums, self._rng.random(count) * self._sums[-1])
        return [self._states[item] for item in found.tolist()]

    def random(self) -> Hidden:
        """Return the next state."""
        return self._next()


class Simulator(pomdp_py.BlackboxModel):  # type: ignore[misc]
    """The generative model, one call a step."""

    def __init__(self, problem: Problem) -> None:
        tables, n_items = problem.tables, problem.n_items
        self.cursor = 0
        self._rewards = problem.rewards
        self._done = Seen()
        self._streams = Streams(problem).drawn
        own = np.eye(n_items, dtype=bool)
        true, false = tables.p_truth, 1.0 - tables.p_truth
        self._answers = {YES: np.where(own, true, false), NO: np.where(own, false, true)}

    def sample(self, state: Hidden, action: Move) -> tuple[Hidden, Seen, float, int]:
        """Return the next state, the observation, the reward and how many steps it took."""
        if action.picks:
            correct = action.item == state.desired
            return state, self._done, self._rewards.pick_correct if correct else self._rewards.pick_wrong, END
        asked, earned = (state.asked, self._rewards.wait) if action.waits else (action.item, self._rewards.point)
        kind = NOT_ASKED if asked < 0 else RIGHT if asked == state.desired else OTHER
        self.cursor = (self.cursor + 1) % DRAWN
        seen, likelihood, answer = self._streams[state.desired, kind, action.waits][self.cursor]
        weights = None
        if state.weights is not None:
            weights = state.weights * likelihood
            if answer != SILENT:
                weights *= self._answers[answer][asked]
        return Hidden(state.desired, asked, weights), seen, earned, 1


class Streams:
    """Observations drawn ahead: `drawn[desired, kind of question, after a wait]` is a list of them."""

    def __init__(self, problem: Problem) -> None:
        self._nodes: dict[tuple[object, ...], Seen] = {}
        self._meaning = [_meaning(problem, word) for word in range(len(problem.words))]
        self.drawn = {
            (desired, kind, waits): self._stream(problem, desired, kind, waits)
            for desired in range(problem.n_items)
            for kind in (NOT_ASKED, RIGHT, OTHER)
            for waits in (True, False)
        }

    def _stream(self, problem: Problem, desired: int, kind: int, waits: bool) -> list[tuple[Seen, Vector, int]]:
        state = random_state(3 * desired + kind)
        rate = problem.tables.p_again if waits else problem.tables.p_l
        codes, likelihoods = draw_ahead(desired, kind, rate, state, problem.tables)
        return [
            (self._node(int(word), int(answer), int(nearest)), likelihood, int(answer))
            for (word, answer, nearest), likelihood in zip(codes, likelihoods, strict=True)
        ]

    def _node(self, word: int, answer: int, nearest: int) -> Seen:
        meaning = self._meaning[word] if word >= 0 else None
        return self._nodes.setdefault((meaning, answer, nearest), Seen())


def _meaning(problem: Problem, word: int) -> tuple[int, ...]:
    tables = problem.tables
    return tuple(tables.word_items[tables.word_starts[word] : tables.word_starts[word + 1]])


@compiled
def draw_ahead(
    desired: int, kind: int, rate: float, state: npt.NDArray[np.uint64], tables: Tables
) -> tuple[Integers, Vector]:
    """Draw observations for a desired item: word, answer and item pointed at, (DRAWN, 3), and likelihoods, (DRAWN, n).

    The likelihoods are those of word and ray given each item, up to a factor that all items share.
    """
    count = len(tables.smoothing)
    codes, likelihoods = np.empty((DRAWN, 3), np.int64), np.ones((DRAWN, count))
    for row in range(DRAWN):
        spoken, which = uniform(state), uniform(state)
        word = draw_word(desired, which, tables) if spoken < tables.p_l else -1
        codes[row, 0] = word
        if word >= 0:
            likelihoods[row] *= tables.smoothing
            for index in range(tables.word_starts[word], tables.word_starts[word + 1]):
                likelihoods[row, tables.word_items[index]] *= 1.0 + 1.0 / tables.alpha
        speaks, means = uniform(state) < rate, uniform(state) < tables.p_truth
        codes[row, 1] = SILENT
        if kind != NOT_ASKED and speaks:
            codes[row, 1] = YES if means == (kind == RIGHT) else NO
        codes[row, 2] = point_at(desired, likelihoods[row], state, tables)
    return codes, likelihoods


@compiled
def point_at(desired: int, likelihood: Vector, state: npt.NDArray[np.uint64], tables: Tables) -> int:
    """Multiply by the likelihood of a gesture drawn for the desired item; return the item pointed at, or -1."""
    if uniform(state) < tables.p_g:
        angle, roll = abs(standard_normal(state)) * tables.sigma, 2.0 * math.pi * uniform(state)
        x, y, z = turned(tables.directions[desired], angle, roll)
        ray = np.array([x, y, z])
        angles = np.arccos(np.minimum(1.0, tables.directions @ ray))
        if angles.min() <= tables.threshold:
            for item in range(len(likelihood)):
                likelihood[item] *= ray_likelihood(angles[item], tables.sigma, tables)
            return int(angles.argmin())
    likelihood *= tables.null_chance
    return -1


class RandomRollout(pomdp_py.RolloutPolicy):  # type: ignore[misc]
    """After the tree: actions at random, as in the library's own."""

    def __init__(self, moves: list[Move]) -> None:
        self._moves = moves
        self.numbers = np.random.default_rng(0)

    def get_all_actions(self, state: Hidden | None = None, history: Any = None) -> list[Move]:
        """Return every action."""
        return self._moves

    def rollout(self, state: Hidden, history: Any) -> Move:
        """Return an action at random."""
        return self._moves[int(self.numbers.random() * len(self._moves))]


class GreedyRollout(RandomRollout):
    """After the tree: the best pick by the exact belief of the simulated history."""

    def rollout(self, state: Hidden, history: Any) -> Move:
        """Return the best pick."""
        return self._moves[int(state.weights.argmax())]  # type: ignore[union-attr]


class AidedRollout(GreedyRollout):
    """The same, and a tree of the few actions that the exact belief leaves worth a thought."""

    def get_all_actions(self, state: Hidden | None = None, history: Any = None) -> list[Move]:
        """Return a wait, the best pick and the two best questions for the belief that came here first."""
        weights = state.weights  # type: ignore[union-attr]
        second, first = weights.argsort()[-2:]  # type: ignore[union-attr]
        n_items = len(weights)  # type: ignore[arg-type]
        return [self._moves[first], self._moves[n_items], *(self._moves[n_items + 1 + i] for i in (first, second))]


ROLLOUTS: Mapping[Style, type[RandomRollout]] = {
    "random": RandomRollout,
    "greedy": GreedyRollout,
    "aided": AidedRollout,
}


@dataclass(frozen=True, slots=True)
class Uct:
    """POUCT or POMCP as a Planner. A new tree at every decision; discount 1, as the return has none."""

    problem: Problem  # the one it will be asked about: its observations are drawn ahead
    seconds: float  # of processor time a decision: a busy machine takes nothing from it
    exploration: float  # of UCB1, in units of reward
    style: Style = "aided"
    particles: int = 0  # of POMCP; 0 is POUCT
    _counts: list[int] = field(default_factory=lambda: [0], repr=False)
    _parts: tuple[Simulator, RandomRollout] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        items = range(self.problem.n_items)
        actions: list[Action] = [*(Pick(item) for item in items), Wait(), *(Point(item) for item in items)]
        moves = [Move(action) for action in actions]
        object.__setattr__(self, "_parts", (Simulator(self.problem), ROLLOUTS[self.style](moves)))

    @property
    def simulated(self) -> int:
        """Return how many simulations there were, in all decisions."""
        return self._counts[0]

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest value when time is up."""
        simulator, rollout = self._parts
        simulator.cursor = int(rng.integers(DRAWN))
        rollout.numbers = rng
        weights = belief.probabilities
        about = -1 if asked is None else asked
        carried = None if self.style == "random" else weights
        states = [Hidden(item, about, carried) for item in range(problem.n_items)]
        drawn = Drawn(states, weights, rng)
        belief_ = pomdp_py.Particles(drawn.some(self.particles)) if self.particles else drawn
        agent = pomdp_py.Agent(belief_, policy_model=rollout, blackbox_model=simulator)
        search = (pomdp_py.POMCP if self.particles else pomdp_py.POUCT)(
            max_depth=MOST_ACTIONS,
            planning_time=-1.0,
            num_sims=ROUND,
            discount_factor=1.0,
            exploration_const=self.exploration,
            rollout_policy=rollout,
        )
        end = time.process_time() + self.seconds
        while True:  # every call grows the same tree
            action: Action = search.plan(agent).action
            self._counts[0] += ROUND
            if time.process_time() >= end:
                break
        return Decision(action, np.nan, unvalued(problem), pick_values(weights, problem))

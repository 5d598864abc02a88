"""The problem as an agent of pomdp_py, for its planners.

    from fetch_pomdp.adapters.planning.pomdp_py import fetch_agent, observe

    agent = fetch_agent(Problem(Scene.load("ambiguous")), seed=0)
    action = pomdp_py.POUCT(num_sims=200, rollout_policy=agent.policy_model).plan(agent).action

Importing this module without pomdp_py raises MissingExtraError.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.random import Generator

from fetch_pomdp.checks import shown
from fetch_pomdp.core import generative
from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.action import Action, Pick
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.discrete import Discrete, all_actions
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem, constant_only
from fetch_pomdp.errors import ActionError, ModelError, ObservationError
from fetch_pomdp.extras import load

pomdp_py = load("pomdp_py", "pomdp-py")

Agent: TypeAlias = Any  # pomdp_py has no types
Kind = Literal["full", "classes"]
KINDS = ("full", "classes")


@dataclass(frozen=True, slots=True)
class FetchState(pomdp_py.State):  # type: ignore[misc,name-defined]
    """The desired item, the last item asked about, and whether an item was picked: then nothing earns any more."""

    desired: int
    asked: int | None = None
    over: bool = False

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how to make a copy: pomdp_py copies beliefs, and its base class would leave out the fields."""
        return FetchState, (self.desired, self.asked, self.over)


@dataclass(frozen=True, slots=True)
class FetchAction(pomdp_py.Action):  # type: ignore[misc,name-defined]
    """An action of the package."""

    action: Action

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how to make a copy."""
        return FetchAction, (self.action,)


@dataclass(frozen=True, slots=True)
class FetchObservation(pomdp_py.Observation):  # type: ignore[misc,name-defined]
    """What was perceived, or the classes of `core.discrete` that it falls in; None after a pick."""

    seen: Observation | tuple[int, int, int] | None

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how to make a copy."""
        return FetchObservation, (self.seen,)


class TransitionModel(pomdp_py.TransitionModel):  # type: ignore[misc,name-defined]
    """A question sets i_r, a pick ends; all is certain."""

    def probability(self, next_state: FetchState, state: FetchState, action: FetchAction) -> float:
        """Return 1 for the state that follows, 0 for any other."""
        return float(next_state == self.sample(state, action))

    def sample(self, state: FetchState, action: FetchAction) -> FetchState:
        """Return the state that follows."""
        if state.over or isinstance(action.action, Pick):
            return FetchState(state.desired, state.asked, over=True)
        return FetchState(state.desired, generative.asked_after(action.action, state.asked))

    def argmax(self, state: FetchState, action: FetchAction) -> FetchState:
        """Return the state that follows."""
        return self.sample(state, action)


class RewardModel(pomdp_py.RewardModel):  # type: ignore[misc,name-defined]
    """R(s, a), and nothing after a pick."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem

    def sample(self, state: FetchState, action: FetchAction, next_state: FetchState) -> float:  # noqa: ARG002
        """Return the reward of an action; it does not depend on what follows."""
        if state.over:
            return 0.0
        return generative.reward(generative.State(state.desired, state.asked), action.action, self._problem)

    def argmax(self, state: FetchState, action: FetchAction, next_state: FetchState) -> float:
        """Return the reward of an action."""
        return self.sample(state, action, next_state)

    def probability(self, reward: float, state: FetchState, action: FetchAction, next_state: FetchState) -> float:
        """Return 1 for the reward of the action, 0 for any other."""
        return float(reward == self.sample(state, action, next_state))


class ObservationModel(pomdp_py.ObservationModel):  # type: ignore[misc,name-defined]
    """Eq. 1-7: a density where a ray is seen."""

    def __init__(self, problem: Problem, rng: Generator) -> None:
        self._problem, self._rng = problem, rng

    def log_likelihood(self, observation: FetchObservation, asked: int | None, action: FetchAction) -> Vector:
        """Return log p(o | i_d, i_r) for each item as the desired one, (n_items,). asked: i_r after the action."""
        if not isinstance(observation.seen, Observation):
            raise ObservationError(f"found {shown(observation.seen)}, expected a full observation", field="observation")
        chances = self._problem.step_chances(action.action)
        return observations.log_likelihoods(observation.seen, asked, self._problem, chances).together()

    def probability(self, observation: FetchObservation, next_state: FetchState, action: FetchAction) -> float:
        """Return p(o | i_d, i_r); after a pick only None is seen. Raises ObservationError for the other kind."""
        if next_state.over or observation.seen is None:
            return float(next_state.over and observation.seen is None)
        return math.exp(self.log_likelihood(observation, next_state.asked, action)[next_state.desired])

    def sample(self, next_state: FetchState, action: FetchAction) -> FetchObservation:
        """Draw what is perceived after an action."""
        return FetchObservation(None if next_state.over else self._drawn(next_state, action))

    def _drawn(self, state: FetchState, action: FetchAction) -> Observation:
        chances = self._problem.step_chances(action.action)
        return observations.sample(state.desired, state.asked, self._problem, chances, self._rng)


class ClassModel(ObservationModel):
    """The same in the classes of `core.discrete`: a tree meets them again, and particles can agree with them."""

    def __init__(self, problem: Problem, rng: Generator) -> None:
        super().__init__(problem, rng)
        self._model = Discrete(problem)

    def log_likelihood(self, observation: FetchObservation, asked: int | None, action: FetchAction) -> Vector:
        """Return the logarithms of the chances of the classes, (n_items,)."""
        if not isinstance(observation.seen, tuple):
            raise ObservationError(f"found {shown(observation.seen)}, expected three classes", field="observation")
        word, response, gesture = observation.seen
        model, answers = self._model, self._model.responses(asked, action.action)
        with np.errstate(divide="ignore"):  # what cannot be is -inf
            return np.log(model.words[:, word] * answers[:, response] * model.gestures[:, gesture])

    def sample(self, next_state: FetchState, action: FetchAction) -> FetchObservation:
        """Draw the classes of what is perceived after an action."""
        return FetchObservation(None if next_state.over else self._model.classify(self._drawn(next_state, action)))

    def get_all_observations(self) -> list[FetchObservation]:
        """Return every observation, None for the end among them."""
        return [FetchObservation(None), *map(FetchObservation, np.ndindex(*self._model.n_classes))]


class PolicyModel(pomdp_py.RolloutPolicy):  # type: ignore[misc,name-defined]
    """All 2n + 1 actions; a rollout hands over the item that the history makes likeliest.

    Choice: actions at random, the library's rollout, pick wrong items so often that POUCT takes every wait or question
    for a loss, and picks at once. The history counts from a uniform belief, as an interaction begins.
    """

    def __init__(self, problem: Problem, perception: ObservationModel) -> None:
        self._actions = tuple(FetchAction(action) for action in all_actions(problem.n_items))
        self._perception = perception

    def get_all_actions(self, state: FetchState | None = None, history: Any = None) -> tuple[FetchAction, ...]:  # noqa: ARG002
        """Return every action: wait, ask about each item, pick each item."""
        return self._actions

    def rollout(self, state: FetchState, history: tuple[tuple[FetchAction, FetchObservation], ...] = ()) -> FetchAction:  # noqa: ARG002
        """Return the pick of the likeliest item; after a pick any action does."""
        asked, log = None, np.zeros(len(self._actions) // 2)
        for action, observation in history or ():
            asked = generative.asked_after(action.action, asked)
            if observation.seen is not None:
                log += self._perception.log_likelihood(observation, asked, action)
        return self._actions[1 + len(log) + int(log.argmax())]


def fetch_agent(problem: Problem, observations: Kind = "full", *, seed: int = 0) -> Agent:
    """Return a pomdp_py.Agent at the start of an interaction; its belief is a Histogram over the desired items.

    observations: "full" perceives as the model does, so that no two rays are alike; "classes" as `core.discrete` does,
    which a tree search that goes deep, and POMCP, need. seed: of the models; pomdp_py draws the states of a Histogram
    from Python's own `random`. Raises ModelError for another kind of observations, and for live people (`turns`).
    """
    if observations not in KINDS:
        found = f"found {shown(observations)}, expected one of {', '.join(KINDS)}"
        raise ModelError(found, field="observations")
    constant_only(problem, "the agent of pomdp_py")
    rng = np.random.default_rng(seed)
    perception = (ClassModel if observations == "classes" else ObservationModel)(problem, rng)
    return pomdp_py.Agent(
        histogram(Belief.uniform(problem.n_items)),
        PolicyModel(problem, perception),
        TransitionModel(),
        perception,
        RewardModel(problem),
    )


def histogram(belief: Belief, asked: int | None = None) -> Any:
    """Return a belief over the desired item as a pomdp_py.Histogram of states. asked: index of i_r, or None."""
    return pomdp_py.Histogram(
        {FetchState(desired, asked): float(chance) for desired, chance in enumerate(belief.probabilities)}
    )


def observe(agent: Agent, action: FetchAction, observation: FetchObservation) -> None:
    """Tell an agent with a Histogram what it did and perceived: its history and, by Bayes' rule, its belief.

    After it `planner.update(agent, action, observation)` keeps what is of use of the planner's tree. Raises ActionError
    for a pick: the interaction is over. Unlike pomdp_py's own update it needs no list of the states to come.
    """
    if isinstance(action.action, Pick):
        raise ActionError(
            f"found {action.action}, expected a wait or a question: nothing follows a pick", field="action"
        )
    weights: dict[FetchState, float] = {}
    for state, chance in agent.belief.get_histogram().items():
        following = agent.transition_model.sample(state, action)
        weight = chance * agent.observation_model.probability(observation, following, action)
        weights[following] = weights.get(following, 0.0) + weight
    total = sum(weights.values())
    agent.update_history(action, observation)
    agent.set_belief(pomdp_py.Histogram({state: weight / total for state, weight in weights.items()}))

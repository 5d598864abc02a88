"""The problem as a Gymnasium environment. Importing this module registers it as fetch_pomdp/Fetch-v0.

    import gymnasium
    import fetch_pomdp.adapters.planning.gym

    env = gymnasium.make("fetch_pomdp/Fetch-v0", scene="ambiguous", observation="belief")

Importing it without gymnasium raises MissingExtraError.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.discrete import all_actions
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.language.unigram import split
from fetch_pomdp.core.language.words import POSITIVE
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem, constant_only
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.core.turns import NO, SILENT, YES
from fetch_pomdp.errors import ActionError, ModelError, SceneError
from fetch_pomdp.extras import load

gymnasium = load("gymnasium", "gym")

ID = "fetch_pomdp/Fetch-v0"
View = Literal["belief", "raw"]
VIEWS = ("belief", "raw")
Seen = dict[str, Any]


class FetchEnv(gymnasium.Env):  # type: ignore[misc,name-defined]
    """One interaction an episode, with a person sampled from the model who desires an item drawn uniformly.

    Actions are Discrete(2n + 1): 0 waits, 1 to n ask about an item, n + 1 to 2n pick one. A pick terminates; MOST_STEPS
    waits and questions without one truncate. The reward is R(s, a). info is {"desired": id of the desired item}.

    observation="belief" gives the exact filter's {"belief": (n,) float64, "asked": 0 or 1 + i_r}, all a policy needs to
    know. "raw" gives what was perceived in the last step instead: {"word": 0 or 1 + index in `problem.words`,
    "response": 0 none, 1 yes, 2 no, "pointing": 0 or 1, "ray": (3,) unit vector of a pointing arm, or zeros, "asked"}.
    Before the first step and after a pick nothing is perceived.

    Raises SceneError or ModelError for an invalid scene, ModelError for an unknown kind of observation and for live
    people (`turns`).
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}

    def __init__(self, scene: str | Path | Scene = "ambiguous", observation: View = "belief") -> None:
        if observation not in VIEWS:
            found = f"found {checks.shown(observation)}, expected one of {', '.join(VIEWS)}"
            raise ModelError(found, field="observation")
        self.problem = Problem(scene if isinstance(scene, Scene) else Scene.load(scene))
        constant_only(self.problem, "the Gymnasium environment")
        self.actions = all_actions(self.problem.n_items)
        self.action_space = gymnasium.spaces.Discrete(len(self.actions))
        self.observation_space = _space(self.problem, observation)
        self._view = observation
        self._state: State | None = None  # None: no episode is going on
        self._belief = Belief.uniform(self.problem.n_items)
        self._steps = 0

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Seen, Seen]:
        """Start an episode; the same seed gives the same one. options: {"desired": id} chooses the desired item.

        Raises SceneError for another option or an id that no item has.
        """
        super().reset(seed=seed)
        options = options or {}
        checks.known(options, ("desired",), "option", SceneError)
        drawn = int(self.np_random.integers(self.problem.n_items))
        chosen = options.get("desired")
        self._state = State(drawn if chosen is None else self.problem.scene.index(chosen, "desired"))
        self._belief, self._steps = Belief.uniform(self.problem.n_items), 0
        return self._seen(self._state, Observation()), self._info(self._state)

    def step(self, action: int) -> tuple[Seen, float, bool, bool, Seen]:
        """Take an action. Raises ActionError for a number out of range, or when no episode is going on."""
        if self._state is None:
            raise ActionError("found an action while no episode is going on, expected a reset before", field="action")
        if not self.action_space.contains(action):
            found = f"found {checks.shown(action)}, expected a whole number from 0 to {len(self.actions) - 1}"
            raise ActionError(found, field="action")
        taken = self.actions[int(action)]
        state, perceived, reward = step(self.problem, self._state, taken, self.np_random)
        self._steps += 1
        if perceived is not None:
            self._belief = self._belief.updated(perceived, state.asked, self.problem)
        terminated = isinstance(taken, Pick)
        truncated = not terminated and self._steps == MOST_STEPS
        self._state = None if terminated or truncated else state
        return self._seen(state, perceived or Observation()), reward, terminated, truncated, self._info(state)

    def _info(self, state: State) -> Seen:
        return {"desired": self.problem.scene.items[state.desired].id}

    def _seen(self, state: State, perceived: Observation) -> Seen:
        asked = np.int64(0 if state.asked is None else 1 + state.asked)
        if self._view == "belief":
            return {"belief": self._belief.probabilities, "asked": asked}
        return {**_raw(perceived, self.problem), "asked": asked}


def _space(problem: Problem, view: View) -> Any:
    spaces = gymnasium.spaces
    asked = spaces.Discrete(problem.n_items + 1)
    if view == "belief":
        beliefs = spaces.Box(0.0, 1.0, (problem.n_items,), np.float64)
        return spaces.Dict({"belief": beliefs, "asked": asked})
    return spaces.Dict(
        {
            "word": spaces.Discrete(len(problem.words) + 1),
            "response": spaces.Discrete(3),
            "pointing": spaces.Discrete(2),
            "ray": spaces.Box(-1.0, 1.0, (3,), np.float64),
            "asked": asked,
        }
    )


def _raw(perceived: Observation, problem: Problem) -> Seen:
    heard, ray = split(perceived.words, problem), perceived.ray
    response = SILENT if not heard.response else YES if heard.response[0] in POSITIVE else NO
    arm = np.zeros(3) if ray is None else np.array(ray.wrist) - np.array(ray.head)
    length = float(np.linalg.norm(arm))
    return {
        "word": np.int64(1 + problem.word_index[heard.base[0]] if heard.base else 0),
        "response": np.int64(response),
        "pointing": np.int64(ray is not None),
        "ray": np.clip(arm / length, -1.0, 1.0) if length else arm,
    }


if ID not in gymnasium.registry:  # a module that is loaded anew must not warn
    gymnasium.register(ID, entry_point=f"{__name__}:FetchEnv")

"""The Gymnasium environment: its contract, its episodes, and what our planner earns in it."""

from __future__ import annotations

import importlib
import sys
import warnings
from typing import Any

import numpy as np
import pytest

from fetch_pomdp import Belief, ExactAnswers, Pick, Problem, Scene, simulate
from fetch_pomdp.core.discrete import all_actions
from fetch_pomdp.errors import ActionError, MissingExtraError, ModelError, SceneError
from tests.oracles.model import posterior
from tests.tables import live, world_of

gymnasium = pytest.importorskip("gymnasium")
module = importlib.import_module("fetch_pomdp.adapters.planning.gym")


def made(**options: Any) -> Any:
    return gymnasium.make("fetch_pomdp/Fetch-v0", **options)


@pytest.mark.parametrize("observation", ["belief", "raw"])
@pytest.mark.parametrize("scene", ["ambiguous", Scene.load("unambiguous")])
def test_the_checker_has_nothing_to_say(scene: str | Scene, observation: str) -> None:
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(made(scene=scene, observation=observation).unwrapped)


@pytest.mark.parametrize("observation", ["belief", "raw"])
def test_the_same_seed_is_the_same_episode(observation: str) -> None:
    def played(seed: int) -> list[Any]:
        env = made(observation=observation)
        steps = [env.reset(seed=seed), *(env.step(action) for action in (0, 3, 0, 1, 0, 9))]
        return [str(step) for step in steps]

    assert played(5) == played(5)
    assert played(5) != played(6)


def test_actions_are_numbered_as_documented() -> None:
    env = made()
    assert env.action_space.n == 13
    seen, info = env.reset(seed=0, options={"desired": "marker-2"})
    assert info == {"desired": "marker-2"}
    assert seen["asked"] == 0
    assert seen["belief"] == pytest.approx([1 / 6] * 6)
    seen, reward, terminated, truncated, _ = env.step(0)
    assert (reward, terminated, truncated, seen["asked"]) == (-1, False, False, 0)
    seen, reward, terminated, truncated, _ = env.step(5)
    assert (reward, terminated, truncated, seen["asked"]) == (-6, False, False, 5)
    _, reward, terminated, truncated, info = env.step(10)
    assert (reward, terminated, truncated, info) == (10, True, False, {"desired": "marker-2"})
    env.reset(options={"desired": "marker-2"})
    assert env.step(7)[1:4] == (-12.5, True, False)


def test_an_episode_is_truncated_after_30_steps() -> None:
    env = made(observation="raw")
    env.reset(seed=1)
    ends = [env.step(step % 7)[2:4] for step in range(30)]
    assert ends == [(False, False)] * 29 + [(False, True)]
    with pytest.raises(ActionError, match="no episode is going on, expected a reset"):
        env.unwrapped.step(0)


def test_a_filter_of_the_raw_view_is_the_belief_of_the_other() -> None:
    raw, full = made(observation="raw"), made(observation="belief")
    problem = raw.unwrapped.problem
    world, head = world_of(problem), problem.scene.head
    pointed = 0
    for seed in range(30):
        raw.reset(seed=seed)
        full.reset(seed=seed)
        expected = [1 / 6] * 6
        for action in (0, 2, 0, 4):
            seen, belief = raw.step(action)[0], full.step(action)[0]
            words = [problem.words[seen["word"] - 1]] if seen["word"] else []
            words += [["yes"], ["no"]][seen["response"] - 1] if seen["response"] else []
            pointed += int(seen["pointing"])
            assert np.linalg.norm(seen["ray"]) == pytest.approx(float(seen["pointing"]))
            ray = (head, tuple(head + seen["ray"])) if seen["pointing"] else None
            asked = int(seen["asked"]) - 1 if seen["asked"] else None
            expected = posterior(expected, words, ray, asked, world)
            assert belief["belief"] == pytest.approx(expected, abs=1e-6)
    assert pointed > 0


def test_desired_items_are_drawn_uniformly() -> None:
    env = made()
    env.reset(seed=3)
    drawn = [env.reset()[1]["desired"] for _ in range(1_200)]
    assert all(
        abs(drawn.count(item.id) - 200) < 4 * np.sqrt(1_200 * 5 / 36) for item in env.unwrapped.problem.scene.items
    )


def test_our_planner_earns_in_it_what_it_earns_in_our_simulation() -> None:
    env, problem, planner = made(), Problem(Scene.load("ambiguous")), ExactAnswers()
    numbers = {action: number for number, action in enumerate(all_actions(problem.n_items))}
    robot, returns, right = np.random.default_rng(0), [], []
    env.reset(seed=11)
    for _ in range(1_500):
        (seen, info), earned, over = env.reset(), 0.0, False
        while not over:
            asked = int(seen["asked"]) - 1 if seen["asked"] else None
            action = planner.decide(problem, Belief(seen["belief"]), asked, rng=robot).action
            seen, reward, terminated, truncated, _ = env.step(numbers[action])
            earned, over = earned + reward, terminated or truncated
        returns.append(earned)
        right.append(isinstance(action, Pick) and problem.scene.items[action.item].id == info["desired"])
    ours = simulate(problem, planner, 5_000, 12)
    error = np.hypot(np.std(returns) / np.sqrt(len(returns)), ours.standard_error)
    assert abs(np.mean(returns) - ours.mean_return) <= 4 * error
    assert abs(np.mean(right) - ours.accuracy) <= 4 * np.sqrt(0.05 * 0.95 * (1 / 1_500 + 1 / 5_000))


def test_what_is_refused() -> None:
    with pytest.raises(ModelError, match="observation: found 'pixels', expected one of belief, raw"):
        module.FetchEnv(observation="pixels")
    with pytest.raises(SceneError, match="found no such scene or file"):
        module.FetchEnv("kitchen")
    with pytest.raises(ModelError, match=r"^turns: found live people, expected none: the Gymnasium environment knows "):
        module.FetchEnv(live(Problem(Scene.load("ambiguous"))).scene)
    env = module.FetchEnv()
    with pytest.raises(ActionError, match="expected a reset"):
        env.step(0)
    with pytest.raises(SceneError, match="wanted: unknown option, expected one of desired"):
        env.reset(options={"wanted": "bowl-1"})
    with pytest.raises(SceneError, match="desired: found 'cup', expected one of bowl-1"):
        env.reset(options={"desired": "cup"})
    env.reset()
    for action in (13, -1, 1.5):
        with pytest.raises(ActionError, match=r"action: found .*, expected a whole number from 0 to 12"):
            env.step(action)


@pytest.mark.parametrize(
    ("name", "library", "extra"), [("gym", "gymnasium", "gym"), ("pomdp_py", "pomdp_py", "pomdp-py")]
)
def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch, name: str, library: str, extra: str) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.delitem(sys.modules, f"fetch_pomdp.adapters.planning.{name}", raising=False)
    with pytest.raises(MissingExtraError, match=rf'{library} is not installed; .*pip install "fetch-pomdp\[{extra}\]"'):
        importlib.import_module(f"fetch_pomdp.adapters.planning.{name}")

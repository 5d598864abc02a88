"""An exported scene, solved by someone else's point-based solver."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.discrete import Discrete, all_actions
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.planners.search.planner import ExactAnswers
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import MOST_STEPS, simulate
from fetch_pomdp.files.export import export
from tests.tables import table

pomdp_toolkit = pytest.importorskip("pomdp_toolkit")

DISCOUNTING = 0.06  # what a discount of 0.999 may take off the value of a fetch: 0.1% of about 10 points a step


def solved(problem: Problem, path: Path) -> tuple[Any, Any]:
    """Perseus from below: it starts with the value of picking each item at once, and no backup overestimates."""
    from pomdp_toolkit.solvers import Perseus

    export(Discrete(problem), path)
    model = pomdp_toolkit.POMDPParser.parse(path)
    picks = np.arange(model.action_count)[-problem.n_items :]
    values = pomdp_toolkit.ValueFunction(model, model.expected_reward_table.T[picks].copy(), picks)
    solution, _ = Perseus.solve(
        model,
        expansions=30,
        max_belief_growth=20,
        update_passes=3,
        initial_value_function=values,
        gamma=0.999,
        rng=0,
        print_progress=False,
        print_stats=False,
    )
    return model, solution


def value(model: Any, solution: Any) -> float:
    return float((solution.alpha_vector_array @ model.start_probabilities).max())


def follow(problem: Problem, model: Any, solution: Any, episodes: int) -> list[float]:
    """Follow the solver's policy with people of the true model, told to it in classes; returns are not discounted."""
    discrete, actions = Discrete(problem), all_actions(problem.n_items)
    _, responses, gestures = discrete.n_classes
    returns = []
    for episode in range(episodes):
        rng, belief, earned = np.random.default_rng((7, episode)), model.start_probabilities, 0.0
        state = State(episode % problem.n_items)
        for _ in range(MOST_STEPS):
            number = int(solution.actions[(solution.alpha_vector_array @ belief).argmax()])
            state, seen, reward = step(problem, state, actions[number], rng)
            earned += reward
            if seen is None:
                break
            word, response, gesture = discrete.classify(seen)
            column = (word * responses + response) * gestures + gesture
            belief = belief @ model.transition_table[:, number] * model.observation_table[:, number, column]
            belief = belief / belief.sum()
        returns.append(earned)
    return returns


@pytest.mark.parametrize(
    ("words", "p_g"),
    [
        ([["cup", "red"], ["cup", "blue"]], 0.1),
        ([["cup", "red"], ["cup", "blue"], ["cup", "red"]], 0.0),  # nobody points: the classes lose nothing
    ],
)
def test_a_solver_is_worth_what_our_planner_earns(tmp_path: Path, words: list[list[str]], p_g: float) -> None:
    problem = table(words, p_g=p_g)
    model, solution = solved(problem, tmp_path / "scene.pomdp")
    found = value(model, solution)
    ours = simulate(problem, ExactAnswers(), 20_000, 0)
    assert found >= 10 / len(words) - 12.5 * (1 - 1 / len(words))  # picking at once
    assert found >= ours.mean_return - DISCOUNTING - 4 * ours.standard_error
    assert found <= ours.mean_return + 0.3 + 4 * ours.standard_error  # ours looks two actions ahead


def test_the_policy_of_a_solver_earns_its_value_with_the_true_people(tmp_path: Path) -> None:
    problem = table([["cup", "red"], ["cup", "blue"], ["cup", "red"]], p_g=0.3)
    model, solution = solved(problem, tmp_path / "scene.pomdp")
    returns = follow(problem, model, solution, 1_500)
    error = 4 * np.std(returns) / np.sqrt(len(returns))
    # Its value is a lower bound of what the policy earns.
    assert value(model, solution) - error <= np.mean(returns) <= value(model, solution) + error + DISCOUNTING + 0.1

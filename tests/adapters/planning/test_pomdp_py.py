"""The agent of pomdp_py: its models against ours, and its planners at work."""

from __future__ import annotations

import copy
import importlib
import math
import random
from typing import Any

import numpy as np
import pytest

from fetch_pomdp import Belief, Observation, Pick, Point, Problem, Ray, Scene, State, Wait, step
from fetch_pomdp.core.discrete import all_actions
from fetch_pomdp.core.observation import log_likelihoods
from fetch_pomdp.core.turns import constant_chances
from fetch_pomdp.errors import ActionError, ModelError, ObservationError
from tests.oracles.model import base_chance, gesture_density, response_chance
from tests.tables import live, table, world_of

pomdp_py = pytest.importorskip("pomdp_py")
door: Any = importlib.import_module("fetch_pomdp.adapters.planning.pomdp_py")

PROBLEM = Problem(Scene.load("ambiguous"))
SEEN = [
    Observation(),
    Observation(("marker", "yes")),
    Observation(("nope",), Ray((0.0, 0.0, 1.6), (0.1, 1.0, 1.3))),
    Observation(("green",), Ray((0.0, 0.0, 1.6), (0.0, -1.0, 1.3))),
]


def test_it_begins_with_a_uniform_histogram_and_every_action() -> None:
    agent = door.fetch_agent(PROBLEM)
    assert isinstance(agent, pomdp_py.Agent)
    assert isinstance(agent.belief, pomdp_py.Histogram)
    expected = {door.FetchState(item): pytest.approx(1 / 6) for item in range(6)}
    assert agent.belief.get_histogram() == expected
    assert [action.action for action in agent.valid_actions()] == list(all_actions(6))


@pytest.mark.parametrize("seen", SEEN)
@pytest.mark.parametrize("action", [Wait(), Point(2), Point(5)])
def test_observations_are_as_likely_as_in_the_model(seen: Observation, action: Wait | Point) -> None:
    problem = table([["marker", "green"], ["bowl"], ["marker"], ["pen"], ["pen"], ["spoon"]], p_answer_again=0.5)
    world, model = world_of(problem), door.fetch_agent(problem).observation_model
    asked = action.item if isinstance(action, Point) else 3
    rate = 0.475 if action == Wait() else 0.95
    base = [word for word in seen.words if word in world.words]
    response = [word for word in seen.words if word not in world.words]
    for desired in range(6):
        state = door.FetchState(desired, asked)
        found = model.probability(door.FetchObservation(seen), state, door.FetchAction(action))
        expected = base_chance(base, desired, world) * response_chance(response, desired, asked, world, rate)
        ray = None if seen.ray is None else gesture_density(seen.ray.head, seen.ray.wrist, desired, world)
        expected *= 0.9 if ray is None else ray
        assert found == pytest.approx(expected)
        together = log_likelihoods(seen, asked, problem, constant_chances(rate, 0.1)).together()
        assert found == pytest.approx(math.exp(together[desired]))


@pytest.mark.parametrize("kind", ["full", "classes"])
def test_transitions_and_rewards_are_those_of_the_generative_model(kind: str) -> None:
    agent, rng = door.fetch_agent(PROBLEM, kind), np.random.default_rng(0)
    for desired in (0, 3):
        for asked in (None, 3, 5):
            for action in all_actions(6):
                following, seen, earned = step(PROBLEM, State(desired, asked), action, rng)
                state, wrapped = door.FetchState(desired, asked), door.FetchAction(action)
                after = agent.transition_model.sample(state, wrapped)
                assert (after.desired, after.asked, after.over) == (following.desired, following.asked, seen is None)
                assert agent.transition_model.probability(after, state, wrapped) == 1
                assert agent.transition_model.probability(door.FetchState(1), state, wrapped) == 0
                assert agent.reward_model.sample(state, wrapped, after) == earned
                drawn = agent.observation_model.sample(after, wrapped)
                assert (drawn.seen is None) == isinstance(action, Pick)
                assert agent.observation_model.probability(drawn, after, wrapped) > 0
    over = door.FetchState(0, None, over=True)
    pick = door.FetchAction(Pick(0))
    assert agent.transition_model.sample(over, pick) == over
    assert agent.reward_model.sample(over, pick, over) == 0


def test_the_classes_are_a_distribution() -> None:
    model = door.fetch_agent(PROBLEM, "classes").observation_model
    everything = model.get_all_observations()
    assert len(everything) == 4 * 3 * 7 + 1
    for state in (door.FetchState(1, 4), door.FetchState(4, 4), door.FetchState(2), door.FetchState(2, 1, over=True)):
        chances = [model.probability(seen, state, door.FetchAction(Wait())) for seen in everything]
        assert sum(chances) == pytest.approx(1)


def test_the_two_kinds_of_observations_are_not_mixed() -> None:
    state, action = door.FetchState(0), door.FetchAction(Wait())
    full, classes = (door.fetch_agent(PROBLEM, kind).observation_model for kind in ("full", "classes"))
    with pytest.raises(ObservationError, match=r"found \(0, 0, 0\), expected a full observation"):
        full.probability(door.FetchObservation((0, 0, 0)), state, action)
    with pytest.raises(ObservationError, match=r"found Observation.*, expected three classes"):
        classes.probability(door.FetchObservation(Observation()), state, action)
    with pytest.raises(ModelError, match="observations: found 'rays', expected one of full, classes"):
        door.fetch_agent(PROBLEM, "rays")


@pytest.mark.parametrize("kind", ["full", "classes"])
def test_live_people_are_refused(kind: str) -> None:
    with pytest.raises(
        ModelError, match=r"^turns: found live people, expected none: the agent of pomdp_py knows [^\n]*$"
    ):
        door.fetch_agent(live(PROBLEM), kind)


def test_observe_is_our_bayes_filter() -> None:
    agent, belief, asked = door.fetch_agent(PROBLEM), Belief.uniform(6), None
    for action, seen in zip((Wait(), Point(2), Wait(), Point(3)), SEEN, strict=True):
        door.observe(agent, door.FetchAction(action), door.FetchObservation(seen))
        asked = action.item if isinstance(action, Point) else asked
        belief = belief.updated(seen, asked, PROBLEM)
        expected = {door.FetchState(item, asked): chance for item, chance in enumerate(belief.probabilities)}
        assert agent.belief.get_histogram() == pytest.approx(expected)
    assert len(agent.history) == 4
    with pytest.raises(ActionError, match="nothing follows a pick"):
        door.observe(agent, door.FetchAction(Pick(0)), door.FetchObservation(None))


def test_a_rollout_hands_over_what_the_history_makes_likeliest() -> None:
    policy = door.fetch_agent(PROBLEM).policy_model
    asked = (door.FetchAction(Point(2)), door.FetchObservation(Observation(("marker", "no"))))
    assert policy.rollout(door.FetchState(0), (asked,)).action == Pick(3)
    assert policy.rollout(door.FetchState(0, None, over=True), (asked, (asked[0], door.FetchObservation(None))))


@pytest.mark.parametrize("kind", ["full", "classes"])
def test_pouct_takes_legal_actions_until_a_pick(kind: str) -> None:
    random.seed(1)
    agent, state = door.fetch_agent(PROBLEM, kind, seed=1), door.FetchState(2)
    planner = pomdp_py.POUCT(
        max_depth=4,
        num_sims=200,
        discount_factor=0.999,
        exploration_const=10.0,
        rollout_policy=agent.policy_model,
    )
    # Two leading markers, as after a word: the planner is then asked what to do.
    door.observe(agent, door.FetchAction(Wait()), agent.observation_model.sample(state, door.FetchAction(Wait())))
    for _ in range(30):
        action = planner.plan(agent)
        assert action.action in all_actions(6)
        if isinstance(action.action, Pick):
            break
        state = agent.transition_model.sample(state, action)
        seen = agent.observation_model.sample(state, action)
        door.observe(agent, action, seen)
        planner.update(agent, action, seen)


def test_pouct_picks_what_is_sure() -> None:
    random.seed(2)
    agent = door.fetch_agent(PROBLEM, "classes")
    for _ in range(3):  # word3 is the class of spoons; yes
        door.observe(agent, door.FetchAction(Point(4)), door.FetchObservation((3, 1, 0)))
    planner = pomdp_py.POUCT(num_sims=500, max_depth=3, exploration_const=10.0, rollout_policy=agent.policy_model)
    assert planner.plan(agent).action == Pick(4)


def test_pomcp_runs_on_classes() -> None:
    random.seed(3)
    agent = door.fetch_agent(PROBLEM, "classes")
    agent.set_belief(pomdp_py.Particles.from_histogram(agent.belief, num_particles=300), prior=True)
    planner = pomdp_py.POMCP(max_depth=3, num_sims=300, exploration_const=10.0, rollout_policy=agent.policy_model)
    assert planner.plan(agent).action in all_actions(6)


def test_states_actions_and_observations_can_be_copied() -> None:
    for thing in (door.FetchState(1, 2, over=True), door.FetchAction(Point(3)), door.FetchObservation(SEEN[2])):
        assert copy.deepcopy(thing) == thing
        assert hash(copy.deepcopy(thing)) == hash(thing)

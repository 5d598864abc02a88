"""Live people: samplers counted against the chances, and the filter by hand; in plain Python and compiled."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest

from fetch_pomdp.core.action import Action, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import random_state
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.kernels import NOBODY, Turn, answered, live_step, turn_of
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import run_episode, simulate
from fetch_pomdp.core.turns import NO, POINTS, SILENT, YES, Turns
from tests.oracles.model import YES_WORDS
from tests.oracles.talking import ANSWERS, Person, Step, all_talks, answer_chance, group, talk_after
from tests.tables import live, twins

# Chances far from 0 and 1, no two alike, so that each is told from the others by counting.
TURNS = Turns(
    words_unbegun=(0.3, 0.6), words_pointed=(0.25, 0.8), words_due=(0.5, 0.85), words_said=(0.15, 0.2),
    words_heard=(0.1, 0.35), words_silent=(0.4, 0.55), words_denied=(0.45, 0.65),
    points_unbegun=(0.6, 0.7), points_pointed=(0.85, 0.9), points_due=(0.75, 0.8), points_said=(0.2, 0.25),
    points_heard=(0.35, 0.5), points_silent=(0.3, 0.4), points_denied=(0.55, 0.65),
    answers_desired=(0.5, 0.7, 0.6, 0.2), answers_other=(0.25, 0.45, 0.35, 0.3), answers_settled=(0.1,),
    patience=3, question=2,
)  # fmt: skip
PERSON = Person({field.name: getattr(TURNS, field.name) for field in dataclasses.fields(Turns)}, 3, 2)
TALKS = all_talks(3)
TRUTH = 0.9
AMBIGUOUS = Scene.load("ambiguous")
# Rays so near the item that none is beyond the threshold: who points is seen to point.
LIVE = Problem(
    dataclasses.replace(
        AMBIGUOUS, model=AMBIGUOUS.model.with_changes({"turns": TURNS, "sigma": 0.03, "p_truth": TRUTH})
    )
)
DRAWS = 4_000
DESIRED = 2
# Phases: unbegun, pointed, heard and open, heard and open for long, heard and denied, silent, said and open.
CASES = [
    (phase, asked, action)
    for phase in (0, 4, 14, 15, 17, 24, 30)
    for asked, action in [(DESIRED, Wait()), (4, Wait()), (None, Wait()), (0, Point(DESIRED)), (None, Point(4))]
]


def chances_of(phase: int, asked: int | None, action: Action) -> dict[str, float]:
    """What a step's words, pointing, "yes" and "no" have a chance of."""
    question, talk = isinstance(action, Point), TALKS[phase]
    name, about = group(talk, 3), action.item if isinstance(action, Point) else asked
    own = about == DESIRED
    speaks = 0.0 if about is None else answer_chance(talk, question, own, PERSON)
    return {
        "words": PERSON.chances[f"words_{name}"][question],
        "points": PERSON.chances[f"points_{name}"][question],
        "yes": speaks * (TRUTH if own else 1 - TRUTH),
        "no": speaks * (1 - TRUTH if own else TRUTH),
    }


def phases_after(phase: int, asked: int | None, action: Action) -> dict[int, float]:
    """The chance of every phase that may follow."""
    chances, found = chances_of(phase, asked, action), dict[int, float]()
    of = {"yes": chances["yes"], "no": chances["no"], "silence": 1 - chances["yes"] - chances["no"]}
    for words, points, answer in itertools.product((False, True), (False, True), ANSWERS):
        after = TALKS.index(talk_after(TALKS[phase], Step(isinstance(action, Point), words, points, answer), PERSON))
        chance = (chances["words"] if words else 1 - chances["words"]) * of[answer]
        chance *= chances["points"] if points else 1 - chances["points"]
        found[after] = found.get(after, 0.0) + chance
    return found


def assert_shares(counts: dict[int, int], chances: dict[int, float], draws: int) -> None:
    assert set(counts) <= set(chances)
    for outcome, chance in chances.items():
        error = math.sqrt(chance * (1 - chance) / draws)
        assert abs(counts.get(outcome, 0) / draws - chance) <= 4 * error, outcome


def counted(phases: list[int]) -> dict[int, int]:
    return {phase: phases.count(phase) for phase in set(phases)}


@pytest.mark.parametrize(("phase", "asked", "action"), CASES)
def test_the_generative_model_counted(phase: int, asked: int | None, action: Action) -> None:
    rng, following = np.random.default_rng((phase, CASES.index((phase, asked, action)))), list[int]()
    happened = dict.fromkeys(("words", "points", "yes", "no"), 0)
    for _ in range(DRAWS):
        state, seen, _ = step(LIVE, State(DESIRED, asked, phase), action, rng)
        assert seen is not None
        following.append(state.phase)
        answers = [word for word in seen.words if word not in LIVE.words]
        happened["words"] += len(answers) < len(seen.words)
        happened["points"] += seen.ray is not None
        happened["yes"] += any(word in YES_WORDS for word in answers)
        happened["no"] += any(word not in YES_WORDS for word in answers)
    for name, chance in chances_of(phase, asked, action).items():
        assert abs(happened[name] / DRAWS - chance) <= 4 * math.sqrt(chance * (1 - chance) / DRAWS), name
    assert_shares(counted(following), phases_after(phase, asked, action), DRAWS)


@pytest.mark.parametrize(("phase", "asked", "action"), CASES)
def test_the_compiled_sampler_counted(phase: int, asked: int | None, action: Action) -> None:
    turn = turn_of(NOBODY if asked is None else asked, phase, action.item if isinstance(action, Point) else NOBODY)
    state, heard, following = random_state(phase + 100 * CASES.index((phase, asked, action))), np.empty(6), list[int]()
    for _ in range(DRAWS):
        belief = np.full(6, 1 / 6)
        following.append(int(live_step(belief, turn, DESIRED, heard, state, LIVE.tables)))
        assert belief.sum() == pytest.approx(1.0)
    assert_shares(counted(following), phases_after(phase, asked, action), DRAWS)


# The filter: two items that sound alike, and answers_desired .6, answers_other .2 in the step of a question.

ALIKE = twins(2, turns=Turns(answers_desired=(0.6, 0.7, 0.5, 0.3), answers_other=(0.2, 0.4, 0.25, 0.6)))


def filtered(answers: list[tuple[Action, str]], prior: list[float]) -> list[list[float]]:
    """The belief after steps, by an agent, by `Belief.updated` and compiled."""
    agent, asked, phase = Agent(ALIKE.scene, Threshold(), prior=prior), None, 0
    belief, numbers = Belief(prior), np.array(prior)
    for action, said in answers:
        agent.did(action)
        chances = ALIKE.step_chances(action, phase)
        asked = action.item if isinstance(action, Point) else asked
        belief = belief.updated(Observation((said,) if said else ()), asked, ALIKE, chances=chances)
        answer, after = {"": SILENT, "yes": YES, "no": NO}[said], np.empty(2)
        turn = Turn(NOBODY if asked is None else asked, phase, int(isinstance(action, Point)))
        answered(numbers, turn, answer, after, ALIKE.tables)
        numbers, phase = after, int(ALIKE.tables.following[phase, turn.kind, 0, 0, answer])
        agent.observe(said)
        assert agent.phase == phase
    return [agent.belief.tolist(), belief.probabilities.tolist(), numbers.tolist()]


@pytest.mark.parametrize(
    ("steps", "own"),
    [
        ([(Point(0), "")], 0.4 / (0.4 + 0.8)),  # a third
        ([(Point(0), "yes")], 0.6 * 0.99 / (0.6 * 0.99 + 0.2 * 0.01)),
        ([(Point(0), "no")], 0.6 * 0.01 / (0.6 * 0.01 + 0.2 * 0.99)),  # 1 in 34
        ([(Wait(), "")], 0.5),  # nothing was asked
        ([(Point(0), ""), (Wait(), "")], 0.4 * 0.5 / (0.4 * 0.5 + 0.8 * 0.75)),
        ([(Point(0), ""), (Wait(), ""), (Wait(), "")], 0.4 * 0.5 * 0.7 / (0.4 * 0.5 * 0.7 + 0.8 * 0.75 * 0.4)),
        ([(Point(0), ""), (Wait(), "yes")], 0.4 * 0.5 * 0.99 / (0.4 * 0.5 * 0.99 + 0.8 * 0.25 * 0.01)),
        # A question about the other item while the first is open: answered .7 if that one is desired, .4 if not.
        ([(Point(0), ""), (Point(1), "")], 0.4 * 0.6 / (0.4 * 0.6 + 0.8 * 0.3)),
        ([(Point(0), ""), (Point(1), "no")], 0.4 * 0.4 * 0.99 / (0.4 * 0.4 * 0.99 + 0.8 * 0.7 * 0.01)),
        # What was answered is answered again with the same chance for both.
        ([(Point(0), "no"), (Wait(), "")], 0.6 * 0.01 / (0.6 * 0.01 + 0.2 * 0.99)),
        ([(Point(0), "no"), (Wait(), "no")], 0.6 * 0.01**2 / (0.6 * 0.01**2 + 0.2 * 0.99**2)),
        # After an answer a question is the first again.
        ([(Point(0), "no"), (Point(1), "")], 0.6 * 0.01 * 0.8 / (0.6 * 0.01 * 0.8 + 0.2 * 0.99 * 0.4)),
    ],
)
def test_beliefs_by_hand(steps: list[tuple[Action, str]], own: float) -> None:
    for found in filtered(steps, [0.5, 0.5]):
        assert found == pytest.approx([own, 1 - own], abs=1e-12)


def test_three_filters_agree_on_long_talks() -> None:
    rng = np.random.default_rng(3)
    for _ in range(40):
        steps: list[tuple[Action, str]] = [(Point(0), "")]
        for kind, said in rng.integers((3, 4), size=(6, 2)):
            steps.append(((Wait(), Point(0), Point(1))[kind], ("", "", "yes", "no")[said]))
        agent, updated, numbers = filtered(steps, [0.7, 0.3])
        assert agent == pytest.approx(updated, abs=1e-12)
        assert numbers == pytest.approx(updated, abs=1e-12)


def test_where_p_g_is_0_live_people_do_not_point_either() -> None:
    """The filter takes any ray for none there, so nobody may be drawn who points."""
    assert ALIKE.model.p_g == 0.0
    assert not ALIKE.tables.chances[..., POINTS].any()
    rng = np.random.default_rng(0)
    for _ in range(200):
        state, seen, _ = step(ALIKE, State(0), Wait(), rng)
        assert seen is not None
        assert seen.ray is None
        assert state.phase in (0, 40)  # unbegun still, or words of one who has not pointed


@pytest.mark.slow
def test_plain_and_compiled_interactions_earn_the_same() -> None:
    problem, planner = live(Problem(Scene.load("ambiguous"))), PaperAlwaysAsk()
    played = [
        run_episode(problem, planner, k % 6, np.random.default_rng((9, k)), np.random.default_rng(k))
        for k in range(1_500)
    ]
    earned, ours = np.array([one.earned for one in played]), simulate(problem, planner, 6_000, seed=1)
    error = math.hypot(earned.std() / math.sqrt(len(earned)), ours.standard_error)
    assert abs(earned.mean() - ours.mean_return) <= 4 * error
    assert error < 0.05 * abs(ours.mean_return)  # a robot that always asks pays for up to 30 questions
    assert abs(np.mean([one.steps for one in played]) - ours.mean_steps) <= 0.6

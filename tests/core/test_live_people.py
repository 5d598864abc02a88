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
from fetch_pomdp.core.turns import LEAST, NO, POINTS, REPEAT, SILENT, UNSURE, YES, Turns
from tests.oracles.model import YES_WORDS, angle
from tests.oracles.talking import (
    ANSWERS,
    Person,
    Question,
    Step,
    Talk,
    all_talks,
    answer_chance,
    group,
    ray_width,
    talk_after,
)
from tests.tables import live, table, twins

# Chances far from 0 and 1, no two alike, so that each is told from the others by counting.
TURNS = Turns(
    words_unbegun=(0.3, 0.6), words_pointed=(0.25, 0.8), words_due=(0.5, 0.85), words_mute=(0.12, 0.7),
    words_said=(0.15, 0.2), words_heard=(0.1, 0.35), words_silent=(0.4, 0.55), words_denied=(0.45, 0.65),
    points_unbegun=(0.6, 0.7), points_pointed=(0.85, 0.9), points_due=(0.75, 0.8), points_mute=(0.33, 0.52),
    points_said=(0.2, 0.25), points_heard=(0.35, 0.5), points_silent=(0.3, 0.4), points_denied=(0.55, 0.65),
    answers_desired=(0.5, 0.7, 0.6, 0.2), answers_other=(0.25, 0.45, 0.35, 0.3), answers_again=(0.58, 0.42, 0.22),
    answers_late=(0.15,), answers_settled=(0.1,), held=(1.5, 2.5), patience=3, question=2, gesturing=2, hesitation=2,
)  # fmt: skip
PERSON = Person({field.name: getattr(TURNS, field.name) for field in dataclasses.fields(Turns)}, 3, 2, 2, 2)
TALKS = all_talks(PERSON)
TRUTH = 0.9
AMBIGUOUS = Scene.load("ambiguous")
SIGMA = 0.02
# Rays so near the item that none is beyond the threshold, not even of a held arm: who points is seen to point.
LIVE = Problem(
    dataclasses.replace(
        AMBIGUOUS, model=AMBIGUOUS.model.with_changes({"turns": TURNS, "sigma": SIGMA, "p_truth": TRUTH})
    )
)
DRAWS = 4_000
DESIRED = 2
ONCE, LATE, AGAIN, THIRD = Question("open", 1), Question("open", 1, 2), Question("open", 2), Question("open", 3, 2)
# Unbegun, pointed, due, mute; heard and open, for longer, late, denied, asked again; silent; said and open, and late
# for the third time.
BEGUN = [
    Talk(), Talk(False, True, 1), Talk(False, True, 2), Talk(False, True, 4), Talk(True, True, 0, ONCE),
    Talk(True, True, 0, Question("open", 1, 1)), Talk(True, True, 1, LATE), Talk(True, True, 0, Question("denied")),
    Talk(True, True, 1, AGAIN), Talk(True, True, 3), Talk(True, False, 0, ONCE), Talk(True, False, 1, THIRD),
]  # fmt: skip
CASES = [
    (TALKS.index(talk), asked, action)
    for talk in BEGUN
    for asked, action in [(DESIRED, Wait()), (4, Wait()), (None, Wait()), (0, Point(DESIRED)), (None, Point(4))]
]


def chances_of(phase: int, asked: int | None, action: Action) -> dict[str, float]:
    """What a step's words, pointing, "yes" and "no" have a chance of."""
    question, talk = isinstance(action, Point), TALKS[phase]
    name, about = group(talk, PERSON), action.item if isinstance(action, Point) else asked
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
    happened, angles = dict.fromkeys(("words", "points", "yes", "no"), 0), list[float]()
    for _ in range(DRAWS):
        state, seen, _ = step(LIVE, State(DESIRED, asked, phase), action, rng)
        assert seen is not None
        following.append(state.phase)
        answers = [word for word in seen.words if word not in LIVE.words]
        happened["words"] += len(answers) < len(seen.words)
        happened["points"] += seen.ray is not None
        if seen.ray is not None:
            angles.append(angle(seen.ray.head, seen.ray.wrist, AMBIGUOUS.items[DESIRED].position))
        happened["yes"] += any(word in YES_WORDS for word in answers)
        happened["no"] += any(word not in YES_WORDS for word in answers)
    for name, chance in chances_of(phase, asked, action).items():
        assert abs(happened[name] / DRAWS - chance) <= 4 * math.sqrt(chance * (1 - chance) / DRAWS), name
    assert_shares(counted(following), phases_after(phase, asked, action), DRAWS)
    assert_spread(angles, SIGMA * ray_width(TALKS[phase], PERSON))


def assert_spread(angles: list[float], sigma: float) -> None:
    """Angles are |N(0, sigma)|: their mean square is sigma squared, with an error of sqrt(2 / n) of it."""
    square = np.square(angles).mean() / sigma**2
    assert abs(square - 1.0) <= 4 * math.sqrt(2 / len(angles))


@pytest.mark.parametrize(("phase", "asked", "action"), CASES)
def test_the_compiled_sampler_counted(phase: int, asked: int | None, action: Action) -> None:
    turn = turn_of(NOBODY if asked is None else asked, phase, action.item if isinstance(action, Point) else NOBODY)
    state, heard, following = random_state(phase + 100 * CASES.index((phase, asked, action))), np.empty(6), list[int]()
    for _ in range(DRAWS):
        belief = np.full(6, 1 / 6)
        following.append(int(live_step(belief, turn, DESIRED, heard, state, LIVE.tables)))
        assert belief.sum() == pytest.approx(1.0)
    assert_shares(counted(following), phases_after(phase, asked, action), DRAWS)


# Rays of a held arm, compiled: two items that sound alike, .1 rad apart, and people who point in every step.

NEVER, ALWAYS = LEAST, 1.0 - LEAST
POINTING = Turns(
    points_unbegun=(ALWAYS, ALWAYS), points_pointed=(ALWAYS, ALWAYS), points_due=(ALWAYS, ALWAYS),
    words_unbegun=(NEVER, NEVER), words_pointed=(NEVER, NEVER), words_due=(NEVER, NEVER), held=(1.5, 2.5),
)  # fmt: skip
NEAR = table([["thing"]] * 2, [(0.0, 2.0, 1.6), (0.2, 2.0, 1.6)], turns=POINTING, sigma=0.05)


def belief_after_a_ray(sigma: float, rng: np.random.Generator) -> float:
    """The belief in the first item, from one half, after a ray drawn for it, by its angles to both (Eq. 7)."""
    off, roll = abs(rng.normal(0.0, sigma)), rng.uniform(0.0, 2 * math.pi)
    wrist = (math.sin(off) * math.cos(roll), math.cos(off), 1.6 + math.sin(off) * math.sin(roll))
    found = [angle((0.0, 0.0, 1.6), wrist, item.position) for item in NEAR.scene.items]
    if min(found) > 0.3:
        return 0.5
    own, other = (math.exp(-0.5 * (apart / sigma) ** 2) for apart in found)
    return own / (own + other)


@pytest.mark.parametrize(("phase", "width"), [(0, 1.0), (20, 1.5), (40, 2.5), (60, 2.5)])
def test_compiled_rays_are_spread_and_read_by_the_width_of_their_step(phase: int, width: float) -> None:
    rng, state, heard, draws = np.random.default_rng(phase), random_state(phase), np.empty(2), 20_000
    compiled = np.empty(draws)
    for number in range(draws):
        belief = np.full(2, 0.5)
        live_step(belief, turn_of(NOBODY, phase, NOBODY), 0, heard, state, NEAR.tables)
        compiled[number] = belief[0]
    plain = np.array([belief_after_a_ray(0.05 * width, rng) for _ in range(draws)])
    for power in (1, 2):
        error = math.hypot((compiled**power).std(), (plain**power).std()) / math.sqrt(draws)
        assert abs((compiled**power).mean() - (plain**power).mean()) <= 4 * error
    assert abs(compiled.mean() - {1.0: 0.82, 1.5: 0.68, 2.5: 0.57}[width]) < 0.02, "widths are told apart"


def test_a_held_arm_is_read_as_wider_by_an_agent() -> None:
    """Rays 0.02 rad from the first item, in phases in which they count 1, 1.5 and twice 2.5 times as wide."""
    agent, odds = Agent(NEAR.scene, Threshold()), 1.0
    first, second = 0.02, math.atan2(0.2, 2.0) - 0.02
    for width in (1.0, 1.5, 2.5, 2.5):
        agent.observe(head=(0.0, 0.0, 1.6), wrist=(math.sin(0.02), math.cos(0.02), 1.6))
        odds *= math.exp(0.5 * (second**2 - first**2) / (0.05 * width) ** 2)
        assert agent.belief[0] == pytest.approx(odds / (1 + odds), abs=1e-9)


# The filter: two items that sound alike, and answers_desired .6, answers_other .2 in the step of a question.

ANSWERING = Turns(answers_desired=(0.6, 0.7, 0.5, 0.3), answers_other=(0.2, 0.4, 0.25, 0.6))
ALIKE = twins(2, turns=ANSWERING)
HASTY = twins(2, turns=dataclasses.replace(ANSWERING, hesitation=2))  # late after two quiet steps
PHRASES = {"unsure": "I don't know", "pardon": "what?"}
READ = {"": SILENT, "yes": YES, "no": NO, "unsure": UNSURE, "pardon": REPEAT}


def filtered(answers: list[tuple[Action, str]], prior: list[float], problem: Problem = ALIKE) -> list[list[float]]:
    """The belief after steps, by an agent, by `Belief.updated` and compiled."""
    agent, asked, phase = Agent(problem.scene, Threshold(), prior=prior), None, 0
    belief, numbers = Belief(prior), np.array(prior)
    for action, said in answers:
        agent.did(action)
        chances = problem.step_chances(action, phase)
        asked = action.item if isinstance(action, Point) else asked
        belief = belief.updated(Observation((said,) if said else ()), asked, problem, chances=chances)
        answer, after = READ[said], numbers.copy()
        turn = Turn(NOBODY if asked is None else asked, phase, int(isinstance(action, Point)))
        if said not in PHRASES:  # the model's people know what they want, and hear what is asked
            answered(numbers, turn, answer, after, problem.tables)
        numbers, phase = after, int(problem.tables.following[phase, turn.kind, 0, 0, answer])
        agent.observe(PHRASES.get(said, said))
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


IN_VAIN: list[tuple[Action, str]] = [(Point(0), ""), (Wait(), ""), (Wait(), "")]
OWN, OTHER = 0.4 * 0.5 * 0.7, 0.8 * 0.75 * 0.4  # what that silence is worth


@pytest.mark.parametrize(
    ("steps", "own"),
    [
        (IN_VAIN, OWN / (OWN + OTHER)),
        # Late: whether it is answered then tells nothing, what is answered does.
        ([*IN_VAIN, (Wait(), "")], OWN / (OWN + OTHER)),
        ([*IN_VAIN, (Wait(), "yes")], OWN * 0.99 / (OWN * 0.99 + OTHER * 0.01)),
        ([*IN_VAIN, (Point(0), "")], OWN / (OWN + OTHER)),
        ([*IN_VAIN, (Point(1), "")], OWN / (OWN + OTHER)),
        ([*IN_VAIN, (Point(0), "no")], OWN * 0.01 / (OWN * 0.01 + OTHER * 0.99)),
        # Asked again, it is open like the first.
        ([*IN_VAIN, (Point(0), ""), (Wait(), "")], OWN * 0.5 / (OWN * 0.5 + OTHER * 0.75)),
        ([*IN_VAIN, (Point(0), ""), (Point(1), "")], OWN * 0.6 / (OWN * 0.6 + OTHER * 0.3)),
        # "I don't know" and "what?" are neither answers nor silence, and the question is late at once.
        ([(Point(0), "unsure")], 0.5),
        ([(Point(0), ""), (Wait(), "unsure")], 0.4 / (0.4 + 0.8)),
        ([(Point(0), "unsure"), (Wait(), "")], 0.5),
        ([(Point(0), "unsure"), (Point(1), "")], 0.5),
        ([(Point(0), "unsure"), (Point(1), "no")], 0.99),
        ([(Point(0), "pardon")], 0.5),
        ([(Point(0), "pardon"), (Point(0), "")], 0.5),
        ([(Point(0), "pardon"), (Point(0), ""), (Wait(), "")], 0.5 / (0.5 + 0.75)),
        ([(Point(0), "pardon"), (Point(0), "yes")], 0.99),
    ],
)
def test_beliefs_by_hand_where_nobody_answers(steps: list[tuple[Action, str]], own: float) -> None:
    for found in filtered(steps, [0.5, 0.5], HASTY):
        assert found == pytest.approx([own, 1 - own], abs=1e-12)


@pytest.mark.parametrize(
    ("steps", "unanswered"),
    [
        ([], 0),
        (IN_VAIN[:-1], 0),
        (IN_VAIN, 1),
        ([*IN_VAIN, (Point(0), "")], 0),
        ([*IN_VAIN, *IN_VAIN], 2),
        ([*IN_VAIN, *IN_VAIN, *IN_VAIN], 3),
        ([*IN_VAIN, *IN_VAIN, *IN_VAIN, (Point(0), "")], 3),
        ([*IN_VAIN, (Wait(), "no")], 0),
        ([(Point(0), "pardon")], 1),
        ([(Point(0), "unsure")], 3),
    ],
)
def test_an_agent_knows_how_often_nobody_answered(steps: list[tuple[Action, str]], unanswered: int) -> None:
    agent = Agent(HASTY.scene, Threshold())
    for action, said in steps:
        agent.did(action)
        agent.observe(PHRASES.get(said, said))
    assert agent.unanswered == unanswered


def test_three_filters_agree_on_long_talks() -> None:
    rng = np.random.default_rng(3)
    for _ in range(40):
        steps: list[tuple[Action, str]] = [(Point(0), "")]
        for kind, said in rng.integers((3, 4), size=(6, 2)):
            steps.append(((Wait(), Point(0), Point(1))[kind], ("", "", "yes", "no")[said]))
        for problem in (ALIKE, HASTY):
            agent, updated, numbers = filtered(steps, [0.7, 0.3], problem)
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
        assert state.phase in (0, 260)  # unbegun still, or words of one who has not pointed


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

"""Turn-taking from logs: what people were drawn with is found again."""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
import pytest

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import Turns
from fetch_pomdp.study.calibrate.steps import Interaction
from fetch_pomdp.study.calibrate.turns import TRUST, Tally, tally

AMBIGUOUS = Scene.load("ambiguous")
TRUTH = Turns(
    words_unbegun=(0.3, 0.6), words_pointed=(0.25, 0.8), words_due=(0.5, 0.85), words_said=(0.1, 0.2),
    words_heard=(0.15, 0.3), words_silent=(0.4, 0.55), words_denied=(0.45, 0.65), words_mute=(0.12, 0.7),
    points_unbegun=(0.4, 0.7), points_pointed=(0.85, 0.9), points_due=(0.75, 0.8), points_said=(0.1, 0.25),
    points_heard=(0.35, 0.5), points_silent=(0.3, 0.4), points_denied=(0.55, 0.65),
    points_mute=(0.33, 0.52), answers_again=(0.45, 0.35, 0.22), answers_late=(0.08,),
    answers_desired=(0.5, 0.7, 0.6, 0.2), answers_other=(0.25, 0.45, 0.35, 0.3), answers_settled=(0.1,),
    patience=3, question=2, gesturing=1, hesitation=2, held=(1.5, 2.5),
)  # fmt: skip
# Rays so near the item that whoever points is seen to.
PEOPLE = Problem(dataclasses.replace(AMBIGUOUS, model=AMBIGUOUS.model.with_changes({"turns": TRUTH, "sigma": 0.03})))
PLACES = [
    (field.name, index, chance)
    for field in dataclasses.fields(Turns)
    if isinstance(chances := getattr(TRUTH, field.name), tuple) and field.name != "held"
    for index, chance in enumerate(chances)
]
START = Turns(patience=3, question=2, gesturing=1, hesitation=2)
STEPS = 30


def interaction(number: int) -> Interaction:
    """Steps of a robot that waits, and asks at random, about the desired item and one other.

    It asks more often what nobody has answered for long, and seldom while an answer is due.
    """
    rng, desired = np.random.default_rng((5, number)), number % 6
    state, events = State(desired), list[Event]()
    for _ in range(STEPS):
        about = desired if rng.random() < 0.5 else (desired + 1) % 6
        late, awaited = PEOPLE.tables.late[state.phase], PEOPLE.tables.awaited[state.phase]
        action: Action = Point(about) if rng.random() < (0.9 if late else 0.15 if awaited else 0.4) else Wait()
        state, seen, _ = step(PEOPLE, state, action, rng)
        assert seen is not None
        events += [Acted(action), Observed(seen)]
    return Interaction(PEOPLE.scene, desired, str(number), tuple(events))


@functools.cache
def counted() -> Tally:
    return tally([interaction(number) for number in range(1_500)], START)


@pytest.mark.parametrize(("name", "index", "chance"), PLACES)
def test_chances_people_were_drawn_with_are_counted(name: str, index: int, chance: float) -> None:
    happened, steps = counted().happened[name, index], counted().steps[name, index]
    assert steps >= 100, "too few to tell anything"
    assert abs(happened / steps - chance) <= 4 * math.sqrt(chance * (1 - chance) / steps)


def test_every_step_is_counted_once() -> None:
    """Words and pointing in all steps, answers in those of a question and after one."""
    steps = counted().steps
    for kind in ("words", "points"):
        assert sum(count for (name, _), count in steps.items() if name.startswith(kind)) == STEPS * 1_500
    assert sum(count for (name, _), count in steps.items() if name.startswith("answers")) < STEPS * 1_500


def test_the_chances_made_of_a_tally_are_beta_means() -> None:
    """By hand: 3 of 8 steps and a chance before of .2 that counts for two steps make 3.4 in 10."""
    assert TRUST == 2.0
    start = dataclasses.replace(START, words_unbegun=(0.2, 0.6))
    found = Tally({("words_unbegun", 0): 3}, {("words_unbegun", 0): 8}).turns(start)
    assert found.words_unbegun == pytest.approx((0.34, 0.6))
    assert dataclasses.replace(found, words_unbegun=START.words_unbegun) == START
    always = Tally({("words_due", 1): 10**9}, {("words_due", 1): 10**9}).turns(START)
    assert always.words_due[1] == 1 - 1e-6
    assert Tally({}, {}).turns(TRUTH) == TRUTH, "how wide a held arm's rays are read is counted by nothing"


def test_a_second_request_is_not_counted() -> None:
    """Whoever makes it wants something that the log does not tell."""
    one = interaction(0)
    again: list[Event] = [Acted(Pick(0)), Observed(Observation(("bowl",)), anew=True), Acted(Wait())]
    both = dataclasses.replace(one, events=(*one.events, *again, *interaction(1).events))
    assert tally([both], START) == tally([one], START)


def test_what_follows_never_mind_is_not_counted() -> None:
    """Neither as this request nor as silence: the robot has begun anew."""
    one = interaction(0)
    events: list[Event] = [Acted(Point(0)), Observed(Observation(("cancel",))), *interaction(1).events]
    both = dataclasses.replace(one, events=(*one.events, *events))
    assert tally([both], START) == tally([one], START)


def test_an_interaction_by_hand() -> None:
    """Nothing, then words, a question that is answered by "no", a wait with pointing, a pick."""
    scene = PEOPLE.scene
    done: list[tuple[Action, Observation]] = [
        (Wait(), Observation()),
        (Wait(), Observation(("marker",))),
        (Point(0), Observation(("no",))),
        (Wait(), Observation((), Ray(scene.head, scene.items[3].position))),
    ]
    events = [event for action, seen in done for event in (Acted(action), Observed(seen))]
    found = tally([Interaction(scene, 3, "", (*events, Acted(Pick(3))))], START)
    expected = {
        ("words_unbegun", 0): (1, 2), ("points_unbegun", 0): (0, 2),
        ("words_said", 1): (0, 1), ("points_said", 1): (0, 1), ("answers_other", 0): (1, 1),
        ("words_denied", 0): (0, 1), ("points_denied", 0): (1, 1), ("answers_settled", 0): (0, 1),
    }  # fmt: skip
    assert {place: (found.happened[place], steps) for place, steps in found.steps.items()} == expected

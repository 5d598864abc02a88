"""Parameters fitted to simulated logs: what was put in comes out, intervals cover, what cannot be known is named."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.header import Header
from fetch_pomdp.study.calibrate.calibration import Calibration, by_person, calibrate
from fetch_pomdp.study.calibrate.estimate import Estimate
from fetch_pomdp.study.calibrate.steps import Interaction, Step, interaction_of, steps_of
from tests.study.calibrate.people import SCENES, TRUTH, logs

NO, YES = Observed(Observation(("no",))), Observed(Observation(("yes",)))
MARKER = Observed(Observation(("marker",)))


TABLE = Problem(SCENES[0])


def repeated(action: Wait | Point, seen: Observed, times: int) -> list[Event]:
    return [event for _ in range(times) for event in (Acted(action), seen)]


def by_name(found: Calibration) -> dict[str, Estimate]:
    return {one.name: one for one in found.estimates}


def interaction(*events: Event, desired: int = 2, person: str = "a", scene: Scene = SCENES[0]) -> Interaction:
    return Interaction(scene, desired, person, events)


# What a step is.


def test_steps_of_an_interaction() -> None:
    ray = Ray((0, 0, 1.6), (0, 1, 1.3))
    events: list[Event] = [
        Acted(Wait()),
        Observed(Observation(("marker",), ray)),
        YES,  # before the question: of the step before
        Acted(Point(1)),
        NO,
        Acted(Point(3), Outcome.FAILED),  # not asked
        MARKER,
        Acted(Pick(3), Outcome.STOPPED),  # shown, and objected to
        NO,
        Acted(Wait()),  # followed by silence that nobody recorded
        Acted(Pick(2)),
    ]
    assert list(steps_of(events, TABLE)) == [
        Step(Wait(), None, Observation(("marker", "yes"), ray)),
        Step(Point(1), 1, Observation(("no",))),
        Step(Wait(), 1, Observation(("marker",))),
        Step(Point(3), 3, Observation(("no",))),
        Step(Wait(), 3, Observation()),
    ]


def test_steps_go_on_after_a_return_and_end_with_a_second_request() -> None:
    events: list[Event] = [
        Acted(Wait()),
        MARKER,
        Acted(Pick(3)),
        Acted(Pick(3), Outcome.RETURNED),  # shown, and objected to
        NO,
        Acted(Pick(2)),
        Observed(Observation(("bowl",)), anew=True),
        Acted(Point(0)),
        YES,
    ]
    assert list(steps_of(events, TABLE)) == [
        Step(Wait(), None, Observation(("marker",))),
        Step(Point(3), 3, Observation(("no",))),
    ]


@pytest.mark.parametrize("said", [("cancel",), ("cancel", "bowl")])
@pytest.mark.parametrize("last", [Wait(), Point(1)])
def test_steps_end_where_nothing_is_wanted_any_more(said: tuple[str, ...], last: Wait | Point) -> None:
    """What somebody wants next is not known, and who says "never mind" has not been silent to the question."""
    begun: list[Event] = [Acted(Wait()), MARKER]
    events = [*begun, Acted(last), Observed(Observation(said)), Acted(Wait()), MARKER, Acted(Point(2)), YES]
    assert list(steps_of(events, TABLE)) == list(steps_of(begun, TABLE)) == [
        Step(Wait(), None, Observation(("marker",)))
    ]  # fmt: skip


def test_a_table_may_have_a_word_for_never_mind() -> None:
    button = dataclasses.replace(SCENES[0].items[0], vocabulary=("cancel", "button"))
    problem = Problem(dataclasses.replace(SCENES[0], items=(button, *SCENES[0].items[1:])))
    events: list[Event] = [Acted(Wait()), Observed(Observation(("cancel", "button")))]
    assert list(steps_of(events, problem)) == [Step(Wait(), None, Observation(("cancel", "button")))]


def test_the_desired_item_must_be_known() -> None:
    header = Header(scene=SCENES[0], target="marker-1", person=7)
    assert interaction_of(header, []) == Interaction(SCENES[0], 2, "7", ())
    with pytest.raises(StudyError, match=r"^f.jsonl:1: target: found none, expected the id"):
        interaction_of(dataclasses.replace(header, target=None), [], "f.jsonl")
    with pytest.raises(StudyError, match="found no observations"):
        calibrate([interaction()])


# Estimates against values worked out by hand.


def test_shares_are_those_of_counting() -> None:
    """With Jeffreys' prior on the logit, k of n gives (k + 1/2) / (n + 1)."""
    events: list[Event] = []
    for answer in [NO] * 7 + [YES] * 2 + [Observed(Observation())]:
        events += [Acted(Point(1)), answer]  # marker-1 is desired, bowl-2 is asked about: "no" is true
    found = by_name(calibrate([interaction(*events)]))
    assert found["p_truth"].value == pytest.approx(1 - 0.5 * share_of_false(2, 9), abs=1e-4)
    assert found["p_l"].value == pytest.approx(9.5 / 21, abs=1e-4), "no base words in ten steps, an answer in nine"
    assert found["p_g"].value < 0.15
    assert (found["p_g"].low, found["p_g"].known) == (0.0, "high")


def share_of_false(wrong: int, answers: int) -> float:
    """The mode of x in (0, 1) with the error rate x / 2: (x/2)^k (1 - x/2)^(n - k) x^(1/2) (1 - x)^(1/2)."""
    grid = np.linspace(1e-6, 1 - 1e-6, 200_001)
    log = (
        wrong * np.log(grid / 2) + (answers - wrong) * np.log1p(-grid / 2) + 0.5 * np.log(grid) + 0.5 * np.log1p(-grid)
    )
    return float(grid[log.argmax()])


def test_alpha_is_that_of_the_share_of_own_words() -> None:
    """Of Eq. 5: a share s of own words is (v + v alpha) / (v + alpha W), for v own words and W in all."""
    scene = SCENES[0]
    own = len(scene.items[2].vocabulary)
    foreign = next(word for word in scene.words if word not in scene.items[2].vocabulary)
    events: list[Event] = []
    for word in ["marker"] * 400 + [foreign] * 100:
        events += [Acted(Wait()), Observed(Observation((word,)))]
    found = by_name(calibrate([interaction(*events)]))["alpha"]
    expected = own * (1 - 0.8) / (0.8 * len(scene.words) - own)
    assert found.value == pytest.approx(expected, rel=0.02), "the prior moves it a little"
    assert found.low < expected < found.high


def test_sigma_is_the_spread_of_the_rays() -> None:
    """Far from the threshold nothing is cut off, and the estimate is the root mean square of the angles."""
    rng, head = np.random.default_rng(0), np.array(SCENES[0].head)
    aim = np.array(SCENES[0].items[2].position) - head
    aim /= np.linalg.norm(aim)
    right = np.array([1.0, 0.0, 0.0]) - aim[0] * aim
    right /= np.linalg.norm(right)
    angles = np.abs(rng.normal(0.0, 0.04, 300))
    events: list[Event] = []
    for angle in angles:
        arm = math.cos(angle) * aim + rng.choice([-1, 1]) * math.sin(angle) * right
        events += [Acted(Wait()), Observed(Observation((), Ray(tuple(head), tuple(head + arm))))]
    found = by_name(calibrate([interaction(*events)]))["sigma"]
    expected = math.sqrt(float((angles**2).mean()))
    assert found.value == pytest.approx(expected, rel=0.01)
    assert found.high - found.low == pytest.approx(2 * 1.645 * expected / math.sqrt(600), rel=0.05)


def test_a_bias_is_found_by_its_directions() -> None:
    head = np.array(SCENES[0].head)
    events: list[Event] = []
    for person in range(2):
        for jitter in (-0.01, 0.0, 0.01):
            place = np.array(SCENES[0].items[2].position)
            distance = np.linalg.norm(place - head)
            place[0] += (0.05 + jitter + 0.001 * person) * distance  # to the right of who looks along y
            events += [Acted(Wait()), Observed(Observation((), Ray(tuple(head), tuple(place))))]
    found = calibrate([interaction(*events[:6]), interaction(*events[6:])]).bias
    assert [one.name for one in found] == ["bias_right", "bias_up"]
    assert found[0].value == pytest.approx(0.0505, abs=0.002)
    assert found[0].covers(0.0505)
    assert found[1].value == pytest.approx(0.0, abs=0.003)
    assert not calibrate([interaction(*events[:6])]).bias, "one piece has no spread between pieces"


# Simulated people.


def test_known_parameters_are_recovered() -> None:
    found = by_name(calibrate(logs(TRUTH, 10, 18, 5)))
    tolerances = {"sigma": 0.012, "p_g": 0.05, "p_l": 0.04, "p_answer_again": 0.12, "alpha": 0.05, "p_truth": 0.08}
    for name, tolerance in tolerances.items():
        assert found[name].value == pytest.approx(TRUTH[name], abs=tolerance), name
        assert found[name].known == "both"
        assert found[name].low < found[name].value < found[name].high


@pytest.mark.long
def test_intervals_cover() -> None:
    """All parameters of 25 sets, 8 intervals a set: 180 of 200 are expected to hold; 4 standard errors are 17."""
    held = total = 0
    for seed in range(25):
        found = calibrate(logs(TRUTH, 1, 18, 1_000 + seed))
        held += sum(one.covers(TRUTH[one.name]) for one in found.estimates)
        held += sum(one.covers(0.0) for one in found.bias)
        total += len(found.estimates) + len(found.bias)
    assert total == 200
    assert 160 <= held <= 196


def test_people_who_differ_widen_the_intervals_of_all_together() -> None:
    alike, unlike = logs(TRUTH, 12, 6, 3), list[Interaction]()
    for person in range(12):
        theirs = logs({**TRUTH, "p_g": 0.1 if person % 3 else 0.9}, 1, 6, person)
        unlike += [dataclasses.replace(one, person=str(person)) for one in theirs]
    even, uneven = (by_name(calibrate(them))["p_g"] for them in (alike, unlike))
    assert uneven.high - uneven.low > 1.5 * (even.high - even.low)
    assert uneven.inflation > 2.5


def test_each_person_has_estimates_of_their_own() -> None:
    exact, vague = logs({**TRUTH, "sigma": 0.03}, 1, 18, 1), logs({**TRUTH, "sigma": 0.2}, 1, 18, 2)
    found = by_person([*exact, *(dataclasses.replace(one, person="vague") for one in vague)])
    assert list(found) == ["0", "vague"]
    assert by_name(found["0"])["sigma"].high < by_name(found["vague"])["sigma"].low
    assert found["vague"].interactions == 18


# What cannot be known.


def test_what_the_logs_do_not_tell_is_named() -> None:
    silent = calibrate([interaction(Acted(Wait()), Observed(Observation()), Acted(Wait()), Observed(Observation()))])
    known = {name: one.known for name, one in by_name(silent).items()}
    assert known.pop("p_g") == known.pop("p_l") == "high", "two steps without, so not always"
    assert known == dict.fromkeys(("sigma", "p_answer_again", "alpha", "p_truth"), "none")
    assert set(silent.changes()) == {"p_g", "p_l"}
    assert silent.unknown()["sigma"] == "pointing"
    assert by_name(silent)["sigma"].high == 0.7, "the whole range"


def test_alpha_has_no_lower_bound_where_no_other_word_was_heard() -> None:
    told = calibrate([interaction(*repeated(Wait(), MARKER, 60))])
    alpha = by_name(told)["alpha"]
    assert (alpha.known, alpha.low) == ("high", 0.0)
    assert alpha.high < 0.2
    assert "alpha" in told.unknown()
    assert "alpha" in told.changes()


def test_alpha_is_unknown_where_all_items_have_all_words() -> None:
    items = tuple(Item(id=str(x), position=(x, 2.0, 0.7), vocabulary=("cup", "mug")) for x in (0.0, 0.5))
    scene = Scene(items=items, head=(0.0, 0.0, 1.6))
    said = Observed(Observation(("cup",)))
    found = by_name(calibrate([interaction(*repeated(Wait(), said, 60), desired=0, scene=scene)]))
    assert found["alpha"].known == "none"


def test_answers_are_needed_for_their_error_rate() -> None:
    before = by_name(calibrate([interaction(*repeated(Wait(), YES, 40))]))["p_truth"]
    assert before.known == "none", "nothing was asked"
    asked = by_name(calibrate([interaction(*repeated(Point(2), YES, 40))]))["p_truth"]
    assert (asked.known, asked.high) == ("low", 1.0)
    assert asked.low > 0.9

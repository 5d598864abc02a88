"""Hand Me That: hand-scored games, groups by the rules, operators, and games played."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.random import Generator, default_rng

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.gesture import angles
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import Decision, unvalued
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import ModelError, StudyError
from fetch_pomdp.study.robocup.contest import Contest, play_group, without
from fetch_pomdp.study.robocup.operators import UNKNOWN, Guests, group_scene
from fetch_pomdp.study.robocup.rules import GroupRecord, Rules, game_score, group_score
from tests.tables import live, twins

RULES = Rules()


@dataclass(frozen=True)
class Scripted:
    """Does the actions of a list, one a decision; it keeps its place, which a planner must not."""

    actions: itertools.chain[Action]

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        return Decision(next(self.actions), np.nan, unvalued(problem), belief.probabilities)


def scripted(*actions: Action) -> Scripted:
    return Scripted(itertools.chain(actions, itertools.repeat(Wait())))


@dataclass
class Silent:
    """An operator who says nothing, and notes what was done."""

    seen: list[tuple[Action, int | None]]

    def respond(self, action: Action, asked: int | None) -> Observation:
        self.seen.append((action, asked))
        return Observation()


# The score.


@pytest.mark.parametrize(
    ("record", "points"),
    [
        (GroupRecord(True, 1, 0), 500),
        (GroupRecord(True, 1, 1), 350),
        (GroupRecord(True, 1, 3), 50),
        (GroupRecord(True, 1, 7), 50),  # three are charged
        (GroupRecord(True, 2, 0), 300),
        (GroupRecord(True, 3, 0), 100),
        (GroupRecord(True, 4, 0), 100),  # two are charged
        (GroupRecord(True, 5, 0), 0),
        (GroupRecord(True, 2, 2), 0),
        (GroupRecord(True, 5, 1), -150),
        (GroupRecord(True, 1, 0, described=True), 100),
        (GroupRecord(True, 2, 0, described=True), -100),
        (GroupRecord(False, 3, 0), 0),  # wrong guesses reduce the right one's value alone
        (GroupRecord(False, 0, 2, waits=9), -300),
    ],
)
def test_groups_scored_by_hand(record: GroupRecord, points: int) -> None:
    assert group_score(record, RULES) == points


def test_games_scored_by_hand() -> None:
    perfect = GroupRecord(True, 1, 0)
    assert game_score([perfect] * 5, RULES) == 2500
    mixed = [perfect, GroupRecord(True, 2, 1), GroupRecord(True, 4, 2), GroupRecord(False, 2, 3), perfect]
    assert game_score(mixed, RULES) == 500 + 150 - 200 - 450 + 500
    assert game_score([GroupRecord(False, 0, 3)] * 5, RULES) == 0, "no team receives negative points"


def test_prices_are_those_of_the_rules() -> None:
    rewards = RULES.rewards()
    assert (rewards.pick_correct, rewards.point, rewards.wait) == (500, -150, -5)
    assert rewards.pick_wrong == pytest.approx(500 / 3)
    with pytest.raises(ModelError, match="pick_wrong"):
        Rules(wrong=0).rewards()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"groups": 0}, "groups: found 0, expected a whole number from 1 to 1000"),
        ({"groups": 2.0}, "groups: found 2.0"),
        ({"most_items": 1}, "most_items: found 1, expected a whole number from 2"),
        ({"least_gap": 0.2}, "most_gap: found 0.1, expected a length from 0.2 to 100 m"),
        ({"least_distance": math.nan}, "least_distance: found nan"),
        ({"question": 150}, "question: found 150, expected a whole number from -1000000 to 0"),
        ({"right": 0}, "right: found 0"),
        ({"last_guess": True}, "last_guess: found True"),
    ],
)
def test_rules_that_cannot_be_played_by_are_refused(changes: dict[str, float], message: str) -> None:
    with pytest.raises(StudyError) as caught:
        Rules(**changes)  # type: ignore[arg-type]
    assert str(caught.value).startswith(message)


# Groups and operators.


def test_groups_are_those_of_the_rules() -> None:
    scenes = [group_scene(RULES, default_rng(seed)) for seed in range(200)]
    assert {len(scene.items) for scene in scenes} == {2, 3, 4, 5}
    for scene in scenes:
        places = np.array([item.position for item in scene.items])
        apart = np.linalg.norm(np.diff(places, axis=0), axis=1)
        assert (apart >= 0.025 - 1e-12).all()
        assert (apart <= 0.10 + 1e-12).all()
        assert 0.5 <= places[:, 1].mean() <= 1.5
        assert len({item.vocabulary for item in scene.items}) == 1, "words tell nothing"
    assert group_scene(RULES, default_rng(3)) == scenes[3]


def test_operators_answer_questions_alone_and_may_not_know() -> None:
    problem = twins(3, p_answer_again=0.0)
    operator = Guests(unknown=0.2, bias=0.0).meet(problem, 1, default_rng(0))
    assert not any(operator.respond(Wait(), asked).words for asked in (None, 1) for _ in range(50))
    said = [operator.respond(Point(0), 0).words for _ in range(4_000)]
    share = sum(words == UNKNOWN for words in said) / len(said)
    assert share == pytest.approx(0.2, abs=4 * math.sqrt(0.16 / len(said)))
    no = sum(words in {("no",), ("nope",), ("other",), ("not",)} for words in said) / len(said)
    expected = 0.8 * 0.95 * 0.99
    assert no == pytest.approx(expected, abs=4 * math.sqrt(expected * (1 - expected) / len(said)))


def test_operators_point_off_their_item_all_the_time() -> None:
    """A bias stays for a group: the mean of many rays is off by it, where it would be off by 0 without."""
    problem = Problem(group_scene(RULES, default_rng(0)))
    off = {}
    for bias in (0.0, 0.1):
        offs = []
        for seed in range(40):
            operator = Guests(0.0, bias).meet(problem, 0, default_rng(seed))
            rays = [ray for _ in range(200) if (ray := operator.respond(Wait(), None).ray) is not None]
            mean = np.mean([ray.wrist for ray in rays], axis=0)
            offs.append(float(angles(dataclasses.replace(rays[0], wrist=tuple(mean)), problem)[0]))
        off[bias] = np.array(offs)
    assert off[0.0].max() < 0.06  # 0.15 rad over the root of 170 rays is 0.012
    assert off[0.1].mean() == pytest.approx(0.1 * math.sqrt(2 / math.pi), abs=4 * 0.06 / math.sqrt(40))


@pytest.mark.parametrize(("unknown", "bias"), [(1.1, 0.0), (-0.1, 0.0), (0.1, 0.8), (0.1, -0.1)])
def test_operators_that_cannot_be_are_refused(unknown: float, bias: float) -> None:
    with pytest.raises(StudyError, match="unknown: found" if bias == 0.0 else "bias: found"):
        Guests(unknown, bias)


# Playing.


def played(desired: int, *actions: Action) -> tuple[GroupRecord, list[tuple[Action, int | None]]]:
    operator = Silent([])
    record = play_group(twins(4), scripted(*actions), desired, operator, default_rng(0))
    return record, operator.seen


def test_a_group_goes_on_until_the_right_guess() -> None:
    record, seen = played(2, Wait(), Point(1), Pick(0), Wait(), Pick(1), Pick(2), Pick(3))
    assert record == GroupRecord(True, guesses=3, questions=1, waits=2)
    assert seen == [(Wait(), None), (Point(1), 1), (Wait(), 1)]
    assert group_score(record, RULES) == 500 - 400 - 150


def test_a_robot_that_never_guesses_does_so_after_thirty_steps() -> None:
    """Twins of whom nothing is known: it goes through them in the order of the scene."""
    record, seen = played(2)
    assert record == GroupRecord(True, guesses=3, questions=0, waits=30)
    assert len(seen) == 30


def test_a_robot_that_insists_on_a_wrong_item_ends_without_it() -> None:
    record, _ = played(2, *[Pick(0)] * 9)
    assert record == GroupRecord(False, guesses=4, questions=0)


@pytest.mark.parametrize(
    ("belief", "guessed", "expected"),
    [
        ([0.5, 0.3, 0.2], [0], [0, 0.6, 0.4]),
        ([1.0, 0.0, 0.0], [0], [0, 0.5, 0.5]),
        ([0.5, 0.5, 0.0], [0, 1], [0, 0, 1]),
        ([0.5, 0.5, 0.0], [0, 1, 2], [0.5, 0.5, 0.0]),
    ],
)
def test_a_wrong_guess_takes_its_item_out(belief: list[float], guessed: Sequence[int], expected: list[float]) -> None:
    assert without(Belief(belief), guessed).probabilities == pytest.approx(expected)


def test_live_people_are_refused() -> None:
    with pytest.raises(ModelError, match=r"^turns: found live people, expected none: Hand Me That knows [^\n]*$"):
        play_group(live(twins(2)), PaperNeverAsk(), 0, Silent([]), default_rng(0))


def test_games_repeat_by_seed_and_planners_meet_the_same_groups() -> None:
    contest = Contest(games=12, seed=4)
    first, twin = contest.standings({"a": PaperNeverAsk(), "b": PaperNeverAsk()})
    assert dataclasses.replace(twin, planner="a") == first
    assert contest.standings({"a": PaperNeverAsk()}) == [first]
    assert Contest(games=12, seed=5).standings({"a": PaperNeverAsk()}) != [first]
    assert first.games == 12
    assert first.questions == 0
    assert 0 < first.mean_score <= 2500


def test_groups_of_one_object_are_won_at_once() -> None:
    alone = Rules(least_items=1, most_items=1)
    (standing,) = Contest(games=3, rules=alone).standings({"never": PaperNeverAsk()})
    assert (standing.mean_score, standing.standard_error, standing.first) == (2500.0, 0.0, 1.0)


@pytest.mark.parametrize(("field", "value"), [("games", 0), ("games", 1.5), ("seed", -1)])
def test_a_contest_that_cannot_be_is_refused(field: str, value: int) -> None:
    with pytest.raises(StudyError, match=f"{field}: found {value}"):
        Contest(**{field: value})  # type: ignore[arg-type]

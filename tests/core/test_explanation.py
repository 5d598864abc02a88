"""Why a decision was taken: numbers that are the decision's, and sentences made from them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explain import even, explain
from fetch_pomdp.core.explanation import Explanation
from fetch_pomdp.core.observation import Parts
from fetch_pomdp.core.phrases import Figure, Phrase, phrase
from fetch_pomdp.core.planners.base import Decision, Planner, pick_values
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.scene import Scene
from tests.tables import table

PLANNERS = [ExactAnswers(width=5), ExactAnswers(depth=1), SparseSampling(), PaperNeverAsk(), PaperAlwaysAsk()]
NAN = math.nan


def explained(agent: Agent) -> tuple[Decision, Explanation]:
    decision = agent.decide()
    assert decision.explanation is not None
    return decision, decision.explanation


@pytest.mark.parametrize("planner", PLANNERS, ids=str)
@given(said=st.lists(st.sampled_from(["marker", "bowl black", "yes", "no", ""]), max_size=3), asked=st.booleans())
@settings(max_examples=15)
def test_the_numbers_are_those_of_the_decision(planner: Planner, said: list[str], asked: bool) -> None:
    agent = Agent("ambiguous", planner)
    for words in said:
        agent.observe(words)
        if asked:
            agent.did(Point(2))
    decision, why = explained(agent)
    assert why.action == decision.action
    assert why.chosen.value == pytest.approx(decision.value, abs=0, nan_ok=True)
    assert (why.wait.value, why.wait.error) == pytest.approx((decision.wait, decision.wait_error), abs=0, nan_ok=True)
    assert isinstance(why.question.action, Point)
    assert isinstance(why.pick.action, Pick)
    assert why.pick.value == max(decision.pick)
    question = why.question.action.item
    assert why.question.value == pytest.approx(decision.point[question], abs=0, nan_ok=True)
    if not np.isnan(decision.point).any():
        assert why.question.value == max(decision.point)
        assert why.gain == max(decision.point) - max(decision.wait, *decision.pick)
    else:
        assert math.isnan(why.gain)
        assert math.isnan(why.gain_error)
    if decision.point_error is not None:
        assert why.question.error == decision.point_error[question]
    assert why.belief == agent.belief[why.item]
    assert why.rival is not None
    assert why.rival.item != why.item
    assert why.rival.belief == max(np.delete(agent.belief, why.item)) == agent.belief[why.rival.item]
    assert why.rival.log_odds.total == pytest.approx(math.log(why.belief / why.rival.belief), abs=1e-9)
    assert str(why)


def test_planners_explain_nothing_and_the_agent_does() -> None:
    agent = Agent("ambiguous", PaperNeverAsk())
    plain = agent.planner.decide(agent.problem, Belief.uniform(6), None, rng=np.random.default_rng((0, 0)))
    assert plain.explanation is None
    decision, why = explained(agent)
    assert (decision.action, decision.wait, decision.pick.tolist()) == (plain.action, plain.wait, plain.pick.tolist())
    expected = explain(plain, Belief.uniform(6), agent.evidence, agent.scene)
    assert str(why) == str(expected)


# Sentences, on a table of named items.

SCENE = Scene.load("ambiguous")
EQUAL = [0.05, 0.05, 0.4, 0.4, 0.05, 0.05]
LEADING = [0.05, 0.05, 0.6, 0.2, 0.05, 0.05]
SURE = [0.01, 0.01, 0.05, 0.91, 0.01, 0.01]
CERTAIN = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]


def reason(
    action: Action,
    belief: list[float],
    values: tuple[float, float] = (NAN, NAN),
    *,
    error: float = 0.0,
    unanswered: int | None = None,
    words: dict[int, float] | None = None,
    pointing: dict[int, float] | None = None,
) -> str:
    """The sentence for an action; values: of a wait and of asking about each item. words, pointing: log-likelihoods."""
    return str(why(action, belief, values, error, unanswered, words or {}, pointing or {}))


def why(
    action: Action,
    belief: list[float],
    values: tuple[float, float],
    error: float,
    unanswered: int | None,
    words: dict[int, float],
    pointing: dict[int, float],
) -> Explanation:
    count = len(belief)
    sums = [np.array([part.get(item, 0.0) for item in range(count)]) for part in (words, pointing)]
    with np.errstate(divide="ignore"):
        log = np.log(belief)
    evidence = Evidence.none(log - sums[0] - sums[1]).plus(Parts(sums[0], np.zeros(count), sums[1]), answered=False)
    if unanswered is not None:
        evidence = evidence.asked(unanswered)
    pick = 22.5 * np.array(belief) - 12.5
    decision = Decision(action, values[0], np.full(count, values[1]), pick, error, np.full(count, error))
    return explain(decision, Belief(belief), evidence, SCENE)


def test_asks_about_equal_rivals() -> None:
    expected = "asks about marker-2: it and marker-1 are equally likely; a wrong pick costs 12.5, the question 6"
    assert reason(Point(3), EQUAL) == expected
    expected += ", and asking is worth 1.25 more than waiting"
    assert reason(Point(3), EQUAL, (0.5, 1.75)) == expected
    assert reason(Point(3), EQUAL, (0.5, 1.75), error=1.0) == expected + ", a close call"
    worse = "a wrong pick costs 12.5, the question 6, though waiting is worth 2.00 more"
    assert reason(Point(3), EQUAL, (3.0, 1.0)).endswith(f"; {worse}")


def test_asks_about_a_leader_or_a_lesser_item() -> None:
    prices = "; a wrong pick costs 12.5, the question 6"
    assert reason(Point(2), LEADING) == "asks about marker-1: it is 3 times as likely as marker-2" + prices
    assert reason(Point(3), LEADING) == "asks about marker-2: marker-1 is 3 times as likely as it" + prices
    near = [0.1, 0.1, 0.3, 0.26, 0.12, 0.12]
    assert reason(Point(3), near) == "asks about marker-2: it and marker-1 are almost equally likely" + prices
    three = [0.3, 0.3, 0.3, 0.04, 0.03, 0.03]
    assert reason(Point(1), three) == "asks about bowl-2: it and 2 others are equally likely" + prices
    assert reason(Point(0), [1 / 6] * 6) == "asks about bowl-1: nothing tells the 6 items apart yet" + prices
    assert reason(Point(2), CERTAIN) == "asks about marker-1: marker-2 is over 1,000 times as likely as it" + prices


def test_asks_again() -> None:
    expected = "asks about marker-1: the question about it is still unanswered; a wrong pick costs 12.5, the question 6"
    assert reason(Point(2), EQUAL, unanswered=2) == expected
    assert "unanswered" not in reason(Point(3), EQUAL, unanswered=2)


def test_speech_and_pointing_disagree() -> None:
    spoken, pointed, faint = {2: math.log(6.0)}, {0: math.log(8.0)}, {0: math.log(1.9)}
    belief = [0.44, 0.05, 0.33, 0.08, 0.05, 0.05]
    said = "speech favours marker-1 6 to 1, pointing bowl-1 8 to 1"
    asks = f"asks about bowl-1: {said}; a wrong pick costs 12.5, the question 6"
    assert reason(Point(0), belief, words=spoken, pointing=pointed) == asks
    assert reason(Wait(), belief, (1.0, 0.5), words=spoken, pointing=pointed).startswith(f"waits: {said}; ")
    assert reason(Pick(2), belief, words=spoken, pointing=pointed).startswith(f"picks marker-1: {said}; ")
    assert "favours" not in reason(Point(0), belief, words=spoken, pointing=faint)


def test_waits() -> None:
    nothing = "waits: nothing tells the 6 items apart yet; "
    expected = nothing + "waiting is worth -1.97, asking -4.66 and picking -8.75"
    assert reason(Wait(), [1 / 6] * 6, (-1.97, -4.66)) == expected
    assert reason(Wait(), [1 / 6] * 6) == nothing + "a wrong pick costs 12.5, the wait 1"
    equal = "waits: marker-1 and marker-2 are equally likely; waiting is worth "
    assert reason(Wait(), EQUAL, (0.27, NAN)) == equal + "0.27 and picking -3.50"
    assert reason(Wait(), EQUAL, (0.27, -5.0)) == equal + "0.27, picking -3.50 and asking -5.00"
    assert (
        reason(Wait(), EQUAL, (0.27, 0.001), error=0.2) == equal + "0.27, asking 0.00 and picking -3.50, a close call"
    )
    assert reason(Wait(), EQUAL, (0.27, -0.001)) == equal + "0.27, asking 0.00 and picking -3.50"
    unanswered = "waits: the question about marker-2 is still unanswered; waiting is worth 2.00, asking 0.00 and "
    assert reason(Wait(), EQUAL, (2.0, 0.0), unanswered=3).startswith(unanswered)


def test_picks() -> None:
    words = {3: math.log(91 / 5)}
    known = "picks marker-2: it is 91% likely"
    assert reason(Pick(3), SURE) == known + "; picking is worth 7.98"
    assert reason(Pick(3), SURE, (5.0, 3.0)) == known + "; picking is worth 7.98, waiting 5.00 and asking 3.00"
    assert reason(Pick(3), SURE, words=words) == known + ", mostly by what was said; picking is worth 7.98"
    assert reason(Pick(3), SURE, pointing=words) == known + ", mostly by the pointing; picking is worth 7.98"
    assert reason(Pick(3), CERTAIN) == "picks marker-2: it is certain; picking is worth 10.00"
    almost = [0.0, 0.0, 0.0002, 0.9998, 0.0, 0.0]
    assert reason(Pick(3), almost) == "picks marker-2: it is all but certain; picking is worth 10.00"
    assert reason(Pick(3), [0.0, 0.0, 0.004, 0.996, 0.0, 0.0]).startswith("picks marker-2: it is 99.6% likely; ")
    assert reason(Pick(3), EQUAL, (-4.0, NAN)) == (
        "picks marker-2: it and marker-1 are equally likely; picking is worth -3.50 and waiting -4.00"
    )


def test_picks_by_an_answer() -> None:
    agent = Agent(table([["cup"], ["cup"]]).scene)
    agent.did(Point(0))
    agent.observe("no")
    assert str(explained(agent)[1]).startswith("picks item-1: it is 99.0% likely, mostly by the answers; ")


def test_the_only_item() -> None:
    agent = Agent(table([["cup"]]).scene)
    decision, found = explained(agent)
    assert decision.action == Pick(0)
    assert found.rival is None
    assert str(found).startswith("picks item-0: it is the only item; picking is worth 10.00, ")


def test_a_planner_that_values_nothing() -> None:
    class Stubborn:
        def decide(self, problem: Any, belief: Any, asked: int | None, *, rng: Any, phase: int = 0) -> Decision:
            nothing = np.full(problem.n_items, NAN)
            return Decision(Pick(2), NAN, nothing, nothing)

    agent = Agent("ambiguous", Stubborn())
    found = explained(agent)[1]
    assert str(found) == "picks marker-1: nothing tells the 6 items apart yet"
    assert [math.isnan(number) for number in (found.gain, found.margin, found.margin_error)] == [True] * 3
    assert not found.close


def test_a_planner_that_values_some_questions() -> None:
    point = np.array([NAN, 1.0, 3.0, NAN, NAN, NAN])
    decision = Decision(Wait(), 4.0, point, pick_values(np.array(EQUAL), Agent("ambiguous").problem))
    found = explain(decision, Belief(EQUAL), Evidence.none(np.log(EQUAL)), SCENE)
    assert (found.question.action, found.question.value, found.gain) == (Point(2), 3.0, -1.0)


@pytest.mark.parametrize(
    ("rewards", "prices"),
    [
        ({"pick_wrong": -40, "point": -2.5}, "a wrong pick costs 40, the question 2.5"),
        ({"pick_wrong": 0, "point": 0, "wait": 0}, "a wrong pick costs nothing, the question nothing"),
        ({"pick_wrong": 3}, "a wrong pick earns 3, the question 6"),
        ({"pick_wrong": -1e6, "point": -12_345.0}, "a wrong pick costs 1,000,000, the question 12,345"),
    ],
)
def test_prices_are_those_of_the_scene(rewards: dict[str, float], prices: str) -> None:
    agent = Agent("ambiguous", PaperAlwaysAsk(), rewards=rewards)
    agent.observe("marker")
    assert str(explained(agent)[1]) == f"asks about marker-1: it and marker-2 are equally likely; {prices}"


def test_digits_follow_the_size_of_the_rewards() -> None:
    cheap = {"pick_correct": 1e-3, "pick_wrong": -1e-3, "point": -1e-4, "wait": -1e-4}
    dear = {"pick_correct": 1e5, "pick_wrong": -1e5}
    # Each pick of six is right once in six: (1 - 5) / 6 of the stake.
    for rewards, expected in ((cheap, "-0.000667"), (dear, "-66667")):
        agent = Agent("ambiguous", ExactAnswers(depth=1), rewards=rewards)
        assert expected in str(explained(agent)[1])


def test_a_thousand_items_stay_a_sentence() -> None:
    agent = Agent(table([["cup"]] * 500 + [["pot"]] * 500, p_g=0.0).scene, PaperAlwaysAsk())
    agent.observe("cup")
    expected = "asks about item-0: it and 499 others are equally likely; a wrong pick costs 12.5, the question 6"
    assert str(explained(agent)[1]) == expected


def test_a_sentence_is_made_of_phrases_for_any_language() -> None:
    found = why(Pick(3), SURE, (NAN, NAN), 0.0, None, {3: math.log(91 / 5)}, {}).phrase()
    known = Phrase("why_likely", {"item": Phrase("why_it", {"item": "marker-2"}), "chance": Figure("91%")})
    stake = Phrase("why_worth_one", {"doing": Phrase("why_picking", {}), "value": Figure("7.98")})
    assert found.key == "why_sentence"
    assert found.values["deed"] == Phrase("why_picks", {"item": "marker-2"})
    reason = {"known": Phrase("why_by_words", {"known": known}), "stake": stake}
    assert found.values["reason"] == Phrase("why_reason", reason)


def test_a_phrase_of_no_template_is_refused() -> None:
    with pytest.raises(KeyError, match="why_not"):
        phrase("why_not")


def test_beliefs_are_even() -> None:
    assert even(np.array([0.505, 0.495]))
    assert not even(np.array([0.51, 0.49]))
    assert not even(np.array([1.0]))

"""What is said and shown after a hand-over, and what the robot says to people whom it does not understand."""

from __future__ import annotations

import math

import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.interaction import (
    ASKING_AGAIN,
    CANCELLED,
    FAILED,
    LISTENING,
    NOT_UNDERSTOOD,
    OBJECTED,
    Timing,
    interact,
    not_understood,
)
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.errors import ModelError
from tests.core.scripted import Script
from tests.core.staged import Arm, Ears, Eyes, acted, frame, observed, towards
from tests.oracles.model import posterior
from tests.tables import world_of

ON = Timing(after=3.0)


def run(
    script: Script, ears: Ears, eyes: Eyes | None = None, arm: Arm | None = None, timing: Timing = ON, **agent: object
) -> tuple[Agent, Arm, list[Event]]:
    mind, body = Agent("ambiguous", script, **agent), arm or Arm()  # type: ignore[arg-type]
    return mind, body, list(interact(mind, body, ears, eyes, timing=timing))


def said(arm: Arm) -> list[str]:
    return [what.removeprefix("say ") for what in arm.done if what.startswith("say ")]


# An item given back.


def test_what_is_given_back_is_taken_back_and_not_handed_over_again() -> None:
    """The pick of item 2 ends at 0; "no, wrong one" is heard in the second after it."""
    agent, arm, events = run(Script(Pick(2), Pick(3)), Ears(("no", 0.5), ("wrong", 0.6), ("one", 0.7)))
    assert arm.done == ["pick marker-1", f"say {OBJECTED}", "take back marker-1", "pick marker-2"]
    assert [(event.action, event.outcome) for event in acted(events)] == [
        (Pick(2), Outcome.DONE), (Pick(2), Outcome.RETURNED), (Pick(3), Outcome.DONE)
    ]  # fmt: skip
    assert [type(event) for event in events] == [Acted, Acted, Observed, Acted]
    assert [event.time for event in events] == [0.0, 1.0, 1.0, 1.0]
    (objection,) = observed(events)
    assert not objection.anew
    assert agent.handed == 3
    assert agent.asked == 2
    assert agent.belief[2] < 0.001


def test_what_was_learnt_is_kept_when_an_item_is_given_back() -> None:
    """The belief is that of "marker" and then of a "no" to a question about item 2 (the oracle's)."""
    ears = Ears(("marker", 0.5), ("wrong", 1.4), ("one", 1.5))
    script = Script(Wait(), Pick(2), Wait())
    agent, _, events = run(script, ears)
    assert [event.observation.words for event in observed(events)] == [("marker",), ("no",), ()]
    assert script.asked == [None, None, 2, 2]
    world, belief = world_of(agent.problem), [1 / 6] * 6
    for words, asked in [(["marker"], None), (["no"], 2), ([], 2)]:
        belief = posterior(belief, words, None, asked, world)
    assert agent.belief == pytest.approx(belief)
    assert agent.belief.argmax() == 3


def test_words_beside_the_objection_count() -> None:
    _, arm, events = run(Script(Pick(0), Pick(2)), Ears(("no", 0.3), ("the", 0.4), ("marker", 0.5)))
    assert observed(events)[0].observation.words == ("no", "the", "marker")
    assert "take back bowl-1" in arm.done


def test_it_may_be_given_back_again_and_again() -> None:
    ears = Ears(("no", 0.5), ("no", 1.5), ("no", 2.5))
    agent, arm, _ = run(Script(Pick(2), Pick(3), Pick(4), Pick(5)), ears)
    assert [what for what in arm.done if not what.startswith("say")] == [
        "pick marker-1", "take back marker-1", "pick marker-2", "take back marker-2", "pick spoon-1",
        "take back spoon-1", "pick spoon-2",
    ]  # fmt: skip
    assert agent.handed == 5
    assert agent.belief[2:5].max() < 0.01


@pytest.mark.parametrize("words", [("no", "that's", "all"), ("no", "yes", "that's", "right")])
def test_who_says_no_and_means_another_thing_keeps_it(words: tuple[str, ...]) -> None:
    agent, arm, _ = run(Script(Pick(2)), Ears(*((word, 0.5 + 0.1 * place) for place, word in enumerate(words))))
    assert "take back marker-1" not in arm.done
    assert agent.handed == 2


# The end.


@pytest.mark.parametrize(
    ("ears", "until"),
    [
        (Ears(), 3.0),
        (Ears(("thanks", 0.5)), 4.0),
        (Ears(("thank", 1.2), ("you", 1.3)), 5.0),
        (Ears(("yes", 2.5)), 6.0),
        (Ears(("thanks", 0.5), ("bye", 3.5)), 7.0),
        (Ears(("thanks", 3.5)), 3.0),  # too late
    ],
)
def test_silence_ends_it(ears: Ears, until: float) -> None:
    """Three seconds of it, listened for a second at a time."""
    agent, arm, events = run(Script(Pick(2)), ears)
    assert events == acted(events)
    assert len(events) == 1
    assert ears.asked_until[-1] == until
    assert "take back marker-1" not in arm.done
    assert agent.handed == 2


def test_without_it_a_hand_over_is_the_end() -> None:
    ears = Ears(("no", 0.5))
    _, arm, events = run(Script(Pick(2)), ears, timing=Timing())
    assert len(events) == 1
    assert arm.done == ["pick marker-1"]
    assert ears.asked_until == []


@pytest.mark.parametrize("after", [-1.0, math.nan])
def test_a_time_after_a_hand_over_that_is_none(after: float) -> None:
    with pytest.raises(ModelError, match="after a hand-over, expected 0 or more"):
        Timing(after=after)
    assert Timing(after=math.inf).after == math.inf


# Another request.


def test_a_second_request_begins_anew() -> None:
    """Between them is a question with its answer: nothing of it is left, and the words that begin it count."""
    ears = Ears(("marker", 0.5), ("yes", 3.5), ("the", 4.2), ("bowl", 4.4))
    script = Script(Wait(), Point(2), Pick(2), Wait(), Pick(0))
    agent, arm, events = run(script, ears, model={"turns": {}})
    begun = observed(events)[2]
    assert begun.anew
    assert begun.observation.words == ("the", "bowl")
    assert script.asked == [None, None, 2, None, None]
    assert [what for what in arm.done if what.startswith("pick")] == ["pick marker-1", "pick bowl-1"]
    again = Agent("ambiguous", Script(), model={"turns": {}})
    again.observe("the bowl")
    again.did(Wait())
    again.observe("")
    assert agent.belief == pytest.approx(again.belief)
    assert agent.phase == again.phase > 0
    assert agent.asked is None


@pytest.mark.parametrize(
    ("said", "anew"),
    [
        ("hand me the other marker", True), ("and now the other one", True), ("gib mir auch den anderen", True),
        ("the other one", False), ("no give me the other one", False), ("not that one i want the other", False),
        ("ich will den anderen nicht den", False), ("wrong one hand me the other", False),
        ("nah give me the other one", False),
    ],
)  # fmt: skip
def test_another_one_is_wanted_beside_the_first_or_in_its_place(said: str, anew: bool) -> None:
    ears = Ears(*((word, 0.1 + 0.05 * place) for place, word in enumerate(said.split())))
    _, arm, events = run(Script(Pick(2), Pick(3)), ears)
    assert observed(events)[0].anew is anew
    assert ("take back marker-1" in arm.done) is not anew
    assert arm.done[-1] == "pick marker-2"


def test_yes_beside_a_second_request_is_no_answer_to_the_last_question() -> None:
    ears = Ears(("yes", 2.5), ("yes", 3.2), ("spoon", 3.4))
    agent, _, events = run(Script(Point(2), Pick(2), Wait()), ears)
    assert [event.anew for event in observed(events)] == [False, True, False]
    assert agent.belief[2] < 0.1
    assert agent.belief[4] == pytest.approx(agent.belief[5])
    assert agent.belief[4] > 0.3


def test_an_agent_with_a_prior_begins_with_it() -> None:
    prior = [0.5, 0.1, 0.1, 0.1, 0.1, 0.1]
    agent, _, _ = run(Script(Pick(2), Wait()), Ears(("marker", 0.5)), prior=prior)
    again = Agent("ambiguous", Script(), prior=prior)
    again.observe("marker")
    again.observe("")
    assert agent.belief == pytest.approx(again.belief)


def pointing(*times: float) -> Eyes:
    return Eyes(*(frame(time, towards(0.075)) for time in times))


def test_an_arm_that_was_lowered_and_points_again_begins_anew() -> None:
    """It points at item 3 until 1.9 s; then it is down for a second."""
    timing = Timing(after=6.0)
    _, arm, events = run(Script(Pick(2), Pick(3)), Ears(), pointing(0.5, 1.5, 1.9, 3.5), timing=timing)
    (begun,) = observed(events)
    assert begun.anew
    assert begun.time == 4.0
    assert begun.observation.ray is not None
    assert arm.done == ["pick marker-1", "pick marker-2"]


def test_an_arm_that_is_still_up_begins_nothing() -> None:
    agent, arm, events = run(Script(Pick(2)), Ears(), pointing(0.5, 1.5, 2.5))
    assert observed(events) == []
    assert arm.done == ["pick marker-1"]
    assert agent.handed == 2


def test_words_with_an_arm_that_is_still_up_begin_anew_with_both() -> None:
    _, _, events = run(Script(Pick(2), Pick(3)), Ears(("marker", 0.6)), pointing(0.5))
    (begun,) = observed(events)
    assert begun.anew
    assert begun.observation.words == ("marker",)
    assert begun.observation.ray is not None


def test_each_request_has_most_steps_of_its_own() -> None:
    """Of three: two waits and a pick, twice, and then three waits."""
    waits = [Wait()] * 9
    script = Script(Wait(), Wait(), Pick(2), Wait(), Wait(), Pick(3), *waits)
    ears = Ears(("bowl", 2.5), ("spoon", 5.5))
    events = list(interact(Agent("ambiguous", script), Arm(), ears, None, timing=ON, most_steps=3))
    assert [type(event.action) for event in acted(events)] == [Wait, Wait, Pick, Wait, Wait, Pick, Wait, Wait, Wait]


def test_an_agent_that_has_handed_over_listens_on_first() -> None:
    """An interaction that is resumed: no decision before the person has said what comes next."""
    agent, arm = Agent("ambiguous", Script(Pick(3))), Arm()
    agent.did(Pick(2))
    ears = Ears(("no", 1.5))
    events = list(interact(agent, arm, ears, None, timing=Timing(after=3.0, before=5.0)))
    assert ears.asked_until[:2] == [1.0, 2.0], "nothing is listened for before the first decision"
    assert [event.outcome for event in acted(events)] == [Outcome.RETURNED, Outcome.DONE]
    assert arm.done[1:] == ["take back marker-1", "pick marker-2"]
    silent = Agent("ambiguous", Script())
    silent.did(Pick(2))
    assert list(interact(silent, Arm(), Ears(), None)) == []
    assert silent.handed == 2


# What people are told.


def test_never_mind_begins_anew_and_says_so() -> None:
    ears = Ears(("marker", 0.5), ("never", 1.3), ("mind", 1.5))
    script = Script(Wait(), Point(2), Wait(), Wait())
    agent, arm, events = run(script, ears, timing=Timing(question=1.0))
    assert observed(events)[1].observation.words == ("cancel",)
    assert said(arm) == [CANCELLED]
    assert agent.belief == pytest.approx([1 / 6] * 6)
    assert script.asked == [None, None, None, None, None]


def test_never_mind_beside_a_request_is_the_new_one() -> None:
    ears = Ears(("marker", 0.5), ("never", 1.2), ("mind", 1.3), ("the", 1.4), ("bowl", 1.5))
    agent, arm, _ = run(Script(Wait(), Wait()), ears, timing=Timing())
    assert said(arm) == []
    assert agent.belief[0] + agent.belief[1] > 0.6
    assert agent.belief[2] < 0.15


def test_never_mind_after_a_hand_over_leaves_it() -> None:
    agent, arm, events = run(Script(Pick(2)), Ears(("never", 0.3), ("mind", 0.5)))
    assert len(events) == 1
    assert said(arm) == [CANCELLED]
    assert agent.handed == 2


@pytest.mark.parametrize("phrase", ["I don't know", "what"])
def test_who_does_not_know_or_did_not_hear_is_not_told_that_nothing_was_understood(phrase: str) -> None:
    words = [(word, 2.0 + 0.1 * place) for place, word in enumerate(phrase.split())]
    agent, arm, events = run(Script(Point(2), *[Wait()] * 6), Ears(*words), timing=Timing())
    assert observed(events)[0].observation.words in {("unsure",), ("pardon",)}
    assert agent.belief == pytest.approx([1 / 6] * 6)
    assert said(arm) == [], "and a question is open, so that the robot's listening is no news"


def test_words_that_nobody_knows_are_answered_with_those_that_are() -> None:
    agent, arm, _ = run(Script(Wait(), Wait()), Ears(("the", 0.4), ("gadget", 0.6)), timing=Timing())
    words = sorted({word for item in agent.scene.items for word in item.vocabulary})
    assert said(arm) == [f"I did not understand that. I know: {', '.join(words)}."]


def test_the_words_of_a_large_scene_are_cut_short() -> None:
    words = [f"w{number}" for number in range(13)]
    assert not_understood(words[:12]) == NOT_UNDERSTOOD + ", ".join(words[:12]) + "."
    assert not_understood(words) == NOT_UNDERSTOOD + ", ".join(words[:12]) + ", ..."


@pytest.mark.parametrize(
    "text",
    ["please", "can you hand me that", "uh", "um I would like", "thank you", "thanks", "the marker gadget", "yes"],
)
def test_courtesy_hesitation_and_what_is_understood_in_part_are_not(text: str) -> None:
    for script in (Script(Wait(), Wait()), Script(Pick(2))):
        words = [(word, 0.3 + 0.05 * place) for place, word in enumerate(text.split())]
        _, arm, _ = run(script, Ears(*words))
        assert not any(NOT_UNDERSTOOD in what for what in said(arm))


@pytest.mark.parametrize("text", ["perfect thanks", "okay", "right", "correct thank you"])
def test_who_praises_a_hand_over_is_understood(text: str) -> None:
    words = [(word, 0.3 + 0.05 * place) for place, word in enumerate(text.split())]
    _, arm, _ = run(Script(Pick(2)), Ears(*words))
    assert said(arm) == []


def test_after_a_hand_over_too() -> None:
    _, arm, events = run(Script(Pick(2)), Ears(("gadget", 0.5)))
    assert said(arm)[0].startswith(NOT_UNDERSTOOD)
    assert len(events) == 1


LATE = {"turns": {"hesitation": 1}}  # a question is late after a quiet step
BEFORE = Timing(before=1.0)  # live people have begun before the robot decides


def requested() -> Ears:
    return Ears(("marker", 0.5))


def test_the_third_asking_says_what_to_answer_first() -> None:
    script = Script(Point(2), Wait(), Point(2), Wait(), Point(2), Wait(), Point(2))
    _, arm, _ = run(script, requested(), timing=BEFORE, model=LATE)
    assert [what for what in arm.done if what != "pick bowl-1"] == [
        "point marker-1", "point marker-1", f"say {ASKING_AGAIN}", "point marker-1", f"say {ASKING_AGAIN}",
        "point marker-1",
    ]  # fmt: skip


def test_a_question_asked_again_before_it_is_late_is_not_in_other_words() -> None:
    script = Script(Point(2), Point(2), Point(2), Point(2))
    _, arm, _ = run(script, requested(), timing=BEFORE, model=LATE)
    assert said(arm) == []
    assert arm.done.count("point marker-1") == 4


def test_the_robot_says_that_it_listens_unless_a_question_is_open() -> None:
    """Four seconds of waits without a word: twice in nine, and none while somebody is asked."""
    _, arm, _ = run(Script(*[Wait()] * 9), Ears(), timing=Timing())
    assert said(arm) == [LISTENING] * 2
    _, arm, _ = run(Script(Point(2), *[Wait()] * 9), Ears(), timing=Timing())
    assert said(arm) == []
    _, arm, _ = run(Script(Point(2), *[Wait()] * 9), Ears(("no", 2.5)), timing=Timing())
    assert said(arm) == [LISTENING] * 2


def test_a_pick_that_failed_is_told_and_listened_after() -> None:
    _, arm, _ = run(Script(Pick(2), Pick(2)), Ears(), arm=Arm(Outcome.FAILED))
    assert arm.done == ["pick marker-1", f"say {FAILED}", "pick marker-1"]

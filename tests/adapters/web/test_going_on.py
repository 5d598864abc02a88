"""What a page is told after a hand-over, after a reload, and by whom who was not understood."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from fetch_pomdp.adapters.web import robot
from fetch_pomdp.adapters.web.server_messages import SENTENCES, say_message
from fetch_pomdp.core.interaction import NOT_UNDERSTOOD
from tests.adapters.web.test_server import House, Page, house, house_of

__all__ = ["house"]
MARKERS = {"marker-1", "marker-2"}


@pytest.fixture(autouse=True)
def quick_body(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ARM", "SPEAK", "GRASP", "CARRY"):
        monkeypatch.setattr(robot, name, 0.05)


def handed(page: Page) -> str:
    """Say what the robot that never asks hands over at once, and return what that is."""
    page.send({"type": "typed", "text": "green marker expo pen"})
    item: str = page.next("action", action="pick", outcome="done")["item"]
    return item


def test_what_was_handed_over_is_taken_back_and_the_other_is_brought(house: House) -> None:
    page = house.page(planner="never")
    first = handed(page)
    page.send({"type": "typed", "text": "no, wrong one"})
    assert page.next("say")["key"] == "objected"
    returned = page.next("action")
    assert (returned["action"], returned["item"], returned["outcome"]) == ("pick", first, "returned")
    assert page.next("observed")["begun"]
    assert {page.next("action", action="pick", outcome="done")["item"]} == MARKERS - {first}


def test_a_second_request_begins_anew(house: House) -> None:
    page = house.page(planner="never")
    first = handed(page)
    page.send({"type": "typed", "text": "now hand me the silver spoon"})
    assert page.next("observed")["anew"]
    belief = page.next("belief", provisional=False)["belief"]
    assert belief[first] == pytest.approx(belief["bowl-1"], rel=0.1), "of the first request nothing is left"
    assert page.next("action", action="pick", outcome="done")["item"].startswith("spoon")


def test_thanks_are_no_request_and_what_nobody_knows_is_answered(house: House) -> None:
    page = house.page(planner="never")
    handed(page)
    page.send({"type": "typed", "text": "thanks a lot"})
    page.send({"type": "typed", "text": "never mind"})
    assert page.next("say")["key"] == "cancelled"
    page.send({"type": "typed", "text": "blorb"})
    said = page.next("say")
    assert said["key"] == "not_understood"
    assert said["words"] == "black, bowl, container, expo, green, marker, metal, pen, plastic, silver, spoon, utensil."


@pytest.mark.parametrize("message", [{"type": "typed", "text": "no, not this one"}, "an arm"])
def test_who_comes_back_after_a_hand_over_goes_on(tmp_path: Path, message: Any) -> None:
    with house_of(data=tmp_path) as house:
        page = house.page(planner="never")
        secret = page.next("welcome")["resume"]
        item = handed(page)
    with house_of(data=tmp_path) as house:  # another server
        page = house.page(resume=secret)
        welcome = page.next("welcome")
        assert (welcome["picked"], welcome["asked"], welcome["begun"]) == (item, None, False)
        if message == "an arm":  # whoever points anew wants another thing
            page.send({"type": "ray", "head": [0, 0, 1.6], "wrist": [0.0675, 0.576, 1.447]})
            assert page.next("observed")["anew"]
        else:
            page.send(message)
            assert page.next("action", action="pick")["outcome"] == "returned"


def test_who_comes_back_during_a_question_is_told_of_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with house_of(data=tmp_path) as house:
        page = house.page()
        welcome = page.next("welcome")
        assert (welcome["asked"], welcome["begun"]) == (None, False)
        page.send({"type": "typed", "text": "green marker"})
        assert page.next("observed")["asked"] is None
        asked = page.next("action", action="point")
        assert asked["asked"] == asked["item"]
        page.send({"type": "typed", "text": "the expo"})
        assert page.next("observed")["asked"] == asked["item"], "that was no answer"
        monkeypatch.setattr(robot, "ARM", 1e6)  # however long it takes to leave, no more is asked
    with house_of(data=tmp_path) as house:
        page = house.page(resume=welcome["resume"])
        back = page.next("welcome")
        assert (back["asked"], back["begun"]) == (asked["item"], True)
        page.send({"type": "typed", "text": "yes"})
        assert page.next("observed")["asked"] is None


def test_items_are_called_by_their_labels(house: House) -> None:
    page = house.page()
    table = page.next("welcome")["scene"]["items"]
    assert table[4] == {**table[4], "id": "spoon-1", "vocabulary": ["spoon", "silver", "metal", "utensil"]}
    page.send({"type": "typed", "text": "spoon 1"})
    observed = page.next("observed")
    assert (observed["unknown"], observed["reading"]) == ([], {"meaning": "spoon, spoon-1", "whose": False})
    assert page.next("belief", provisional=False)["belief"]["spoon-1"] > 0.9


def test_every_sentence_of_the_robot_has_a_sound_and_a_translation(house: House) -> None:
    texts = json.loads((files("fetch_pomdp.adapters.web") / "page" / "texts.json").read_text(encoding="utf-8"))
    for key, sentence in SENTENCES.items():
        assert say_message(sentence, audible=True)["audio"] == f"voice/{key}.wav"
        assert texts["en"][key].partition(" I know")[0] == sentence
        assert house.client.get(f"/voice/{key}.wav").headers["content-type"] == "audio/wav"
    assert texts["en"]["not_understood"].startswith(NOT_UNDERSTOOD)
    said = say_message(f"{NOT_UNDERSTOOD}cup, pot.", audible=True)
    assert (said["audio"], said["words"]) == ("voice/not_understood.wav", "cup, pot.")


def test_a_question_in_other_words_is_asked_when_the_arm_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, "SPEAK_AGAIN", 0.05)
    said: list[str] = []
    body = robot.PageRobot(said.append)
    item: Any = None
    for sentence in (SENTENCES["asking_again"], "Hello."):
        body.say(sentence)
        body.point(item)
    assert said == [SENTENCES["asking_again"], "Hello.", "This one?"]

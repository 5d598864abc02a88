"""Whole interactions in a real browser."""

from __future__ import annotations

import json
import re
import wave
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, expect

from tests.e2e.conftest import PATIENCE, Person, Server

pytestmark = pytest.mark.browser
Visit = Callable[..., Person]
Serve = Callable[..., Server]
MARKERS = {"marker-1", "marker-2"}


def share(person: Person, item: str) -> float:
    """The belief in an item (0 to 100), as its label shows it."""
    return float(person.find(f"#items [data-item={item}] .percent").inner_text().removesuffix("%"))


def test_a_request_a_question_an_answer_a_hand_over_and_once_more(visit: Visit) -> None:
    person = visit()
    person.say("hand me the marker")
    asked = person.asked_about()
    assert asked in MARKERS
    expect(person.find("#bubble")).to_have_text("This one?")
    expect(person.find("#spoken")).to_have_text("This one?")
    person.find("[data-say=no]").click()
    assert {person.got()} == MARKERS - {asked}
    assert share(person, person.got()) > 50 > share(person, asked)
    assert "worth" in person.find("#why").inner_text()
    person.find("#again").click()
    expect(person.find("#log li")).to_have_count(0)
    assert share(person, "marker-1") == 17


def test_the_keyboard_is_enough(visit: Visit) -> None:
    person = visit()
    label = person.find("#items [data-item=spoon-2]")
    for _ in range(20):
        person.page.keyboard.press("Tab")
        if label.evaluate("element => element === document.activeElement"):
            break
    person.page.keyboard.press("Enter")
    expect(person.find("#log")).to_contain_text("You pointed at the table", timeout=PATIENCE)
    assert share(person, "spoon-2") > share(person, "bowl-1")
    person.find("#say").focus()
    person.page.keyboard.type("silver spoon")
    person.page.keyboard.press("Enter")
    expect(person.find("#log")).to_contain_text("silver spoon", timeout=PATIENCE)


def test_pointing_with_the_mouse_moves_the_bars_at_once(visit: Visit) -> None:
    person = visit()
    person.point_with_the_mouse("bowl-1")
    assert share(person, "bowl-1") > share(person, "spoon-2")


def test_a_hand_over_that_is_stopped(visit: Visit) -> None:
    person = visit()
    person.find("#options").click()
    person.find("#planner").select_option("never")
    person.find("#options").click()
    expect(person.find("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)
    person.say("the green expo marker pen")
    expect(person.find("#items .about")).to_have_count(1, timeout=PATIENCE)
    person.find("#stop").click()
    expect(person.find("#log")).to_contain_text("and stopped", timeout=PATIENCE)
    expect(person.find("#spoken")).to_have_text("All right, not that one.")


def test_two_people_at_once_hear_nothing_of_each_other(visit: Visit) -> None:
    one, other = visit(), visit()
    one.say("the silver spoon")
    other.say("the black bowl")
    assert one.asked_about().startswith("spoon")
    assert other.asked_about().startswith("bowl")
    assert "bowl" not in one.log()
    assert "spoon" not in other.log()
    assert share(other, "spoon-1") < share(one, "spoon-1")


def test_a_killed_server_loses_nothing_that_was_shown(visit: Visit, serve: Serve) -> None:
    server = serve()
    person = visit(server)
    person.say("hand me the marker")
    asked = person.asked_about()
    before = person.log().splitlines()
    server.kill()
    (log,) = server.data.iterdir()
    events = [json.loads(line) for line in log.read_text().splitlines()]
    assert [event["item"] for event in events if event.get("action") == "point"] == [asked]
    expect(person.find("#state")).to_contain_text("lost", timeout=PATIENCE)
    server.start()
    expect(person.find("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)
    assert [line.partition(" →")[0] for line in before] == [
        line.partition(" →")[0] for line in person.log().splitlines()
    ]
    person.say("no")
    assert {person.got()} == MARKERS - {asked}


def test_a_table_is_edited_saved_and_opened(visit: Visit, tmp_path: Path) -> None:
    person = visit()
    person.find("#edit").click()
    person.find("#rows fieldset").nth(0).locator("input").nth(1).fill("yellow, teapot")
    with person.page.expect_download() as download:
        person.find("#download").click()
    path = tmp_path / "table.toml"
    download.value.save_as(path)
    path.write_text(path.read_text().replace('"bowl-1"', '"pot"'))
    person.page.set_input_files("#upload", path)
    expect(person.find("#items [data-item=pot]")).to_have_count(1, timeout=PATIENCE)
    person.find("#edit").click()
    person.say("teapot")
    expect(person.find("#log")).to_contain_text("now most likely: pot", timeout=PATIENCE)
    person.find("#edit").click()
    path.write_text(path.read_text().replace("teapot", "yes"))
    person.page.set_input_files("#upload", path)
    expect(person.find("#editor-error")).to_contain_text("items[0].vocabulary", timeout=PATIENCE)


def test_a_table_that_the_server_was_started_with(visit: Visit, serve: Serve, tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    places = ("-0.3", "0.3")
    items = [
        f'[[items]]\nid = "{name}"\nposition = [{x}, 2, 0.75]\nvocabulary = ["{name}"]\n'
        for name, x in zip(("tea", "cup"), places, strict=True)
    ]
    path.write_text("head = [0, 0, 1.6]\n" + "".join(items) + "[model]\nsigma = 0.3\n")
    server = serve(str(path))
    person = visit(server)
    person.say("cup")
    assert person.got() == "cup"
    person.find("#again").click()
    expect(person.find("#log li")).to_have_count(0, timeout=PATIENCE)
    assert share(person, "tea") == 50
    person.say("tea")
    expect(person.find("#log")).to_contain_text("tea", timeout=PATIENCE)
    logs = [path.read_text() for path in server.data.iterdir()]
    assert [json.loads(log.splitlines()[0])["model"]["sigma"] for log in logs] == [0.3, 0.3]


@pytest.mark.parametrize("language", ["en", "de"])
def test_axe_finds_nothing(visit: Visit, language: str) -> None:
    person = visit()
    person.find("#options").click()
    person.find("#language").select_option(language)
    found = [Axe().run(person.page)]
    person.find("#edit").click()
    found.append(Axe().run(person.page))
    person.find("#edit").click()
    person.say("green marker")
    expect(person.find("#answers")).to_be_visible(timeout=PATIENCE)
    found.append(Axe().run(person.page))
    person.find("[data-say=yes]").click()
    expect(person.find("#end")).to_be_visible(timeout=PATIENCE)
    found.append(Axe().run(person.page))
    person.page.set_viewport_size({"width": 390, "height": 844})
    found.append(Axe().run(person.page))
    assert [result.generate_report() for result in found if result.violations_count] == []


def test_a_microphone_is_heard(server: Server, chromium: Callable[..., Browser]) -> None:
    """Chromium's microphone plays examples/marker.wav ("hand me the marker") over and over."""
    sound = Path(__file__).parents[2] / "examples" / "marker.wav"
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with chromium(*flags, f"--use-file-for-fake-audio-capture={sound}") as browser:
        person = Person(browser.new_context(permissions=["microphone"], locale="en"), server.address)
        person.let_the_server_listen()
        person.find("#microphone").click()
        expect(person.find("#log")).to_contain_text("marker", timeout=PATIENCE)
        assert share(person, "marker-1") > 30
        person.find("#options").click()
        person.find("#scene").select_option("unambiguous")  # a new interaction, over which the microphone stays open
        expect(person.find("#log li")).to_have_count(0, timeout=PATIENCE)
        expect(person.find("#microphone")).to_have_attribute("aria-pressed", "true")
        expect(person.find("#log")).to_contain_text("marker", timeout=PATIENCE)
        person.find("#microphone").click()
        assert person.errors == []


def test_a_microphone_that_was_let_go_is_off(server: Server, chromium: Callable[..., Browser]) -> None:
    """Pressed, let go and pressed again while the microphone opens slowly, then let go: no track is left open."""
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with chromium(*flags) as browser:
        context = browser.new_context(permissions=["microphone"], locale="en")
        context.add_init_script(SLOW_MICROPHONE)
        person = Person(context, server.address)
        for movement in ("pointerdown", "pointerup", "pointerdown"):
            person.find("#microphone").dispatch_event(movement)
        person.page.wait_for_function(
            "() => tracks.length === 2 && tracks.some((track) => track.readyState === 'ended')"
        )
        expect(person.find("#microphone")).to_have_attribute("aria-pressed", "true")
        person.find("#microphone").dispatch_event("pointerup")
        person.page.wait_for_function("() => tracks.every((track) => track.readyState === 'ended')")
        assert person.errors == []


SLOW_MICROPHONE = """
const open = MediaDevices.prototype.getUserMedia;
window.tracks = [];
MediaDevices.prototype.getUserMedia = async function (...wanted) {
  const stream = await open.apply(this, wanted);
  tracks.push(...stream.getTracks());
  await new Promise((resolve) => setTimeout(resolve, 300));
  return stream;
};
"""


def test_figure_1_is_told_by_the_real_parts(server: Server, chromium: Callable[..., Browser], tmp_path: Path) -> None:
    """A person asks for the marker aloud, points between two, says "no" aloud when asked, and gets the other."""
    sound = tmp_path / "story.wav"
    write_story(sound)
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with chromium(*flags, f"--use-file-for-fake-audio-capture={sound}%noloop") as browser:
        context = browser.new_context(viewport={"width": 1280, "height": 800}, permissions=["microphone"], locale="en")
        person = Person(context, server.address)
        person.let_the_server_listen()
        boxes = [person.find(f"#items [data-item={item}]").bounding_box() for item in sorted(MARKERS)]
        middle = sum(box["x"] + box["width"] / 2 for box in boxes if box) / 2
        person.page.mouse.move(middle, min(box["y"] for box in boxes if box) - 20)
        person.find("#microphone").click()
        person.page.mouse.move(middle, min(box["y"] for box in boxes if box) - 20)
        person.page.mouse.down()
        asked = person.asked_about()
        person.page.mouse.up()
        assert asked in MARKERS
        assert {person.got()} == MARKERS - {asked}
        story = person.log()
        assert "You pointed at the table" in story
        assert story.index("marker") < story.index("This one?") < story.index("“no”")
        assert person.errors == []


def write_story(path: Path) -> None:
    """Write "hand me the green marker" and, when the robot has had the time to ask, "no"."""
    with wave.open(str(Path(__file__).parents[2] / "examples" / "marker.wav")) as recording:
        settings, rate = recording.getparams(), recording.getframerate()
        sound = np.frombuffer(recording.readframes(recording.getnframes()), np.int16)
    request, answer = sound[: 2 * rate], sound[int(3.9 * rate) : 5 * rate]
    room = np.random.default_rng(0).normal(0, 30, 20 * rate).astype(np.int16)
    story = np.concatenate((room[: 2 * rate], request, room[: 5 * rate], answer, room))
    with wave.open(str(path), "wb") as made:
        made.setparams(settings)
        made.writeframes(story.tobytes())


def test_a_reload_during_a_question_shows_the_question(visit: Visit) -> None:
    person = visit()
    person.say("hand me the marker")
    asked = person.asked_about()
    person.page.reload()
    expect(person.find("#answers")).to_be_visible(timeout=PATIENCE)
    expect(person.find("#bubble")).to_have_text("This one?")
    expect(person.find("#items .about")).to_contain_text(asked)
    person.find("[data-say=yes]").click()
    assert person.got() == asked
    expect(person.find("#answers")).to_be_hidden()


def test_yes_and_no_stay_until_they_are_answered(visit: Visit) -> None:
    person = visit()
    person.say("hand me the marker")
    person.asked_about()
    person.say("the green one, the expo")
    expect(person.find("#log")).to_contain_text("expo", timeout=PATIENCE)
    expect(person.find("#answers")).to_be_visible()
    expect(person.find("#log")).to_have_text(re.compile("This one.*This one"), timeout=PATIENCE)
    expect(person.find("#answers")).to_be_visible()


def test_an_example_is_said_and_examples_come_back_after_the_hand_over(visit: Visit) -> None:
    person = visit()
    expect(person.find("#examples button")).to_have_text(
        ["hand me the bowl", "the green marker, please", "could I have spoon 2"]
    )
    person.find("#examples button").nth(2).focus()
    person.page.keyboard.press("Enter")
    expect(person.find("#say")).to_be_focused()
    expect(person.find("#examples")).to_be_hidden(timeout=PATIENCE)
    assert person.got() == "spoon-2"
    expect(person.find("#examples")).to_be_visible(timeout=PATIENCE)
    person.say("blorb")
    expect(person.find("#bubble")).to_contain_text("I know: black, bowl", timeout=PATIENCE)
    person.say("hand me the bowl")
    expect(person.find("#log")).to_contain_text("Another request", timeout=PATIENCE)
    expect(person.find("#end")).to_be_hidden()


def test_what_was_handed_over_is_given_back(visit: Visit) -> None:
    person = visit()
    person.say("spoon 2")
    assert person.got() == "spoon-2"
    person.page.reload()
    expect(person.find("#outcome")).to_have_text("You got spoon-2.", timeout=PATIENCE)
    person.find("#stop").click()
    expect(person.find("#log")).to_contain_text("You gave spoon-2 back", timeout=PATIENCE)
    expect(person.find("#end")).to_be_hidden()

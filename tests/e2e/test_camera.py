"""Pointing with an arm: Chromium's camera plays a film of a person who points at known places (tests/e2e/film)."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, expect

from tests.e2e import film
from tests.e2e.conftest import PATIENCE, Person, Server
from tests.e2e.test_page import share

pytestmark = pytest.mark.browser
MARKS = [f"mark-{number}" for number in range(1, 7)]
CAMERA = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
# Whether the lamp of the film's beginning is on, in the preview's picture.
LAMP = """canvas => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height / 3);
  let white = 0;
  for (let at = 0; at < data.length; at += 4) white += Math.min(data[at], data[at + 1], data[at + 2]) > 245;
  return white > 100;
}"""
# Keeps the streams that the page opens, so that a camera can be pulled out.
STREAMS = """
const open = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);
window.streams = [];
navigator.mediaDevices.getUserMedia = async (wanted) => {
  window.streams.push(await open(wanted));
  return window.streams.at(-1);
};
"""
# Lets each of the pose model's answers take half a second.
SLUGGISH = """
const Quick = window.Worker;
window.Worker = class extends Quick {
  set onmessage(heard) { super.onmessage = (event) => setTimeout(() => heard(event), 500); }
};
"""
UNPLUG = "() => window.streams.flatMap((s) => s.getTracks()).forEach((t) => t.dispatchEvent(new Event('ended')))"

CLOSED = "() => window.streams.flatMap((s) => s.getTracks()).every((t) => t.readyState === 'ended')"


@contextmanager
def before_camera(
    server: Server,
    chromium: Callable[..., Browser],
    *flags: str,
    permissions: Sequence[str] = ("camera",),
    script: str = STREAMS,
) -> Iterator[Person]:
    """A person before the table with the twins far apart, whose camera is on."""
    with chromium(*flags) as browser:
        context = browser.new_context(viewport={"width": 1280, "height": 800}, permissions=permissions, locale="en")
        context.add_init_script(script)
        person = Person(context, server.address)
        person.find("#options").click()
        person.find("#scene").select_option("unambiguous")
        person.find("[name=pointing][value=camera]").check()
        person.find("#options").click()
        yield person
        assert person.errors == person.strangers == []


def film_of(places: Sequence[str], folder: Path) -> tuple[str, ...]:
    """Flags of a camera before which somebody points at places."""
    path = folder / "film.mjpeg"
    film.write(path, places)
    return (*CAMERA, f"--use-file-for-fake-video-capture={path}")


def said(person: Person) -> Any:
    return expect(person.find("#camera-state"))


def calibrate(person: Person) -> None:
    """Begin a calibration at the film's beginning."""
    said(person).to_contain_text("then calibrate", timeout=PATIENCE)
    preview = person.find("#preview")
    while not preview.evaluate(LAMP):
        person.page.wait_for_timeout(100)
    person.find("#calibrate").click()
    expect(person.find("#mark")).to_be_visible()


def messages(person: Person) -> list[dict[str, Any]]:
    """What the page has sent."""
    return [json.loads(message) for message in person.sent]


def mouse_moves_the_belief(person: Person, item: str) -> None:
    person.point_with_the_mouse(item)
    assert share(person, item) > 50


def test_an_arm_is_calibrated_and_moves_the_belief(
    server: Server, chromium: Callable[..., Browser], tmp_path: Path
) -> None:
    with before_camera(server, chromium, *film_of([*MARKS, "marker-2"], tmp_path)) as person:
        calibrate(person)
        said(person).to_contain_text("Pointing is good to 0.", timeout=PATIENCE)
        expect(person.find("#mark")).to_be_hidden()
        expect(person.find("#log")).to_contain_text(
            "You pointed at the table → now most likely: marker-2", timeout=PATIENCE
        )
        sent = messages(person)
    hellos = [message["sigma"] for message in sent if message["type"] == "hello"]
    assert hellos[:-1] == [None, None]
    assert 0.02 <= hellos[-1] <= 0.3
    # Nothing but heads and wrists has left the browser.
    assert {message["type"] for message in sent} == {"hello", "ray"}
    rays = [message for message in sent if message["type"] == "ray"]
    assert all(ray.keys() == {"type", "head", "wrist"} and len(ray["head"]) == len(ray["wrist"]) == 3 for ray in rays)
    assert len(rays) < 12 * 10


def test_an_arm_that_is_too_coarse_is_not_used(
    server: Server, chromium: Callable[..., Browser], tmp_path: Path
) -> None:
    elsewhere = [MARKS[index] for index in (2, 5, 1, 0, 4, 3)]
    with before_camera(server, chromium, *film_of([*elsewhere, "marker-2"], tmp_path)) as person:
        calibrate(person)
        said(person).to_contain_text("0.30 is the most that helps. The mouse is used.", timeout=PATIENCE)
        person.page.wait_for_timeout(6_000)  # the film points at marker-2 meanwhile
        assert {message["type"] for message in messages(person)} == {"hello"}
        assert all(message["sigma"] is None for message in messages(person))
        mouse_moves_the_belief(person, "bowl-1")


def test_a_camera_that_sees_nobody_and_is_pulled_out_ends_nothing(
    server: Server, chromium: Callable[..., Browser]
) -> None:
    with before_camera(server, chromium, *CAMERA) as person:
        said(person).to_contain_text("Nobody is seen", timeout=PATIENCE)
        person.page.evaluate(UNPLUG)
        said(person).to_contain_text("The camera is gone. The mouse works.")
        expect(person.find("#calibrate")).to_be_disabled()
        person.find("#camera-off").click()
        expect(person.find("#camera")).to_be_hidden()
        assert person.page.evaluate(CLOSED)
        mouse_moves_the_belief(person, "spoon-1")


def test_two_hands_and_few_pictures_are_said(server: Server, chromium: Callable[..., Browser], tmp_path: Path) -> None:
    flags = film_of(["both", "both"], tmp_path)
    with before_camera(server, chromium, *flags, script=SLUGGISH) as person:
        said(person).to_contain_text("Both hands are up. Lower one.", timeout=PATIENCE)
        expect(person.find("#camera-slow")).to_contain_text("few pictures a second", timeout=PATIENCE)
        mouse_moves_the_belief(person, "marker-1")


def test_a_camera_that_is_refused_is_said(server: Server, chromium: Callable[..., Browser]) -> None:
    with before_camera(server, chromium, CAMERA[0], permissions=()) as person:
        said(person).to_contain_text("The camera cannot be used", timeout=PATIENCE)
        mouse_moves_the_belief(person, "bowl-2")


@pytest.mark.parametrize("language", ["en", "de"])
def test_axe_finds_nothing_in_a_calibration_by_keyboard(
    server: Server, chromium: Callable[..., Browser], language: str
) -> None:
    with before_camera(server, chromium, *CAMERA) as person:
        person.find("#options").click()
        person.find("#language").select_option(language)
        found = [Axe().run(person.page)]
        person.find("#options").click()
        button = person.find("#calibrate")
        expect(button).to_be_enabled(timeout=PATIENCE)
        button.focus()
        person.page.keyboard.press("Enter")
        expect(person.find("#mark")).to_be_visible()
        found.append(Axe().run(person.page))
        person.page.set_viewport_size({"width": 390, "height": 844})
        found.append(Axe().run(person.page))
        person.page.keyboard.press("Tab")
        person.page.keyboard.press("Enter")
        expect(person.find("#camera")).to_be_hidden()
        assert [result.generate_report() for result in found if result.violations_count] == []

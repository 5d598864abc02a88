"""Measures pointing with an arm in the film, with Debian's Chromium: python -m tests.e2e.film.measure [PICTURE.png]

The page is calibrated at the six marks, and then each item of the table is pointed at. Nothing is replaced; what the
page sends over its WebSocket is compared with where the items are, and its pose model's answers are counted. A picture
of the page is written while the first item is pointed at.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Page, expect, sync_playwright

from fetch_pomdp.core.rays import angles_from
from fetch_pomdp.core.scene import Scene
from tests.e2e import film
from tests.e2e.conftest import FLAGS, PATIENCE, Person, Server
from tests.e2e.test_camera import CAMERA, MARKS, calibrate

BETWEEN = 2.0  # s between gestures
COUNT = """
const Plain = window.Worker;
window.answers = [];
window.Worker = class extends Plain {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", ({ data }) => window.answers.push([performance.now(), data.joints !== null]));
  }
};
"""


def rays_of(page: Page) -> list[tuple[float, Any]]:
    """Return a list that fills with the rays which the page sends, and when (s)."""
    rays: list[tuple[float, Any]] = []

    def sent(message: str | bytes) -> None:
        data = json.loads(message)
        if data["type"] == "ray":
            rays.append((time.monotonic(), data))

    page.on("websocket", lambda socket: socket.on("framesent", sent))
    return rays


def gestures(rays: list[tuple[float, Any]]) -> list[list[Any]]:
    """Return the rays of each gesture."""
    found: list[list[Any]] = []
    last = -np.inf
    for at, ray in rays:
        if at - last > BETWEEN / 2:
            found.append([])
        found[-1].append(ray)
        last = at
    return found


def report(scene: Scene, rays: list[tuple[float, Any]]) -> None:
    """Print for each gesture how far its median ray is off its item."""
    positions = np.array([item.position for item in scene.items])
    angles = []
    for index, gesture in enumerate(gestures(rays)[: len(scene.items)]):
        wrist = np.median([ray["wrist"] for ray in gesture], axis=0)
        angle = angles_from(np.array(scene.head), wrist, positions)
        angles.append(float(angle[index]))
        nearest = scene.items[int(np.argmin(angle))].id
        print(f"{scene.items[index].id}: off by {angle[index]:.3f} rad ({len(gesture)} rays), nearest item {nearest}")
    print(f"root mean square over {len(angles)} items: {np.sqrt(np.mean(np.square(angles))):.3f} rad")


def opened(person: Person) -> None:
    """Choose the table and the camera. The robot that always asks never ends the interaction."""
    person.find("#options").click()
    person.find("#planner").select_option("always")
    person.find("#scene").select_option("unambiguous")
    person.find("[name=pointing][value=camera]").check()
    person.find("#options").click()


def report_pictures(person: Person) -> None:
    """Print how many pictures the pose model was given, how fast, and in how many it found somebody."""
    answers = person.page.evaluate("() => window.answers")
    times = np.array([at for at, _ in answers]) / 1000
    rate = (len(times) - 1) / (times[-1] - times[0])
    print(f"{len(times)} pictures, {rate:.1f} a second, median {1 / np.median(np.diff(times)):.1f}")
    print(f"a person was found in {np.mean([found for _, found in answers]):.1%}")


def main(picture: str | None) -> None:
    """Calibrate, point at every item, print what was measured."""
    scene = Scene.load("unambiguous")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        path, server = Path(folder) / "film.mjpeg", Server(Path(folder) / "data")
        seconds = film.write(path, [*MARKS, *(item.id for item in scene.items)], between=BETWEEN)
        flags = [*FLAGS, *CAMERA, f"--use-file-for-fake-video-capture={path}"]
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=flags)
        context = browser.new_context(viewport={"width": 1280, "height": 800}, permissions=["camera"], locale="en")
        context.add_init_script(COUNT)
        person = Person(context, server.address)
        rays = rays_of(person.page)
        opened(person)
        calibrate(person)
        expect(person.find("#camera-state")).to_contain_text("Pointing is good to", timeout=PATIENCE)
        print(person.find("#camera-state").inner_text())
        began = time.monotonic()
        while not rays:
            person.page.wait_for_timeout(200)
        person.page.wait_for_timeout(1000)
        if picture is not None:
            person.page.screenshot(path=picture)
        person.page.wait_for_timeout(1000 * (began + seconds / 2 - time.monotonic()))
        report_pictures(person)
        report(scene, rays)
        server.kill()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)

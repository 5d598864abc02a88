"""Film a short interaction for README and docs: serve.webp, as fast as it happens.

    python docs/make_film.py [--frames FOLDER]

Chromium's frames are taken with the times at which they were drawn; the mouse, which they lack, is drawn in.
"""

from __future__ import annotations

import argparse
import base64
import io
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image, ImageDraw
from visiting import PATIENCE, listening, served, visited

if TYPE_CHECKING:
    from playwright.sync_api import Page

FILM = Path(__file__).with_name("serve.webp")
SIZE = (1060, 690)  # pixels, of the page
SHOWN = (960, 625)  # pixels, of the film
APART = 0.08  # s between frames, at least
LAST = 2.0  # s that the end is shown
QUALITY = 80
LARGEST = 1_500_000  # bytes
ARROW = ((0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12))


@dataclass
class Film:
    """Frames and where the mouse was, with their times (s)."""

    frames: list[tuple[float, bytes]] = field(default_factory=list)
    mouse: list[tuple[float, float, float]] = field(default_factory=list)

    def roll(self, page: Page) -> None:
        """Take every frame that the page draws from now on."""
        session = page.context.new_cdp_session(page)

        def take(frame: dict[str, Any]) -> None:
            self.frames.append((frame["metadata"]["timestamp"], base64.b64decode(frame["data"])))
            session.send("Page.screencastFrameAck", {"sessionId": frame["sessionId"]})

        session.on("Page.screencastFrame", take)
        session.send("Page.startScreencast", {"format": "png"})

    def move(self, page: Page, x: float, y: float) -> None:
        """Move the mouse there within half a second."""
        _, left, top = self.mouse[-1] if self.mouse else (0.0, 0.62 * SIZE[0], 0.8 * SIZE[1])
        for share in (step / 10 for step in range(1, 11)):
            page.mouse.move(left + share * (x - left), top + share * (y - top))
            self.mouse.append((time.time(), left + share * (x - left), top + share * (y - top)))
            page.wait_for_timeout(40)

    def pictures(self) -> list[tuple[Image.Image, int]]:
        """Return the frames that are shown, and for how long (ms)."""
        kept = self.frames[:1]
        for frame in self.frames[1:]:
            if frame[0] - kept[-1][0] >= APART:
                kept.append(frame)
        ends = [*(moment for moment, _ in kept[1:]), kept[-1][0] + LAST]
        return [
            (self._picture(moment, data), round(1000 * (end - moment)))
            for (moment, data), end in zip(kept, ends, strict=True)
        ]

    def _picture(self, moment: float, data: bytes) -> Image.Image:
        picture = Image.open(io.BytesIO(data)).convert("RGB")
        before = [place for place in self.mouse if place[0] <= moment]
        if before:
            _, left, top = before[-1]
            arrow = [(left + x, top + y) for x, y in ARROW]
            ImageDraw.Draw(picture).polygon(arrow, fill="black", outline="white")
        return picture.resize(SHOWN, Image.Resampling.LANCZOS)


def act(page: Page, film: Film) -> None:
    """Ask for a marker, point at one, answer the question, and wait for the hand-over."""
    from playwright.sync_api import expect

    page.focus("#say")
    page.wait_for_timeout(600)
    page.keyboard.type("hand me the marker", delay=45)
    page.keyboard.press("Enter")
    place = page.locator("#items [data-item=marker-1]").bounding_box()
    if place is None:
        raise RuntimeError("the marker is not on the page")
    film.move(page, place["x"] + place["width"] / 2, place["y"] - 14)
    page.mouse.down()
    page.wait_for_timeout(900)
    page.mouse.up()
    expect(page.locator("#answers")).to_be_visible(timeout=PATIENCE)
    button = page.locator("[data-say=no]").bounding_box()
    if button is None:
        raise RuntimeError("there is no answer to click")
    film.move(page, button["x"] + button["width"] / 2, button["y"] + button["height"] / 2)
    page.wait_for_timeout(300)
    page.click("[data-say=no]")
    expect(page.locator("#end")).to_be_visible(timeout=PATIENCE)
    page.wait_for_timeout(900)


def main() -> None:
    """Write the film, and its frames for who wants to look at them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=Path, metavar="FOLDER")
    folder = parser.parse_args().frames
    film = Film()
    with served() as address, visited(address, *SIZE) as page:
        listening(page)
        film.roll(page)
        act(page, film)
    pictures, durations = zip(*film.pictures(), strict=True)
    options = {"quality": QUALITY, "method": 6, "minimize_size": True, "allow_mixed": True}
    pictures[0].save(FILM, save_all=True, append_images=pictures[1:], duration=durations, loop=0, **options)
    for number, picture in enumerate(pictures if folder else ()):
        picture.save(folder / f"{number:03d}.png")
    size = FILM.stat().st_size
    print(f"{FILM.name}: {len(pictures)} frames, {sum(durations) / 1000:.1f} s, {size / 1e6:.2f} MB")
    if size > LARGEST:
        raise SystemExit(f"found {size} bytes, expected at most {LARGEST}")


if __name__ == "__main__":
    main()

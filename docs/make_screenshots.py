"""Draw the pictures of docs/serve.md and docs/study-with-people.md: servers, Chromium, and short interactions."""

from __future__ import annotations

import re
import secrets
import tempfile
from pathlib import Path

from visiting import PATIENCE, listening, served, visited

from fetch_pomdp.user_study.config import template

FOLDER = Path(__file__).parent
TOKEN = secrets.token_urlsafe()


def main() -> None:
    """Write serve-*.png and study-*.png."""
    with served() as address:
        draw(address)
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.toml"
        asks = re.sub(r"^(never|fetch) = .*$", "", template(), flags=re.MULTILINE)
        study.write_text(asks, encoding="utf-8")
        database = f"sqlite:///{folder}/participants.db"
        with served("--study", str(study), "--database", database, "--researcher-token", TOKEN) as address:
            draw_study(address)


def draw_study(address: str) -> None:
    """Take part in a study up to a question, and look at the researcher's page."""
    with visited(address, 1280, 800) as page:
        page.locator("#study-page h2").wait_for()
        page.screenshot(path=FOLDER / "study-consent.png")
        for _ in range(2):
            before = page.locator("#study-page h2").inner_text()
            page.click("#study-page .strong")
            page.wait_for_function("old => document.querySelector('#study-page h2')?.innerText !== old", arg=before)
        page.click("#ready")
        page.wait_for_function("() => !document.querySelector('#say').disabled")
        kind = next(kind for kind in ("marker", "spoon", "bowl") if kind in page.locator("#task-item").inner_text())
        page.fill("#say", f"the {kind}")
        page.press("#say", "Enter")
        page.locator("#answers").wait_for()
        page.wait_for_timeout(900)
        page.screenshot(path=FOLDER / "study-round.png")
        page.goto(f"{address}researcher.html#token={TOKEN}")
        page.locator("tbody tr").first.wait_for()
        page.screenshot(path=FOLDER / "study-researcher.png")


def draw(address: str) -> None:
    """Visit a server and take the pictures."""
    from playwright.sync_api import expect

    with visited(address, 1280, 800) as page:
        listening(page)
        page.fill("#say", "hand me the marker")
        page.press("#say", "Enter")
        expect(page.locator("#bubble")).to_have_text("This one?", timeout=PATIENCE)
        page.wait_for_timeout(900)
        page.screenshot(path=FOLDER / "serve-asks.png")
        page.click("[data-say=no]")
        expect(page.locator("#end")).to_be_visible(timeout=PATIENCE)
        page.wait_for_timeout(900)
        page.screenshot(path=FOLDER / "serve-hands-over.png")
        page.click("#options")
        page.select_option("#scene", "unambiguous")
        page.click("#options")
        page.wait_for_timeout(3000)
        page.mouse.move(400, 480)
        page.mouse.down()
        page.locator("#items .provisional").first.wait_for(state="attached", timeout=PATIENCE)
        page.wait_for_timeout(700)
        page.screenshot(path=FOLDER / "serve-points.png")
        page.mouse.up()
        page.set_viewport_size({"width": 390, "height": 844})
        page.wait_for_timeout(1500)
        page.screenshot(path=FOLDER / "serve-phone.png")


if __name__ == "__main__":
    main()

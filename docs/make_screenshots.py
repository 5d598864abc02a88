"""Draw the pictures of docs/serve.md: a server, Chromium, and a short interaction with it."""

from __future__ import annotations

from pathlib import Path

from visiting import PATIENCE, served, visited

FOLDER = Path(__file__).parent


def main() -> None:
    """Write serve-asks.png, serve-hands-over.png, serve-points.png and serve-phone.png."""
    with served() as address:
        draw(address)


def draw(address: str) -> None:
    """Visit a server and take the pictures."""
    from playwright.sync_api import expect

    with visited(address, 1280, 800) as page:
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
        page.wait_for_timeout(1500)
        page.screenshot(path=FOLDER / "serve-points.png")
        page.mouse.up()
        page.set_viewport_size({"width": 390, "height": 844})
        page.wait_for_timeout(1500)
        page.screenshot(path=FOLDER / "serve-phone.png")


if __name__ == "__main__":
    main()

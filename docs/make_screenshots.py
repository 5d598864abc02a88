"""Draw the pictures of docs/serve.md: a server, Chromium, and a short interaction with it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).parent
PORT = 8765
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PATIENCE = 120_000  # ms


def main() -> None:
    """Write serve-asks.png, serve-hands-over.png, serve-points.png and serve-phone.png."""
    program = str(Path(sys.executable).with_name("fetch-pomdp"))
    server = subprocess.Popen([program, "serve", "--port", str(PORT)], stdout=subprocess.PIPE, text=True)
    try:
        if server.stdout is None or "robot is at" not in server.stdout.readline():
            sys.exit("the server does not start")
        draw(f"http://127.0.0.1:{PORT}/")
    finally:
        server.terminate()


def draw(address: str) -> None:
    """Visit a server and take the pictures."""
    from playwright.sync_api import expect, sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": 1280, "height": 800}, locale="en")
        page.goto(address)
        expect(page.locator("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)
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
        browser.close()


if __name__ == "__main__":
    main()

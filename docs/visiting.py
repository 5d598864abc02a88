"""A server and Debian's Chromium before it, for the pictures of the documentation."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PATIENCE = 120_000  # ms
READY = "The robot is listening."


@contextmanager
def served(*options: str) -> Iterator[str]:
    """Give the address of a server of one's own, started with these options."""
    with socket.create_server(("127.0.0.1", 0)) as door:
        port = door.getsockname()[1]
    program = str(Path(sys.executable).with_name("fetch-pomdp"))
    command = [program, "serve", "--port", str(port), *options]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        if server.stdout is None or "robot is at" not in server.stdout.readline():
            sys.exit("the server does not start")
        yield f"http://127.0.0.1:{port}/"
    finally:
        server.terminate()
        server.wait()


@contextmanager
def visited(address: str, width: int, height: int) -> Iterator[Page]:
    """Open the page of a server."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": width, "height": height}, locale="en")
        page.set_default_timeout(PATIENCE)
        page.goto(address)
        yield page
        browser.close()


def listening(page: Page) -> None:
    """Wait until the robot listens."""
    from playwright.sync_api import expect

    expect(page.locator("#state")).to_have_text(READY, timeout=PATIENCE)

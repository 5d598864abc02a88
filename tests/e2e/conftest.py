"""A server as a user starts it, and Debian's Chromium before it; nothing is replaced."""

from __future__ import annotations

import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect, sync_playwright

# Without a graphics card Chromium draws WebGL in software only if it is told to.
FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
PATIENCE = 120_000  # ms: the first server of a run compiles the planner


class Server:
    """A server process on a port of its own, which can be killed and started again."""

    def __init__(self, data: Path, *options: str) -> None:
        self.data, self._options = data, options
        self._port = _free_port()
        self.address = f"http://127.0.0.1:{self._port}/"
        self.start()

    def start(self) -> None:
        program = str(Path(sys.executable).with_name("fetch-pomdp"))
        command = [program, "serve", *self._options, "--port", str(self._port), *self.keeps()]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        assert self.address in self._process.stdout.readline()

    def keeps(self) -> list[str]:
        """The options that say where it keeps what happens."""
        return ["--data", str(self.data)]

    def kill(self) -> None:
        self._process.send_signal(signal.SIGKILL)
        self._process.communicate()


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as door:
        return int(door.getsockname()[1])


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """The server of all tests that do nothing to it."""
    made = Server(tmp_path_factory.mktemp("data"))
    yield made
    made.kill()


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Callable[..., Server]]:
    """Starts a server of the test's own, with further options."""
    made: list[Server] = []

    def start(*options: str) -> Server:
        made.append(Server(tmp_path / f"data-{len(made)}", *options))
        return made[-1]

    yield start
    for each in made:
        each.kill()


@pytest.fixture(scope="session")
def chromium() -> Iterator[Callable[..., Browser]]:
    """Opens a Chromium with further flags."""
    path = shutil.which("chromium")
    assert path, "chromium is not installed; install it with: apt install chromium"
    with sync_playwright() as playwright:
        yield lambda *flags: playwright.chromium.launch(executable_path=path, args=[*FLAGS, *flags])


@pytest.fixture(scope="session")
def browser(chromium: Callable[..., Browser]) -> Iterator[Browser]:
    with chromium() as opened:
        yield opened


class Person:
    """Somebody before a page; knows what went wrong on it, and what it asked other hosts for."""

    def __init__(self, context: BrowserContext, address: str) -> None:
        self.page: Page = context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.errors: list[str] = []
        self.strangers: list[str] = []
        self.sent: list[str | bytes] = []  # over the WebSocket
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("websocket", lambda socket: socket.on("framesent", self._sent))
        self.page.on("request", lambda request: self._asked(request.url, address))
        self.page.goto(address)
        expect(self.page.locator("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)

    def _sent(self, message: str | bytes) -> None:
        self.sent.append(message)

    def _asked(self, url: str, address: str) -> None:
        if not url.startswith((address, address.replace("http", "ws"), "data:", "blob:")):
            self.strangers.append(url)

    def say(self, text: str) -> None:
        self.page.fill("#say", text)
        self.page.press("#say", "Enter")

    def find(self, selector: str) -> Locator:
        return self.page.locator(selector)

    def point_with_the_mouse(self, item: str) -> None:
        """Point above an item until the bars have moved."""
        place = self.find(f"#items [data-item={item}]").bounding_box()
        assert place is not None
        self.page.mouse.move(place["x"] + place["width"] / 2, place["y"] - 12)
        self.page.mouse.down()
        expect(self.find("#items .provisional")).not_to_have_count(0, timeout=PATIENCE)
        self.page.mouse.up()
        expect(self.find("#log")).to_contain_text("You pointed", timeout=PATIENCE)

    def let_the_server_listen(self) -> None:
        """Choose the server's ears, for a microphone that stays open."""
        self.find("#options").click()
        self.find("[name=ears][value=server]").check()
        self.find("#hold").uncheck()
        self.find("#options").click()

    def log(self) -> str:
        return self.find("#log").inner_text()

    def asked_about(self) -> str:
        """Wait for a question and return the item that it is about."""
        expect(self.find("#log")).to_contain_text("This one?", timeout=PATIENCE)
        found = re.findall(r"points at (\S+):", self.log())
        return str(found[-1])

    def got(self) -> str:
        """Wait for the hand-over and return what it was."""
        expect(self.find("#outcome")).to_be_visible(timeout=PATIENCE)
        return self.find("#outcome").inner_text().removeprefix("You got ").removesuffix(".")


@pytest.fixture
def visit(browser: Browser, server: Server) -> Iterator[Callable[..., Person]]:
    """Lets somebody come to the common server, or to another."""
    contexts: list[BrowserContext] = []
    people: list[Person] = []

    def come(to: Server = server) -> Person:
        contexts.append(browser.new_context(viewport={"width": 1280, "height": 800}, locale="en"))
        people.append(Person(contexts[-1], to.address))
        return people[-1]

    yield come
    for person in people:
        assert person.errors == person.strangers == []
    for context in contexts:
        context.close()

"""A study in a real browser: from consent to completion code, through what goes wrong, to its analysis."""

from __future__ import annotations

import re
import sqlite3
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect

from tests.e2e.conftest import PATIENCE, Server
from tests.user_study.small import small_study

pytestmark = pytest.mark.browser
TOKEN = "a researcher's own secret"
SIDES = re.compile("left|right|links|rechts")
Come = Callable[..., "Participant"]


class StudyServer(Server):
    """A server with a small study: one round of practice, two that count."""

    def keeps(self) -> list[str]:
        self.data.mkdir(exist_ok=True)
        self.database = self.data / "participants.db"
        study = str(small_study(self.data))
        return ["--study", study, "--database", f"sqlite:///{self.database}", "--researcher-token", TOKEN]

    def rows(self, query: str) -> list[tuple[object, ...]]:
        with sqlite3.connect(self.database) as connection:
            return connection.execute(query).fetchall()


class Participant:
    """Somebody before the page of a study."""

    def __init__(self, page: Page, address: str) -> None:
        self.page, self.found = page, list[str]()
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: self.found.append(str(error)))
        page.goto(address)

    def look(self) -> None:
        """Let axe-core look at the page."""
        result = Axe().run(self.page)
        if result.violations_count:
            self.found.append(result.generate_report())

    def heading(self, text: str) -> None:
        expect(self.page.locator("#study-page h2")).to_have_text(text, timeout=PATIENCE)
        expect(self.page.locator("#study-page h2")).to_be_focused()

    def agree(self) -> None:
        """Read what there is to read, up to the first round."""
        for _ in range(2):
            before = self.page.locator("#study-page h2").inner_text()
            self.page.locator("#study-page .strong").click()
            expect(self.page.locator("#study-page h2").filter(has_text=re.compile(f"^{before}$"))).to_have_count(0)
        expect(self.page.locator("#ready")).to_be_visible()

    def begin(self) -> str:
        """Begin the round; return what is to be got, in words."""
        self.page.click("#ready")
        expect(self.page.locator("#say")).to_be_enabled()
        return self.page.locator("#task-item").inner_text()

    def say(self, text: str) -> None:
        self.page.fill("#say", text)
        self.page.press("#say", "Enter")

    def asked(self) -> str:
        """Wait for a question; return what it is about, in words."""
        expect(self.page.locator("#answers")).to_be_visible(timeout=PATIENCE)
        return self.page.locator("#spoken").inner_text()

    def get(self) -> None:
        """Ask for what is to be got and answer, until the robot tells what it brings."""
        wanted = self.begin()
        self.say("the marker")
        self.answer(wanted)

    def answer(self, wanted: str) -> None:
        right = SIDES.findall(self.asked())[-1:] == SIDES.findall(wanted)
        self.page.click("[data-say=yes]" if right else "[data-say=no]")
        expect(self.page.locator("#next")).to_be_visible()
        assert SIDES.findall(self.page.locator("#outcome").inner_text()) == SIDES.findall(wanted)


@pytest.fixture
def study(tmp_path: Path) -> Iterator[StudyServer]:
    made = StudyServer(tmp_path / "study")
    yield made
    made.kill()


@pytest.fixture
def come(browser: Browser, study: StudyServer) -> Iterator[Come]:
    people: list[Participant] = []

    def arrive(language: str = "en") -> Participant:
        context = browser.new_context(viewport={"width": 1280, "height": 800}, locale=language)
        people.append(Participant(context.new_page(), study.address))
        return people[-1]

    yield arrive
    for person in people:
        assert person.found == []
        person.page.context.close()


@pytest.mark.parametrize("language", ["en", "de"])
def test_from_consent_to_report(come: Come, study: StudyServer, tmp_path: Path, language: str) -> None:
    person = come(language)
    page = person.page
    person.heading("Fetching" if language == "en" else "Holen")
    person.look()
    person.agree()
    person.look()
    for number in range(3):
        person.get()
        if number == 0:
            person.look()
        page.click("#next")
        if number < 2:
            expect(page.locator("#task-title")).to_contain_text(f"{number + 1} ", timeout=PATIENCE)
    page.fill("#study-page textarea", "Markers, I think.")
    person.look()
    page.click("#study-page .strong")
    expect(page.locator("fieldset.scale")).to_be_visible()
    person.look()
    page.get_by_label("Names").check()
    page.locator("fieldset.scale input").nth(4).check()
    page.set_viewport_size({"width": 390, "height": 844})
    page.click("#study-page .strong")
    completion = page.locator(".code").inner_text()
    person.look()
    assert study.rows("SELECT completion FROM participants") == [(completion,)]
    assert study.rows("SELECT count(*) FROM answers") == [(3,)]
    reported(person, study, tmp_path)


def reported(person: Participant, study: StudyServer, folder: Path) -> None:
    """The researcher's page shows who is done, and what it exports is reported like any study."""
    page = person.page.context.new_page()
    page.goto(f"{study.address}researcher.html#token={TOKEN}")
    expect(page.locator("tbody tr")).to_contain_text("2 / 2", timeout=PATIENCE)
    result = Axe().run(page)
    assert result.violations_count == 0, result.generate_report()
    with page.expect_download() as download:
        page.click("#export")
    download.value.save_as(folder / "all.zip")
    with zipfile.ZipFile(folder / "all.zip") as archive:
        archive.extractall(folder)
    program = str(Path(sys.executable).with_name("fetch-pomdp"))
    logs = sorted((folder / "small" / "logs").iterdir())
    assert len(logs) == 2
    subprocess.run([program, "log", "check", *map(str, logs)], check=True)
    subprocess.run([program, "study", "report", str(folder / "small")], check=True)
    assert (folder / "small" / "report" / "report.html").is_file()


def test_a_killed_server_and_a_reloaded_page_lose_nothing(come: Come, study: StudyServer) -> None:
    person = come()
    person.agree()
    wanted = person.begin()
    person.say("the marker")
    asked = person.asked()
    person.page.wait_for_timeout(2500)  # the question's own event comes with its end
    study.kill()
    before = study.rows("SELECT line FROM events ORDER BY trial, number")
    assert any('"point"' in str(line) for line in before)
    expect(person.page.locator("#state")).to_contain_text("lost", timeout=PATIENCE)
    study.start()
    expect(person.page.locator("#state")).to_have_text("The robot is listening.", timeout=PATIENCE)
    assert study.rows("SELECT line FROM events ORDER BY trial, number")[: len(before)] == before
    person.page.reload()
    expect(person.page.locator("#task-item")).to_have_text(wanted, timeout=PATIENCE)
    expect(person.page.locator("#ready")).to_be_hidden()  # no new countdown in the middle of a round
    expect(person.page.locator("#say")).to_be_enabled()
    person.say("yes" if SIDES.findall(asked)[-1:] == SIDES.findall(wanted) else "no")  # the question still stands
    expect(person.page.locator("#next")).to_be_visible(timeout=PATIENCE)
    assert SIDES.findall(person.page.locator("#outcome").inner_text()) == SIDES.findall(wanted)
    assert study.rows("SELECT count(*) FROM trials") == [(1,)]


def test_who_withdraws_is_deleted(come: Come, study: StudyServer) -> None:
    person = come()
    person.agree()
    person.begin()
    person.say("a green marker")
    expect(person.page.locator("#answers")).to_be_visible()
    person.page.click("#withdraw")
    person.look()
    person.page.click("#leave")
    person.heading("You take part no longer")
    assert study.rows("SELECT count(*) FROM participants") == [(0,)]
    for _ in range(100):  # the file is written anew after the person was told
        if b"a green marker" not in study.database.read_bytes():
            break
        person.page.wait_for_timeout(100)
    else:
        pytest.fail("the words of who has withdrawn are in the file")
    person.page.reload()
    person.heading("Fetching")


def test_the_keyboard_is_enough(come: Come) -> None:
    person = come()
    keyboard = person.page.keyboard

    def press(selector: str) -> None:
        """Go to a button with the Tab key, and press it."""
        expect(person.page.locator(selector)).to_be_visible()
        for _ in range(20):
            keyboard.press("Tab")
            if person.page.locator(selector).evaluate("element => element === document.activeElement"):
                break
        keyboard.press("Enter")

    person.heading("Fetching")
    press("#study-page .strong")
    person.heading("How it goes")
    press("#study-page .strong")
    press("#ready")
    expect(person.page.locator("#say")).to_be_focused(timeout=PATIENCE)
    keyboard.type("the marker")
    keyboard.press("Enter")
    person.asked()
    keyboard.type("yes")
    keyboard.press("Enter")
    expect(person.page.locator("#next")).to_be_focused(timeout=PATIENCE)
    keyboard.press("Enter")
    expect(person.page.locator("#task-title")).to_have_text("Round 1 of 2", timeout=PATIENCE)

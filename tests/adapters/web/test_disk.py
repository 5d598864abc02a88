"""No answer of the server, whatever it is asked, tells of the disk it runs on."""

from __future__ import annotations

import json
import random
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from starlette.testclient import TestClient

import fetch_pomdp
from fetch_pomdp.adapters.web.connection_manager import ServerConfig
from tests.adapters.web.test_server import ENDLESS, HELLO, HOME, ORIGIN, SESSION, House, house_of, nonsense

TELLTALES = ("Traceback", '.py"', "site-packages", "/lib/python", "\\\\lib\\\\", "fetch_pomdp/")
COUNT = 3_000


def telling(text: str, data: Path) -> list[str]:
    """What of an answer tells of the disk."""
    homes = {str(data), str(Path.home()), sys.prefix, str(Path(fetch_pomdp.__file__).parents[2])} - {"/"}
    return [mark for mark in (*TELLTALES, *homes) if mark in text]


def bad_tables(rng: random.Random) -> str:
    """The text of a scene file with something wrong in it, or a path in place of it."""
    item = '[[items]]\nid = "cup"\nposition = [0, 3, 0.7]\nvocabulary = ["cup"]\n'
    good = f"head = [0, 0, 1.6]\n{item}[model]\nsigma = 0.1\n"
    if rng.random() < 0.2:
        return rng.choice(
            ["/etc/passwd", "../../etc/passwd", "file:///etc/passwd", "C:\\secret.toml", "\x00", "~/.ssh/id"]
        )
    letters = list(good)
    for _ in range(rng.randint(1, 5)):
        place = rng.randrange(len(letters))
        letters[place] = rng.choice(['"', "[", "]", "=", "\n", "9", "-", "e", "nan", "\\", "#", "'", "é", "\ud800"])
    return "".join(letters)


def greetings(rng: random.Random) -> str:
    """A hello that is refused, or is not."""
    odd: list[object] = [
        None,
        True,
        -1,
        1e99,
        "",
        "/etc/passwd",
        "../" * 9,
        [],
        {},
        {"toml": 1},
        {"path": "/etc/passwd"},
        "\x00",
        "é" * 301,
    ]
    hello = {
        **HELLO,
        rng.choice(["scene", "planner", "seed", "resume", "token", "version", "data", "type"]): rng.choice(odd),
    }
    return json.dumps({**hello, "scene": {"toml": bad_tables(rng)}} if rng.random() < 0.5 else hello)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return tmp_path / "journals"


@pytest.fixture
def house(data: Path) -> Iterator[House]:
    with house_of(ServerConfig(limits=ENDLESS), data=data) as made:
        yield made


def test_no_message_of_a_conversation_does(house: House, data: Path) -> None:
    rng, page = random.Random(1), house.page()
    page.next("welcome")
    for number in range(COUNT):
        page.send(nonsense(rng) if number % 10 else greetings(rng))
        if number % 17 == 0:
            page.socket.send_bytes(rng.randbytes(rng.choice([1, 3, 33])))
    page.send({"type": "typed", "text": "spoon"})
    refused = 0
    while True:
        text = page.socket.receive_text()
        assert telling(text, data) == []
        message = json.loads(text)
        refused += message["type"] == "error"
        if message["type"] == "observed" and "spoon" in (message["observation"]["utterance"] or ""):
            break
    assert refused > COUNT / 2


def test_no_answer_to_a_first_message_does(house: House, data: Path) -> None:
    rng, kinds = random.Random(2), set()
    for _ in range(400):
        first = greetings(rng) if rng.random() < 0.8 else nonsense(rng)
        with house.client.websocket_connect(SESSION, headers=ORIGIN) as socket:
            socket.send_text(first)
            text = socket.receive_text()
        assert telling(text, data) == [], first
        kinds.add(json.loads(text)["type"])
    assert kinds == {"error", "welcome"}


def test_no_answer_over_http_does(house: House, data: Path) -> None:
    rng = random.Random(3)
    parts = [
        "..",
        "%2e%2e",
        "..%2f",
        "etc",
        "passwd",
        "app.js",
        "voice",
        ".wav",
        "%00",
        "%ff",
        "~",
        "session",
        "vendor",
        "//",
        "\\",
    ]
    methods = ["GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "TRACE"]
    headers = [
        {},
        {"range": "bytes=9-1"},
        {"range": "bytes=0-0,-1,z"},
        {"if-none-match": "*"},
        {"if-modified-since": "never"},
    ]
    quiet = TestClient(house.client.app, raise_server_exceptions=False)
    for _ in range(COUNT // 3):
        path = HOME + "/" + "/".join(rng.choice(parts) for _ in range(rng.randint(0, 5)))
        answer = quiet.request(rng.choice(methods), path, headers=rng.choice(headers))
        said = f"{answer.headers} {answer.text if 'javascript' not in answer.headers.get('content-type', '') else ''}"
        assert telling(said, data) == [], path
        assert answer.status_code < 500, path

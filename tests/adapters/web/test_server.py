"""The server as a page sees it: over HTTP and a WebSocket, with nothing replaced."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from fetch_pomdp.adapters.web import robot
from fetch_pomdp.adapters.web.connection_manager import ServerConfig
from fetch_pomdp.adapters.web.conversations import ConversationOpener
from fetch_pomdp.adapters.web.ears import speech_if_installed
from fetch_pomdp.adapters.web.page_connection import ConnectionLimits
from fetch_pomdp.adapters.web.server import create_app
from fetch_pomdp.core.live.person import LIVE_MODEL

HOME = "http://127.0.0.1:8000"
ORIGIN = {"origin": HOME}
SESSION = "ws://127.0.0.1:8000/session"  # the test client calls a relative address testserver
HELLO = {"type": "hello", "version": 1, "planner": "threshold"}
USUAL = ServerConfig()
FOR_EVER = 1e6  # s
ENDLESS = ConnectionLimits(messages=1e9, sound=1e9)


class Page:
    """A page without a browser."""

    def __init__(self, client: TestClient, **hello: Any) -> None:
        self._context = client.websocket_connect(SESSION, headers=ORIGIN)
        self.socket = self._context.__enter__()
        self.send({**HELLO, **hello})

    def send(self, message: Any) -> None:
        self.socket.send_text(message if isinstance(message, str) else json.dumps(message))

    def next(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The next message of a kind, with certain fields."""
        while True:
            message: dict[str, Any] = json.loads(self.socket.receive_text())
            if message["type"] == kind and wanted.items() <= message.items():
                return message

    def leave(self) -> None:
        self._context.__exit__(None, None, None)


class House:
    """A server and the pages that are open."""

    def __init__(self, client: TestClient) -> None:
        self.client = client
        self.pages: list[Page] = []

    def page(self, **hello: Any) -> Page:
        self.pages.append(Page(self.client, **hello))
        return self.pages[-1]


@contextmanager
def house_of(
    config: ServerConfig = USUAL,
    *,
    data: Path | None = None,
    insight: bool = True,
) -> Iterator[House]:
    speech = speech_if_installed()
    app = create_app(config, ConversationOpener(data, insight=insight, speech=speech), voice=speech.voice)
    with TestClient(app, base_url=HOME) as client:
        house = House(client)
        yield house
        for page in house.pages:
            page.leave()


@pytest.fixture
def house() -> Iterator[House]:
    with house_of() as made:
        yield made


@pytest.fixture
def client(house: House) -> TestClient:
    return house.client


def test_the_page_and_all_it_loads_are_in_the_package(client: TestClient) -> None:
    page = client.get("/")
    assert page.status_code == 200
    assert "default-src 'self'" in page.headers["content-security-policy"]
    for name in (
        "app.js",
        "style.css",
        "texts.json",
        "worklet.js",
        "vendor/three.module.min.js",
        "vendor/three.core.min.js",
        "vendor/pose/pose.js",
        "vendor/pose/pose_landmark_lite.tflite",
        "vendor/pose/pose_solution_simd_wasm_bin.wasm",
    ):
        assert client.get(f"/{name}").status_code == 200, name
    assert "http" not in page.text


def test_only_the_worker_of_the_pose_model_may_compile_webassembly(client: TestClient) -> None:
    policies = {
        name: client.get(name).headers["content-security-policy"] for name in ("/", "/app.js", "/pose-worker.js")
    }
    allowed = {name for name, policy in policies.items() if "'wasm-unsafe-eval'" in policy}
    assert allowed == {"/pose-worker.js"}
    assert not any("'unsafe-eval'" in policy or "'unsafe-inline'" in policy for policy in policies.values())


def test_a_calibrated_camera_sets_the_spread_of_pointing(house: House) -> None:
    assert house.page(sigma=0.21).next("welcome")["scene"]["sigma"] == 0.21
    assert house.page().next("welcome")["scene"]["sigma"] == LIVE_MODEL.sigma


def test_a_page_is_told_the_table_to_begin_with(client: TestClient) -> None:
    assert client.get("/table.json").json() == {"scene": "ambiguous"}
    own = {"toml": 'head = [0, 0, 1.6]\n[[items]]\nid = "cup"\nposition = [0, 3, 0.7]\nvocabulary = ["cup"]\n'}
    with house_of(ServerConfig(scene=own)) as house:
        welcome = house.page(**house.client.get("/table.json").json()).next("welcome")
        assert [item["id"] for item in welcome["scene"]["items"]] == ["cup"]


def test_both_languages_have_every_text(client: TestClient) -> None:
    texts = client.get("/texts.json").json()
    assert texts["en"].keys() == texts["de"].keys()
    holes = {language: {key: sorted(_holes(text)) for key, text in all_.items()} for language, all_ in texts.items()}
    assert holes["en"] == {**holes["de"], "why_it": []}  # a pronoun, where other languages name the item
    assert holes["de"]["why_it"] == ["item"]


def _holes(text: str) -> list[str]:
    return [part.partition("}")[0] for part in text.split("{")[1:]]


@pytest.mark.parametrize(
    "path", ["/../server.py", "/%2e%2e/server.py", "/..%2fserver.py", "//etc/passwd", "/voice/%2e%2e.wav"]
)
def test_no_other_file_is_served(client: TestClient, path: str) -> None:
    answer = client.get(path)
    assert answer.status_code == 404
    assert str(Path(__file__).parents[3]) not in answer.text


def test_a_name_that_was_made_to_lead_here_is_not_answered(client: TestClient) -> None:
    assert client.get("/", headers={"host": "evil.example"}).status_code == 421


@pytest.mark.parametrize("headers", [{}, {"origin": "http://evil.example"}, {"origin": HOME, "host": "evil.example"}])
def test_a_page_of_another_site_may_not_talk_to_it(client: TestClient, headers: dict[str, str]) -> None:
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(SESSION, headers=headers):
        pass


def test_a_token_is_needed_where_there_is_one() -> None:
    with house_of(ServerConfig(token="a secret of many letters")) as house:
        page = house.page(token="a guess")
        assert "token" in page.next("error")["message"]
        with pytest.raises(WebSocketDisconnect):
            page.socket.receive_text()
        page = house.page(token="a secret of many letters")
        assert page.next("welcome")["picked"] is None


def test_a_request_a_question_an_answer_and_a_hand_over(house: House) -> None:
    page = house.page()
    welcome = page.next("welcome")
    assert welcome["belief"]["marker-1"] == pytest.approx(1 / 6)
    page.send({"type": "typed", "text": "hand me the green marker"})
    shown = page.next("belief", provisional=True)  # at once, before the step has ended
    assert shown["belief"]["marker-1"] > 0.3
    asked = page.next("decided", action="point")
    assert asked["item"] in ("marker-1", "marker-2")
    assert asked["explanation"]["sentence"]
    assert asked["phrase"]["key"] == "why_sentence"
    assert page.next("say")["text"] == "This one?"
    page.next("action", action="point", outcome="done")
    page.send({"type": "typed", "text": "yes"})
    assert page.next("say")["text"] == "Here you are."
    assert page.next("action", action="pick", outcome="done")["item"] == asked["item"]


def test_what_is_being_typed_is_shown_and_leaves_no_trace_when_it_is_changed(house: House) -> None:
    page = house.page()
    page.next("status", sensor="planner", state="ok")
    page.send({"type": "typing", "text": "green mar"})
    shown = page.next("belief", provisional=True)
    assert shown["heard"] == ["green"], "the last word may be unfinished"
    page.send({"type": "typed", "text": "spoon"})
    heard = page.next("observed")
    assert heard["observation"]["utterance"] == "spoon"
    belief = page.next("belief", provisional=False)["belief"]
    assert belief["marker-1"] == pytest.approx(belief["bowl-1"], rel=0.1)


def test_what_was_understood_is_told_and_whose_left_it_may_be(house: House) -> None:
    page = house.page()
    page.send({"type": "typed", "text": "the marker on the left"})
    assert page.next("observed")["reading"] == {"meaning": "marker, left", "whose": True}
    page.send({"type": "typed", "text": "on my left"})
    assert page.next("observed")["reading"]["whose"] is False


def test_the_first_decision_is_about_what_woke_the_robot(house: House) -> None:
    """With two or three items it would ask about one of them at once, whatever is being said."""
    table = "\n".join(
        f'[[items]]\nid = "{name}"\nposition = [{x}, 1.2, 0.75]\nvocabulary = ["{word}"]'
        for name, x, word in (("mug-1", -0.3, "mug"), ("mug-2", 0.0, "mug"), ("pen", 0.3, "pen"))
    )
    page = house.page(scene={"toml": f"head = [0.0, 0.0, 1.6]\n{table}"}, planner="fitted")
    page.send({"type": "typed", "text": "give me the pen please"})
    assert page.next("observed")["observation"]["utterance"] == "give me the pen please"
    assert "pen" in page.next("decided")["explanation"]["sentence"]


def test_words_that_nobody_knows_are_told_as_such(house: House) -> None:
    page = house.page()
    page.send({"type": "typed", "text": "den grünen Stift bitte"})
    heard = page.next("observed")
    assert (heard["understood"], heard["unknown"]) == (False, ["den", "grünen", "stift"])
    page.send({"type": "typed", "text": "grün marker"})
    assert page.next("observed")["understood"]


def test_pointing_alone_begins_an_interaction(house: House) -> None:
    page = house.page()
    page.send({"type": "ray", "head": [0, 0, 1.6], "wrist": [0.0675, 0.576, 1.447]})
    seen = page.next("observed")["observation"]
    assert (seen["utterance"], seen["head"]) == (None, [0.0, 0.0, 1.6])
    belief = page.next("belief", provisional=False)["belief"]
    assert max(belief, key=belief.get) == "spoon-2"


def test_who_may_not_look_into_the_robot_s_mind_is_told_nothing_of_it() -> None:
    with house_of(insight=False) as house:
        page = house.page()
        assert page.next("welcome")["belief"] is None
        page.send({"type": "typed", "text": "hand me the green marker"})
        assert "belief" not in page.next("belief", provisional=True)
        assert page.next("decided", action="point").keys() == {"type", "t", "action", "item"}


def test_a_hand_over_can_be_stopped(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, "GRASP", FOR_EVER)
    page = house.page(planner="paper-never")
    page.send({"type": "typed", "text": "green marker expo pen"})
    item = page.next("decided", action="pick")["item"]
    page.send({"type": "typed", "text": "stop"})
    assert page.next("action", action="pick")["outcome"] == "stopped"
    assert page.next("say")["text"] == "All right, not that one."
    assert page.next("belief", provisional=False)["belief"][item] < 0.1


def test_two_people_hear_nothing_of_each_other(house: House) -> None:
    one, other = house.page(), house.page(scene="unambiguous")
    sessions = {page.next("welcome")["session"] for page in (one, other)}
    assert len(sessions) == 2
    one.send({"type": "typed", "text": "marker"})
    other.send({"type": "typed", "text": "spoon"})
    for page, word, absent in ((one, "marker", "spoon"), (other, "spoon", "marker")):
        heard = page.next("observed")
        assert heard["observation"]["utterance"] == word
        belief = page.next("belief", provisional=False)["belief"]
        assert belief[f"{word}-1"] > 2 * belief[f"{absent}-1"]


def test_who_comes_back_goes_on_where_they_were(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with house_of(data=tmp_path) as house:
        page = house.page()
        secret = page.next("welcome")["resume"]
        page.send({"type": "typed", "text": "green marker"})
        asked = page.next("action", action="point")["item"]
        monkeypatch.setattr(robot, "ARM", FOR_EVER)  # however long it takes to leave, no more is asked
    with house_of(data=tmp_path) as house:  # another server
        page = house.page(resume=secret, scene="unambiguous")
        welcome = page.next("welcome")
        assert (welcome["resumed"], welcome["scene_name"]) == (True, "ambiguous")
        assert [event["type"] for event in welcome["past"]] == ["observed", "action"]
        page.send({"type": "typed", "text": "no"})
        other = ({"marker-1", "marker-2"} - {asked}).pop()
        belief = page.next("belief", provisional=False, heard=["no"])["belief"]
        assert max(belief, key=belief.get) == other
        page.next("decided", item=other)


def test_what_was_handed_over_is_known_to_who_comes_back_after_it(house: House) -> None:
    page = house.page(planner="paper-never")
    secret = page.next("welcome")["resume"]
    page.send({"type": "typed", "text": "green marker expo pen"})
    picked = page.next("action", action="pick", outcome="done")["item"]
    assert house.page(resume=secret).next("welcome")["picked"] == picked


def test_who_comes_back_elsewhere_takes_the_conversation_along(house: House) -> None:
    first = house.page()
    secret = first.next("welcome")["resume"]
    second = house.page(resume=secret)
    assert second.next("welcome")["resumed"]
    with pytest.raises(WebSocketDisconnect) as left:
        first.next("nothing")
    assert left.value.code == 4001


def test_more_people_than_there_is_room_for_are_told_so() -> None:
    with house_of(ServerConfig(most_people=1)) as house:
        page = house.page()
        page.next("welcome")
        refused = house.page()
        assert refused.next("error")["message"] == "server full (1 of 1); try again later"
        with pytest.raises(WebSocketDisconnect) as left:
            refused.next("nothing")
        assert left.value.code == 1013, "the page tries again after that"


def test_who_sends_too_much_is_not_heard_and_then_let_go() -> None:
    with house_of(ServerConfig(limits=ConnectionLimits(messages=0.0))) as house:
        page = house.page()
        page.next("welcome")
        for _ in range(230):
            page.send({"type": "typed", "text": "marker"})
        with pytest.raises(WebSocketDisconnect) as left:
            page.next("nothing")
        assert left.value.code == 1008


def nonsense(rng: random.Random) -> str:
    """A message that is none: a good one with something wrong, or no JSON at all."""
    good = [
        '{"type": "typed", "text": "marker"}',
        '{"type": "ray", "head": [0, 0, 1.6], "wrist": [0, 0.5, 1.4]}',
        '{"type": "hello", "version": 1}',
        '{"type": "microphone", "on": false}',
    ]
    letters = list(rng.choice(good))
    for _ in range(rng.randint(1, 4)):
        letters.insert(
            rng.randrange(len(letters)), rng.choice(['"', "{", "[", "\\", "9", "e", "\x00", "é", "null", "-"])
        )
        del letters[rng.randrange(len(letters))]
    return "".join(letters) + rng.choice(["", "}", "]", " 1"])


def test_ten_thousand_malformed_messages_and_nothing_dies() -> None:
    rng, count = random.Random(0), 10_000
    with house_of(ServerConfig(limits=ENDLESS)) as house:
        witness, page = house.page(), house.page()
        for each in (witness, page):
            each.next("welcome")
        for number in range(count):
            if number % 10 == 9:
                page.socket.send_bytes(rng.randbytes(rng.choice([1, 3, 33])))
            else:
                page.send(nonsense(rng))
        page.send({"type": "typed", "text": "spoon"})
        page.next("observed")
        witness.send({"type": "typed", "text": "bowl"})
        assert witness.next("observed")["observation"]["utterance"] == "bowl"

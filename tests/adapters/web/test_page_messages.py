"""What a page may send: understood, or refused with the field that is wrong."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.adapters.web.page_messages import (
    LARGEST_MESSAGE,
    MOST_ITEMS,
    Hello,
    Microphone,
    PageMessage,
    Pointed,
    Typed,
    header_of,
    read_page_message,
)
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.live.person import LIVE_MODEL
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import InputError
from fetch_pomdp.files.header import Header

TABLE = """
head = [0.0, 0.0, 1.6]
[[items]]
id = "mug"
position = [0.1, 1.0, 0.75]
vocabulary = ["mug"]
"""


def read(text: str) -> PageMessage | Header:
    """A message; of a hello the interaction that it asks for."""
    message = read_page_message(text)
    return header_of(message) if isinstance(message, Hello) else message


def hello(**fields: Any) -> Header:
    """The interaction that a hello asks for."""
    header = read(json.dumps({"type": "hello", "version": 1, **fields}))
    assert isinstance(header, Header)
    return header


def test_hello_has_defaults() -> None:
    header, message = hello(), read_page_message('{"type": "hello", "version": 1}')
    assert (header.scene_name, header.planner, header.seed) == ("ambiguous", "fitted", 0)
    assert header.scene.items == named(Scene.load("ambiguous")).items
    assert message == Hello(choices={}, resume=None, participant=None, token=None)


def test_a_hello_is_read_without_its_table() -> None:
    """Of a page that may not come in, nothing that is work is done."""
    message = read_page_message(json.dumps({"type": "hello", "version": 1, "token": "guess", "scene": {"toml": "["}}))
    assert isinstance(message, Hello)
    assert message.token == "guess"
    with pytest.raises(InputError, match="broken TOML"):
        header_of(message)


def test_a_page_s_tables_expect_live_people_unless_their_file_does_not() -> None:
    assert hello().scene.model == hello(scene={"toml": TABLE}).scene.model == LIVE_MODEL
    own = hello(scene={"toml": TABLE + "[model]\np_l = 0.9\n"}).scene.model
    assert own == LIVE_MODEL.with_changes({"p_l": 0.9})
    constant = hello(scene={"toml": TABLE + "[model]\nturns = false\n"}).scene.model
    assert constant == LIVE_MODEL.with_changes({"turns": False})
    assert constant.turns is None


@pytest.mark.parametrize("scene", ["ambiguous", {"toml": TABLE + "[model]\nsigma = 0.1\nalpha = 0.5\n"}])
def test_a_calibrated_camera_sets_the_spread_of_pointing_and_nothing_else(scene: Any) -> None:
    plain, calibrated = hello(scene=scene, sigma=None).scene, hello(scene=scene, sigma=0.21).scene
    assert plain == hello(scene=scene).scene
    assert calibrated.model.with_changes({"sigma": plain.model.sigma}) == plain.model
    assert (calibrated.model.sigma, calibrated.items) == (0.21, plain.items)


def test_the_other_messages() -> None:
    assert read_page_message('{"type": "typed", "text": "the cup"}') == Typed("the cup")
    assert read_page_message('{"type": "microphone", "on": true}') == Microphone(True)
    pointed = read_page_message('{"type": "ray", "head": [0, 0, 1.6], "wrist": [0, 0.5, 1.4]}')
    assert pointed == Pointed((0.0, 0.0, 1.6), (0.0, 0.5, 1.4))


@pytest.mark.parametrize(
    ("text", "field"),
    [
        ("", ""),
        ("[]", ""),
        ('{"text": "a"}', "type"),
        ('{"type": ["typed"], "text": "a"}', "type"),
        ('{"type": "typed"}', "text"),
        ('{"type": "typed", "text": 3}', "text"),
        ('{"type": "typed", "text": "' + "a" * 301 + '"}', "text"),
        ('{"type": "typed", "text": "a", "volume": 1}', "volume"),
        ('{"type": "ray", "head": [0, 0, 1]}', "wrist"),
        ('{"type": "ray", "head": [0, 0, 1], "wrist": [0, 0, 1]}', "wrist"),
        ('{"type": "ray", "head": [0, 0, NaN], "wrist": [0, 0, 1]}', "head"),
        ('{"type": "ray", "head": [0, 0, 1e999], "wrist": [0, 0, 1]}', "head"),
        ('{"type": "microphone", "on": 1}', "on"),
        ('{"type": "hello"}', "version"),
        ('{"type": "hello", "version": true}', "version"),
        ('{"type": "hello", "version": 1, "scene": "../../etc/passwd"}', "scene"),
        ('{"type": "hello", "version": 1, "scene": {"path": "/etc/passwd"}}', "path"),
        ('{"type": "hello", "version": 1, "planner": "best"}', "planner"),
        ('{"type": "hello", "version": 1, "seed": -1}', "seed"),
        ('{"type": "hello", "version": 1, "sigma": 0}', "sigma"),
        ('{"type": "hello", "version": 1, "sigma": 0.31}', "sigma"),
        ('{"type": "hello", "version": 1, "sigma": NaN}', "sigma"),
        ('{"type": "hello", "version": 1, "sigma": "0.1"}', "sigma"),
        ('{"type": "hello", "version": 1, "resume": 7}', "resume"),
        ("[" * 100_000, ""),
    ],
)
def test_what_is_no_message_is_refused_with_its_field(text: str, field: str) -> None:
    with pytest.raises(InputError) as raised:
        read(text)
    assert raised.value.field == field


def test_a_broken_table_is_answered_with_its_line() -> None:
    with pytest.raises(InputError, match=r"^table:6: items\[0\].vocabulary"):
        hello(scene={"toml": TABLE.replace('["mug"]', "[]")})
    with pytest.raises(InputError, match=r"^table:3: broken TOML"):
        hello(scene={"toml": "\nhead = [\n"})
    many = TABLE + "".join(TABLE.split("1.6]")[1].replace("mug", f"mug{number}") for number in range(MOST_ITEMS))
    with pytest.raises(InputError, match=f"found {MOST_ITEMS + 1}, expected at most {MOST_ITEMS}"):
        hello(scene={"toml": many})


def test_a_message_that_is_too_large_is_not_read() -> None:
    with pytest.raises(InputError, match=str(LARGEST_MESSAGE)):
        read_page_message('{"type": "typed", "text": "' + " " * LARGEST_MESSAGE + '"}')


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)
FIELDS = st.sampled_from(["text", "head", "wrist", "on", "version", "scene", "planner", "seed", "resume", "token", "x"])


@given(
    kind=st.sampled_from(["hello", "typed", "ray", "microphone"]), fields=st.dictionaries(FIELDS, VALUES, max_size=5)
)
def test_nothing_but_a_complaint_comes_of_nonsense(kind: str, fields: dict[str, Any]) -> None:
    for text in (json.dumps({**fields, "type": kind}), json.dumps(fields)):
        complaint = ""
        try:
            read(text)
        except InputError as error:
            complaint = str(error)
        assert "\n" not in complaint

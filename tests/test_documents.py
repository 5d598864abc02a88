"""Text files as mappings that remember their lines, and the checks of single values."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp import checks, documents
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import (
    LARGEST_TOML,
    MOST_LEVELS,
    json_lines,
    parse_toml,
    read_json_lines,
    read_text,
    read_toml,
)
from fetch_pomdp.errors import EventError, InputError, ModelError, SceneError, StudyError

GOOD = """\
# a comment
head = [0.0, 0.0, 1.6]

[model]
sigma = 0.2

[rewards]
point = -5.0

[[items]]
id = "cup"
position = [0.0, 2.0, 0.75]
vocabulary = ["cup", "mug"]

[[items]]
id = "pot"
position = [0.5, 2.0, 0.75]
vocabulary = ["pot"]
"""


def toml(tmp_path: Path, content: str | bytes) -> Path:
    path = tmp_path / "scene.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def test_a_scene_file(tmp_path: Path) -> None:
    scene = Scene.load(toml(tmp_path, GOOD))
    assert [item.id for item in scene.items] == ["cup", "pot"]
    assert scene.head == (0.0, 0.0, 1.6)
    assert scene.model.sigma == 0.2
    assert scene.rewards.point == -5.0
    assert Scene.load(str(toml(tmp_path, GOOD))) == scene


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("sigma = 0.2", "sigma = -0.2", 5, "model.sigma: found -0.2, expected an angle above 0"),
        ("sigma = 0.2", "sigmma = 0.2", 5, "model.sigmma: unknown parameter, expected one of alpha"),
        ("sigma = 0.2", "sigma = nan", 5, "model.sigma: found nan"),
        ("point = -5.0", "point = inf", 8, "rewards.point: found inf"),
        ("point = -5.0", "pont = 1", 8, "rewards.pont: unknown reward"),
        ("head = [0.0, 0.0, 1.6]", "head = [0.0, 1.6]", 2, "head: found [0.0, 1.6], expected [x, y, z]"),
        ("head = [0.0, 0.0, 1.6]", "head = [0.0, 0.0, -inf]", 2, "head: found -inf"),
        ("head = [0.0, 0.0, 1.6]", "head = [0, 0, 0x" + "f" * 9_000 + "]", 2, "head: found a huge int"),
        ("head = [0.0, 0.0, 1.6]", "", 1, "head: found no such field, expected one among 'model', 'rewards', 'items'"),
        (
            "head = [0.0, 0.0, 1.6]",
            "heads = 3\nhead = [0, 0, 1]",
            2,
            "heads: unknown field, expected one of head, items",
        ),
        ('id = "pot"', 'id = "cup"', 16, "items[1].id: found 'cup', which items[0] has, expected an id of its own"),
        ('id = "pot"', "id = 7", 16, "items[1].id: found 7"),
        ('id = "pot"', "", 15, "items[1].id: found no such field"),
        ('vocabulary = ["pot"]', "vocabulary = []", 18, "items[1].vocabulary: found []"),
        ('vocabulary = ["pot"]', 'vocabulary = ["pot", ""]', 18, "items[1].vocabulary[1]: found ''"),
        ('vocabulary = ["pot"]', 'vocabulary = ["pot"]\ncolour = 1', 19, "items[1].colour: unknown field"),
        ("[0.5, 2.0, 0.75]", "[0.0, 0.0, 1.6]", 17, "items[1].position: found the position of the head"),
        ("[0.5, 2.0, 0.75]", '["a", 2, 3]', 17, "items[1].position: found 'a'"),
        ("# a comment", "# a\u2028comment\nhead = 3", 3, "broken TOML: Cannot overwrite a value"),
        ("# a comment", "# a\u2028comment\nheads = 3", 2, "heads: unknown field"),
        ("# a comment", "a = ", 1, "broken TOML: Invalid value"),
        ("# a comment", "a = [1,", 19, "broken TOML: "),
    ],
)
def test_a_bad_scene_is_one_line_with_its_place(tmp_path: Path, old: str, new: str, line: int, message: str) -> None:
    assert old in GOOD
    path = toml(tmp_path, GOOD.replace(old, new))
    with pytest.raises(InputError) as caught:
        Scene.load(path)
    found = str(caught.value)
    if new != "a = [1,":
        assert found.startswith(f"{path}:{line}: {message}")
    assert "expected" in found
    assert "\n" not in found
    assert len(found) < 400


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", ":1: head: found no such field, expected one among none"),
        (b"items = 3\nhead = [0, 0, 1]\n", ":1: items: found 3, expected [[items]] tables, one an item"),
        (b"items = []\nhead = [0, 0, 1]\n", ":1: items: found no items, expected one or more"),
        (b"items = [3]\nhead = [0, 0, 1]\n", ":1: items[0]: found 3, expected a table of named fields"),
        (b"head = [0, 0, 1]\nitems = [{id = 3}]\n", ":2: items[0].position: found no such field"),
        (b"model = 3\nhead = [0, 0, 1]\nitems = []\n", ":1: model: found 3, expected a table of named fields"),
        (b"# ok\n# \xff\n", ":2: found byte 0xff, expected UTF-8 text"),
        (b"a = " + b"1" * 5_000, ": broken TOML: Exceeds the limit"),
        (b"a = " + b"[" * 5_000, ": broken TOML: nested too deeply"),
        (b"a = 1979-13-40", ":1: broken TOML"),
    ],
)
def test_files_that_are_no_scene(tmp_path: Path, content: bytes, message: str) -> None:
    path = toml(tmp_path, content)
    with pytest.raises(InputError) as caught:
        Scene.load(path)
    assert str(caught.value).startswith(f"{path}{message}")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    for path in (tmp_path / "none.toml", tmp_path, Path("a\0b.toml"), Path("a" * 5_000 + ".toml")):
        for read in (read_text, read_toml):
            with pytest.raises(SceneError, match=r"cannot be read: .*, expected a readable file"):
                read(path, SceneError)
        with pytest.raises(EventError, match="cannot be read"):
            list(read_json_lines(path, EventError))


# JSON Lines.


def read(content: bytes) -> list[dict[str, Any]]:
    return [dict(document.data) for document in json_lines(io.BytesIO(content), "x.jsonl", EventError)]


DOTS = "a." * MOST_LEVELS + "a"
TEXTS = (f'x = "{DOTS}"', f'y = """{DOTS}\\""" {DOTS}"""""', f"z = '{DOTS}' # {DOTS}", f"q = '''{DOTS}\n{DOTS}''''")


@pytest.mark.parametrize(
    "text",
    [
        f"{DOTS} = 1",
        f"[{DOTS}]",
        f"[[{DOTS}]]",
        f"x = {{y = 1, {DOTS} = 1}}",
        f"x = [[{{{DOTS} = 1}}]]",
        DOTS.replace(".", " .\t") + " = 1",
        DOTS.replace("a", "'a'") + " = 1",
        DOTS.replace("a", '"\\"."') + " = 1",
        f"x = {{q = '''a'''', {DOTS} = 1, r = 'b'}}",  # a text that ends with a quote of its own
        f'x = {{q = """a""""", {DOTS} = 1, r = "b"}}',
    ],
)
def test_a_key_of_many_parts_is_not_parsed(text: str) -> None:
    """tomllib takes time with the square of their number: 18 s for 30,000."""
    with pytest.raises(StudyError, match=rf"^x\.toml:4: key with too many dots, expected at most {MOST_LEVELS} parts$"):
        parse_toml(f'x = "{DOTS}"\n\n\n{text}', "x.toml", StudyError)


def test_dots_of_texts_comments_and_numbers_are_no_key_s() -> None:
    text = "\n".join(TEXTS) + "\nn = [" + "1.5, " * 40 + "]\n" + ".".join("abcdefgh") + " = 1\n"
    data = parse_toml(text, "x.toml", StudyError).data
    assert (data["x"], data["y"], data["z"]) == (DOTS, f'{DOTS}""" {DOTS}""', DOTS)
    assert (data["q"], len(data["n"])) == (f"{DOTS}\n{DOTS}'", 40)


def test_a_file_of_any_size_is_not_read_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "large.toml"
    path.write_bytes(b"#" * (LARGEST_TOML + 1))
    with pytest.raises(StudyError, match=f"large.toml: file too large, expected at most {LARGEST_TOML} bytes"):
        read_toml(path, StudyError)
    path.write_bytes(b"#" * LARGEST_TOML)
    assert read_toml(path, StudyError).data == {}
    with pytest.raises(StudyError, match="file too large"):
        read_toml("/dev/zero", StudyError)


def test_json_lines_are_numbered_and_empty_ones_skipped() -> None:
    documents = list(json_lines(io.BytesIO(b'{"a": 1}\n\n  \r\n{"b": {"c": [2]}}'), "x.jsonl", EventError))
    assert [dict(document.data) for document in documents] == [{"a": 1}, {"b": {"c": [2]}}]
    assert [document.line_of("anything") for document in documents] == [1, 4]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'{"a": 1}\n{"a": ', "x.jsonl:2: broken JSON: Expecting value at column"),
        (b"[1]", "x.jsonl:1: found [1], expected a JSON object"),
        (b"null", "x.jsonl:1: found None, expected a JSON object"),
        (b'{"a": 1}\n\n{"a": 1, "b": 2, "a": 3}', "x.jsonl:3: a: found twice, expected once"),
        (b'{"a": {"b": 1, "b": 1}}', "x.jsonl:1: b: found twice, expected once"),
        (b'{"a": 1}\n{"a": "\xe9"}', "x.jsonl:2: found byte 0xe9, expected UTF-8 text"),
        (b'{"a": ' + b"1" * 5_000 + b"}", "x.jsonl:1: broken JSON: Exceeds the limit"),
        (b'{"a": ' + b"[" * 200_000, "x.jsonl:1: broken JSON: nested too deeply"),
        (b'\xef\xbb\xbf{"a": 1}', "x.jsonl:1: broken JSON"),
        (b'{"a": 1} {"b": 2}', "x.jsonl:1: broken JSON: Extra data"),
    ],
)
def test_lines_that_are_no_json_object(content: bytes, message: str) -> None:
    with pytest.raises(EventError) as caught:
        read(content)
    assert str(caught.value).startswith(message)
    assert "expected" in str(caught.value)


def test_lines_before_a_bad_one_are_read() -> None:
    documents = json_lines(io.BytesIO(b'{"a": 1}\nnonsense'), "x", EventError)
    assert next(documents).data == {"a": 1}
    with pytest.raises(EventError):
        next(documents)


# Checks.


def nested(depth: int) -> list[object]:
    value: list[object] = []
    for _ in range(depth):
        value = [value]
    return value


def test_shown_is_short_and_one_line() -> None:
    assert checks.shown("a\nb") == "'a\\nb'"
    assert len(checks.shown("x" * 1_000)) == 60
    assert checks.shown(10**9_000) == "a huge int"
    assert checks.shown(nested(5_000)) == "a huge list"


@given(st.one_of(st.none(), st.booleans(), st.text(), st.binary(), st.lists(st.integers()), st.complex_numbers()))
def test_number_refuses_what_is_none(value: object) -> None:
    with pytest.raises(ModelError, match=r"^x: found"):
        checks.number(value, "x", "a number", ModelError)


@given(st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(10**300), 10**300))
def test_number_takes_finite_ones(value: float) -> None:
    assert checks.number(value, "x", "a number", ModelError) == float(value)


@given(st.text(min_size=1).filter(lambda text: text.strip() != ""))
def test_text_takes_what_utf_8_can_hold(value: str) -> None:
    try:
        value.encode()
    except UnicodeEncodeError:
        with pytest.raises(ModelError):
            checks.text(value, "x", "text", ModelError)
    else:
        assert checks.text(value, "x", "text", ModelError) == value


def test_text_with_half_a_character_is_refused() -> None:
    for value in ("\ud800", "a\udfffb", "\udbff"):
        with pytest.raises(ModelError, match="expected text that UTF-8 can hold"):
            checks.text(value, "x", "text", ModelError)


def test_known_answers_with_the_known_ones() -> None:
    checks.known(["a"], ["a", "b"], "letter", ModelError)
    with pytest.raises(ModelError, match=r"^wate: unknown action, expected one of wait, point, did you mean 'wait'$"):
        checks.known(["wait", "wate"], ["wait", "point"], "action", ModelError)
    with pytest.raises(ModelError, match=r"^b: found no such field, expected one among 'a'$"):
        checks.required({"a": 1}, ["a", "b"], ModelError)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no device without end")
def test_what_has_no_end_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"^/dev/zero: found more than 64 MiB, expected a smaller file$"):
        documents.read_raw("/dev/zero", SceneError)
    with pytest.raises(SceneError, match=r"^/dev/zero:1: found a line of more than 16 MiB, expected a shorter one$"):
        list(documents.read_json_lines("/dev/zero", SceneError))
    (tmp_path / "two.jsonl").write_bytes(b'{"a": 1}\n' + b" " * (documents.LONGEST_LINE + 1))
    lines = documents.read_json_lines(tmp_path / "two.jsonl", SceneError)
    assert next(lines).data == {"a": 1}
    with pytest.raises(SceneError, match=r"two.jsonl:2: found a line"):
        next(lines)

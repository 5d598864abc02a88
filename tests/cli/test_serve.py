"""The command serve: what it refuses before it listens."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

from fetch_pomdp.cli.serve import address_of
from fetch_pomdp.user_study.config import load_user_study
from fetch_pomdp.user_study.store.store import Store
from tests.cli.conftest import Run
from tests.user_study.small import small_study


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.1", "robot.example"])
def test_beyond_loopback_a_token_is_needed(run: Run, host: str) -> None:
    code, _, error = run("serve", "--host", host)
    assert code == 2
    assert f"--token: {host} needs a token, such as --token " in error


def test_a_short_token_is_refused(run: Run) -> None:
    code, _, error = run("serve", "--token", "secret")
    assert (code, error) == (2, "fetch-pomdp: --token: found 6 characters, expected 16 or more\n")


@pytest.mark.parametrize("option", ["--token", "--researcher-token"])
@pytest.mark.parametrize(
    "token",
    [
        "a secret that ends with ",
        "ein-geheimes-wort-mit-ü",
        "no-text-\udcff-at-all-is-this",
        "tab\tbed-token-of-many",
        "",
    ],
)
def test_a_token_that_no_request_can_carry_is_refused(run: Run, option: str, token: str) -> None:
    code, _, error = run("serve", option, token)
    found = "expected printable ASCII characters, without a space at either end" if token else "found 0 characters"
    assert (code, error.count("\n")) == (2, 1)
    assert error.startswith(f"fetch-pomdp: {option}: {found}")


def test_a_folder_that_cannot_be_made_is_said_in_a_line(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for folder in (tmp_path / "file", tmp_path / "file" / "data", Path("/proc/data")):
        code, _, error = run("serve", "--data", folder)
        assert (code, error.splitlines()[-1].startswith(f"fetch-pomdp: --data: {folder}: ")) == (2, True)
        assert error.endswith("expected a folder, or a place for one\n")


def test_an_address_that_is_taken_is_said_in_a_line(run: Run) -> None:
    with socket.create_server(("127.0.0.1", 0)) as door:
        port = door.getsockname()[1]
        code, _, error = run("serve", "--port", port)
    assert code == 2
    assert error.splitlines()[-1].startswith(f"fetch-pomdp: --port: found 127.0.0.1:{port} (")


def test_a_table_that_is_none_is_said_with_file_and_line(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    path.write_text('head = [0, 0, 1.6]\n[[items]]\nid = "cup"\nposition = [0, 3]\nvocabulary = ["cup"]\n')
    code, _, error = run("serve", path)
    assert code == 2
    assert f"{path}:4: items[0].position" in error
    assert run("serve", "ambigous")[2].endswith(
        "expected one of ambiguous, unambiguous, or a TOML file, did you mean 'ambiguous'\n"
    )


def test_a_table_too_large_for_a_page_is_refused(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    item = '[[items]]\nid = "{0}"\nposition = [0.{0}, 3, 0.7]\nvocabulary = ["cup"]\n'
    path.write_text("head = [0, 0, 1.6]\n" + "".join(item.format(number) for number in range(10, 51)))
    code, _, error = run("serve", path)
    assert (code, error) == (2, f"fetch-pomdp: {path}: items: found 41, expected at most 40\n")


@pytest.mark.parametrize("option", ["--database", "--researcher-token"])
def test_what_belongs_to_a_study_needs_one(run: Run, option: str) -> None:
    code, _, error = run("serve", option, "sqlite:///nowhere.db")
    assert (code, error) == (2, f"fetch-pomdp: {option} needs --study\n")


def test_a_study_has_a_database_and_no_folder(run: Run, tmp_path: Path) -> None:
    study = str(small_study(tmp_path))
    code, _, error = run("serve", "--study", study, "--data", tmp_path)
    assert (code, error.startswith("fetch-pomdp: --data: a study is kept in its database")) == (2, True)
    code, _, error = run("serve", "--study", study, "--researcher-token", "short")
    assert (code, error) == (2, "fetch-pomdp: --researcher-token: found 5 characters, expected 16 or more\n")


def test_a_preview_is_of_a_study_and_has_no_database(run: Run, tmp_path: Path) -> None:
    assert run("serve", "--preview")[2] == "fetch-pomdp: --preview needs --study\n"
    study = str(small_study(tmp_path))
    code, _, error = run("serve", "--study", study, "--preview", "--database", "sqlite:///kept.db")
    assert (code, error.startswith("fetch-pomdp: --database: a preview keeps nothing")) == (2, True)


def free_port() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


def test_a_preview_leaves_nothing_behind(tmp_path: Path) -> None:
    """The server as a process of its own, which an interrupt ends as soon as it has told its address.

    It is begun as a shell begins what runs in the background, deaf to interrupts until it asks to hear them.
    """
    study, temporary = small_study(tmp_path), tmp_path / "tmp"
    temporary.mkdir()
    command = ["sh", "-c", 'trap "" INT; exec "$@"', "sh"]
    command += [sys.executable, "-m", "fetch_pomdp", "serve", "--study", str(study), "--preview"]
    command += ["--port", str(free_port())]
    server = subprocess.Popen(
        command, cwd=tmp_path, env={**os.environ, "TMPDIR": str(temporary)}, stdout=subprocess.PIPE, text=True
    )
    try:
        assert server.stdout is not None
        lines = [server.stdout.readline() for _ in range(3)]
        assert lines[2].startswith("A preview: no place is taken")
        assert len(list(temporary.glob("fetch-pomdp-preview-*/preview.db"))) == 1
    finally:
        server.send_signal(signal.SIGINT)
        server.wait(timeout=60)
    assert not list(temporary.glob("fetch-pomdp-*"))
    assert not (tmp_path / "participants.db").exists()


def test_a_study_that_was_changed_is_refused_under_its_name(run: Run, tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path / 'participants.db'}"
    store = Store.open(url)
    store.begin("small", "0123456789abcdef", 2)
    store.close()
    code, _, error = run("serve", "--study", small_study(tmp_path), "--database", url)
    assert code == 2
    assert "study: 'small' was begun with other contents (0123456789abcdef, not " in error


def test_the_template_is_a_study(run: Run, tmp_path: Path) -> None:
    code, printed, _ = run("participants", "template")
    (tmp_path / "own.toml").write_text(printed)
    assert (code, load_user_study(tmp_path / "own.toml").people) == (0, 16)


def test_a_token_of_any_letters_arrives_as_it_is() -> None:
    token = "a+b&c=d%20e#f/ü"
    address = urlsplit(address_of("::1", 8000, "researcher.html", token))
    assert (address.netloc, address.path) == ("[::1]:8000", "/researcher.html")
    assert parse_qs(address.fragment) == {"token": [token]}  # as the page's URLSearchParams reads it
    assert address_of("127.0.0.1", 8000, "", None) == "http://127.0.0.1:8000/"

"""The command serve: what it refuses before it listens."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from tests.cli.conftest import Run


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.1", "robot.example"])
def test_beyond_loopback_a_token_is_needed(run: Run, host: str) -> None:
    code, _, error = run("serve", "--host", host)
    assert code == 2
    assert f"--token: found none for {host}, expected one, such as --token " in error


def test_a_short_token_is_refused(run: Run) -> None:
    code, _, error = run("serve", "--token", "secret")
    assert (code, error) == (2, "fetch-pomdp: --token: found 6 letters, expected 16 or more\n")


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
    assert run("serve", "ambigous")[2].count("ambiguous") == 2  # the known names


def test_a_table_too_large_for_a_page_is_refused(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    item = '[[items]]\nid = "{0}"\nposition = [0.{0}, 3, 0.7]\nvocabulary = ["cup"]\n'
    path.write_text("head = [0, 0, 1.6]\n" + "".join(item.format(number) for number in range(10, 51)))
    code, _, error = run("serve", path)
    assert (code, error) == (2, f"fetch-pomdp: {path}: items: found 41, expected at most 40\n")

"""The command serve: what it refuses before it listens."""

from __future__ import annotations

import socket

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

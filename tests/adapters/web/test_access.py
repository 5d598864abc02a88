"""Who may come in, and how much they may send."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.gate import Allowance, Gate


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost:8000", "LOCALHOST", "[::1]:8000"])
def test_on_loopback_it_answers_to_loopback_names(host: str) -> None:
    assert Gate(None).host_allowed(host)


@pytest.mark.parametrize("host", [None, "", "evil.example", "127.0.0.1.evil.example", "evil.example:8000", "[::1", "@"])
def test_and_to_no_others_which_may_have_been_made_to_lead_here(host: str | None) -> None:
    assert not Gate(None).host_allowed(host)
    assert Gate("a secret of many letters").host_allowed(host)


def test_only_its_own_pages_may_talk_to_it() -> None:
    gate = Gate(None)
    assert gate.origin_allowed("http://127.0.0.1:8000", "127.0.0.1:8000")
    assert gate.origin_allowed("https://robot.example", "robot.example")
    for origin in (
        None,
        "",
        "null",
        "http://evil.example",
        "http://127.0.0.1:9000",
        "file://127.0.0.1:8000",
        "http://[",
    ):
        assert not gate.origin_allowed(origin, "127.0.0.1:8000")


def test_the_token_is_asked_for_where_there_is_one() -> None:
    assert Gate(None).token_allowed(None)
    gate = Gate("correct horse battery")
    assert gate.token_allowed("correct horse battery")
    for token in (None, "", "correct", "correct horse battery ", "ü", "\ud800"):
        assert not gate.token_allowed(token)


def test_an_allowance_is_a_burst_and_then_a_rate() -> None:
    time = [0.0]
    allowance = Allowance(rate=2.0, burst=3.0, now=lambda: time[0])
    assert [allowance.take() for _ in range(4)] == [True, True, True, False]
    time[0] = 0.4  # 0.8 of one more
    assert not allowance.take()
    time[0] = 0.5
    assert allowance.take()
    assert not allowance.take()
    time[0] = 100.0  # never more than the burst
    assert not allowance.take(3.5)
    assert allowance.take(3.0)

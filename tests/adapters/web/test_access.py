"""Who may come in, and how much they may send."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.access import (
    ALL_GUESSES,
    GUESSES,
    AccessRules,
    RateLimit,
    TokenCheck,
    TooManyGuessesError,
)
from fetch_pomdp.errors import MessageError
from tests.adapters.web.fakes import FakeClock


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost:8000", "LOCALHOST", "[::1]:8000"])
def test_on_loopback_it_answers_to_loopback_names(host: str) -> None:
    assert AccessRules(open_to_network=False).host_allowed(host)


@pytest.mark.parametrize("host", [None, "", "evil.example", "127.0.0.1.evil.example", "evil.example:8000", "[::1", "@"])
def test_and_to_no_others_which_may_have_been_made_to_lead_here(host: str | None) -> None:
    assert not AccessRules(open_to_network=False).host_allowed(host)
    assert AccessRules(open_to_network=True).host_allowed(host)


def test_only_its_own_pages_may_talk_to_it() -> None:
    rules = AccessRules(open_to_network=False)
    assert rules.origin_allowed("http://127.0.0.1:8000", "127.0.0.1:8000")
    assert rules.origin_allowed("https://robot.example", "robot.example")
    for origin in (
        None,
        "",
        "null",
        "http://evil.example",
        "http://127.0.0.1:9000",
        "file://127.0.0.1:8000",
        "http://[",
    ):
        assert not rules.origin_allowed(origin, "127.0.0.1:8000")


def test_the_token_is_asked_for_where_there_is_one() -> None:
    TokenCheck(None).check(None, "192.0.2.1")
    tokens = TokenCheck("correct horse battery")
    tokens.check("correct horse battery", "192.0.2.1")
    for number, token in enumerate((None, "", "correct", "correct horse battery ", "ü", "\ud800")):
        with pytest.raises(MessageError, match="token: wrong token"):
            tokens.check(token, f"192.0.2.{number}")


def test_beyond_a_few_wrong_tokens_none_is_compared() -> None:
    clock = FakeClock()
    tokens, at_once = TokenCheck("correct horse battery", clock), int(GUESSES[1])
    for number in range(200):
        with pytest.raises(MessageError) as refused:
            tokens.check(f"guess {number}", "192.0.2.1")
        assert isinstance(refused.value, TooManyGuessesError) == (number >= at_once)
    with pytest.raises(TooManyGuessesError):
        tokens.check("correct horse battery", "192.0.2.1")
    tokens.check("correct horse battery", "192.0.2.2")  # nobody keeps another out
    clock.time = 1 / GUESSES[0]
    tokens.check("correct horse battery", "192.0.2.1")


def test_many_addresses_together_have_a_limit_too() -> None:
    tokens, compared = TokenCheck("correct horse battery", FakeClock()), 0
    for number in range(300):
        try:
            tokens.check("a guess", f"2001:db8::{number}")
        except TooManyGuessesError:
            continue
        except MessageError:
            compared += 1
    assert compared == ALL_GUESSES[1]


def test_a_rate_limit_is_a_burst_and_then_a_rate() -> None:
    time = [0.0]
    limit = RateLimit(rate=2.0, burst=3.0, now=lambda: time[0])
    assert [limit.take() for _ in range(4)] == [True, True, True, False]
    time[0] = 0.4  # 0.8 of one more
    assert not limit.take()
    time[0] = 0.5
    assert limit.take()
    assert not limit.take()
    time[0] = 100.0  # never more than the burst
    assert not limit.take(3.5)
    assert limit.take(3.0)

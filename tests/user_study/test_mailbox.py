"""What waits for the thread that runs a participant's session."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.server_messages import ServerMessage
from fetch_pomdp.errors import MessageError
from fetch_pomdp.user_study import mailbox as module
from fetch_pomdp.user_study.mailbox import LeftError, Mailbox, WithdrawnError
from fetch_pomdp.user_study.messages import GiveUp, Next, Ready, Withdraw
from fetch_pomdp.user_study.trial import Over


def test_a_withdrawal_wins_over_a_page_that_is_gone() -> None:
    mailbox = Mailbox(list[ServerMessage]().append)
    mailbox.put(Next())
    mailbox.put(Withdraw())
    mailbox.close()
    with pytest.raises(WithdrawnError):
        mailbox.expect(Ready)
    other = Mailbox(list[ServerMessage]().append)
    other.close()
    with pytest.raises(LeftError):
        other.expect(Ready)


def test_a_full_mailbox_takes_the_server_s_own_messages_and_a_withdrawal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST", 10)
    told = list[ServerMessage]()
    mailbox = Mailbox(told.append)
    for _ in range(11):
        mailbox.put(GiveUp())
    with pytest.raises(MessageError, match="too many messages at once"):
        mailbox.put(GiveUp())
    mailbox.post(Over("marker-1"))
    assert mailbox.expect(Over) == Over("marker-1")
    assert len(told) == 11, "the others are refused"
    for _ in range(11):
        mailbox.put(GiveUp())
    mailbox.put(Withdraw())
    with pytest.raises(WithdrawnError):
        mailbox.expect(Over)


def test_what_is_posted_as_an_error_is_raised() -> None:
    mailbox = Mailbox(list[ServerMessage]().append)
    mailbox.post(module.BrokenError("no robot"))
    with pytest.raises(module.BrokenError, match="no robot"):
        mailbox.expect(Over)
    assert mailbox.expect(Over, within=0.0) is None

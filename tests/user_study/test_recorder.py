"""What waits for the thread that leads somebody, and what it keeps of their trial."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.participation import mailbox as module
from fetch_pomdp.adapters.web.participation.answers import answered
from fetch_pomdp.adapters.web.participation.keeping import NOTED, Keeping
from fetch_pomdp.adapters.web.participation.mailbox import LeftError, Mailbox, WithdrawnError
from fetch_pomdp.adapters.web.participation.messages import GiveUp, Next, Ready, Withdraw
from fetch_pomdp.adapters.web.participation.rounds import Over
from fetch_pomdp.adapters.web.tell import Told
from fetch_pomdp.errors import MessageError
from fetch_pomdp.study.questions import Question

FRAME = 1_280  # bytes: 40 ms


class Trial:
    """A trial that remembers what it was told to keep."""

    def __init__(self) -> None:
        self.clocks, self.sounds = list[float](), list[tuple[float, bytes]]()

    def note_clock(self, time: float) -> None:
        self.clocks.append(time)

    def keep_sound(self, start: float, pcm: bytes) -> None:
        self.sounds.append((start, pcm))


class Hand:
    """A clock that shows what it is set to."""

    time = 0.0

    def now(self) -> float:
        return self.time


@pytest.fixture
def trial() -> Trial:
    return Trial()


@pytest.fixture
def hand() -> Hand:
    return Hand()


@pytest.fixture
def keeping(trial: Trial, hand: Hand) -> Keeping:
    return Keeping(trial, hand)  # type: ignore[arg-type]


def test_sound_is_written_a_second_at_a_time(keeping: Keeping, trial: Trial) -> None:
    frames = [bytes([number]) * FRAME for number in range(60)]
    for number, frame in enumerate(frames):
        keeping.sound(2.0 + 0.04 * number, frame)
    keeping.flush()
    keeping.flush()
    assert [len(pcm) for _, pcm in trial.sounds] == [32_000, 32_000, 12_800]
    assert [start for start, _ in trial.sounds] == pytest.approx([2.0, 3.0, 4.0])
    assert b"".join(pcm for _, pcm in trial.sounds) == b"".join(frames)


def test_sound_after_a_silence_is_a_piece_of_its_own(keeping: Keeping, trial: Trial) -> None:
    for start in (1.0, 1.04 + 0.09, 3.0):  # the second is late, the third comes after a silence
        keeping.sound(start, bytes(FRAME))
    keeping.flush()
    assert [(start, len(pcm)) for start, pcm in trial.sounds] == [(1.0, 2 * FRAME), (3.0, FRAME)]


def test_the_clock_is_noted_now_and_then(keeping: Keeping, trial: Trial, hand: Hand) -> None:
    for hand.time in (0.1, NOTED - 0.1, NOTED, NOTED + 1, 2 * NOTED + 0.5):
        keeping.look()
    assert trial.clocks == [NOTED, 2 * NOTED + 0.5]


def test_a_withdrawal_wins_over_a_page_that_is_gone() -> None:
    mailbox = Mailbox(list[Told]().append)
    mailbox.put(Next())
    mailbox.put(Withdraw())
    mailbox.close()
    with pytest.raises(WithdrawnError):
        mailbox.expect(Ready)
    other = Mailbox(list[Told]().append)
    other.close()
    with pytest.raises(LeftError):
        other.expect(Ready)


def test_a_full_mailbox_takes_the_server_s_own_messages_and_a_withdrawal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST", 10)
    told = list[Told]()
    mailbox = Mailbox(told.append)
    for _ in range(11):
        mailbox.put(GiveUp())
    with pytest.raises(MessageError, match="found 10 messages waiting, expected fewer"):
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
    mailbox = Mailbox(list[Told]().append)
    mailbox.post(module.BrokenError("no robot"))
    with pytest.raises(module.BrokenError, match="no robot"):
        mailbox.expect(Over)
    assert mailbox.expect(Over, within=0.0) is None


def test_line_ends_of_an_answer_are_those_of_a_table() -> None:
    question = Question(id="open", kind="text", text={"en": "What?"})
    assert answered([question], {"open": "one\r\ntwo\rthree\nfour"}) == {"open": "one\ntwo\nthree\nfour"}

"""A reader over a real server of the chat-completions interface: a process that speaks HTTP."""

from __future__ import annotations

import logging
import math
import re
import sys

import numpy as np
import pytest

from fetch_pomdp.adapters.reading.choice import reader_named
from fetch_pomdp.adapters.reading.connection import KEY, Connection
from fetch_pomdp.adapters.reading.endpoint import EndpointReader
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.reading.calibration import Calibration
from fetch_pomdp.core.language.reading.reader import Context
from fetch_pomdp.core.language.reading.telling import told
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.errors import InputError
from tests.adapters.reading import served_model
from tests.core.language.reading.tables import LINE, READER, scene

pytest.importorskip("httpx2")


def reader(model: str, url: str, method: str = "openai", limit: float = 20.0) -> EndpointReader:
    found = reader_named(f"{method}:{model}@{url}", limit=limit)
    assert isinstance(found, EndpointReader)
    return found


def by_hand(*shared: int) -> np.ndarray:
    """The chances of items that share some words with what was said, of which "?" shares none and goes to all alike."""
    weights = np.exp(served_model.STEEP * np.array([*shared, 0]))
    weights /= weights.sum()
    return np.asarray(weights[:-1] + weights[-1] / len(shared))


def test_scores_are_the_models_own(served: str) -> None:
    said = reader("words", served).asked(words_of("the green mug"), LINE, Context())
    assert said.chances == pytest.approx(by_hand(1, 2, 1, 0), abs=1e-9)
    assert said.lost == pytest.approx(1.0 / (2 * math.e**2 + math.e**4 + 2))


def test_a_reading_says_who_read_it(served: str) -> None:
    heard = reader("words", served).read(words_of("the green mug"), LINE, Context())
    assert np.exp(heard.log_likelihood) == pytest.approx(Calibration().believed(by_hand(1, 2, 1, 0), np.ones(4)))
    assert told(heard) == "I understood (read by words)"
    own = READER.read(words_of("no wait, the green mug"), LINE, Context())
    again = reader("words", served).read(words_of("no wait, the green mug"), LINE, Context())
    assert again.corrects
    assert again.context == own.context


def test_samples_tend_to_the_models_chances(served: str) -> None:
    reading = reader("words", served, "openai-samples")
    total = np.zeros(4)
    texts = [f"{filler} white bowl" for filler in ("the", "a", "that", "one", "my", "this", "your", "some")]
    for text in texts:
        said = reading.asked(words_of(text), LINE, Context())
        assert said.chances.sum() == pytest.approx(1.0)
        total += said.chances * 11.0 / 10.0 - 0.1 * (4.0 / 5.0 / 4.0 + 1.0 / 5.0 / 4.0)  # without the shared answer
    share = by_hand(0, 0, 0, 2)[3]
    error = math.sqrt(share * (1.0 - share) / (10 * len(texts)))
    assert abs(total[3] / len(texts) - share) < 4.0 * error


def test_many_items_are_sampled_by_numbers_and_not_scored(served: str) -> None:
    blocks = ["red block" if index == 30 else "blue block" for index in range(40)]
    big = scene(*((block, 0.1 * (index % 8), 0.5 + 0.1 * (index // 8)) for index, block in enumerate(blocks)))
    said = reader("words", served, "openai-samples").asked(("red",), big, Context())
    assert said.chances.sum() == pytest.approx(1.0)
    heard = reader("words", served).read(("red",), big, Context())
    assert "at most 26 items" in heard.note
    assert heard.log_likelihood.argmax() == 30


@pytest.mark.parametrize(
    ("model", "why"),
    [
        ("failing", "status 500"),
        ("elsewhere", "status 307"),
        ("locked", f"status 401.*{KEY}"),
        ("a-page", "no JSON"),
        ("deep", "no JSON"),
        ("long", "more than 1,000,000 bytes"),
        ("cut", "could not be asked"),
        ("silent", "could not be asked"),
        ("a-list", "another form"),
        ("null", "another form"),
        ("nothing-chosen", "another form"),
        ("no-choices", "another form"),
        ("text-logprobs", "another form"),
        ("text-token", "another form"),
        ("not-a-number", "another form"),
        ("no-label", "no label"),
        ("no-logprobs", "openai-samples"),
    ],
)
def test_where_a_model_fails_ours_reads_and_says_so(served: str, model: str, why: str) -> None:
    heard = reader(model, served).read(words_of("the green mug"), LINE, Context())
    own = READER.read(words_of("the green mug"), LINE, Context())
    assert heard.log_likelihood.tolist() == own.log_likelihood.tolist()
    assert heard.readings == own.readings
    assert heard.note.startswith(f"read without {model}, which ")
    assert re.search(why, heard.note)
    assert told(heard).startswith("I understood: green, mug (read without")


@pytest.mark.parametrize("model", ["chatty", "a-list", "nothing-chosen", "null"])
def test_samples_that_say_nothing_fail_too(served: str, model: str) -> None:
    assert reader(model, served, "openai-samples").read(("green",), LINE, Context()).note.startswith("read without")


@pytest.mark.parametrize("model", ["slow", "dripping"])
def test_who_is_late_is_not_waited_for(served: str, model: str) -> None:
    reading = reader(model, served, limit=0.3)
    assert "did not answer within 0.3 s" in reading.read(("green",), LINE, Context()).note
    assert reading.read(("green",), LINE, Context()).log_likelihood.argmax() == 1, "and may be asked again"


def test_nobody_there_and_what_is_no_url() -> None:
    assert "could not be asked" in reader("words", "http://127.0.0.1:9/v1").read(("green",), LINE, Context()).note
    with pytest.raises(InputError, match="expected words, table"):
        reader_named("openai:words@127.0.0.1:9")
    with pytest.raises(InputError, match="no host"):
        reader_named("openai:words@http://:9/v1")


def test_the_key_is_sent_and_never_told(
    served: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)
    monkeypatch.setenv(KEY, served_model.KEY)
    right = reader("locked", served)
    assert right.read(("green",), LINE, Context()).log_likelihood.argmax() == 0, "it answers A to who has the key"
    monkeypatch.setenv(KEY, "sk-a-wrong-one")
    wrong = reader("locked", served)
    heard = wrong.read(("green",), LINE, Context())
    assert "status 401" in heard.note
    for secret in (served_model.KEY, "sk-a-wrong-one"):
        assert all(secret not in text for text in (caplog.text, heard.note, repr(right), repr(wrong), repr(heard)))
    monkeypatch.setenv(KEY, "schlüssel")
    with pytest.raises(InputError, match=rf"{KEY}: found letters") as caught:
        reader("locked", served)
    assert "schlüssel" not in str(caught.value)


def test_an_agent_reads_by_it(served: str) -> None:
    agent = Agent("ambiguous", reader=reader("words", served))
    agent.observe("the spoon please")
    assert agent.scene.items[int(agent.belief.argmax())].id.startswith("spoon")
    assert agent.understood.heard is not None
    assert agent.understood.heard.note == "read by words"


def test_nothing_is_asked_about_silence_or_after_the_end(served: str) -> None:
    reading = reader("words", served)
    assert reading.read((), LINE, Context()).note == ""
    reading.connection.close()
    reading.connection.close()
    assert "not connected any more" in reading.read(("green",), LINE, Context()).note


def test_a_missing_library_is_named_with_the_line_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "httpx2", None)
    with pytest.raises(ImportError, match=r'pip install "fetch-pomdp\[endpoint\]"'):
        Connection("http://127.0.0.1:9/v1", 1.0)

from __future__ import annotations

import io
import json
from collections.abc import Iterator

import pytest

from fetch_pomdp.adapters.speech import worker
from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.adapters.speech.worker import SphinxProcess, serve
from fetch_pomdp.errors import AudioError
from tests.adapters.speech.sounds import DATA, VOCABULARY, samples_of, with_noise

pytest.importorskip("pocketsphinx")

MARKER = SpeechSegment(3.0, with_noise(samples_of(DATA / "marker.wav")))


@pytest.fixture(scope="module")
def process() -> Iterator[SphinxProcess]:
    made = SphinxProcess()
    yield made
    made.close()


def test_another_process_hears_the_same(process: SphinxProcess) -> None:
    words = process.transcriber(VOCABULARY).words(MARKER)
    assert words == SphinxTranscriber(VOCABULARY).words(MARKER)
    assert [word.text for word in words] == ["hand", "me", "the", "marker"]


def test_two_vocabularies_share_a_process_and_no_words(process: SphinxProcess) -> None:
    ours, theirs = process.transcriber(VOCABULARY), process.transcriber(["banana", "apple"])
    assert [word.text for word in ours.words(MARKER)] == ["hand", "me", "the", "marker"]
    assert "marker" not in [word.text for word in theirs.words(MARKER)]


def test_a_process_that_died_is_missed_once(process: SphinxProcess, monkeypatch: pytest.MonkeyPatch) -> None:
    transcriber = process.transcriber(VOCABULARY)
    with monkeypatch.context() as patience:
        patience.setattr(worker, "ANSWER_TIMEOUT", 0.0)  # none: it is killed while it works
        with pytest.raises(AudioError, match="found no answer"):
            transcriber.words(MARKER)
    assert [word.text for word in transcriber.words(MARKER)] == ["hand", "me", "the", "marker"]


def test_the_protocol() -> None:
    request = {"vocabulary": VOCABULARY, "start": 3.0, "samples": len(MARKER.samples)}
    asked = json.dumps(request).encode() + b"\n" + MARKER.samples.astype("<i2").tobytes()
    answers = io.BytesIO()
    serve(io.BytesIO(asked * 2), answers)
    first, second = (json.loads(line) for line in answers.getvalue().splitlines())
    assert first == second
    text, start, end, posterior = first["words"][-1]
    assert text == "marker"
    assert 3.0 < start < end < 3.0 + len(MARKER.samples) / 16_000
    assert 0 < posterior <= 1

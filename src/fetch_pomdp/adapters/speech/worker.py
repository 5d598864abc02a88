"""PocketSphinx in a process of its own: it holds Python's lock while it decodes, which would stop a whole server.

    python -m fetch_pomdp.adapters.speech.worker

Requests on standard input, a line of JSON and then the samples (16-bit little-endian mono, 16 kHz); for each a line of
JSON on standard output:

    {"vocabulary": ["marker"], "start": 1.5, "samples": 8000}
    {"words": [["marker", 1.8, 2.2, 0.97]], "readings": [[["marker"], 0.9], [["mark", "her"], 0.1]]}
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, BinaryIO

import numpy as np

from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.utterances import SpeechSegment, Transcriber
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.ports import Word
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load

ANSWER_TIMEOUT = 20.0  # s for an answer, loading included; a process that takes longer is killed
NAME = "speech recogniser"


class SphinxProcess:
    """Transcribers of any vocabularies that share a process, started when it is needed, and anew when it has died.

    Safe to use from any thread. Raises MissingExtraError without pocketsphinx.
    """

    def __init__(self) -> None:
        load("pocketsphinx", "speech")
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None

    def transcriber(self, vocabulary: Sequence[str]) -> Transcriber:
        """Return a Transcriber of a scene's words, and load what it needs."""
        transcriber = _Remote(self, vocabulary)
        transcriber.words(SpeechSegment(0.0, np.zeros(1600, np.int16)))
        return transcriber

    def ask(self, request: dict[str, Any], samples: bytes) -> dict[str, Any]:
        """Send a request and return the answer. Raises AudioError if there is none in time."""
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                command = [sys.executable, "-m", "fetch_pomdp.adapters.speech.worker"]
                self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
            return _exchange(self._process, json.dumps(request).encode() + b"\n" + samples)

    def close(self) -> None:
        """End the process."""
        with self._lock:
            if self._process is not None:
                self._process.kill()
                self._process.wait()
                self._process = None


class _Remote:
    """A Transcriber over a SphinxProcess."""

    def __init__(self, process: SphinxProcess, vocabulary: Sequence[str]) -> None:
        self._process, self._vocabulary = process, list(vocabulary)

    def words(self, utterance: SpeechSegment) -> list[Word]:
        request = {"vocabulary": self._vocabulary, "start": utterance.start, "samples": len(utterance.samples)}
        answer = self._process.ask(request, utterance.samples.astype("<i2").tobytes())
        readings = tuple(Alternative(tuple(words), weight) for words, weight in answer["readings"])
        return [Word(text, start, end, posterior, readings) for text, start, end, posterior in answer["words"]]


def _exchange(process: subprocess.Popen[bytes], request: bytes) -> dict[str, Any]:
    to, back = process.stdin, process.stdout
    if to is None or back is None:
        raise AudioError("found no pipe, expected one to the process", source=NAME)
    timer = threading.Timer(ANSWER_TIMEOUT, process.kill)
    timer.start()
    try:
        to.write(request)
        to.flush()
        answer: dict[str, Any] = json.loads(back.readline())
    except (OSError, ValueError):  # ValueError: no JSON, what is left of a line when the process dies
        process.kill()
        process.wait()
        raise AudioError("found no answer, expected words; it is started anew", source=NAME) from None
    finally:
        timer.cancel()
    return answer


@lru_cache(maxsize=8)
def _transcriber(vocabulary: tuple[str, ...]) -> SphinxTranscriber:
    return SphinxTranscriber(vocabulary)


def serve(requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer requests until there are no more."""
    while line := requests.readline():
        request = json.loads(line)
        samples = np.frombuffer(requests.read(2 * request["samples"]), "<i2").astype(np.int16)
        words = _transcriber(tuple(request["vocabulary"])).words(SpeechSegment(request["start"], samples))
        found = [[word.text, word.start, word.end, word.posterior] for word in words]
        readings = [[each.words, each.weight] for each in words[0].readings] if words else []
        answers.write(json.dumps({"words": found, "readings": readings}).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    serve(sys.stdin.buffer, sys.stdout.buffer)

"""Which recogniser hears: PocketSphinx unless another is named, as "whisper:MODEL" or "vosk:DIR"; or several together,
as "sphinx+whisper:tiny.en".
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from fetch_pomdp.adapters.speech import vosk, whisper
from fetch_pomdp.adapters.speech.audio import Sound
from fetch_pomdp.adapters.speech.ensemble import Ensemble
from fetch_pomdp.adapters.speech.recorded import SoundRecognizer
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.adapters.speech.utterances import Transcriber
from fetch_pomdp.adapters.speech.worker import SphinxProcess
from fetch_pomdp.core.ports import Recognizer
from fetch_pomdp.errors import InputError

SPHINX = "sphinx"
KINDS = ("whisper", "vosk")
EXPECTED = f"expected {SPHINX}, whisper:MODEL or vosk:DIR, or several with + between them"
_AND = re.compile(rf"\+(?={SPHINX}(?:\+|$)|whisper:|vosk:)")  # a folder may have a + in its name


class Transcribers(Protocol):
    """Transcribers of any vocabularies that share a model. Safe to use from any thread."""

    def transcriber(self, vocabulary: Sequence[str]) -> Transcriber:
        """Return a Transcriber of a scene's words, and load what it needs."""
        ...

    def close(self) -> None:
        """Give back what is held."""
        ...


class ModelTranscribers:
    """Transcribers over a model that is loaded once. make: a Transcriber from the model and a vocabulary."""

    def __init__(self, model: Any, make: Callable[[Any, Sequence[str]], Transcriber]) -> None:
        self._model, self._make = model, make

    def transcriber(self, vocabulary: Sequence[str]) -> Transcriber:
        """Return a Transcriber of a scene's words."""
        return self._make(self._model, vocabulary)

    def close(self) -> None:
        """Do nothing: the model goes with its last Transcriber."""


class Together:
    """Ensembles of what several Transcribers make."""

    def __init__(self, members: Sequence[Transcribers]) -> None:
        self._members = tuple(members)

    def transcriber(self, vocabulary: Sequence[str]) -> Transcriber:
        """Return an Ensemble for a scene's words."""
        return Ensemble([member.transcriber(vocabulary) for member in self._members])

    def close(self) -> None:
        """Close all."""
        for member in self._members:
            member.close()


def transcribers(ears: str) -> Transcribers:
    """Return the transcribers of ears by name, the models loaded or fetched.

    Raises InputError for another name; MissingExtraError, AudioError for what is not installed, or no model.
    """
    names = [_parsed(name) for name in _AND.split(ears)]
    members = [_loaded(*name) for name in names]
    return members[0] if len(members) == 1 else Together(members)


def _loaded(kind: str, model: str) -> Transcribers:
    if kind == SPHINX:
        return SphinxProcess()
    if kind == "whisper":
        return ModelTranscribers(whisper.load_model(model), whisper.WhisperTranscriber)
    return ModelTranscribers(vosk.load_model(model), vosk.transcriber)


def recognizer(ears: str, sound: Sound, vocabulary: Sequence[str]) -> Recognizer:
    """Return ears over a Sound, by name. Raises as `transcribers` does."""
    if ears == SPHINX:
        return SphinxRecognizer(sound, vocabulary)
    return SoundRecognizer(sound, transcribers(ears).transcriber(vocabulary).words)


def _parsed(ears: str) -> tuple[str, str]:
    kind, _, model = ears.partition(":")
    if ears != SPHINX and not (kind in KINDS and model):
        raise InputError(f"found {ears!r}, {EXPECTED}", field="--ears")
    return kind, model

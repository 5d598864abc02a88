"""A reader that asks a language model at an OpenAI-compatible endpoint, local or not; ours reads where none answers."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fetch_pomdp.adapters.reading.completions import Method, Said, Scores
from fetch_pomdp.adapters.reading.connection import Connection
from fetch_pomdp.adapters.reading.prompt import messages
from fetch_pomdp.core.language.reading.calibration import Calibration
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader, TableReader
from fetch_pomdp.core.language.reading.tokens import STOP
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EndpointError


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EndpointReader:
    """Has a model say how likely each item is, as sure as its calibration makes it.

    own: reads what the model is not asked or does not answer in time, and always the corrections ("no wait") and what
    an utterance leaves for the next one. What is said, and the table, are sent to the endpoint.
    """

    model: str
    connection: Connection
    method: Method = field(default_factory=Scores)
    calibration: Calibration = field(default_factory=Calibration)
    own: Reader = field(default_factory=TableReader)

    @property
    def meanwhile(self) -> Reader:
        """The reader of what is still being said, and of the recogniser's other readings."""
        return self.own

    def read(self, words: Sequence[str], scene: Scene, context: Context) -> Heard:
        """Read what was said; `Heard.note` says who read it."""
        heard = self.own.read(words, scene, context)
        if all(word == STOP for word in words):
            return heard
        try:
            said = self.asked(words, scene, context)
        except EndpointError as error:
            return dataclasses.replace(heard, note=f"read without {self.model}, which {error}")
        chances = self.calibration.believed(said.chances, np.exp(heard.log_likelihood))
        return dataclasses.replace(
            heard, log_likelihood=np.log(chances), readings=(), unknown=(), lost=said.lost, note=f"read by {self.model}"
        )

    def asked(self, words: Sequence[str], scene: Scene, context: Context) -> Said:
        """Return what the model says, as it says it. Raises EndpointError for a model that says nothing of use."""
        question = {"model": self.model, "messages": messages(words, scene, context), **self.method.options()}
        return self.method.said(self.connection.ask(question), len(scene.items))

"""Which reader reads what people say: our grammar unless another is named."""

from __future__ import annotations

import re
from pathlib import Path

from fetch_pomdp.adapters.reading.completions import Method, Samples, Scores
from fetch_pomdp.adapters.reading.connection import Connection
from fetch_pomdp.adapters.reading.endpoint import EndpointReader
from fetch_pomdp.core.language.reading.calibration import Calibration, calibration_of
from fetch_pomdp.core.language.reading.catalogue import DEFAULT, OWN, OWN_EXPECTED, own_reader
from fetch_pomdp.core.language.reading.reader import Reader
from fetch_pomdp.core.language.reading.weights import Weights, weights_of
from fetch_pomdp.errors import InputError

METHODS: dict[str, Method] = {"openai": Scores(), "openai-samples": Samples()}
EXPECTED = f"{OWN_EXPECTED}, " + " or ".join(f"{method}:MODEL@URL" for method in METHODS)
LIMIT = 2.0  # s, of a model's answer
_SERVED = re.compile(rf"({'|'.join(METHODS)}):(\S+)@(https?://[^\s@?#]+)")


def reader_named(name: str = DEFAULT, *, weights: Path | None = None, limit: float = LIMIT) -> Reader | None:
    """Return a reader by name, as `Agent(reader=...)` takes it: None is the paper's, word by word (Eq. 4, 5).

    name: words, table, table:LANGUAGE, openai:MODEL@URL (which scores the items) or openai-samples:MODEL@URL (whose
    answers are counted). weights: a file of `fit-reader` for that reader. limit: s, after which ours reads in a model's
    place. Raises InputError for another name, or for weights that the reader has no use for; MissingExtraError.
    """
    served = _SERVED.fullmatch(name)
    if served is None:
        if name.partition(":")[0] not in OWN:
            raise InputError(f"found {name!r}, expected {EXPECTED}", field="reader")
        return own_reader(name, None if weights is None else Weights.of(weights_of(weights)))
    method, model, url = served.groups()
    return EndpointReader(
        model=model,
        connection=Connection(url, limit),
        method=METHODS[method],
        calibration=Calibration() if weights is None else calibration_of(weights),
    )

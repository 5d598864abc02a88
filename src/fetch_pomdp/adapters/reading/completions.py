"""The chat-completions interface: what is asked of a model, and the chances of the items that its answer gives.

`Scores` reads the log-probabilities of the first token that is a label; `Samples` counts the labels of several answers.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from fetch_pomdp.adapters.reading.prompt import LETTERS, UNCLEAR, labels
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.errors import EndpointError

TOKENS = 4  # of an answer: some models begin with a space or a line
LISTED = 20  # log-probabilities that the interface gives of a token, at most
LEAST = 1e-9
_LABEL = re.compile(r"\W*?(\?|[A-Z]\b|\d+)")


@dataclass(frozen=True, slots=True, eq=False)
class Said:
    """What a model said of the items: the chance of each, (n_items,), and how likely nobody could tell."""

    chances: Vector
    lost: float


class Method(Protocol):
    """A way to have a model say how likely each item is."""

    def options(self) -> dict[str, Any]:
        """Return what is asked for beside the model and the messages."""
        ...

    def said(self, answer: Any, count: int) -> Said:
        """Return what an answer, as JSON, says of `count` items. Raises EndpointError where it says nothing."""
        ...


@dataclass(frozen=True, slots=True)
class Scores:
    """One answer, whose token carries the log-probabilities of the labels; for at most 26 items."""

    def options(self) -> dict[str, Any]:
        """Return that log-probabilities are asked for."""
        return {"max_tokens": TOKENS, "temperature": 0, "logprobs": True, "top_logprobs": LISTED}

    def said(self, answer: Any, count: int) -> Said:
        """Return what the tokens say. A label that is not listed has its share of what is left, at most the least's."""
        if count > len(LETTERS):
            raise EndpointError(f"gives scores of at most {len(LETTERS)} items, and {count} are there; samples are not")
        try:
            choice = answer["choices"][0]
            content = (choice.get("logprobs") or {}).get("content")
            if not content:
                raise EndpointError("answered without log-probabilities; openai-samples:MODEL@URL needs none")
            listed = next(filter(None, (_listed(token, count) for token in content)), None)
        except (AttributeError, IndexError, KeyError, OverflowError, TypeError, ValueError):
            raise EndpointError("answered in another form than a chat completion's") from None
        if listed is None:
            raise EndpointError("answered with what is no label of an item")
        chances, left = listed
        names = (*labels(count), UNCLEAR)
        missing = [name for name in names if name not in chances]
        floor = min(left / max(len(missing), 1), *chances.values())
        return _said([max(chances.get(name, floor), LEAST) for name in names])


def _listed(token: Mapping[str, Any], count: int) -> tuple[dict[str, float], float] | None:
    """Return the chance of each label that is listed at a token, and what is left over; None if the token is none."""
    names = {*labels(count), UNCLEAR}
    if str(token["token"]).strip() not in names:
        return None
    chances: dict[str, float] = {}
    total = 0.0
    for each in token.get("top_logprobs") or [token]:
        chance = math.exp(min(_finite(each["logprob"]), 0.0))
        total += chance
        name = str(each["token"]).strip()
        if name in names:
            chances[name] = chances.get(name, 0.0) + chance
    return (chances, max(1.0 - total, 0.0)) if chances else None


def _finite(value: Any) -> float:
    found = float(value)
    if math.isnan(found):
        raise ValueError("no number")
    return found


@dataclass(frozen=True, slots=True)
class Samples:
    """Several answers at temperature 1, which are counted.

    Choice: one answer more is shared by all labels, so that no item is ruled out by a few answers.
    """

    count: int = 10

    def options(self) -> dict[str, Any]:
        """Return that several answers are asked for."""
        return {"max_tokens": TOKENS, "temperature": 1, "n": self.count}

    def said(self, answer: Any, count: int) -> Said:
        """Return the shares of the labels among the answers that begin with one."""
        names = (*labels(count), UNCLEAR)
        try:
            texts = [str(each["message"]["content"] or "") for each in answer["choices"]]
        except (AttributeError, IndexError, KeyError, TypeError):
            raise EndpointError("answered in another form than a chat completion's") from None
        found = Counter(match[1] for text in texts if (match := _LABEL.match(text)) and match[1] in names)
        if not found:
            raise EndpointError("answered with what is no label of an item")
        return _said([found[name] + 1.0 / len(names) for name in names])


def _said(weights: Sequence[float]) -> Said:
    """Return chances from the weights of all items, and of none."""
    *items, unclear = weights
    chances = np.array(items)
    lost = unclear / (chances.sum() + unclear)
    return Said((1.0 - lost) * chances / chances.sum() + lost / len(items), float(lost))

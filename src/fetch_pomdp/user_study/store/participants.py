"""A participant as the database knows them, and the codes that stand for them."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from fetch_pomdp.errors import StoreError

STAGES = ("instructions", "practice", "trials", "questions", "done")
LETTERS = "23456789BCDFGHJKMNPQRSTVWXYZ"  # no two alike when read aloud or written by hand, and no vowels: no words


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """What somebody has agreed to, and the text that they were shown."""

    language: str
    given: Mapping[str, bool]
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Participant:
    """Somebody who takes part in a study.

    code: shown to them, to be quoted by who wants their data deleted. completion: shown at the end only, None before.
    """

    id: int
    person: int  # number in the study, from 0
    code: str
    stage: str  # of STAGES
    language: str
    consent: Mapping[str, bool]
    answers: Mapping[str, Any]  # by question
    completion: str | None
    practice_done: int
    trials_done: int


def new_code() -> str:
    """Return a random code, such as K7Q-2MP."""
    letters = "".join(secrets.choice(LETTERS) for _ in range(6))
    return f"{letters[:3]}-{letters[3:]}"


def code_of(text: str) -> str:
    """Return a code as it was given out, from one as it was typed."""
    letters = "".join(letter for letter in text.upper() if letter.isalnum())
    return f"{letters[:3]}-{letters[3:]}"


def hashed(text: str) -> str:
    """Return what is kept of a secret, or of a text that was agreed to: SHA-256, in hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def now() -> str:
    """Return the time, UTC, ISO 8601, to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def as_json(value: object, field: str) -> str:
    """Return a value as JSON that any database can hold. Raises StoreError for what is no JSON."""
    try:
        text = json.dumps(value, ensure_ascii=False, allow_nan=False)
        text.encode("utf-8")
    except (TypeError, ValueError, RecursionError) as cause:
        raise StoreError(f"found what is no JSON: {cause}, expected text, numbers or lists", field=field) from None
    return text

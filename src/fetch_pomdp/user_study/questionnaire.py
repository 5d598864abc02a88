"""Questions to the people of a study, after their trials (Section IV-D)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.errors import InputError, StudyError

LANGUAGES = ("en", "de")  # the first is that of who has no other
KINDS = ("text", "scale", "choice", "choices")
FIELDS = ("id", "kind", "text", "options", "required", "page")
ENDS = 2  # a scale has a text at each end


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """A possible answer, or one end of a scale; text: by language."""

    id: str
    text: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A question: an answer in words, a place on a scale from 1 to 7, one choice, or any number of choices.

    page: questions of a later page are shown when those before are answered, which cannot be changed then, so that
    possible answers put nothing into the mouth of who answers in their own words before.
    """

    id: str
    kind: str  # of KINDS
    text: Mapping[str, str]  # by language
    options: tuple[Option, ...] = ()
    required: bool = True
    page: int = 1


def question_from_mapping(value: object, path: str) -> Question:
    """Build a question from the fields of a file. Raises StudyError, with the field."""
    try:
        data = checks.mapping(value, "", StudyError)
        checks.known(data, FIELDS, "field", StudyError)
        checks.required(data, ("id", "kind", "text"), StudyError)
        kind, page = data["kind"], data.get("page", 1)
        if kind not in KINDS:
            raise StudyError(f"found {shown(kind)}, expected one of {', '.join(KINDS)}", field="kind")
        if type(page) is not int or page < 1:
            raise StudyError(f"found {shown(page)}, expected a whole number from 1", field="page")
        return Question(
            id=checks.text(data["id"], "id", "a name that is not empty", StudyError),
            kind=kind,
            text=texts(data["text"], "text"),
            options=_options(data.get("options", []), kind),
            required=truth(data.get("required", True), "required"),
            page=page,
        )
    except InputError as error:
        raise error.within(path) from None


def _options(value: object, kind: str) -> tuple[Option, ...]:
    if not isinstance(value, list | tuple):
        raise StudyError(f"found {shown(value)}, expected a list of texts by language", field="options")
    options = tuple(_option(each, f"options[{index}]") for index, each in enumerate(value))
    names = [option.id for option in options]
    if len(set(names)) < len(names):
        raise StudyError(f"found {', '.join(names)}, expected each id once", field="options")
    if kind == "text" and options:
        raise StudyError(f"found {len(options)}, expected none: the answer is a text", field="options")
    if kind == "scale" and len(options) != ENDS:
        raise StudyError(f"found {len(options)}, expected {ENDS}, of the ends of the scale", field="options")
    if kind in ("choice", "choices") and not options:
        raise StudyError("found none, expected one or more", field="options")
    return options


def _option(value: object, path: str) -> Option:
    """Read an option; its id, if it has none, is its English text."""
    try:
        fields = dict(checks.mapping(value, "", StudyError))
        name = fields.pop("id", fields.get("en"))
        return Option(id=checks.text(name, "id", "a name that is not empty", StudyError), text=texts(fields, ""))
    except InputError as error:
        raise error.within(path) from None


def texts(value: object, path: str) -> dict[str, str]:
    """Return a text by language. Raises StudyError where the first language is missing, or for one we do not speak."""
    data = checks.mapping(value, path, StudyError)
    try:
        checks.known(data, LANGUAGES, "language", StudyError)
        checks.required(data, LANGUAGES[:1], StudyError)
        return {name: checks.text(text, name, "a text that is not empty", StudyError) for name, text in data.items()}
    except InputError as error:
        raise error.within(path) if path else error from None


def truth(value: Any, path: str) -> bool:
    """Return true or false."""
    if not isinstance(value, bool):
        raise StudyError(f"found {shown(value)}, expected true or false", field=path)
    return value

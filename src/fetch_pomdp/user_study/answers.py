"""Answers to the questionnaire, and to the consent text: complete and possible, or refused."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.adapters.web.participation.programme import Question
from fetch_pomdp.adapters.web.tell import Told
from fetch_pomdp.checks import shown
from fetch_pomdp.errors import MessageError

LONGEST = 5_000  # letters of an answer
POINTS = 7  # of a scale


def consented(values: Mapping[str, Any], *, languages: Sequence[str]) -> tuple[dict[str, bool], str]:
    """Return what somebody agrees to, and their language. Raises MessageError, naming the field."""
    checks.known(values, ("taking_part", "sound", "language"), "field", MessageError)
    given = {name: values.get(name, False) for name in ("taking_part", "sound")}
    for name, value in given.items():
        if not isinstance(value, bool):
            raise MessageError(f"found {shown(value)}, expected true or false", field=name)
    language = values.get("language", languages[0])
    if language not in languages:
        raise MessageError(f"found {shown(language)}, expected one of {', '.join(languages)}", field="language")
    return given, language


def answered(questions: Sequence[Question], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return an answer to each question, None where there is none. Raises MessageError, naming the question."""
    checks.known(values, [question.id for question in questions], "question", MessageError)
    return {question.id: _answer(question, values.get(question.id)) for question in questions}


def _answer(question: Question, value: Any) -> Any:
    if value is None or value in ("", []):
        if question.required:
            raise MessageError("found no answer, expected one", field=question.id)
        return [] if question.kind == "choices" else None
    names = [option.id for option in question.options]
    if question.kind == "text":
        text = checks.text(value, question.id, "a text", MessageError).replace("\x00", "")
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        if len(text) > LONGEST:
            raise MessageError(f"found {len(text)} letters, expected at most {LONGEST}", field=question.id)
        return text
    if question.kind == "scale":
        if type(value) is not int or not 1 <= value <= POINTS:
            raise MessageError(f"found {shown(value)}, expected 1 to {POINTS}", field=question.id)
        return value
    chosen = value if question.kind == "choices" else [value]
    if not isinstance(chosen, list) or any(each not in names for each in chosen) or len(set(chosen)) < len(chosen):
        raise MessageError(f"found {shown(value)}, expected of {', '.join(names)}", field=question.id)
    return [name for name in names if name in chosen] if question.kind == "choices" else value


def question_to_json(question: Question) -> Told:
    """Return a question as a page shows it."""
    fields = {"id": question.id, "kind": question.kind, "text": dict(question.text), "required": question.required}
    options = [{"id": option.id, "text": dict(option.text)} for option in question.options]
    return {**fields, "options": options, "points": POINTS if question.kind == "scale" else None}

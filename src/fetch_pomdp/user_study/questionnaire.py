"""The questions to participants after their trials (Section IV-D), and the check of their answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.adapters.web.server_messages import ServerMessage
from fetch_pomdp.checks import shown
from fetch_pomdp.errors import InputError, MessageError, StudyError

LANGUAGES = ("en", "de")  # the first is required
CHECK = "attention_check"
KINDS = ("text", "scale", "choice", "choices", CHECK)
FIELDS = ("id", "kind", "text", "options", "correct", "required", "page")
ENDS = 2  # a scale has a text at each end
POINTS = 7  # of a scale
LONGEST = 5_000  # characters of an answer


@dataclass(frozen=True, slots=True, kw_only=True)
class ResponseOption:
    """A possible answer, or one end of a scale; text: by language."""

    id: str
    text: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A question: an answer in words, a place on a scale from 1 to 7, one choice, any number of choices, or a check
    that people read what they answer: one choice, of which `correct` is the id of the option that the text asks for.

    page: questions of a later page are shown when those before are answered, which cannot be changed then, so that
    listed answers do not influence an open question before them.
    """

    id: str
    kind: str  # of KINDS
    text: Mapping[str, str]  # by language
    options: tuple[ResponseOption, ...] = ()
    correct: str | None = None  # of an attention check
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
        options = _options(data.get("options", []), kind)
        return Question(
            id=checks.text(data["id"], "id", "a name that is not empty", StudyError),
            kind=kind,
            text=texts(data["text"], "text"),
            options=options,
            correct=_correct(data, kind, options),
            required=truth(data.get("required", True), "required"),
            page=page,
        )
    except InputError as error:
        raise error.within(path) from None


def _options(value: object, kind: str) -> tuple[ResponseOption, ...]:
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
    if kind in ("choice", "choices", CHECK) and not options:
        raise StudyError("found none, expected one or more", field="options")
    return options


def _correct(data: Mapping[str, Any], kind: str, options: Sequence[ResponseOption]) -> str | None:
    names, found = [option.id for option in options], data.get("correct")
    if kind != CHECK and found is not None:
        raise StudyError(f"found {shown(found)}, expected none: only an {CHECK} has a correct answer", field="correct")
    if kind == CHECK and found not in names:
        raise StudyError(f"found {shown(found)}, expected one of {', '.join(names)}", field="correct")
    return found if kind == CHECK else None


def _option(value: object, path: str) -> ResponseOption:
    """Read an option; without an id, its English text is its id."""
    try:
        fields = dict(checks.mapping(value, "", StudyError))
        name = fields.pop("id", fields.get("en"))
        return ResponseOption(
            id=checks.text(name, "id", "a name that is not empty", StudyError), text=texts(fields, "")
        )
    except InputError as error:
        raise error.within(path) from None


def texts(value: object, path: str) -> dict[str, str]:
    """Return a text by language. Raises StudyError if English is missing, or for an unknown language."""
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


def consented(values: Mapping[str, Any], *, languages: Sequence[str] = LANGUAGES) -> tuple[dict[str, bool], str]:
    """Return what a person agrees to, and their language. Raises MessageError, naming the field."""
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
            raise MessageError("an answer is required", field=question.id)
        return [] if question.kind == "choices" else None
    names = [option.id for option in question.options]
    if question.kind == "text":
        text = checks.text(value, question.id, "a text", MessageError).replace("\x00", "")
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        if len(text) > LONGEST:
            raise MessageError(f"found {len(text)} characters, expected at most {LONGEST}", field=question.id)
        return text
    if question.kind == "scale":
        if type(value) is not int or not 1 <= value <= POINTS:
            raise MessageError(f"found {shown(value)}, expected 1 to {POINTS}", field=question.id)
        return value
    chosen = value if question.kind == "choices" else [value]
    if not isinstance(chosen, list) or any(each not in names for each in chosen) or len(set(chosen)) < len(chosen):
        expected = f"{'any' if question.kind == 'choices' else 'one'} of {', '.join(names)}"
        raise MessageError(f"found {shown(value)}, expected {expected}", field=question.id)
    if question.kind == CHECK:
        return {"chosen": value, "passed": value == question.correct}
    return [name for name in names if name in chosen] if question.kind == "choices" else value


def question_to_json(question: Question) -> ServerMessage:
    """Return a question as a page shows it; an attention check looks like any choice, and its answer stays here."""
    kind = "choice" if question.kind == CHECK else question.kind
    fields = {"id": question.id, "kind": kind, "text": dict(question.text), "required": question.required}
    options = [{"id": option.id, "text": dict(option.text)} for option in question.options]
    return {**fields, "options": options, "points": POINTS if question.kind == "scale" else None}

"""Answers as they are kept."""

from __future__ import annotations

import pytest

from fetch_pomdp.errors import MessageError, StudyError
from fetch_pomdp.user_study.questionnaire import Question, answered, question_from_mapping, question_to_json


def test_line_ends_of_an_answer_are_those_of_a_table() -> None:
    question = Question(id="open", kind="text", text={"en": "What?"})
    assert answered([question], {"open": "one\r\ntwo\rthree\nfour"}) == {"open": "one\ntwo\nthree\nfour"}


CHECK = {
    "id": "reading",
    "kind": "attention_check",
    "text": {"en": "To show that you read this, choose “often”."},
    "options": [{"id": "never", "en": "never"}, {"id": "often", "en": "often"}],
    "correct": "often",
}


def test_an_attention_check_is_passed_by_the_correct_choice_alone() -> None:
    question = question_from_mapping(CHECK, "questions[0]")
    assert answered([question], {"reading": "often"}) == {"reading": {"chosen": "often", "passed": True}}
    assert answered([question], {"reading": "never"}) == {"reading": {"chosen": "never", "passed": False}}
    with pytest.raises(MessageError, match="reading: found 'sometimes', expected one of never, often"):
        answered([question], {"reading": "sometimes"})
    with pytest.raises(MessageError, match="reading: an answer is required"):
        answered([question], {})


def test_the_page_is_not_told_which_question_is_a_check() -> None:
    shown = question_to_json(question_from_mapping(CHECK, "questions[0]"))
    plain = {name: value for name, value in CHECK.items() if name != "correct"}
    assert shown == question_to_json(question_from_mapping({**plain, "kind": "choice"}, "questions[0]"))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"correct": "rarely"}, r"questions\[0\].correct: found 'rarely', expected one of never, often"),
        ({"correct": None}, r"questions\[0\].correct: found None, expected one of never, often"),
        ({"kind": "choice"}, r"questions\[0\].correct: found 'often', expected none"),
        ({"options": []}, r"questions\[0\].options: found none"),
    ],
)
def test_a_check_has_a_correct_option(changes: dict[str, object], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        question_from_mapping({**CHECK, **changes}, "questions[0]")

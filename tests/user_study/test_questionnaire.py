"""Answers as they are kept."""

from __future__ import annotations

from fetch_pomdp.user_study.questionnaire import Question, answered


def test_line_ends_of_an_answer_are_those_of_a_table() -> None:
    question = Question(id="open", kind="text", text={"en": "What?"})
    assert answered([question], {"open": "one\r\ntwo\rthree\nfour"}) == {"open": "one\ntwo\nthree\nfour"}

"""The configuration of a user study: its design, and what people read, agree to and are asked."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.documents import parse_toml, read_toml
from fetch_pomdp.errors import InputError, StudyError
from fetch_pomdp.files.header import Header
from fetch_pomdp.study.configuration import digest, study_from_mapping, to_plain
from fetch_pomdp.study.design import PRACTICE, Study, assignments_of, stream
from fetch_pomdp.study.trial import Assignment
from fetch_pomdp.user_study.questionnaire import CHECK, Question, question_from_mapping, texts, truth

SECTION = "participation"
FIELDS = ("title", "consent", "instructions", "practice", "questions", "keep_sound", "countdown")
SIMULATED = ("population", "clock", "logs", "real_speech")  # fields of a study that are about simulated people alone
MOST_PRACTICE = 100
LONGEST_COUNTDOWN = 60.0  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class UserStudy:
    """A study in which real people take part. Texts are by language, each with English.

    Where the study's files do not say, the robot expects of them what it expects of live people (core/live/person.py).
    Raises StudyError for an invalid field.
    """

    name: str  # of the study, in a database of participants
    study: Study
    title: Mapping[str, str]
    consent: Mapping[str, str]
    instructions: Mapping[str, str]
    questions: tuple[Question, ...]
    practice: int  # trials before those that count
    keep_sound: bool  # of those who agree to it
    countdown: float  # s, before each trial

    def __post_init__(self) -> None:
        if type(self.practice) is not int or not 0 <= self.practice <= MOST_PRACTICE:
            expected = f"expected a whole number from 0 to {MOST_PRACTICE}"
            raise StudyError(f"found {shown(self.practice)}, {expected}", field="practice")
        expected = f"seconds, from 0 to {LONGEST_COUNTDOWN:g}"
        checks.within(self.countdown, 0.0, LONGEST_COUNTDOWN, "countdown", expected, StudyError)
        names = [question.id for question in self.questions]
        if twice := next((name for name in names if names.count(name) > 1), None):
            raise StudyError(f"found {twice!r} twice, expected each id once", field="questions")

    @property
    def people(self) -> int:
        """How many people may take part."""
        return self.study.people

    @property
    def digest(self) -> str:
        """A hash of all that answers and trials depend on.

        Choice: wordings are not part of it, so that a misprint can be corrected while a study is running; a hash of the
        text that was agreed to is kept with each consent.
        """
        study = {name: value for name, value in to_plain(self.study).items() if name not in SIMULATED}
        asked = [
            [each.id, each.kind, each.page, each.required, [option.id for option in each.options]]
            + ([each.correct] if each.kind == CHECK else [])
            for each in self.questions
        ]
        return digest({"study": study, "practice": self.practice, "countdown": self.countdown, "asked": asked})

    def trials(self, person: int) -> tuple[Header, ...]:
        """Return the headers of a person's trials, in order; each begins at 0 s."""
        return tuple(self._header(assignment) for assignment in assignments_of(self.study, person))

    def practice_trials(self, person: int) -> tuple[Header, ...]:
        """Return the headers of a person's practice trials.

        Choice: items and paradigms are drawn anew for each person, so that practice favours none.
        """
        layout, rng = self.study.layout_of(person), stream(self.study, PRACTICE, person)
        items = [item.id for item in self.study.layouts[layout].items]
        order = [items[place] for place in rng.permutation(len(items)).tolist()]
        paradigms = list(self.study.paradigms)
        headers = []
        for number in range(self.practice):
            paradigm = paradigms[int(rng.integers(len(paradigms)))]
            header = self._header(Assignment(person, layout, paradigm, order[number % len(order)], number))
            headers.append(dataclasses.replace(header, seed=int(rng.integers(2**63))))
        return tuple(headers)

    def robots(self) -> tuple[Header, ...]:
        """Return a trial of each paradigm at each layout."""
        return tuple(
            self._header(Assignment(0, layout, paradigm, scene.items[0].id, 0))
            for layout, scene in self.study.layouts.items()
            for paradigm in self.study.paradigms
        )

    def _header(self, assignment: Assignment) -> Header:
        return dataclasses.replace(self.study.header(assignment), begun=0.0)


def load_user_study(path: str | Path) -> UserStudy:
    """Read a user study from a TOML file: that of a study, with a section [participation].

    Title and consent are required; what else is missing is as in the template. The study has the file's name. Raises
    InputError with file, line and field.
    """
    place = Path(path)
    document = read_toml(place, StudyError)
    return document.build(lambda data: user_study_from_mapping(data, place.parent, place.stem))


def user_study_from_mapping(data: Mapping[str, Any], folder: Path, name: str) -> UserStudy:
    """Build a user study from the fields of a file in `folder`."""
    usual = _template()
    robots = {key: usual[key] for key in ("paradigms", "reader")}
    design = robots | {key: data[key] for key in data if key != SECTION}
    study = study_from_mapping(design, folder, live_scene)
    checks.required(data, (SECTION,), StudyError)
    try:
        given = checks.mapping(data[SECTION], "", StudyError)
        checks.known(given, FIELDS, "field", StudyError)
        checks.required(given, ("title", "consent"), StudyError)
        fields = {**usual[SECTION], **given}
        return UserStudy(
            name=name,
            study=study,
            questions=_questions(fields["questions"]),
            keep_sound=truth(fields["keep_sound"], "keep_sound"),
            title=texts(fields["title"], "title"),
            consent=texts(fields["consent"], "consent"),
            instructions=texts(fields["instructions"], "instructions"),
            practice=fields["practice"],
            countdown=fields["countdown"],
        )
    except InputError as error:
        raise error.within(SECTION) from None


def _questions(value: object) -> tuple[Question, ...]:
    if not isinstance(value, list | tuple):
        raise StudyError(f"found {shown(value)}, expected [[{SECTION}.questions]] tables", field="questions")
    return tuple(question_from_mapping(each, f"questions[{index}]") for index, each in enumerate(value))


def template() -> str:
    """Return the text of a study file to begin with."""
    return (files("fetch_pomdp.user_study") / "template.toml").read_text(encoding="utf-8")


def _template() -> Mapping[str, Any]:
    return parse_toml(template(), "the template", StudyError).data

"""What is asked of the people of a study, as its maker wrote it. Texts are by language, each with English ("en")."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from fetch_pomdp.files.header import Header


class Option(Protocol):
    """A possible answer, or one end of a scale."""

    @property
    def id(self) -> str:
        """What is kept of it."""
        ...

    @property
    def text(self) -> Mapping[str, str]:
        """What is shown."""
        ...


class Question(Protocol):
    """A question of the questionnaire."""

    @property
    def id(self) -> str:
        """Its name."""
        ...

    @property
    def kind(self) -> str:
        """How it is answered: "text", "scale" (1 to 7; options are its ends), "choice" or "choices"."""
        ...

    @property
    def text(self) -> Mapping[str, str]:
        """What is asked."""
        ...

    @property
    def options(self) -> Sequence[Option]:
        """What can be chosen."""
        ...

    @property
    def required(self) -> bool:
        """Whether it must be answered."""
        ...

    @property
    def page(self) -> int:
        """Its page; later ones come when all before are answered."""
        ...


class Programme(Protocol):
    """A study with real people."""

    @property
    def name(self) -> str:
        """Its name in the database."""
        ...

    @property
    def digest(self) -> str:
        """A text that changes with what trials and answers depend on."""
        ...

    @property
    def people(self) -> int:
        """How many may take part."""
        ...

    @property
    def title(self) -> Mapping[str, str]:
        """The study's title."""
        ...

    @property
    def consent(self) -> Mapping[str, str]:
        """What people agree to."""
        ...

    @property
    def instructions(self) -> Mapping[str, str]:
        """What people read before they begin."""
        ...

    @property
    def questions(self) -> Sequence[Question]:
        """What they are asked in the end."""
        ...

    @property
    def keep_sound(self) -> bool:
        """Whether sound may be kept of who agrees."""
        ...

    @property
    def countdown(self) -> float:
        """How long (s) the countdown before each trial takes."""
        ...

    def trials(self, person: int) -> Sequence[Header]:
        """Return what each trial of a person is about, in their order."""
        ...

    def practice_trials(self, person: int) -> Sequence[Header]:
        """Return what a person's trials before those that count are about."""
        ...

    def robots(self) -> Sequence[Header]:
        """Return a trial of each kind of robot at each table."""
        ...

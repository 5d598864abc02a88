"""One participant before a page, led from stage to stage; each goes on where it was after a lost connection."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, Literal

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.store.journal import SECOND
from fetch_pomdp.adapters.store.participant import Agreement, Participant
from fetch_pomdp.adapters.store.store import Store
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Hearing
from fetch_pomdp.adapters.web.journal import name_of
from fetch_pomdp.adapters.web.participation.answers import answered, consented, question_to_json
from fetch_pomdp.adapters.web.participation.mailbox import LeftError, Mailbox, WithdrawnError
from fetch_pomdp.adapters.web.participation.messages import STUDY, Answer, Next, Reply
from fetch_pomdp.adapters.web.participation.programme import Programme, Question
from fetch_pomdp.adapters.web.participation.rounds import Round, Sound
from fetch_pomdp.adapters.web.protocol import read_message
from fetch_pomdp.adapters.web.tell import BROKEN, Told, complaint
from fetch_pomdp.errors import InputError, StoreError
from fetch_pomdp.files.header import Header

logger = logging.getLogger(__name__)


class Attendance:
    """A Party: one participant, and one conversation after the other.

    secret, person: of who comes back, None for somebody new, of whom nothing is kept before they agree. tell: takes
    messages, from any thread, and returns soon.
    """

    def __init__(
        self,
        programme: Programme,
        store: Store,
        tell: Callable[[Told], None],
        *,
        secret: str | None,
        person: Participant | None,
        voice: Voice | None,
        hearing: Hearing | None,
    ) -> None:
        self._programme, self._store, self._tell = programme, store, tell
        self._secret, self._person = secret, person
        self._voice, self._hearing = voice, hearing
        self._mailbox = Mailbox(tell)
        self._talk: Conversation | None = None
        self._keeps_sound = False
        self._thread = threading.Thread(target=self._run, name=f"attendance {self.name[:8]}", daemon=True)

    @property
    def name(self) -> str:
        """The name under which it is found when its person comes back."""
        return f"newcomer-{id(self)}" if self._secret is None else name_of(self._secret)

    def start(self) -> None:
        """Begin, in a thread."""
        self._thread.start()

    def close(self) -> None:
        """End soon, from any thread; the person may come back."""
        self._mailbox.close()

    def join(self, timeout: float) -> None:
        """Wait until the thread has ended."""
        self._thread.join(timeout)

    def take(self, message: str | bytes) -> None:
        """Take what a page sent. What is said or shown outside an interaction reaches nobody.

        Raises InputError for what is no message.
        """
        said = message if isinstance(message, bytes) else read_message(message, STUDY)
        talk = self._talk
        if isinstance(said, Answer):
            self._mailbox.put(said)
        elif talk is not None:
            talk.heed(said)
            if isinstance(said, bytes) and self._keeps_sound:
                self._mailbox.put(Sound(talk.clock.now() - len(said) / SECOND, said))

    def _run(self) -> None:
        try:
            self._attend()
        except LeftError:
            logger.info("a participant left")
        except WithdrawnError:
            logger.info("a participant withdraws")
        except Exception as error:
            self._broke(error)
        if self._mailbox.withdrawn:
            self._withdraw()

    def _broke(self, error: Exception) -> None:
        """Let the page come back: it is let go when it is told that its party is broken."""
        logger.error("an attendance broke off", exc_info=error)
        if not self._mailbox.withdrawn:
            self._tell(complaint(error, BROKEN))

    def _withdraw(self) -> None:
        """Delete the person and tell them so, then remove what the rows have left behind, which may take long."""
        try:
            person = self._store.returning(self._programme.name, self._secret or "")
            if person is not None:
                self._store.erase(person.code)
        except StoreError as error:
            logger.exception("somebody who withdraws is not deleted: their page asks again when it comes back")
            self._tell(complaint(error, BROKEN))
            return
        self._person = self._secret = None
        self._show("withdrawn")
        try:
            self._store.scrub()
        except StoreError:
            logger.exception(
                "somebody who has withdrawn is deleted, but bytes may be left: forget anybody to try again"
            )

    def _attend(self) -> None:
        person = self._person or self._enrolled()
        steps: dict[str, Callable[[Participant], None]] = {
            "instructions": self._instructions,
            "practice": self._practice,
            "trials": self._trials,
            "questions": self._questions,
        }
        for here, after in pairwise([*steps, "done"]):
            if person.stage == here:
                steps[here](person)
                self._store.advance(person.id, after)
                person = self._refreshed()
        self._show("done", completion=person.completion)
        self._mailbox.expect()  # they may still withdraw

    def _show(self, stage: str, **fields: object) -> None:
        title = dict(self._programme.title)
        known = {} if self._person is None else {"code": self._person.code, "resume": self._secret}
        self._tell({"type": "stage", "stage": stage, "title": title, **known, **fields})

    def _refreshed(self) -> Participant:
        person = self._store.returning(self._programme.name, self._secret or "")
        if person is None:
            raise StoreError("found nobody, expected a participant: they were deleted meanwhile")
        self._person = person
        return person

    def _filled(self, stage: str) -> Reply:
        """Wait for what is filled in at a stage; what belongs to another, such as a second click, is passed over."""
        while True:
            reply: Reply = self._mailbox.expect(Reply)
            if reply.stage == stage:
                return reply

    def _enrolled(self) -> Participant:
        """Ask for consent; take in who agrees. Raises LeftError for who does not, and where there is no room."""
        programme = self._programme
        self._show("consent", text=dict(programme.consent), keep_sound=programme.keep_sound)
        given, language = self._agreement()
        if not given["taking_part"]:
            self._show("declined")
            raise LeftError
        given = {**given, "sound": given["sound"] and programme.keep_sound}
        read = programme.consent.get(language, programme.consent["en"])
        try:
            self._person, self._secret = self._store.enrol(
                programme.name, programme.digest, programme.people,
                Agreement(language=language, given=given, text=read),
                trials=lambda number: len(programme.trials(number)),
            )  # fmt: skip
        except StoreError as error:
            if error.field != "people":
                raise
            self._show("full")
            raise LeftError from None
        return self._person

    def _agreement(self) -> tuple[dict[str, bool], str]:
        while True:
            try:
                return consented(self._filled("consent").values, languages=("en", "de"))
            except InputError as error:
                self._tell(complaint(error))

    def _instructions(self, person: Participant) -> None:
        programme = self._programme
        counts = {"practice": len(programme.practice_trials(person.person)), "of": len(programme.trials(person.person))}
        self._show("instructions", text=dict(programme.instructions), ears=self._hearing is not None, **counts)
        self._filled("instructions")

    def _practice(self, person: Participant) -> None:
        self._rounds(person, "practice", person.practice_done, self._programme.practice_trials(person.person))

    def _trials(self, person: Participant) -> None:
        self._keeps_sound = bool(self._programme.keep_sound and person.consent.get("sound"))
        self._rounds(person, "trial", person.trials_done, self._programme.trials(person.person))
        self._keeps_sound = False

    def _rounds(
        self, person: Participant, part: Literal["practice", "trial"], done: int, headers: Sequence[Header]
    ) -> None:
        stage = {"type": "stage", "stage": "practice" if part == "practice" else "trials", "of": len(headers)}
        known = {"title": dict(self._programme.title), "code": person.code, "resume": self._secret}
        for order in range(done, len(headers)):
            trial = self._store.trial(person.id, part, order, headers[order])
            played = Round(
                trial, self._mailbox, self._tell, voice=self._voice, hearing=self._hearing, began=self._began
            )
            played.play({**stage, **known, "order": order}, self._programme.countdown)
            self._mailbox.expect(Next)

    def _began(self, talk: Conversation | None) -> None:
        self._talk = talk

    def _questions(self, person: Participant) -> None:
        pages = sorted({question.page for question in self._programme.questions})
        for number, page in enumerate(pages):
            questions = [question for question in self._programme.questions if question.page == page]
            if all(question.id in person.answers for question in questions):
                continue
            shown = [question_to_json(question) for question in questions]
            self._show("questions", order=number, of=len(pages), questions=shown)
            for name, value in self._answers(questions).items():
                self._store.answer(person.id, name, value)

    def _answers(self, questions: Sequence[Question]) -> dict[str, Any]:
        while True:
            try:
                return answered(questions, self._filled("questions").values)
            except InputError as error:
                self._tell(complaint(error))

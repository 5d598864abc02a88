"""The session of one participant, from stage to stage; after a lost connection it goes on where it was."""

from __future__ import annotations

import logging
import secrets
import threading
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, Literal

from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.journal import name_of
from fetch_pomdp.adapters.web.page_messages import read_message
from fetch_pomdp.adapters.web.server_messages import BROKEN, Send, error_message
from fetch_pomdp.errors import InputError, StoreError
from fetch_pomdp.files.header import Header
from fetch_pomdp.user_study.config import UserStudy
from fetch_pomdp.user_study.mailbox import LeftError, Mailbox, WithdrawnError
from fetch_pomdp.user_study.messages import PARTICIPANT, Command, Next, Reply
from fetch_pomdp.user_study.questionnaire import Question, answered, consented, question_to_json
from fetch_pomdp.user_study.store.participants import Agreement, Participant
from fetch_pomdp.user_study.store.store import Store
from fetch_pomdp.user_study.store.trials import SECOND
from fetch_pomdp.user_study.trial import Sound, TrialRunner

logger = logging.getLogger(__name__)


class ParticipantSession:
    """A PageSession: one participant, and one conversation after the other.

    returning: the secret and the participant of a page that comes back; None for a new page, of whose person nothing is
    kept before they agree.

    Choice: a new page gets its secret with the consent text, before there is a participant. A place is taken by the
    answer of a page that holds its secret already, so that no place is lost if the server dies right after.
    """

    def __init__(
        self, study: UserStudy, store: Store, send: Send, *, speech: Speech, returning: tuple[str, Participant] | None
    ) -> None:
        self._study, self._store, self._send, self._speech = study, store, send, speech
        self._secret = secrets.token_urlsafe(24) if returning is None else returning[0]
        self._person = None if returning is None else returning[1]
        self.name = name_of(self._secret)
        self._mailbox = Mailbox(send)
        self._conversation: Conversation | None = None
        self._keeps_sound = False
        self._ended: Callable[[], None] = lambda: None
        self._thread = threading.Thread(target=self._run, name=f"participant {self.name[:8]}", daemon=True)

    def start(self, ended: Callable[[], None] = lambda: None) -> None:
        """Start, in a thread, which calls `ended` at its end."""
        self._ended = ended
        self._thread.start()

    def close(self) -> None:
        """End soon, from any thread; the person may come back."""
        self._mailbox.close()

    def receive(self, message: str | bytes) -> None:
        """Take what a page sent; what is said or shown outside an interaction is dropped.

        Raises InputError if it is invalid.
        """
        read = message if isinstance(message, bytes) else read_message(message, PARTICIPANT)
        conversation = self._conversation
        if isinstance(read, Command):
            self._mailbox.put(read)
        elif conversation is not None:
            conversation.handle(read)
            if isinstance(read, bytes) and self._keeps_sound:
                self._mailbox.put(Sound(conversation.clock.now() - len(read) / SECOND, read))

    def _run(self) -> None:
        try:
            self._lead()
        except LeftError:
            logger.info("a participant left")
        except WithdrawnError:
            logger.info("a participant withdraws")
        except Exception as error:
            self._fail(error)
        try:
            if self._mailbox.withdrawn:
                self._withdraw()
        finally:
            self._ended()

    def _fail(self, error: Exception) -> None:
        """Let the page come back: it is disconnected when it is told that its session is broken."""
        logger.error("the session of a participant failed", exc_info=error)
        if not self._mailbox.withdrawn:
            self._send(error_message(error, BROKEN))

    def _withdraw(self) -> None:
        """Delete the person and tell them, then remove what the rows have left behind, which may take long."""
        try:
            person = self._store.returning(self._study.name, self._secret)
            if person is not None:
                self._store.erase(person.code)
        except StoreError as error:
            logger.exception(
                "a participant who withdraws could not be deleted; their page asks again when it comes back"
            )
            self._send(error_message(error, BROKEN))
            return
        self._person = None
        self._show("withdrawn")
        try:
            self._store.scrub()
        except StoreError:
            logger.exception("a participant who withdrew is deleted, but bytes may be left; the next `forget` retries")

    def _lead(self) -> None:
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
        title = dict(self._study.title)
        known = {} if self._person is None else {"code": self._person.code, "resume": self._secret}
        self._send({"type": "stage", "stage": stage, "title": title, **known, **fields})

    def _refreshed(self) -> Participant:
        person = self._store.returning(self._study.name, self._secret)
        if person is None:
            raise StoreError("the participant was deleted meanwhile")
        self._person = person
        return person

    def _filled(self, stage: str) -> Reply:
        """Wait for the form of a stage; one of another stage, such as after a second click, is ignored."""
        while True:
            reply: Reply = self._mailbox.expect(Reply)
            if reply.stage == stage:
                return reply

    def _enrolled(self) -> Participant:
        """Ask for consent, and enrol the person. Raises LeftError if they do not agree, or if all places are taken."""
        study = self._study
        self._show("consent", text=dict(study.consent), keep_sound=study.keep_sound, resume=self._secret)
        given, language = self._agreement()
        if not given["taking_part"]:
            self._show("declined")
            raise LeftError
        given = {**given, "sound": given["sound"] and study.keep_sound}
        read = study.consent.get(language, study.consent["en"])
        try:
            self._person = self._store.enrol(
                study.name, study.digest, study.people,
                Agreement(language=language, given=given, text=read),
                secret=self._secret, trials=lambda number: len(study.trials(number)),
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
                return consented(self._filled("consent").values)
            except InputError as error:
                self._send(error_message(error))

    def _instructions(self, person: Participant) -> None:
        study = self._study
        counts = {"practice": len(study.practice_trials(person.person)), "of": len(study.trials(person.person))}
        self._show("instructions", text=dict(study.instructions), ears=self._speech.hearing is not None, **counts)
        self._filled("instructions")

    def _practice(self, person: Participant) -> None:
        self._run_trials(person, "practice", person.practice_done, self._study.practice_trials(person.person))

    def _trials(self, person: Participant) -> None:
        self._keeps_sound = bool(self._study.keep_sound and person.consent.get("sound"))
        self._run_trials(person, "trial", person.trials_done, self._study.trials(person.person))
        self._keeps_sound = False

    def _run_trials(
        self, person: Participant, part: Literal["practice", "trial"], done: int, headers: Sequence[Header]
    ) -> None:
        stage = {"type": "stage", "stage": "practice" if part == "practice" else "trials", "of": len(headers)}
        known = {"title": dict(self._study.title), "code": person.code, "resume": self._secret}
        for order in range(done, len(headers)):
            trial = self._store.trial(person.id, part, order, headers[order])
            runner = TrialRunner(
                trial, self._mailbox, self._send, speech=self._speech, on_conversation=self._set_conversation
            )
            runner.run({**stage, **known, "order": order}, self._study.countdown)
            self._mailbox.expect(Next)

    def _set_conversation(self, conversation: Conversation | None) -> None:
        self._conversation = conversation

    def _questions(self, person: Participant) -> None:
        pages = sorted({question.page for question in self._study.questions})
        for number, page in enumerate(pages):
            questions = [question for question in self._study.questions if question.page == page]
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
                self._send(error_message(error))

"""Who comes to take part in a study, and the researcher's doors to it."""

from __future__ import annotations

import asyncio
import dataclasses
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.store.exporting import Scored
from fetch_pomdp.adapters.store.participant import Participant
from fetch_pomdp.adapters.store.store import Store
from fetch_pomdp.adapters.web.ears import Hearing
from fetch_pomdp.adapters.web.gate import Gate
from fetch_pomdp.adapters.web.hall import PENALTY
from fetch_pomdp.adapters.web.journal import name_of
from fetch_pomdp.adapters.web.participation.attendance import Attendance
from fetch_pomdp.adapters.web.participation.programme import Programme
from fetch_pomdp.adapters.web.protocol import Hello
from fetch_pomdp.adapters.web.tell import Told
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.extras import load

EXTRA = "serve"


class Registry:
    """A Reception: table and robot are the study's. voice, hearing: None where they are not installed."""

    def __init__(self, venue: Venue, *, voice: Voice | None, hearing: Hearing | None) -> None:
        self._venue, self._voice, self._hearing = venue, voice, hearing

    def name(self, hello: Hello) -> str | None:
        """Return the name of the attendance that a page comes back to, if it does."""
        return None if hello.participant is None else name_of(hello.participant)

    def returning(self, hello: Hello, tell: Callable[[Told], None]) -> Attendance | None:
        """Return the attendance of who comes back, None for nobody we know."""
        secret, venue = hello.participant, self._venue
        person = None if secret is None else venue.store.returning(venue.programme.name, secret)
        return None if person is None else self._attendance(tell, secret, person)

    def newcomer(self, hello: Hello, tell: Callable[[Told], None]) -> Attendance:  # noqa: ARG002
        """Return the attendance of somebody new."""
        return self._attendance(tell, None, None)

    def get_ready(self) -> None:
        """Compile the planners and solve the tables before the first person comes."""
        for header in self._venue.programme.robots():
            agent = header.agent()
            prepare(agent.planner, agent.problem)

    def _attendance(self, tell: Callable[[Told], None], secret: str | None, person: Participant | None) -> Attendance:
        return Attendance(
            self._venue.programme, self._venue.store, tell,
            secret=secret, person=person, voice=self._voice, hearing=self._hearing,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Venue:
    """Where a study takes place. token: what a researcher must know; scored: makes rows of trials (`Store.export`)."""

    programme: Programme
    store: Store
    token: str
    scored: Scored

    def reception(self, voice: Voice | None, hearing: Hearing | None) -> Registry:
        """Return who receives the participants. Raises StoreError if the study has changed since it began."""
        self.store.begin(self.programme.name, self.programme.digest, self.programme.people)
        return Registry(self, voice=voice, hearing=hearing)

    def routes(self) -> list[Any]:
        """Return the routes of the researcher's page. Raises MissingExtraError without FastAPI."""
        routing = load("starlette.routing", EXTRA)
        return [
            routing.Route("/researcher/progress", self._guarded(self._progress)),
            routing.Route("/researcher/export", self._guarded(self._export)),
        ]

    def _guarded(self, answer: Callable[[], Any]) -> Callable[[Any], Any]:
        """Return an endpoint that answers who knows the token, and lets others wait."""
        gate, responses = Gate(self.token), load("starlette.responses", EXTRA)

        async def endpoint(request: Any) -> Any:
            kind, _, token = request.headers.get("authorization", "").partition(" ")
            if kind.lower() != "bearer" or not gate.token_allowed(token):
                await asyncio.sleep(PENALTY)
                challenge = {"www-authenticate": "Bearer"}
                return responses.PlainTextResponse("the researcher's token is needed", 401, challenge)
            return await asyncio.to_thread(answer)

        return endpoint

    def _progress(self) -> Any:
        rows = [dataclasses.asdict(row) for row in self.store.progress(self.programme.name)]
        study = {"name": self.programme.name, "title": dict(self.programme.title), "people": self.programme.people}
        return load("starlette.responses", EXTRA).JSONResponse({**study, "progress": rows})

    def _export(self) -> Any:
        """Return all that is kept of the study, as a ZIP file that is gone when it has been sent."""
        responses, background = load("starlette.responses", EXTRA), load("starlette.background", EXTRA)
        folder = Path(tempfile.mkdtemp(prefix="fetch-pomdp-export-"))
        try:
            self.store.export(folder / self.programme.name, self.programme.name, scored=self.scored)
            made = shutil.make_archive(str(folder / "export"), "zip", folder, self.programme.name)
        except BaseException:
            shutil.rmtree(folder)
            raise
        gone = background.BackgroundTask(shutil.rmtree, folder)
        name = f"{self.programme.name}.zip"
        return responses.FileResponse(made, media_type="application/zip", filename=name, background=gone)

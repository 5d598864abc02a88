"""A user study on a server: a session for each participant, and the researcher's routes."""

from __future__ import annotations

import asyncio
import dataclasses
import shutil
import tempfile
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from fetch_pomdp.adapters.web.access import TokenCheck, TooManyGuessesError
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.journal import name_of
from fetch_pomdp.adapters.web.page_messages import Hello
from fetch_pomdp.adapters.web.server_messages import Send
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.errors import MessageError
from fetch_pomdp.user_study.config import UserStudy
from fetch_pomdp.user_study.session import ParticipantSession
from fetch_pomdp.user_study.store.participants import Participant
from fetch_pomdp.user_study.store.store import Store

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.routing import BaseRoute


class StudyApp:
    """A SessionOpener whose tables and robots are the study's, with the researcher's routes.

    token: of the researcher. Raises StoreError if the study has changed since its first participant.
    """

    def __init__(self, study: UserStudy, store: Store, token: str, *, speech: Speech) -> None:
        self._study, self._store, self._speech = study, store, speech
        self._tokens = TokenCheck(token)
        store.begin(study.name, study.digest, study.people)

    def session_name(self, hello: Hello) -> str | None:
        """Return the name of the session that a page comes back to, None for a new page."""
        return None if hello.participant is None else name_of(hello.participant)

    def resume(self, hello: Hello, send: Send) -> ParticipantSession | None:
        """Return the session of a participant who comes back, None for an unknown secret."""
        secret = hello.participant
        person = None if secret is None else self._store.returning(self._study.name, secret)
        return None if secret is None or person is None else self._session(send, (secret, person))

    def new(self, hello: Hello, send: Send) -> ParticipantSession:  # noqa: ARG002
        """Return the session of somebody new."""
        return self._session(send, None)

    def warm_up(self) -> None:
        """Compile the planners and solve the tables before the first page comes."""
        for header in self._study.robots():
            agent = header.agent()
            prepare(agent.planner, agent.problem)

    def routes(self) -> list[BaseRoute]:
        """Return the researcher's routes."""
        from starlette.routing import Route

        return [
            Route("/researcher/progress", self._protected(self._progress)),
            Route("/researcher/export", self._protected(self._export)),
        ]

    def _session(self, send: Send, returning: tuple[str, Participant] | None) -> ParticipantSession:
        return ParticipantSession(self._study, self._store, send, speech=self._speech, returning=returning)

    def _protected(self, answer: Callable[[], Response]) -> Callable[[Request], Awaitable[Response]]:
        """Return an endpoint for those who know the token."""
        from starlette.responses import PlainTextResponse

        async def endpoint(request: Request) -> Response:
            kind, _, token = request.headers.get("authorization", "").partition(" ")
            try:
                self._tokens.check(token if kind.lower() == "bearer" else None, _address(request))
            except TooManyGuessesError as error:
                return PlainTextResponse(str(error), 429, {"retry-after": "1"})
            except MessageError:
                challenge = {"www-authenticate": "Bearer"}
                return PlainTextResponse("the researcher's token is needed", 401, challenge)
            return await _in_own_thread(answer)

        return endpoint

    def _progress(self) -> Response:
        from starlette.responses import JSONResponse

        rows = [dataclasses.asdict(row) for row in self._store.progress(self._study.name)]
        study = {"name": self._study.name, "title": dict(self._study.title), "people": self._study.people}
        return JSONResponse({**study, "progress": rows})

    def _export(self) -> Response:
        """Return all that is kept of the study, as a ZIP file that is deleted when it has been sent."""
        from starlette.background import BackgroundTask
        from starlette.responses import FileResponse

        folder = Path(tempfile.mkdtemp(prefix="fetch-pomdp-export-"))
        try:
            self._store.export(folder / self._study.name, self._study.name)
            made = shutil.make_archive(str(folder / "export"), "zip", folder, self._study.name)
        except BaseException:
            shutil.rmtree(folder)
            raise
        delete = BackgroundTask(shutil.rmtree, folder)
        return FileResponse(made, media_type="application/zip", filename=f"{self._study.name}.zip", background=delete)


def _address(request: Request) -> str:
    return request.client.host if request.client else ""


async def _in_own_thread(answer: Callable[[], Response]) -> Response:
    """Run in a new thread: an export may take long, and nobody else waits for it."""
    thread = ThreadPoolExecutor(1, thread_name_prefix="researcher")
    try:
        return await asyncio.get_running_loop().run_in_executor(thread, answer)
    finally:
        thread.shutdown(wait=False)

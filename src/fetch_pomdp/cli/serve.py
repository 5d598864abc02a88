"""The command serve: the robot in a browser."""

from __future__ import annotations

import dataclasses
import ipaddress
import logging
import secrets
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from urllib.parse import quote

import typer

from fetch_pomdp.cli.options import Ears, ReaderName
from fetch_pomdp.cli.participants import DATABASE
from fetch_pomdp.core.language.reading.catalogue import DEFAULT as READER
from fetch_pomdp.errors import InputError

if TYPE_CHECKING:
    from fetch_pomdp.adapters.web.ears import Speech
    from fetch_pomdp.user_study.app import StudyApp

Table = Annotated[
    str,
    typer.Argument(
        metavar="[SCENE]", help="The table to begin with: ambiguous, unambiguous, or a TOML file (docs/scenes.md)."
    ),
]
Host = Annotated[str, typer.Option(help="Address to listen at; anything but loopback needs a token.")]
Port = Annotated[int, typer.Option(min=1, max=65535, help="Port to listen at.")]
Token = Annotated[str | None, typer.Option(help="The token that a page needs.  [default: none on loopback]")]
Data = Annotated[Path | None, typer.Option(metavar="DIR", help="Keep each interaction in this folder, as it happens.")]
Insight = Annotated[bool, typer.Option("--no-insight", help="Do not show what the robot believes, nor why it acts.")]

StudyFile = Annotated[
    Path | None, typer.Option("--study", metavar="F.toml", help="Let people take part in this study.")
]
Database = Annotated[
    str | None,
    typer.Option(metavar="URL", help=f"Where a study's participants are kept.  [default: {DATABASE}]"),
]
ResearcherToken = Annotated[
    str | None, typer.Option(metavar="TOKEN", help="The token that the researcher's page needs.  [default: a new one]")
]

Preview = Annotated[
    bool, typer.Option("--preview", help="Walk through the study: no place is taken, and nothing is kept at the end.")
]

BEGINNING = "ambiguous"
DATABASE_FILE = "preview.db"
PREVIEW = {"en": "Preview", "de": "Vorschau"}  # before the title of a study that is walked through
SHORTEST_TOKEN = 16


def serve_page(
    scene: Table = BEGINNING,
    *,
    host: Host = "127.0.0.1",
    port: Port = 8000,
    token: Token = None,
    data: Data = None,
    no_insight: Insight = False,
    study: StudyFile = None,
    database: Database = None,
    ears: Ears = None,
    reader: ReaderName = READER,
    researcher_token: ResearcherToken = None,
    preview: Preview = False,
) -> None:
    """Open a page on which people talk to the robot, type to it and point. Stop with Ctrl-C.

    With --study people take part in a study there, from consent to completion code.
    """
    from fetch_pomdp.adapters.web.connection_manager import ServerConfig
    from fetch_pomdp.adapters.web.conversations import ConversationOpener
    from fetch_pomdp.adapters.web.ears import speech_if_installed, speech_with
    from fetch_pomdp.adapters.web.page_messages import scene_asked_for
    from fetch_pomdp.adapters.web.server import create_app, serve

    _check_token(token, "--token", None if _is_loopback(host) else host)
    _check_token(researcher_token, "--researcher-token")
    given = {"--data": data, "--database": database, "--researcher-token": researcher_token}
    _check_combination(scene, study, given, preview=preview)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    config = ServerConfig(scene=scene_asked_for(scene), token=token)
    speech = speech_if_installed() if ears is None else speech_with(ears)
    addresses = [f"The robot is at {address_of(host, port, '', token)}  (Ctrl-C ends it)"]
    opener: ConversationOpener | StudyApp
    with _kept_at(database, preview=preview) as url:
        if study is None:
            opener = ConversationOpener(data, insight=not no_insight, speech=speech, reader=reader)
            app = create_app(config, opener, voice=speech.voice)
        else:
            secret = researcher_token or secrets.token_urlsafe(24)
            opener = _study_app(study, url, secret, speech, preview=preview)
            app = create_app(config, opener, voice=speech.voice, routes=opener.routes())
            addresses.append(f"The researcher's page is {address_of(host, port, 'researcher.html', secret)}")
            if preview:
                addresses.append("A preview: no place is taken, and all of it is deleted at the end.")
        ready = partial(print, *addresses, sep="\n", flush=True)
        serve(app, host, port, ready=ready, warm_up=opener.warm_up)


def address_of(host: str, port: int, page: str, token: str | None) -> str:
    """Return a page's address, with the token in its fragment, which browsers do not send."""
    shown = f"[{host}]" if ":" in host else host
    return f"http://{shown}:{port}/{page}" + (f"#token={quote(token, safe='')}" if token else "")


def _check_combination(scene: str, study: Path | None, options: Mapping[str, object], *, preview: bool) -> None:
    """Raise InputError for options that do not go together."""
    if preview and study is None:
        raise InputError("--preview needs --study")
    if preview and options["--database"] is not None:
        raise InputError("a preview keeps nothing; leave this out with --preview", field="--database")
    if study is None:
        for name in ("--database", "--researcher-token"):
            if options[name] is not None:
                raise InputError(f"{name} needs --study")
    elif scene != BEGINNING:
        raise InputError("a study has its own scenes; leave this out with --study", field="SCENE")
    elif options["--data"] is not None:
        raise InputError("a study is kept in its database; leave this out with --study", field="--data")


@contextmanager
def _kept_at(database: str | None, *, preview: bool) -> Iterator[str]:
    """Yield the URL of the participants' database; that of a preview is deleted at the end."""
    if not preview:
        yield database or DATABASE
        return
    with tempfile.TemporaryDirectory(prefix="fetch-pomdp-preview-", ignore_cleanup_errors=True) as folder:
        yield f"sqlite:///{folder}/preview.db"


def _study_app(study: Path, database: str, token: str, speech: Speech, *, preview: bool) -> StudyApp:
    from fetch_pomdp.user_study.app import StudyApp
    from fetch_pomdp.user_study.config import load_user_study
    from fetch_pomdp.user_study.store.store import Store

    config = load_user_study(study)
    if preview:
        title = {language: f"{PREVIEW[language]}: {words}" for language, words in config.title.items()}
        config = dataclasses.replace(config, title=title)
    return StudyApp(config, Store.open(database), token, speech=speech)


def _check_token(token: str | None, field: str, host: str | None = None) -> None:
    """Raise InputError for a token that is easily guessed, that a request cannot carry, or that `host` lacks."""
    if token is None:
        if host is not None:
            raise InputError(f"{host} needs a token, such as --token {secrets.token_urlsafe(16)}", field=field)
        return
    if not all(" " <= letter <= "~" for letter in token) or token != token.strip():
        raise InputError("expected printable ASCII characters, without a space at either end", field=field)
    if len(token) < SHORTEST_TOKEN:
        raise InputError(f"found {len(token)} characters, expected {SHORTEST_TOKEN} or more", field=field)


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"

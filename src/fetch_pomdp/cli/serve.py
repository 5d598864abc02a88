"""The command serve: the robot in a browser."""

from __future__ import annotations

import ipaddress
import logging
import secrets
from pathlib import Path
from typing import Annotated
from urllib.parse import quote

import typer

from fetch_pomdp.adapters.store.store import Store
from fetch_pomdp.adapters.web.hall import Config
from fetch_pomdp.adapters.web.participation.registry import Venue
from fetch_pomdp.adapters.web.protocol import scene_asked_for
from fetch_pomdp.adapters.web.server import serve
from fetch_pomdp.cli.participants import DATABASE
from fetch_pomdp.errors import InputError
from fetch_pomdp.study.from_logs import trials_of
from fetch_pomdp.study.participation import load_participation

Table = Annotated[
    str,
    typer.Argument(
        metavar="[SCENE]", help="The table to begin with: ambiguous, unambiguous, or a TOML file (docs/scenes.md)."
    ),
]
Host = Annotated[str, typer.Option(help="Address to listen at; anything but loopback needs a token.")]
Port = Annotated[int, typer.Option(min=1, max=65535, help="Port to listen at.")]
Token = Annotated[str | None, typer.Option(help="What a page must know to come in.  [default: none on loopback]")]
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
    str | None, typer.Option(metavar="TOKEN", help="What the researcher's page must know.  [default: a new one]")
]

BEGINNING = "ambiguous"
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
    researcher_token: ResearcherToken = None,
) -> None:
    """Open a page on which people talk to the robot, type to it and point. Stop with Ctrl-C.

    With --study people take part in a study there, from consent to completion code.
    """
    if not _is_loopback(host) and token is None:
        suggestion = secrets.token_urlsafe(16)
        raise InputError(f"found none for {host}, expected one, such as --token {suggestion}", field="--token")
    _long_enough(token, "--token")
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    config = Config(scene=scene_asked_for(scene), token=token, data=data, insight=not no_insight)
    if study is not None and scene != BEGINNING:
        raise InputError(f"found {scene!r} beside --study, expected none: a study has tables of its own", field="SCENE")
    venue = None if study is None else _venue(study, data, database, researcher_token)

    def ready() -> None:
        print(f"The robot is at {address_of(host, port, '', token)}  (Ctrl-C ends it)", flush=True)
        if venue is not None:
            print(f"The researcher's page is {address_of(host, port, 'researcher.html', venue.token)}", flush=True)

    if venue is None and (database or researcher_token) is not None:
        found = "--database" if database is not None else "--researcher-token"
        raise InputError("found no study, expected one beside it", field=found)
    serve(config, host, port, ready, venue=venue)


def address_of(host: str, port: int, page: str, token: str | None) -> str:
    """Return a page's address, with the token in its fragment, which browsers do not send."""
    shown = f"[{host}]" if ":" in host else host
    return f"http://{shown}:{port}/{page}" + (f"#token={quote(token, safe='')}" if token else "")


def _venue(study: Path, data: Path | None, database: str | None, token: str | None) -> Venue:
    if data is not None:
        raise InputError(
            "found a folder beside --study, expected none: a study is kept in its database", field="--data"
        )
    _long_enough(token, "--researcher-token")
    programme = load_participation(study)
    return Venue(programme, Store.open(database or DATABASE), token or secrets.token_urlsafe(24), trials_of)


def _long_enough(token: str | None, field: str) -> None:
    if token is not None and len(token) < SHORTEST_TOKEN:
        raise InputError(f"found {len(token)} letters, expected {SHORTEST_TOKEN} or more", field=field)


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"

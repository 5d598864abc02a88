"""The command serve: the robot in a browser."""

from __future__ import annotations

import ipaddress
import logging
import secrets
from pathlib import Path
from typing import Annotated

import typer

from fetch_pomdp.adapters.web.hall import Config
from fetch_pomdp.adapters.web.protocol import scene_asked_for
from fetch_pomdp.adapters.web.server import serve
from fetch_pomdp.errors import InputError

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

SHORTEST_TOKEN = 16


def serve_page(
    scene: Table = "ambiguous",
    *,
    host: Host = "127.0.0.1",
    port: Port = 8000,
    token: Token = None,
    data: Data = None,
    no_insight: Insight = False,
) -> None:
    """Open a page on which people talk to the robot, type to it and point. Stop with Ctrl-C."""
    if not _is_loopback(host) and token is None:
        suggestion = secrets.token_urlsafe(16)
        raise InputError(f"found none for {host}, expected one, such as --token {suggestion}", field="--token")
    if token is not None and len(token) < SHORTEST_TOKEN:
        raise InputError(f"found {len(token)} letters, expected {SHORTEST_TOKEN} or more", field="--token")
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    shown = f"[{host}]" if ":" in host else host
    address = f"http://{shown}:{port}/{f'#token={token}' if token else ''}"
    config = Config(scene=scene_asked_for(scene), token=token, data=data, insight=not no_insight)
    serve(config, host, port, lambda: print(f"The robot is at {address}  (Ctrl-C ends it)", flush=True))


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"

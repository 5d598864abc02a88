"""The command fetch-pomdp."""

from __future__ import annotations

import os
import sys

import typer

from fetch_pomdp.cli.calibrate import calibrate
from fetch_pomdp.cli.doors import export_scene
from fetch_pomdp.cli.gap import gap
from fetch_pomdp.cli.interact import fetch
from fetch_pomdp.cli.logs import app as logs
from fetch_pomdp.cli.offline import decide, filter_events, simulate
from fetch_pomdp.cli.participants import app as participants
from fetch_pomdp.cli.robocup import robocup
from fetch_pomdp.cli.serve import serve_page
from fetch_pomdp.cli.study import app as study
from fetch_pomdp.errors import FetchPomdpError

app = typer.Typer(
    help="A robot that fetches: it waits, asks or picks, by what it hears and sees (the FETCH-POMDP).\n\n"
    "Start with: fetch-pomdp fetch ambiguous",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command()(fetch)
app.command("filter")(filter_events)
app.command()(decide)
app.command()(simulate)
app.command("export")(export_scene)
app.command()(gap)
app.command()(robocup)
app.add_typer(study, name="study")
app.add_typer(logs, name="log")
app.add_typer(participants, name="participants")
app.command()(calibrate)
app.command("serve")(serve_page)


def main() -> None:
    """Run the command; bad input is one line on standard error and exit code 2."""
    try:
        app()
    except FetchPomdpError as error:
        print(f"fetch-pomdp: {error}", file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:  # whoever read the output has left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)

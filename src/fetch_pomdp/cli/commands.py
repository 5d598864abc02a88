"""All commands of fetch-pomdp, under one name."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from fetch_pomdp.cli.calibrate import calibrate
from fetch_pomdp.cli.export import export_scene
from fetch_pomdp.cli.gap import gap
from fetch_pomdp.cli.interact import fetch
from fetch_pomdp.cli.logs import app as logs
from fetch_pomdp.cli.offline import decide, filter_events, simulate
from fetch_pomdp.cli.participants import app as participants
from fetch_pomdp.cli.robocup import robocup
from fetch_pomdp.cli.says import explain, fit_reader
from fetch_pomdp.cli.serve import serve_page
from fetch_pomdp.cli.study import app as study

app = typer.Typer(
    context_settings={"help_option_names": ["-h", "--help"]},
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command()(fetch)
app.command("filter")(filter_events)
app.command()(decide)
app.command()(simulate)
app.command()(explain)
app.command("fit-reader")(fit_reader)
app.command("export")(export_scene)
app.command()(gap)
app.command()(robocup)
app.add_typer(study, name="study")
app.add_typer(logs, name="log")
app.add_typer(participants, name="participants")
app.command()(calibrate)
app.command("serve")(serve_page)


def _version(asked: bool) -> None:
    if asked:
        from fetch_pomdp import __version__

        print(f"fetch-pomdp {__version__}")
        raise typer.Exit


@app.callback()
def fetch_pomdp_command(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """A robot that fetches: it waits, asks or picks, by what it hears and sees (the FETCH-POMDP).

    Start with: fetch-pomdp fetch ambiguous
    """  # noqa: D401


def command() -> Any:
    """Return the command with all below it; a list of commands shows the whole first paragraph of each."""
    whole: Any = typer.main.get_command(app)
    _unshortened(whole)
    return whole


def _unshortened(group: Any) -> None:
    for one in group.commands.values():
        one.short_help = " ".join((one.help or "").split("\n\n")[0].split())
        if hasattr(one, "commands"):
            _unshortened(one)

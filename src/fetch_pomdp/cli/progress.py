"""The progress bar of commands that play trials."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from fetch_pomdp.cli.terminal import Terminal


@contextmanager
def trials_bar(total: int) -> Iterator[Callable[[int], None]]:
    """Show how many of `total` trials are on disk, as the function told says; stopped by hand, exit with code 130."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Terminal(stderr=True)) as bar:
        task = bar.add_task("trials", total=total)
        try:
            yield lambda count: bar.update(task, completed=count)
        except KeyboardInterrupt:
            bar.console.print("stopped; run the same command again to go on")
            raise typer.Exit(130) from None

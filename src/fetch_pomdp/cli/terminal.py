"""What the commands print on, and the progress bar of those that play trials."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


class Terminal(Console):
    """A rich console that prints things as they are, and leaves a reader who has left to `cli.main`."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, **options)

    def on_broken_pipe(self) -> None:
        """Raise the BrokenPipeError that is being handled; rich would exit instead."""
        raise  # noqa: PLE0704


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

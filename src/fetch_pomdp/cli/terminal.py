"""What the commands print on."""

from __future__ import annotations

from typing import Any

from rich.console import Console


class Terminal(Console):
    """A rich console that prints things as they are, and leaves a reader who has left to `cli.main`."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, **options)

    def on_broken_pipe(self) -> None:
        """Raise the BrokenPipeError that is being handled; rich would exit instead."""
        raise  # noqa: PLE0704

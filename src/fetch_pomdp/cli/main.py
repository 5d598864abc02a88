"""The program fetch-pomdp, and every way in which it can end.

Nothing that takes long is imported before somebody listens for Ctrl-C.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable
from typing import Any

from fetch_pomdp.cli.interrupts import INTERRUPTED, ending_at_once
from fetch_pomdp.errors import FetchPomdpError, InputError

WRONG = 2  # what was given, or a file that cannot be read or written
NOBODY_READS = 128 + 13  # as a shell counts who is ended by SIGPIPE, which Windows has not
OUTPUT = "standard output"


def main() -> None:
    """Run the command of the command line, and exit: with 0, or with one line on standard error and 2.

    Ctrl-C ends it silently with 130, and a reader of its output who has left (`| head -1`) with 141.
    """
    _open_streams()
    with contextlib.redirect_stdout(_Output(sys.stdout)):
        code = _ended(_run)
        code = _ended(_flush) or code  # a full disk is noticed here at the latest
    sys.exit(code)


def _run() -> int:
    with ending_at_once():
        import typer

        from fetch_pomdp.cli.commands import command
        from fetch_pomdp.cli.compiling import watched

        whole = command()
    usage_error: Any = typer.BadParameter.__base__  # Typer has no name of its own for it
    try:
        with watched(), whole.make_context("fetch-pomdp", sys.argv[1:]) as context:
            whole.invoke(context)
    except typer.Exit as ended:
        return ended.exit_code
    except typer.Abort:
        return INTERRUPTED
    except usage_error as error:
        return _misused(error)
    return 0


def _misused(error: Any) -> int:
    """Tell what is wrong with a command line and where its help is; of one without a command tell the help itself."""
    message = error.format_message()
    if "\n" in message.strip():
        print(message, file=sys.stderr)
        return WRONG
    path = "fetch-pomdp" if error.ctx is None else error.ctx.command_path
    _tell(message.rstrip("."))
    _tell(f"try {path} --help")
    return WRONG


def _ended(act: Callable[[], int]) -> int:
    """Return the exit code of an act, or of what ended it; the user is told of what they can mend."""
    try:
        return act()
    except FetchPomdpError as error:
        _tell(str(error))
        return WRONG
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _let_go_of_output()
        return NOBODY_READS
    except OSError as error:
        place = "" if error.filename is None else os.fsdecode(error.filename)
        expected = "a place for what is printed" if place == OUTPUT else "a file or folder that can be used"
        _tell(f"{error.strerror or error}, expected {expected}", place)
        _let_go_of_output()
        return WRONG


def _tell(message: str, place: str = "") -> None:
    line = InputError(message, source=place)  # which makes one line of it
    with contextlib.suppress(OSError):
        print(f"fetch-pomdp: {line}", file=sys.stderr, flush=True)


def _flush() -> int:
    sys.stdout.flush()
    return 0


def _let_go_of_output() -> None:
    """Send what is still to be printed nowhere: the interpreter would complain of it once more when it ends."""
    with contextlib.suppress(OSError, ValueError):  # a stream without a file: a test's
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class _Output:
    """A stream whose errors say that it is the output: those of a file's `write` name nothing."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        return int(self._named(lambda: self._stream.write(text)))

    def flush(self) -> None:
        self._named(self._stream.flush)

    def _named(self, act: Callable[[], Any]) -> Any:
        try:
            return act()
        except OSError as error:
            error.filename = OUTPUT
            raise


def _open_streams() -> None:
    """See to it that there are three streams, and that there is no letter that they cannot hold."""
    sys.stdin = sys.stdin or open(os.devnull, encoding="utf-8")  # noqa: SIM115, PTH123 (open to the end)
    sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
    for stream, errors in ((sys.stdin, "replace"), (sys.stdout, "backslashreplace")):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors=errors)

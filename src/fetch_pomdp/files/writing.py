"""Files written whole or not at all, and logs that grow by whole lines, also where the disk is full."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, Literal

from fetch_pomdp.errors import InputError

FULL = {errno.ENOSPC, errno.EFBIG, errno.EDQUOT}


def unwritable(cause: Exception, path: str | Path, error: type[InputError]) -> InputError:
    """Return the complaint about a file that cannot be written."""
    if isinstance(cause, FileExistsError):
        return error("found an existing file, expected a new one", source=str(path))
    reason = getattr(cause, "strerror", None) or cause
    expected = "room for it" if getattr(cause, "errno", None) in FULL else "a folder for it"
    return error(f"cannot be written: {reason}, expected {expected}", source=str(path))


def write_new(path: str | Path, lines: Iterable[str], error: type[InputError]) -> None:
    """Write lines to a new UTF-8 file, whole or not at all. Raises `error` if it exists or cannot be written."""
    target = Path(path)
    try:
        if os.path.lexists(target):
            raise FileExistsError
        with _gone_afterwards(target.with_name(f".{target.name}.{os.getpid()}.part")) as part:
            with part.open("x", encoding="utf-8", newline="\n") as stream:
                stream.writelines(f"{line}\n" for line in lines)
            _name_new(part, target)
    except InputError:
        raise
    except (OSError, ValueError) as cause:  # ValueError: a NUL in the path
        raise unwritable(cause, path, error) from None


@contextlib.contextmanager
def replaced(path: str | Path, error: type[InputError]) -> Iterator[BinaryIO]:
    """Write a file whole or not at all, over whatever was there. Raises `error` if it cannot be written."""
    target = Path(path)
    try:
        with _gone_afterwards(target.with_name(f"{target.name}.part")) as part:  # what a kill left is written over
            with part.open("wb") as stream:
                yield stream
            part.replace(target)
    except InputError:
        raise
    except (OSError, ValueError) as cause:
        raise unwritable(cause, path, error) from None


@contextlib.contextmanager
def _gone_afterwards(part: Path) -> Iterator[Path]:
    try:
        yield part
    finally:
        with contextlib.suppress(FileNotFoundError):
            part.unlink()


def _name_new(part: Path, target: Path) -> None:
    try:
        target.hardlink_to(part)  # unlike a renaming it never replaces a file that came in the meantime
    except FileExistsError:
        raise
    except OSError:  # a file system without links
        part.rename(target)


def append(stream: BinaryIO, data: bytes) -> None:
    """Add bytes to an unbuffered file, all of them or none. Raises OSError."""
    begin, written = stream.seek(0, os.SEEK_END), 0
    try:
        while written < len(data):
            written += stream.write(data[written:])
    except OSError:
        with contextlib.suppress(OSError):
            stream.truncate(begin)
        raise


class LineFile:
    """A UTF-8 file that whole lines are added to: each is in it when `write` returns, or not at all.

    Raises the `error` it is given, with the path, if it cannot be opened or written; a new file ("x") must be new.
    """

    def __init__(self, path: str | Path, mode: Literal["x", "a"], error: type[InputError]) -> None:
        self.path, self._error = Path(path), error
        try:
            self._stream: BinaryIO = self.path.open(f"{mode}b", buffering=0)  # type: ignore[assignment]
        except (OSError, ValueError) as cause:
            raise unwritable(cause, path, error) from None

    def write(self, text: str) -> int:
        """Add a line, with its end."""
        try:
            append(self._stream, text.encode())
        except OSError as cause:
            raise unwritable(cause, self.path, self._error) from None
        return len(text)

    def flush(self) -> None:
        """Do nothing: what was written is in the file."""

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

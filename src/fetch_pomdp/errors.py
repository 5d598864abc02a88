"""What can go wrong, one type for each source of bad input."""

from __future__ import annotations

from typing import Self


class FetchPomdpError(Exception):
    """Base of every error this package raises on purpose."""


class InputError(FetchPomdpError, ValueError):
    """Something handed in is not as it must be.

    The message is one line: where (source and line, when it came from a file), which field, what was found and what was
    expected. `field` is the path of the field, such as ``items[1].position``, or "" when the whole is meant.
    """

    def __init__(self, problem: str, *, field: str = "", source: str = "", line: int | None = None) -> None:
        self.problem, self.field, self.source, self.line = problem, field, source, line
        place = f"{source}:{line}" if source and line is not None else source
        message = ": ".join(part for part in (place, field, problem) if part)
        super().__init__("".join(letter if letter.isprintable() else " " for letter in message))

    def located(self, source: str, line: int | None) -> Self:
        """Return the same complaint, with the file and line it came from."""
        return type(self)(self.problem, field=self.field, source=source, line=line)

    def within(self, parent: str) -> Self:
        """Return the same complaint about a field of `parent`."""
        inner = self.field if not self.field or self.field.startswith("[") else f".{self.field}"
        return type(self)(self.problem, field=parent + inner, source=self.source, line=self.line)


class SceneError(InputError):
    """A scene, its items or their words."""


class ModelError(InputError):
    """A parameter of the model or a reward."""


class ObservationError(InputError):
    """An utterance or a pointing ray."""


class BeliefError(InputError):
    """A prior that is not a distribution, or evidence that leaves no item possible."""


class ActionError(InputError):
    """An action that does not exist, or an item it cannot be about."""


class PlannerError(InputError):
    """A planner's name or parameter."""


class EventError(InputError):
    """A recorded interaction that cannot have happened, or cannot be read."""


class SkeletonError(InputError):
    """A recorded or streamed skeleton."""


class AudioError(InputError):
    """A recording or stream of sound."""


class ExportError(InputError):
    """A file for other planners that cannot be written: too large, there already, or of no known format."""


class StudyError(InputError):
    """A study's configuration, table or log cannot be used."""


class StoreError(InputError):
    """A database of participants that cannot be used, or does not allow what was asked of it."""


class MessageError(InputError):
    """A message from a page that the server does not know or allow."""


class RobotDescriptionError(InputError):
    """A file that describes a robot."""


class EndpointError(FetchPomdpError):
    """A model that others serve did not answer, or not as its interface has it; the message goes on after its name."""


class MissingExtraError(FetchPomdpError, ImportError):
    """An optional library is not installed; the message is the line that installs it."""

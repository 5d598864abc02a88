"""Trials from recorded interactions, so that logs of real people go through the analysis of simulated ones."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from fetch_pomdp.errors import EventError
from fetch_pomdp.files.recordings import Recording
from fetch_pomdp.study.trial import Assignment, Trial, scored


def trials_of(recordings: Iterable[tuple[str, Recording]]) -> Iterator[Trial]:
    """Yield how each recorded trial went, in the order given; each recording comes with the name of its file.

    Raises EventError, with the file, where the header does not say who wanted what: `person` and `target`, and `layout`
    of a scene that is not built in.

    Choice: a trial without `order` is the next of its person, one without `begun` began at 0, and one without
    `paradigm` has its planner's name.
    """
    known: Counter[int] = Counter()
    for source, recording in recordings:
        assignment = assignment_of(recording, source, known)
        yield scored(assignment, recording.events, recording.header.scene, recording.header.begun or 0.0)


def assignment_of(recording: Recording, source: str, known: Counter[int]) -> Assignment:
    """Return the trial that a recording is of, counting the person's trials in `known`. Raises as `trials_of`."""
    header = recording.header
    layout = header.layout or header.scene_name
    for name, value in (("person", header.person), ("target", header.target), ("layout", layout)):
        if value is None:
            found = "found none, expected it in the header of a trial of a study"
            raise EventError(found, field=name, source=source, line=1)
    person, target = header.person or 0, header.target or ""
    order = known[person] if header.order is None else header.order
    known[person] += 1
    return Assignment(person, layout or "", header.paradigm or header.planner, target, order)

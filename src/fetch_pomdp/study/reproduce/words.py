"""A comparison as text: tables in Markdown, and what does not fit in a sentence a cell."""

from __future__ import annotations

from collections.abc import Iterator

from fetch_pomdp.study.reproduce.compare import FAR, Comparison, Held, Row
from fetch_pomdp.study.reproduce.stories import StoryResult
from fetch_pomdp.study.reproduce.targets import Targets

HEAD = (
    "| layout | robot | time, paper (s) | ours | off | accuracy, paper (%) | ours | off | questions | |\n"
    "|---|---|---|---|---|---|---|---|---|---|"
)
CLAUSES = "| | claim | over persons | as the paper reads its tests |\n|---|---|---|---|"


def markdown(found: Comparison) -> str:
    """Return the cells, the clauses and what does not fit; "off": standard errors of a study of the paper's size."""
    parts = [HEAD, *map(_row, found.rows), "", CLAUSES, *map(_clause, found.clauses), "", *_misfits(found)]
    return "\n".join(parts)


def _row(row: Row) -> str:
    target, ours = row.target, row.ours
    low, high = target.accuracy
    cells = (
        target.layout, target.paradigm,
        f"{target.time:.2f}", f"{ours.time:.2f}", f"{row.time_off:+.1f}",
        f"{low:.1f} to {high:.1f}", f"{ours.accuracy:.1f}", f"{row.accuracy_off:+.1f}",
        f"{ours.questions:.2f}", "fitted" if target.fitted else "predicted",
    )  # fmt: skip
    return f"| {' | '.join(cells)} |"


def _clause(held: Held) -> str:
    return f"| {held.hypothesis} | {held.claim} | {held.people} of {held.studies} | {held.pairs} of {held.studies} |"


def _misfits(found: Comparison) -> Iterator[str]:
    far = [row for row in found.rows if not row.fits]
    if not far:
        yield f"Every cell is within {FAR:g} standard errors."
    for row in far:
        where = f"{row.target.paradigm}, {row.target.layout} ({'fitted' if row.target.fitted else 'predicted'})"
        yield f"- Does not fit: {where}: {'; '.join(_reasons(row))}."


def _reasons(row: Row) -> Iterator[str]:
    target, ours = row.target, row.ours
    if abs(row.time_off) > FAR:
        yield f"{abs(ours.time - target.time):.2f} s too {'slow' if row.time_off > 0 else 'fast'}"
    if abs(row.accuracy_off) > FAR:
        points = abs(target.accuracy_off(ours.accuracy))
        yield f"{points:.1f} points too {'accurate' if row.accuracy_off > 0 else 'inaccurate'}"


def stories_head(targets: Targets) -> str:
    """Return the head of the table of outcomes."""
    names = [f"{target.paradigm}, {target.layout}" for target in targets.cells]
    columns = ["story", "strength", *(f"{name} (s, %)" for name in names), "loss"]
    return f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}"


def outcome(told: StoryResult) -> str:
    """Return an outcome as a row of it; loss is that of the fitted cells."""
    cells = [f"{ours.time:.2f}, {ours.accuracy:.1f}" for ours in told.cells]
    story = told.story
    return f"| {' | '.join([story.name, f'{story.strength} {told.strength:g}', *cells, f'{told.loss:.0f}'])} |"

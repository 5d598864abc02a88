"""The results of many scenes as Markdown."""

from __future__ import annotations

import numpy as np

from planning import Record
from planning.report import short, table
from planning.scene_contest import AT_ONCE, DEFAULT, LONG, PAPER, TUNED

PLANNERS = (DEFAULT, PAPER, TUNED, AT_ONCE, LONG)


def by_loss(results: Record) -> list[Record]:
    """Return the scenes, worst first: by what is lost to the best known."""
    return sorted(results["scenes"], key=lambda found: -float(found["loss"]))


def counts(results: Record) -> str:
    """Return both criteria, counted."""
    scenes = results["scenes"]
    losses = np.array([found["loss"] for found in scenes])
    below = [found["scene"] for found in scenes if found["below_rival"]]
    rows = (
        ("below the best of paper, thresholds and pick at once by over 3 standard errors", below),
        (
            "within max(a tenth of the paper planner's loss, 0.1) of the best known",
            [found["scene"] for found in scenes if found["within"]],
        ),
        (
            "the same, or over it by less than 2 standard errors of the difference",
            [found["scene"] for found in scenes if found["within_2_errors"]],
        ),
    )
    lines = [(name, f"{len(found)} of {len(scenes)}") for name, found in rows]
    lines.append(("loss to the best known: mean", f"{losses.mean():.3f}"))
    lines.append(("loss to the best known: worst", f"{losses.max():.3f}"))
    return table(("the default planner", "scenes"), lines)


def returns(results: Record, most: int | None = None) -> str:
    """Return what every planner earns, worst first; `most` scenes."""
    lines = []
    for found in by_loss(results)[:most]:
        rows = {row["planner"]: row for row in found["planners"]}
        marks = ("" if found["within"] else " *") + (" below" if found["below_rival"] else "")
        lines.append((
            found["scene"],
            str(found["items"]),
            *(cell(rows[name]) for name in PLANNERS),
            f"{found['loss']:.3f} ± {found['loss_error']:.3f}{marks}",
            f"{found['allowed']:.2f}",
            f"{rows[DEFAULT]['mean_steps']:.1f}",
            short(rows[DEFAULT]["solve_s"]),
            short(rows[DEFAULT]["decide_median_s"]),
        ))  # fmt: skip
    return table(
        ("scene", "items", *PLANNERS, "loss", "allowed", "steps", "solving", "a decision"),
        lines,
    )


def cell(row: Record) -> str:
    """Return a return and its standard error."""
    return f"{row['mean_return']:.2f}" + (f" ± {row['standard_error']:.2f}" if row["standard_error"] else "")


def times(results: Record) -> str:
    """Return what planners cost: the median scene and the worst."""
    lines = []
    for name in (DEFAULT, LONG, TUNED, PAPER):
        rows = [row for found in results["scenes"] for row in found["planners"] if row["planner"] == name]
        cells = []
        for column in ("solve_s", "decide_median_s"):
            found = [row[column] for row in rows]
            cells += [short(float(np.median(found))), short(max(found))]
        lines.append((name, *cells, f"{np.median([row['mean_steps'] for row in rows]):.1f}"))
    head = ("median and worst scene", "solving", "worst", "a decision", "worst", "steps")
    return table(head, lines)


def tables(results: Record, most: int | None = None) -> str:
    """Return the whole report; `most` scenes, worst first."""
    about = results["about"]
    meaning = (
        f"`python benchmarks/scenes.py --{about['set']}`: {about['episodes']:,} people a scene for the default and the "
        f"thresholds, {about['fewer']:,} of them for the other two; {about['minutes']:.1f} minutes of processor time; "
        "fetch-pomdp " + about["fetch-pomdp"] + ", Python " + about["Python"] + "."
    )
    return "\n\n".join((meaning, counts(results), returns(results, most), times(results)))

"""The results of many scenes as Markdown."""

from __future__ import annotations

import numpy as np

from planning import Record
from planning.report import short, table
from planning.scene_contest import AT_ONCE, DEFAULT, LONG, PAPER, TUNED, scene_named

PLANNERS = (DEFAULT, PAPER, TUNED, AT_ONCE, LONG)


def by_loss(results: Record) -> list[Record]:
    """Return the scenes, worst first: by what is lost to the best known."""
    return sorted(results["scenes"], key=lambda found: -float(found["loss"]))


CRITERIA = {
    "below the best of paper, thresholds and pick at once by over 3 standard errors": "below_rival",
    "within max(a tenth of the paper planner's loss, 0.1) of the best known": "within",
    "the same, or over it by less than 2 standard errors of the difference": "within_2_errors",
}
LIKELIHOODS = {"exact": "exact gesture likelihood", "eq7": "that of Eq. 7"}


def counts(results: Record) -> str:
    """Return both criteria, counted, by gesture likelihood too."""
    scenes = results["scenes"]
    by_likelihood: dict[str, list[Record]] = {name: [] for name in LIKELIHOODS}
    for found in scenes:
        by_likelihood[scene_named(found["scene"]).model.gesture_likelihood].append(found)
    groups = [scenes, *by_likelihood.values()]
    lines = [
        (name, *(f"{sum(found[key] for found in group)} of {len(group)}" for group in groups))
        for name, key in CRITERIA.items()
    ]
    for name, of in (("mean", np.mean), ("worst", np.max)):
        cells = [f"{of([found['loss'] for found in group]):.3f}" if group else "-" for group in groups]
        lines.append((f"loss to the best known: {name}", *cells))
    return table(("the default planner", "all scenes", *LIKELIHOODS.values()), lines)


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

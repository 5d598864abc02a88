"""Pictures of robustness curves, and of price lists on the plane of time and accuracy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.trials import Table
from fetch_pomdp.study.curves import Curve
from fetch_pomdp.study.plots import COLOURS, MARKS, Figure, legend, styled

MEASURES = (("accuracy", "right item (%)", 100.0), ("time", "time (s)", 1.0))
MANY = 20  # a curve that reaches so many times its first value is drawn over a logarithmic axis


@styled
def curve(table: Table, of: Curve) -> Figure:
    """Return a curve: accuracy (%) and time (s) of each paradigm, a column a condition, with 95 % intervals.

    table: of `curves.trace`.
    """
    own = table[table["curve"] == of.name]
    layouts, conditions = list(own["layout"].unique()), list(own["condition"].unique())
    rows = [(layout, *measure) for layout in layouts for measure in MEASURES]
    size = (2.4 * len(conditions) + 0.8, 1.9 * len(rows) + 0.7)
    figure = load("matplotlib.figure", "study").Figure(figsize=size, layout="constrained")
    axes = figure.subplots(len(rows), len(conditions), squeeze=False, sharex=True, sharey="row")
    for row, (layout, measure, unit, scale) in enumerate(rows):
        for column, condition in enumerate(conditions):
            axis = axes[row][column]
            _lines(axis, own[(own["layout"] == layout) & (own["condition"] == condition)], measure, scale)
            if row == 0:
                axis.set_title(condition)
            if of.values[0] > 0 and of.values[-1] > MANY * of.values[0]:
                axis.set_xscale("log")
                axis.set_xticks(of.values, [f"{value:g}" for value in of.values])
                axis.minorticks_off()
        axes[row][0].set_ylabel(f"{layout}\n{unit}" if len(layouts) > 1 else unit)
    axes[-1][len(conditions) // 2].set_xlabel(of.label)
    legend(figure, [axis for line in axes for axis in line])
    return figure


def _lines(axis: Any, cells: Table, measure: str, scale: float) -> None:
    for place, (paradigm, line) in enumerate(cells.groupby("paradigm", sort=False)):
        colour, value = COLOURS[place % len(COLOURS)], line["value"].to_numpy(float)
        axis.plot(value, scale * line[measure], MARKS[place % len(MARKS)] + "-", color=colour, ms=3.5, lw=1.2,
                  label=paradigm)  # fmt: skip
        axis.fill_between(value, scale * line[f"{measure}_low"].astype(float),
                          scale * line[f"{measure}_high"].astype(float), color=colour, alpha=0.18, lw=0)  # fmt: skip


@styled
def plane(table: Table, chosen: str | None, names: Sequence[str]) -> Figure:
    """Return settings on the plane of time (s) and accuracy (%), a panel a layout.

    table: of `prices.search`; chosen: the setting that stands out, if there is one; names: the paper's paradigms,
    drawn with 95 % intervals. The line joins the settings that no other beats in both.
    """
    layouts = list(table["layout"].unique())
    figure = load("matplotlib.figure", "study").Figure(figsize=(4.6 * len(layouts), 3.8), layout="constrained")
    axes = figure.subplots(1, len(layouts), squeeze=False)[0]
    for axis, layout in zip(axes, layouts, strict=True):
        here = table[table["layout"] == layout]
        ours = here[~here["paradigm"].isin(names)]
        axis.plot(ours["time"], 100 * ours["accuracy"], ".", color=COLOURS[0], ms=5, alpha=0.6, label="fitted")
        best = frontier(ours)
        axis.plot(best["time"], 100 * best["accuracy"], "-", color=COLOURS[0], lw=1.2, label="fitted, unbeaten")
        for place, name in enumerate(names, start=1):
            _cross(axis, here[here["paradigm"] == name], place, f"{name} (paper)")
        if chosen is not None:
            _cross(axis, here[here["paradigm"] == chosen], len(names) + 1, f"fitted: {chosen}")
        axis.set(title=layout, xlabel="time (s)", ylabel="right item (%)")
    legend(figure, axes)
    return figure


def _cross(axis: Any, cell: Table, place: int, label: str) -> None:
    if cell.empty:
        return
    one, colour = cell.iloc[0], COLOURS[place % len(COLOURS)]
    axis.errorbar(
        [one["time"]], [100 * one["accuracy"]],
        xerr=[[max(0.0, one["time"] - one["time_low"])], [max(0.0, one["time_high"] - one["time"])]],
        yerr=[[max(0.0, 100 * (one["accuracy"] - one["accuracy_low"]))],
              [max(0.0, 100 * (one["accuracy_high"] - one["accuracy"]))]],
        fmt=MARKS[place % len(MARKS)], color=colour, ms=7, lw=1, label=label,
    )  # fmt: skip


def frontier(cells: Table) -> Table:
    """Return the cells that no other beats in time and accuracy, by time."""
    ordered = cells.sort_values(["time", "accuracy"], ascending=[True, False])
    before = ordered["accuracy"].cummax().shift(fill_value=-1.0)
    return ordered[ordered["accuracy"] > before]

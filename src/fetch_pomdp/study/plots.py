"""Pictures of a study: the paper's Figures 5 and 6, interaction times, and questions.

Each function returns a matplotlib figure without a window. Colours are those of Okabe and Ito, told apart by people who
see few; ink is a grey that can be read on white and on black, and the ground is transparent.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeAlias

import numpy as np

from fetch_pomdp.extras import load
from fetch_pomdp.study.analysis.cells import Cell
from fetch_pomdp.study.analysis.trials import Table, Values, means

P = ParamSpec("P")
Figure: TypeAlias = Any  # a matplotlib Figure; a third-party type cannot be named without importing it

INK = "#767676"  # contrast 4.5 to white and 4.6 to black
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933", "#882255", "#404040", "#AA4499",
           "#44AA99", "#DDCC77")  # fmt: skip
MARKS = ("s", "^", "o", "D", "v", "P", "X", "*")
STYLE = {
    "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.spines.right": False, "axes.spines.top": False,
    "figure.facecolor": "none", "axes.facecolor": "none", "savefig.facecolor": "none", "legend.frameon": False,
    "legend.labelcolor": INK, "text.color": INK, "xtick.color": INK, "ytick.color": INK, "font.size": 9,
    "axes.titlesize": 9, "figure.titlesize": 10, "svg.hashsalt": "fetch-pomdp",
}  # fmt: skip


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw with the style above, whatever the user's own is."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        matplotlib = load("matplotlib", "study")
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(STYLE)
            return draw(*args, **kwargs)

    return drawn


@styled
def bars(cells: Sequence[Cell]) -> Figure:
    """Return Fig. 5: mean time (s) and accuracy (%) of each cell with its interval."""
    layouts, paradigms = _names(cells)
    figure, axes = _axes(2, "Mean time and accuracy")
    width = 0.8 / len(paradigms)
    for place, paradigm in enumerate(paradigms):
        mine = [cell for cell in cells if cell.paradigm == paradigm]
        x = [layouts.index(cell.layout) + (place - (len(paradigms) - 1) / 2) * width for cell in mine]
        for axis, name, unit in ((axes[0], "time", 1.0), (axes[1], "accuracy", 100.0)):
            height = [unit * getattr(cell, name) for cell in mine]
            reach = [[unit * part for part in _reach(cell, name)] for cell in mine]
            axis.bar(x, height, 0.92 * width, color=COLOURS[place % len(COLOURS)], label=paradigm)
            axis.errorbar(x, height, np.transpose(reach), fmt="none", ecolor=INK, capsize=3)
    axes[0].set_ylabel("interaction time (s)")
    floor = _floor(cells)
    axes[1].set_ylabel(f"right item (%), from {floor:.0f}" if floor else "right item (%)")
    axes[1].set_ylim(floor, 101)
    for axis in axes:
        axis.set_xticks(range(len(layouts)), layouts)
    legend(figure, axes)
    return figure


def _reach(cell: Cell, name: str) -> tuple[float, float]:
    """Return how far the interval reaches below and above the mean; nowhere if there is none."""
    mean = getattr(cell, name)
    low, high = getattr(cell, f"{name}_low"), getattr(cell, f"{name}_high")
    return (0.0, 0.0) if low is None or high is None else (max(0.0, mean - low), max(0.0, high - mean))


def _floor(cells: Sequence[Cell]) -> float:
    """Return where the axis of accuracy (%) begins: bars near 100 differ by little, so it need not be 0."""
    lowest = min(cell.accuracy if cell.accuracy_low is None else cell.accuracy_low for cell in cells)
    return max(0.0, float(10 * np.floor(10 * lowest - 0.5)))


@styled
def persons(table: Table, cells: Sequence[Cell]) -> Figure:
    """Return Fig. 6: each person's mean time (s) and accuracy (%) with each paradigm, and one-sigma ellipses."""
    layouts, paradigms = _names(cells)
    figure, axes = _axes(len(layouts), "A point a person and paradigm; ellipses: one standard deviation")
    for axis, layout in zip(axes, layouts, strict=True):
        trials = table[table["layout"] == layout]
        times, shares = means(trials, "time"), 100 * means(trials, "accuracy")
        for place, paradigm in enumerate(paradigms):
            if paradigm in times:
                points = np.column_stack([times[paradigm], shares[paradigm]])
                _cloud(axis, points[np.isfinite(points).all(axis=1)], place, paradigm)
        axis.set(title=layout, xlabel="mean time of a person (s)", ylabel="right item (%)")
    legend(figure, axes)
    return figure


def _cloud(axis: Any, points: Values, place: int, label: str) -> None:
    colour = COLOURS[place % len(COLOURS)]
    axis.plot(
        *points.T,
        MARKS[place % len(MARKS)],
        color=colour,
        ms=5,
        alpha=0.75,
        label=label,
        mec="none",
        rasterized=len(points) > 1000,
    )
    if len(points) > 2:
        outline = ellipse(points)
        axis.plot(*outline.T, color=colour, lw=1.5)


def ellipse(points: Values) -> Values:
    """Return the outline (101, 2) of the Gaussian fitted to points (n, 2), at one standard deviation, n > 2."""
    values, vectors = np.linalg.eigh(np.cov(points.T))
    turn = np.linspace(0, 2 * np.pi, 101)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    outline = points.mean(axis=0) + circle * np.sqrt(np.maximum(values, 0)) @ vectors.T
    return np.asarray(outline, float)


@styled
def survival(table: Table, cells: Sequence[Cell]) -> Figure:
    """Return the share of trials (%) that still went on after so many seconds (Kaplan and Meier 1958).

    A trial that ended without a pick is censored: the robot had not picked until then.
    """
    layouts, paradigms = _names(cells)
    figure, axes = _axes(len(layouts), "Interactions that still went on")
    curve_of = load("statsmodels.duration.survfunc", "study").SurvfuncRight
    for axis, layout in zip(axes, layouts, strict=True):
        for place, paradigm in enumerate(paradigms):
            trials = table[(table["layout"] == layout) & (table["paradigm"] == paradigm)]
            picked = trials["picked"].notna().to_numpy(int)
            if picked.any():
                curve = curve_of(trials["time"].to_numpy(float), picked)
                time, share = thinned(np.r_[0.0, curve.surv_times], 100 * np.r_[1.0, curve.surv_prob])
                style = {"color": COLOURS[place % len(COLOURS)], "ls": ("-", "--", "-.", ":")[place % 4]}
                axis.step(time, share, where="post", label=paradigm, **style)
        axis.set(title=layout, xlabel="time since the request began (s)", ylabel="without a pick (%)", ylim=(0, 101))
        axis.set_xlim(left=0)
    legend(figure, axes)
    return figure


def thinned(time: Values, share: Values, most: int = 500) -> tuple[Values, Values]:
    """Return at most so many corners of a curve, the first and the last among them."""
    kept = np.unique(np.linspace(0, len(time) - 1, min(most, len(time))).round().astype(int))
    return time[kept], share[kept]


@styled
def questions(table: Table, cells: Sequence[Cell], most: int = 4) -> Figure:
    """Return the share of trials (%) with 0, 1, ... questions; those with `most` or more are together."""
    layouts, paradigms = _names(cells)
    figure, axes = _axes(len(layouts), "Questions asked in a trial")
    width = 0.8 / len(paradigms)
    for axis, layout in zip(axes, layouts, strict=True):
        for place, paradigm in enumerate(paradigms):
            trials = table[(table["layout"] == layout) & (table["paradigm"] == paradigm)]
            counts = np.bincount(np.minimum(trials["questions"].to_numpy(int), most), minlength=most + 1)
            x = np.arange(most + 1) + (place - (len(paradigms) - 1) / 2) * width
            share = 100 * counts / max(len(trials), 1)
            axis.bar(x, share, 0.92 * width, color=COLOURS[place % len(COLOURS)], label=paradigm)
        axis.set_xticks(range(most + 1), [*map(str, range(most)), f"{most}+"])
        axis.set(title=layout, xlabel="questions", ylabel="trials (%)")
    legend(figure, axes)
    return figure


@styled
def svg(figure: Figure) -> str:
    """Return a figure as SVG, the same text for the same figure."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return buffer.getvalue()


def _axes(count: int, title: str) -> tuple[Figure, Sequence[Any]]:
    figure = load("matplotlib.figure", "study").Figure(figsize=(max(4.8, 4.2 * count), 3.4), layout="constrained")
    figure.suptitle(title)
    return figure, list(figure.subplots(1, count, squeeze=False)[0])


def legend(figure: Figure, axes: Sequence[Any]) -> None:
    """Put one legend under all axes, with what any of them shows."""
    entries = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(entries.values(), entries, loc="outside lower center", ncols=min(4, max(1, len(entries))))


def _names(cells: Sequence[Cell]) -> tuple[list[str], list[str]]:
    """Return the layouts and the paradigms of cells, each in the cells' order."""
    return list(dict.fromkeys(cell.layout for cell in cells)), list(dict.fromkeys(cell.paradigm for cell in cells))

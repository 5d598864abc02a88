"""Return lost against time a decision, and time against the number of items."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from planning import DEFAULT, Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# No policy earns more, whatever its filter (upper bounds by information relaxation); and the best policy that we know
# with the paper's belief filter, the default planner, earned this from 50,000 people (docs/make_numbers.py).
BOUND = {"ambiguous": -0.04, "unambiguous": 1.93}
BEST_KNOWN = {"ambiguous": -0.18, "unambiguous": 1.82}
BEST_KNOWN_ERROR = 0.02

# Marker, fill, line: told apart without colour.
STYLES = {
    "FittedValue": ("*", "black", "-"),
    "Threshold": ("h", "white", ""),
    "ExactAnswers": ("o", "black", "-"),
    "ExactAnswers, depth 3": ("p", "black", ""),
    "ExactAnswers, leaf pick": ("o", "white", "-"),
    "SparseSampling": ("s", "0.55", "--"),
    "SparseSampling, deeper": ("p", "0.55", ""),
    "PaperNeverAsk": ("v", "white", ":"),
    "PaperAlwaysAsk": ("^", "white", ":"),
    "plain NumPy": ("s", "white", "--"),
    "POUCT, aided": ("D", "0.55", "-."),
    "POMCP, aided": ("D", "black", "-."),
    "POUCT, greedy": ("D", "white", "-."),
    "POUCT, random": ("x", "black", "-."),
}
SCALING = (
    (DEFAULT, None, "FittedValue", DEFAULT),
    ("ExactAnswers, default", None, "ExactAnswers", "ExactAnswers, default"),
    ("ExactAnswers, leaf pick", 10, "ExactAnswers, leaf pick", "ExactAnswers(2, 10), leaf pick"),
    ("SparseSampling", 10, "SparseSampling", "SparseSampling(2, 10)"),
    ("PaperNeverAsk", 10, "PaperNeverAsk", "PaperNeverAsk(2, 10)"),
)


def draw(results: Record, path: Path) -> None:
    """Draw the three panels into a PNG file."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, (ambiguous, unambiguous, scaling) = plt.subplots(1, 3, figsize=(13, 4.8), layout="constrained")
    for axes, scene in ((ambiguous, "ambiguous"), (unambiguous, "unambiguous")):
        _lost(axes, [found for found in results["returns"] if found["scene"] == scene], scene)
    unambiguous.sharey(ambiguous)
    _scaling(scaling, results["decision_times"])
    handles, labels = ambiguous.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False, fontsize=8)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def _lost(axes: Axes, records: list[Record], scene: str) -> None:
    for family, (marker, fill, line) in STYLES.items():
        points = sorted((f for f in records if f["family"] == family), key=lambda f: float(f["decide_median_s"]))
        # Through the default planner on the same people: those who met a few people alone may have met easy ones.
        lost = [BOUND[scene] - BEST_KNOWN[scene] - found["behind"] for found in points]
        errors = [math.hypot(BEST_KNOWN_ERROR, found["behind_error"]) for found in points]
        axes.errorbar(
            [found["decide_median_s"] for found in points],
            lost,
            # a bar that reaches below 0 has no end on a logarithmic axis
            yerr=[
                [min(error, 0.9 * abs(y)) for error, y in zip(errors, lost, strict=True)],
                errors,
            ],
            fmt=marker, linestyle=line, color="0.35", mfc=fill, mec="black", ms=7, lw=0.9, label=family,
        )  # fmt: skip
    known = BOUND[scene] - BEST_KNOWN[scene]
    axes.axhline(known, color="0.6", lw=0.8, ls=(0, (1, 3)), label="best policy known, same filter")
    axes.set(xscale="log", yscale="log", xlabel="time a decision (s)", ylabel=f"return lost, {scene} scene")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_ylim(0.05, 12)


def _scaling(axes: Axes, times: list[Record]) -> None:
    for name, width, style, label in SCALING:
        marker, fill, line = STYLES[style]
        cases = [c for c in times if c["planner"] == name and c["depth"] == 2 and width in (None, c["width"])]
        cases.sort(key=lambda case: int(case["items"]))
        items, seconds = [case["items"] for case in cases], [case["decide_s"] for case in cases]
        axes.plot(
            items, seconds, marker=marker, ls=line, color="0.35", mfc=fill, mec="black", ms=7, lw=0.9, label=label
        )
    axes.set(xscale="log", yscale="log", xlabel="items", ylabel="time a decision (s)")
    axes.legend(frameon=False, fontsize=8, loc="upper left")

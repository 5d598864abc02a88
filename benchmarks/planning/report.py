"""The results as Markdown tables, for the terminal and for `docs/benchmark-tables.md` alike."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from planning import DEFAULT, Record

# Times (s) to be met on the machine where a prototype of the search had them, kernels within a factor of 1.5.
TARGETS = (
    ("kernel", "ExactAnswers, leaf pick", 6, 2, 10, 2.1e-6),
    ("kernel", "ExactAnswers, leaf pick", 6, 3, 10, 330e-6),
    ("kernel", "ExactAnswers, leaf pick", 1_000, 2, 10, 46e-6),
    ("kernel", "ExactAnswers, leaf pick", 100_000, 2, 10, 5.3e-3),
    ("decide", "ExactAnswers, default", 6, 2, 80, 30e-6),
    ("decide", "ExactAnswers, default", 100_000, 2, 5, 5e-3),
)


def tables(results: Record) -> dict[str, str]:
    """Return every table by the name of its place in the docs."""
    times = results["decision_times"]
    return {
        "versions": versions(results["about"]),
        "startup": startup(results["startup"]),
        "kernel": by_items(times, "kernel_s"),
        "decide": by_items(times, "decide_s"),
        "targets": targets(times),
        "observe": table(("observe", "time"), [(name, short(time)) for name, time in results["observe"].items()]),
        **{f"returns-{scene}": returns(results["returns"], scene) for scene in ("ambiguous", "unambiguous")},
        "exploration": exploration(results["all_returns"]),
    }


def refresh(document: Path, results: Record) -> None:
    """Write the tables between their markers in a Markdown document."""
    text = document.read_text(encoding="utf-8")
    for name, content in tables(results).items():
        place = re.compile(rf"(<!-- planners: {name} -->\n).*?(<!-- end -->)", re.DOTALL)
        text = place.sub(rf"\1\n{content}\n\n\2", text)
    document.write_text(text, encoding="utf-8")


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a Markdown table, aligned for reading as text too; all columns but the first to the right."""
    lines = [list(head), *(list(row) for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    first, *rest = (
        "| "
        + " | ".join([line[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(line[1:], widths[1:], strict=True))])
        + " |"
        for line in lines
    )
    rule = "|" + "|".join(["-" * (widths[0] + 2), *("-" * (width + 1) + ":" for width in widths[1:])]) + "|"
    return "\n".join([first, rule, *rest])


def short(seconds: float) -> str:
    """Return a time with two or three digits and a unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{_digits(seconds / size)} {unit}"
    return f"{_digits(seconds / 1e-9)} ns"


def _digits(value: float) -> str:
    return f"{value:.1f}" if value < 100 else f"{value:.0f}"


def versions(about: Record) -> str:
    """Return what the run was made with."""
    return table(("with", "version"), [(str(name), str(version)) for name, version in about.items()])


def startup(times: dict[str, dict[str, float]]) -> str:
    """Return compile and import times."""
    columns = list(times)
    names = times[columns[0]]
    rows = [(name.removesuffix("_s").replace("_", " "), *(short(times[c][name]) for c in columns)) for name in names]
    return table(("a new process", *columns), rows)


def by_items(times: list[Record], column: str) -> str:
    """Return times against the number of items; a dash is too long to measure."""
    sizes = sorted({case["items"] for case in times})
    own = ("ExactAnswers, default", DEFAULT)  # without a depth and a width
    found = {(c["planner"], c["depth"], c["width"], c["items"]): c[column] for c in times if c["planner"] not in own}
    settings = dict.fromkeys((planner, depth, width) for planner, depth, width, _ in found)
    rows = []
    for planner, depth, width in sorted(settings, key=lambda s: (list(settings).index((s[0], 2, 10)), *s[1:])):
        cells = [found.get((planner, depth, width, size)) for size in sizes]
        rows.append((f"{planner} ({depth}, {width})", *("-" if cell is None else short(cell) for cell in cells)))
    for name in own:
        measured = {case["items"]: case[column] for case in times if case["planner"] == name}
        rows.append((name, *(short(measured[size]) if size in measured else "-" for size in sizes)))
    return table(("planner (depth, width)", *(f"{size:,} items" for size in sizes)), rows)


def targets(times: list[Record]) -> str:
    """Return the measured times beside what was asked for."""
    rows = []
    for what, planner, items, depth, width, goal in TARGETS:
        for case in times:
            if (case["planner"], case["items"], case["depth"], case["width"]) == (planner, items, depth, width):
                name = f"{what}: {planner} ({depth}, {width}), {items:,} items"
                time = case[f"{what}_s"]
                rows.append((name, short(time), short(goal), f"{time / goal:.2f}"))
    return table(("what", "time", "target", "ratio"), rows)


def returns(records: list[Record], scene: str) -> str:
    """Return what every planner earns on a scene, and its time."""
    rows = []
    field = [found for found in records if found["scene"] == scene]
    base = next(found["decide_median_s"] for found in field if found["planner"] == DEFAULT)
    for found in sorted(field, key=lambda f: -float(f["behind"])):
        behind = "" if found["planner"] == DEFAULT else f"{found['behind']:+.2f} +- {found['behind_error']:.2f}"
        rows.append((
            found["planner"],
            f"{found['mean_return']:+.3f} +- {found['standard_error']:.3f}",
            behind,
            f"{found['accuracy']:.3f}",
            f"{found['mean_steps']:.2f}",
            f"{found['mean_questions']:.2f}",
            f"{found['episodes']:,}",
            short(found["decide_median_s"]),
_digits(found["decide_median_s"] / base),
        ))  # fmt: skip
    head = (
        "planner",
        "return",
        "to the default, paired",
        "accuracy",
        "steps",
        "questions",
        "episodes",
        "a decision",
        "ratio",
    )
    return table(head, rows)


def exploration(records: list[Record]) -> str:
    """Return POUCT's results at every exploration constant."""
    rows = []
    for found in records:
        if found["milliseconds"]:
            rows.append((
                f"{found['planner'].removeprefix('pomdp_py ')}, {found['scene']}",
                f"{found['exploration']:g}",
                f"{found['mean_return']:+.2f} +- {found['standard_error']:.2f}",
                str(found["episodes"]),
                f"{found['simulations_per_s']:,.0f}",
            ))  # fmt: skip
    return table(
        ("solver, style, time a decision, scene", "constant", "return", "episodes", "simulations a second"), rows
    )

"""The report of a study: one HTML file, and its tables beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.writing import replaced
from fetch_pomdp.study import page, plots
from fetch_pomdp.study.analysis import words
from fetch_pomdp.study.analysis.cells import Cell
from fetch_pomdp.study.analysis.findings import EFFECTS, Findings, analyse, tables
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import Table

THIRDS = ("first", "second", "last")
READING = (
    "A person is one number, the mean of their trials; intervals and the tests of persons show what varies between "
    "persons. They say what another such person would do.",
    "The signed ranks of paired trials are the paper's test. They take the trials of a person for independent, so "
    "their p is too small if persons differ; they say little about other persons.",
    "“At least as” is tested by a margin. A difference that is not significant is no evidence that there is none.",
    "Holm's correction keeps the chance of any false finding in a family below the level. A hypothesis that claims "
    "all its clauses needs no correction; picking out one of them does.",
)


def write_report(table: Table, out: str | Path, plan: Plan | None = None) -> Path:
    """Write `report.html`, and its tables as CSV and Parquet, into the directory `out`; return the page's path.

    table: a DataFrame whose columns are the fields of Trial. The same table gives the same files, each whole or not at
    all. Raises StudyError for a table that cannot be used or a directory that cannot be written to.
    """
    found = analyse(table, plan)
    folder = Path(out)
    path = folder / "report.html"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as cause:  # ValueError: a NUL in the path
        reason = getattr(cause, "strerror", None) or cause
        raise StudyError(f"cannot be written: {reason}, expected a directory", source=str(out)) from None
    for name, frame in tables(found).items():
        with replaced(folder / f"{name}.csv", StudyError) as file:
            file.write(frame.to_csv(index=False, lineterminator="\n").encode())
        with replaced(folder / f"{name}.parquet", StudyError) as file:
            frame.to_parquet(file, index=False)
    with replaced(path, StudyError) as file:
        file.write(html(found).encode())
    return path


def html(found: Findings) -> str:
    """Return the report as one page that needs nothing beside itself."""
    body = [*_study(found), *_answers(found), *_cells(found), *_comparisons(found), *_course(found), *_order(found)]
    body += _power(found)
    body += [page.heading("How to read this"), page.points(READING)]
    return page.page("A study of fetching robots", body)


def _study(found: Findings) -> list[str]:
    trials = found.trials
    layouts = trials.groupby("layout")["person"].nunique()
    who = ", ".join(f"{count} in {layout}" for layout, count in layouts.items())
    lost = sum(cell.without_pick for cell in found.cells)
    text = f"{len(trials)} trials of {trials['person'].nunique()} persons ({who}); {lost} ended without a pick."
    unpaired = max((row.unpaired for row in found.comparisons), default=0)
    return [page.paragraph(text + (f" Up to {unpaired} trials of a comparison have no partner." if unpaired else ""))]


def _answers(found: Findings) -> list[str]:
    parts = [page.heading("The hypotheses of Section IV")]
    for hypothesis in found.hypotheses:
        sentences = [words.verdict(clause, found.plan) for clause in hypothesis.clauses]
        parts += [page.paragraph(words.answer(hypothesis)), page.points(sentences)]
    return parts


def _cells(found: Findings) -> list[str]:
    percent = f"{100 * (1 - found.plan.level):g}%"
    headers = ("layout", "paradigm", "persons", "trials", "time (s)", f"{percent} interval", "right (%)",
               f"{percent} interval", "questions", "waits", "no pick")  # fmt: skip
    alt = "Bars of the numbers in the table below. " + " ".join(_spoken(cell) for cell in found.cells)
    return [
        page.heading("Time and accuracy"),
        page.picture(plots.svg(plots.bars(found.cells)), alt, f"As the paper's Fig. 5; whiskers: {percent} intervals."),
        page.grid("Means over persons, for each paradigm in each layout", headers, [_row(c) for c in found.cells], 2),
        page.picture(
            plots.svg(plots.persons(found.trials, found.cells)),
            "Points of each person's mean time and accuracy with each paradigm; the numbers are in people.csv.",
            "As the paper's Fig. 6. An ellipse holds about 39% of persons if they are normally distributed.",
        ),
    ]


def _spoken(cell: Cell) -> str:
    return f"{cell.layout}, {cell.paradigm}: {cell.time:.2f} s, {100 * cell.accuracy:.1f}% right."


def _row(cell: Cell) -> Sequence[str]:
    return (
        str(cell.layout), str(cell.paradigm), str(cell.people), str(cell.trials),
        f"{cell.time:.2f}", _ends(cell.time_low, cell.time_high, 1.0, 2),
        f"{100 * cell.accuracy:.1f}", _ends(cell.accuracy_low, cell.accuracy_high, 100.0, 1),
        f"{cell.questions:.2f}", f"{cell.waits:.2f}", str(cell.without_pick),
    )  # fmt: skip


def _ends(low: float | None, high: float | None, unit: float, digits: int) -> str:
    return words.NONE if low is None or high is None else f"{unit * low:.{digits}f} to {unit * high:.{digits}f}"


def _comparisons(found: Findings) -> list[str]:
    percent = f"{100 * (1 - found.plan.level):g}%"
    headers = ("layout", "difference", "of", "mean", f"{percent} interval", "pairs", "p of pairs", "Holm", "effect",
               "persons", "p of persons", "Holm", "effect", "p no worse", "by ranks")  # fmt: skip
    rows = [
        (str(row.layout), f"{row.system} − {row.other}", f"{row.measure} ({words.UNITS[row.measure]})",
         words.difference(row.difference, row.measure), words.span(row.low, row.high, row.measure),
         str(row.pairs), words.chance(row.p_pairs), words.chance(row.p_pairs_holm), _effect(row.effect_pairs),
         str(row.people), words.chance(row.p_people), words.chance(row.p_people_holm), _effect(row.effect_people),
         words.chance(row.p_no_worse), words.chance(row.p_no_worse_ranks))
        for row in found.comparisons
    ]  # fmt: skip
    notes = [
        f"{row.layout}, {row.system} − {row.other}, {row.measure}: {row.note}" for row in found.comparisons if row.note
    ]
    plan = found.plan
    margins = f"{plan.margin_time:g} s and {100 * plan.margin_accuracy:g} points"
    text = (
        "Two-sided signed ranks of paired trials (the k-th trials of a person with the same item) and of persons, with "
        f"Holm's correction over this table; effect: rank-biserial correlation. “No worse”: one-sided, margins of "
        f"{margins}, Student's test of persons and signed ranks of persons."
    )
    caption = f"{plan.system} against the others"
    below = [page.points(notes)] if notes else []
    return [page.heading("Comparisons"), page.paragraph(text), page.grid(caption, headers, rows, 3), *below]


def _effect(value: float | None) -> str:
    return words.NONE if value is None else f"{value:+.2f}".replace("-", "−")


def _course(found: Findings) -> list[str]:
    asked = " ".join(f"{cell.layout}, {cell.paradigm}: {cell.questions:.2f} questions a trial." for cell in found.cells)
    return [
        page.heading("Course of the interactions"),
        page.picture(
            plots.svg(plots.survival(found.trials, found.cells)),
            "Falling curves: the share of trials without a pick after so many seconds, for each paradigm and layout.",
            "Kaplan–Meier curves; trials that ended without a pick are censored.",
        ),
        page.picture(plots.svg(plots.questions(found.trials, found.cells)), f"Bars. {asked}", "Questions of a trial."),
    ]


def _order(found: Findings) -> list[str]:
    """Return how a person's trials change from the first to the last, whatever the robot."""
    trials = found.trials
    place = trials.groupby("person")["order"].rank(method="first") - 1.0
    part = (place * len(THIRDS) // trials.groupby("person")["order"].transform("size")).astype(int)
    each = trials.groupby(["layout", part.rename("part"), "person"])[["time", "correct", "questions"]].mean()
    means = each.groupby(["layout", "part"]).mean()
    rows = [
        (str(layout), THIRDS[part], f"{row.time:.2f}", f"{100 * row.correct:.1f}", f"{row.questions:.2f}")
        for (layout, part), row in zip(means.index, means.itertuples(), strict=True)
    ]
    text = (
        "Means over persons of the thirds of their trials, in the order in which they had them, over all paradigms: "
        "what practice or fatigue does. Paradigms are mixed within each person, so that it falls on all of them."
    )
    headers = ("layout", "third", "time (s)", "right (%)", "questions")
    return [page.heading("Order of the trials"), page.paragraph(text), page.grid("By order", headers, rows, 2)]


def _power(found: Findings) -> list[str]:
    plan = found.plan
    by: dict[str, list[str]] = {}
    for one in found.sizings:
        by.setdefault(f"{one.clause.hypothesis}: {one.clause.claim}", []).append(words.people(one.needed, plan))
    text = (
        f"People in the layout, each with as many trials as here, who show a clause with a chance of {plan.power:.0%}. "
        f"{plan.draws} studies of a size were drawn from the persons of this table; in brackets, what that number of "
        "draws leaves open. The first column takes the advantage observed here for the true one, which overrates it if "
        "only studies that went well are looked at; the second assumes half of it."
    )
    headers = ("clause", *(f"{effect:.0%} of the advantage" for effect in EFFECTS))
    rows = [(claim, *counts) for claim, counts in by.items()]
    return [page.heading("People that a study needs"), page.paragraph(text), page.grid("People needed", headers, rows)]

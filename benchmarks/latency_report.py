"""What latency.py measured, in Markdown."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

MARKERS = re.compile(r"(<!-- latency -->\n).*?(<!-- end -->)", re.DOTALL)


def report(found: dict[str, Any]) -> str:
    """Return tables and lines about what was measured."""
    crowd = found.get("crowd")
    delays = [
        (name, row)
        for name, row in (
            ("one person speaks: to the message", found.get("alone", {}).get("word_to_bar_s")),
            ("one person speaks: to the bar in Chromium", found.get("page_word_to_bar_s")),
            ("ten of fifty speak: to the message", crowd and crowd["speakers"]["word_to_bar_s"]),
        )
        if row
    ]
    parts = [_table("end of a word to its bar", "words", delays, missed=True)] if delays else []
    if crowd:
        told = crowd["all"]["decision_told_late_s"]
        rows = [("step's end to decision", crowd["all"]["decision_s"]), ("told later than the promptest", told)]
        parts += [_table("fifty people", "decisions", rows, missed=False), _crowd(crowd)]
    where = f"{found['cores']} cores, {found['snr']} dB, load average before the run {found['load_before']:.1f}"
    return "\n\n".join([*parts, f"{where}."])


def _table(title: str, of: str, rows: list[tuple[str, dict[str, float]]], *, missed: bool) -> str:
    last = " not heard |" if missed else ""
    lines = [f"| {title} | {of} | median | 90% | 99% | longest |{last}", "|---|" + "---:|" * (5 + missed)]
    for name, row in rows:
        times = " | ".join(_time(row[each]) for each in ("median", "p90", "p99", "longest"))
        lines.append(f"| {name} | {row['count']:,} | {times} |" + (f" {row['missed']} |" if missed else ""))
    return "\n".join(lines)


def _time(seconds: float) -> str:
    return f"{1000 * seconds:.1f} ms" if abs(seconds) < 0.0995 else f"{seconds:.2f} s"


def _crowd(crowd: dict[str, Any]) -> str:
    memory, cores = crowd["memory_mb"], crowd["cores"]
    none, some, all_ = memory.items()
    each = (all_[1] - none[1]) / int(all_[0])
    who = [f"{crowd[who]['right']} of {crowd[who]['handed_over']} {who}'" for who in ("speakers", "typists")]
    came = sum(crowd[who]["interactions"] for who in ("speakers", "typists"))
    over = sum(crowd[who]["handed_over"] for who in ("speakers", "typists"))
    return (
        f"{over} of {came} interactions ended in a hand-over; of what was wanted in {who[0]} and {who[1]}.\n"
        f"The server took {cores['server']:.2f} of a core, the people {cores['people']:.2f}. Its memory (Pss, the"
        f" recogniser's process included) was\n{none[1]:.0f} MB with nobody there, {some[1]:.0f} MB with {some[0]}"
        f" people and {all_[1]:.0f} MB with {all_[0]}: {each:.1f} MB each."
    )


def write(path: Path, text: str) -> None:
    """Put a report between its markers in a document."""
    page = path.read_text(encoding="utf-8")
    path.write_text(MARKERS.sub(lambda found: f"{found[1]}\n{text}\n\n{found[2]}", page), encoding="utf-8")

"""The figure of docs/robustness.md: 2 to 50 alike items, kinds of question on and off.

python benchmarks/asking/figure.py benchmarks/results/questions-alike.json docs/robustness/questions.png
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt

KINDS = ("point", "attribute", "attributes", "region", "pair", "open", "repeat")


def main() -> None:
    """Draw accuracy, time and the questions by kind of the widest set."""
    rows = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    figure, (right, seconds, kinds) = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    for name in dict.fromkeys(row["questions"] for row in rows):
        own = [row for row in rows if row["questions"] == name]
        items = [row["items"] for row in own]
        right.plot(items, [100 * row["right"] for row in own], marker="o", label=name)
        seconds.plot(items, [row["seconds"] for row in own], marker="o", label=name)
    widest = [row for row in rows if row["questions"] == rows[-1]["questions"]]
    shares = [[row[kind] for row in widest] for kind in KINDS]
    kinds.stackplot([row["items"] for row in widest], shares, labels=KINDS)
    for axes, title in ((right, "right, %"), (seconds, "waits and questions, s"), (kinds, "questions, all kinds on")):
        axes.set(xlabel="alike items", title=title, ylim=(0, None), xscale="log")
        axes.set_xticks([2, 4, 8, 12, 24, 50], labels=["2", "4", "8", "12", "24", "50"])
        axes.minorticks_off()
        axes.legend(fontsize=8)
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()

"""What a recogniser hears for what is said, from logs in which somebody wrote down what was said."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from fetch_pomdp.core.events import Event, Observed

NOTHING = ""  # said but not heard, or heard but not said

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Confusion:
    """How often each word was heard for each word said; `NOTHING` stands for what was not said or not heard."""

    counts: Mapping[Pair, int]  # (said, heard)

    @property
    def said(self) -> int:
        """How many words were said."""
        return sum(count for (said, _), count in self.counts.items() if said)

    @property
    def word_error(self) -> float:
        """Words put in, left out or changed, over words said."""
        wrong = sum(count for (said, heard), count in self.counts.items() if said != heard)
        return wrong / max(self.said, 1)

    def rows(self) -> dict[str, dict[str, float]]:
        """Return the share of each word heard for each word said, the usual ones first."""
        totals: Counter[str] = Counter()
        for (said, _), count in self.counts.items():
            totals[said] += count
        ordered = sorted(self.counts.items(), key=lambda entry: (-totals[entry[0][0]], entry[0][0], -entry[1]))
        table: dict[str, dict[str, float]] = {}
        for (said, heard), count in ordered:
            table.setdefault(said, {})[heard] = count / totals[said]
        return table


def confusion_of(logs: Iterable[Sequence[Event]]) -> Confusion:
    """Return the confusions of the observations that say what was spoken."""
    counts: Counter[Pair] = Counter()
    for events in logs:
        for event in events:
            if isinstance(event, Observed) and event.spoken is not None:
                counts.update(aligned(event.spoken, event.observation.words))
    return Confusion(dict(counts))


def aligned(said: Sequence[str], heard: Sequence[str]) -> list[Pair]:
    """Return the words said and heard in pairs, with the fewest of them unlike (Levenshtein's alignment).

    Of alignments with equally few, one that pairs words at the end where it can.
    """
    rows, columns = len(said) + 1, len(heard) + 1
    cost = [[max(row, column) if not (row and column) else 0 for column in range(columns)] for row in range(rows)]
    for row in range(1, rows):
        for column in range(1, columns):
            changed = cost[row - 1][column - 1] + (said[row - 1] != heard[column - 1])
            cost[row][column] = min(changed, cost[row - 1][column] + 1, cost[row][column - 1] + 1)
    pairs: list[Pair] = []
    row, column = rows - 1, columns - 1
    while row or column:
        here = cost[row][column]
        if row and column and here == cost[row - 1][column - 1] + (said[row - 1] != heard[column - 1]):
            row, column = row - 1, column - 1
            pairs.append((said[row], heard[column]))
        elif row and here == cost[row - 1][column] + 1:
            row -= 1
            pairs.append((said[row], NOTHING))
        else:
            column -= 1
            pairs.append((NOTHING, heard[column]))
    return pairs[::-1]

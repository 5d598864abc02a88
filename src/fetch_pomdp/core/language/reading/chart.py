"""A weighted chart parser: every constituent of a clause with its best derivations, and the best ways to cover it.

Choice: lark's Earley takes some 30 ms a sentence and its LALR knows one parse; a chart of pairs of neighbours (CKY),
which keeps few derivations of a constituent, takes about a millisecond and ranks them. What no constituent covers is
skipped at a cost, so that every string has a reading.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.core.language.reading.grammar import Grammar, Rule

KEPT = 4  # derivations of a constituent
COVERS = 6  # ways to cover a clause
LEAF = 0.15  # cost of a word or phrase: long phrases are what they are
FRAGMENT = 1.0  # cost of a constituent that stands alone

Derivation = tuple[float, Any]  # cost and meaning


@dataclass(frozen=True, slots=True)
class Token:
    """A word or phrase from `start` to before `end`, and what it may be."""

    start: int
    end: int
    category: str
    value: str


@dataclass(frozen=True, slots=True)
class Cover:
    """Constituents side by side that cover a clause. cost: of their rules, of being many and of what was skipped."""

    cost: float
    meanings: tuple[Any, ...]
    skipped: float


Cell = dict[str, list[Derivation]]


def covers(tokens: Sequence[Token], skips: Sequence[float], grammar: Grammar) -> list[Cover]:
    """Return the best covers of a clause, best first. skips: the cost of leaving out each word."""
    size = len(skips)
    cells = _filled(tokens, size, grammar)
    best: list[list[Cover]] = [[Cover(0.0, (), 0.0)]]
    for end in range(1, size + 1):
        skip = skips[end - 1]
        found = [Cover(each.cost + skip, each.meanings, each.skipped + skip) for each in best[end - 1]]
        for start in range(end):
            cell = cells.get((start, end))
            if not cell:
                continue
            for category in ("NP", "M"):
                for cost, meaning in cell.get(category, ()):
                    found += [
                        Cover(before.cost + cost + FRAGMENT, (*before.meanings, meaning), before.skipped)
                        for before in best[start][:3]
                    ]
        best.append(_best_covers(found))
    return best[size]


def _best_covers(found: list[Cover]) -> list[Cover]:
    found.sort(key=lambda cover: cover.cost)
    kept: dict[tuple[Any, ...], Cover] = {}
    for each in found:
        if each.meanings not in kept:
            kept[each.meanings] = each
            if len(kept) == COVERS:
                break
    return list(kept.values())


def _filled(tokens: Sequence[Token], size: int, grammar: Grammar) -> Mapping[tuple[int, int], Cell]:
    cells: dict[tuple[int, int], Cell] = {}
    for token in tokens:
        cell = cells.setdefault((token.start, token.end), {})
        cell.setdefault(token.category, []).append((LEAF, token.value))
    ends: dict[int, list[int]] = {}  # of the constituents that begin at a place, shortest first
    for start in range(size - 1, -1, -1):
        for end in range(start + 1, size + 1):
            cell = cells.get((start, end), {})
            for middle in ends.get(start, ()):
                if middle < end and (middle, end) in cells:
                    _join(cells[start, middle], cells[middle, end], cell, grammar)
            if cell:
                _close(cell, grammar)
                cells[start, end] = cell
                ends.setdefault(start, []).append(end)
    return cells


def _join(left: Cell, right: Cell, cell: Cell, grammar: Grammar) -> None:
    for category, firsts in left.items():
        rules = grammar.binary.get(category)
        if rules is None:
            continue
        for other, found in rules.items():
            if other not in right:
                continue
            for rule in found:
                _add(cell, rule.parent, _pairs(rule, firsts, right[other]))


def _pairs(rule: Rule, firsts: Sequence[Derivation], seconds: Sequence[Derivation]) -> Iterator[Derivation]:
    for cost, first in firsts:
        for more, second in seconds:
            parts = (*first, second) if isinstance(first, _Begun) else (first, second)
            meaning = _Begun(parts) if rule.action is None else rule.action(*parts)
            if meaning is not None:
                yield cost + more + rule.cost, meaning


class _Begun(tuple[Any, ...]):
    """The meanings of the first parts of a rule that goes on."""

    __slots__ = ()


def _close(cell: Cell, grammar: Grammar) -> None:
    """Add what single constituents become."""
    agenda = list(cell)
    while agenda:
        category = agenda.pop()
        for rule in grammar.unary.get(category, ()):
            action = rule.action
            if action is None:
                continue
            made = [
                (cost + rule.cost, meaning) for cost, part in cell[category] if (meaning := action(part)) is not None
            ]
            if _add(cell, rule.parent, iter(made)):
                agenda.append(rule.parent)


def _add(cell: Cell, category: str, made: Iterator[Derivation]) -> bool:
    """Add derivations of a category; return whether any was kept."""
    kept = cell.get(category, [])
    meanings = {meaning: cost for cost, meaning in kept}
    changed = False
    for cost, meaning in made:
        if cost < meanings.get(meaning, float("inf")) - 1e-12:
            meanings[meaning] = cost
            changed = True
    if changed:
        ranked = sorted(((cost, meaning) for meaning, cost in meanings.items()), key=lambda each: each[0])[:KEPT]
        changed = ranked != kept
        cell[category] = ranked
    return changed

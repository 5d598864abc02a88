"""A weighted chart parser: every constituent of a clause with its best derivations, and the best ways to cover it.

Choice: lark's Earley takes some 30 ms a sentence and its LALR knows one parse; a chart of pairs of neighbours (CKY),
which keeps few derivations of a constituent, takes about a millisecond and ranks them. What no constituent covers is
skipped at a cost, so that every string has a reading.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

from fetch_pomdp.core.language.reading.grammar import Grammar, Rule

KEPT = 4  # derivations of a constituent
COVERS = 6  # ways to cover a clause
LEAF = 0.15  # cost of a word or phrase: long phrases are what they are
FRAGMENT = 1.0  # cost of a constituent that stands alone
_cost = itemgetter(0)

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
Openings = list[tuple[Mapping[str, tuple[Rule, ...]], list[Derivation]]]  # what may begin a rule, and its derivations


def covers(tokens: Sequence[Token], skips: Sequence[float], grammar: Grammar) -> list[Cover]:
    """Return the best covers of a clause, best first. skips: the cost of leaving out each word."""
    size = len(skips)
    cells = _filled(tokens, size, grammar)
    best: list[list[Cover]] = [[Cover(0.0, (), 0.0)]]
    for end in range(1, size + 1):
        skip = skips[end - 1]
        found: list[tuple[float, Cover, Any]] = [(each.cost + skip, each, None) for each in best[end - 1]]
        for start in range(end):
            cell = cells[start][end]
            for category in ("NP", "M"):
                for cost, meaning in cell.get(category, ()):
                    found += [(before.cost + cost + FRAGMENT, before, meaning) for before in best[start][:3]]
        best.append(_best_covers(found, skip))
    return best[size]


def _best_covers(found: list[tuple[float, Cover, Any]], skip: float) -> list[Cover]:
    """Return the best of covers that go on from others: with one more meaning, or None for one more word left out."""
    found.sort(key=_cost)
    kept: list[Cover] = []
    seen: list[tuple[Any, ...]] = []
    for cost, before, meaning in found:
        meanings = before.meanings if meaning is None else (*before.meanings, meaning)
        if meanings not in seen:
            seen.append(meanings)
            kept.append(Cover(cost, meanings, before.skipped + skip if meaning is None else before.skipped))
            if len(kept) == COVERS:
                break
    return kept


def _filled(tokens: Sequence[Token], size: int, grammar: Grammar) -> list[list[Cell]]:
    """Return the constituents from each word (the first index) to before another."""
    cells: list[list[Cell]] = [[{} for _ in range(size + 1)] for _ in range(size)]
    for token in tokens:
        cells[token.start][token.end].setdefault(token.category, []).append((LEAF, token.value))
    openings: list[list[tuple[int, Openings]]] = [[] for _ in range(size)]  # at each word, by where they end
    for start in range(size - 1, -1, -1):
        for end in range(start + 1, size + 1):
            cell = cells[start][end]
            for middle, begun in openings[start]:
                right = cells[middle][end]
                if right:
                    _join(begun, right, cell)
            if cell:
                _close(cell, grammar)
                begun = [(rules, cell[name]) for name in cell if (rules := grammar.binary.get(name)) is not None]
                if begun and end < size:
                    openings[start].append((end, begun))
    return cells


def _join(begun: Openings, right: Cell, cell: Cell) -> None:
    """Add to a cell what two neighbours make together."""
    for rules, firsts in begun:
        for other, found in rules.items():
            seconds = right.get(other)
            if seconds is not None:
                for rule in found:
                    _pair(rule, firsts, seconds, cell)


def _pair(rule: Rule, firsts: list[Derivation], seconds: list[Derivation], cell: Cell) -> None:
    action, made = rule.action, list[Derivation]()
    most = _dearest(cell.get(rule.parent, ()))
    for cost, first in firsts:
        for more, second in seconds:
            total = cost + more + rule.cost
            if total >= most:
                break  # and so are all that follow, which cost more
            parts = (*first, second) if isinstance(first, _Begun) else (first, second)
            meaning = _Begun(parts) if action is None else action(*parts)
            if meaning is not None:
                made.append((total, meaning))
    if made:
        _add(cell, rule.parent, made)


def _dearest(kept: Sequence[Derivation]) -> float:
    """Return the cost from which on a derivation is none of the best."""
    return kept[-1][0] if len(kept) >= KEPT else math.inf


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
            most = _dearest(cell.get(rule.parent, ()))
            made = [
                (cost + rule.cost, meaning)
                for cost, part in cell[category]
                if cost + rule.cost < most and (meaning := action(part)) is not None
            ]
            if made and _add(cell, rule.parent, made):
                agenda.append(rule.parent)


def _add(cell: Cell, category: str, made: list[Derivation]) -> bool:
    """Add derivations of a category, of which the cheapest are kept; return whether any was."""
    kept = cell.get(category, [])
    ranked = list(kept)
    for cost, meaning in made:
        for index, (known, other) in enumerate(ranked):
            if other == meaning:  # a hash of all that is in a meaning would take longer
                if cost < known - 1e-12:
                    ranked[index] = (cost, meaning)
                break
        else:
            ranked.append((cost, meaning))
    ranked.sort(key=_cost)
    del ranked[KEPT:]
    if ranked == kept:
        return False
    cell[category] = ranked
    return True

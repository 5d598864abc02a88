"""Readers of .pomdp and .pomdpx for tests, written from the formats alone: whole arrays, whatever wildcards say."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass
class Pomdp:
    """transition: (actions, states, states); observation: (actions, states, observations); reward: (actions, states)"""

    discount: float
    states: list[str]
    actions: list[str]
    observations: list[str]
    start: Array
    transition: Array
    observation: Array
    reward: Array


def indices(name: str, names: list[str]) -> list[int]:
    return list(range(len(names))) if name == "*" else [names.index(name)]


def read_pomdp(path: Path) -> Pomdp:
    lines = [line.split("#")[0].strip() for line in path.read_text().splitlines()]
    stream = iter([line for line in lines if line])
    head = dict(next(stream).split(": ") for _ in range(6))
    states, actions, seen = (head[key].split() for key in ("states", "actions", "observations"))
    count = len(states)
    result = Pomdp(
        float(head["discount"]),
        states,
        actions,
        seen,
        np.array(head["start"].split(), dtype=float),
        np.zeros((len(actions), count, count)),
        np.zeros((len(actions), count, len(seen))),
        np.zeros((len(actions), count)),
    )
    for line in stream:
        kind, *parts = [part.strip() for part in line.split(":")]
        action = indices(parts[0], actions)
        if kind == "T" and len(parts) == 1:
            assert next(stream) == "identity"
            result.transition[action] = np.eye(count)
        elif kind == "T":
            following, chance = parts[2].split()
            result.transition[np.ix_(action, indices(parts[1], states), indices(following, states))] = float(chance)
        elif kind == "O":
            row = np.array(next(stream).split(), dtype=float)
            result.observation[np.ix_(action, indices(parts[1], states))] = row
        else:
            assert kind == "R"
            anything, earned = parts[3].split()
            assert parts[2] == anything == "*"
            result.reward[np.ix_(action, indices(parts[1], states))] = float(earned)
    return result


def read_pomdpx(path: Path) -> tuple[dict[str, list[str]], dict[str, Array]]:
    """Return the values of every variable, and a table for every variable over its parents and itself."""
    root = Xml.parse(path).getroot()
    values: dict[str, list[str]] = {}
    for variable in root.find("Variable") or []:
        names = [variable.get(key) for key in ("vname", "vnamePrev", "vnameCurr")]
        values |= {name: (variable.findtext("ValueEnum") or "").split() for name in names if name}
    tables = {}
    for block in root.iter():
        if block.tag in {"CondProb", "Func"}:
            name, parents = block.findtext("Var") or "", (block.findtext("Parent") or "").split()
            axes = [*parents, *([name] if block.tag == "CondProb" else [])]
            tables[name] = table(block, [values[axis] for axis in axes if axis != "null"])
    return values, tables


def table(block: Xml.Element, axes: list[list[str]]) -> Array:
    result = np.zeros([len(axis) for axis in axes])
    for entry in block.iter("Entry"):
        instance = (entry.findtext("Instance") or "").split()
        text = (entry.findtext("ProbTable") or entry.findtext("ValueTable") or "").split()
        swept = [axis for axis, part in zip(axes, instance, strict=True) if part == "-"]
        numbers = (
            {"identity": np.eye(len(swept[0])), "uniform": np.full(len(swept[0]), 1 / len(swept[0]))} if swept else {}
        )
        filled = numbers[text[0]] if text[0] in numbers else np.array(text, dtype=float)
        filled = filled.reshape([len(axis) for axis in swept])
        for cell in cells(instance, axes):
            result[cell] = filled
    return result


def cells(instance: list[str], axes: list[list[str]]) -> Iterator[tuple[int | slice, ...]]:
    choices: list[list[int | slice]] = []
    for part, axis in zip(instance, axes, strict=True):
        choices.append([slice(None)] if part == "-" else [*indices(part, axis)])
    yield from itertools.product(*choices)

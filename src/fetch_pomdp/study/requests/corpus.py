"""Requests about tables, with the item that was meant and those that listeners took it for.

A folder holds `tables.json` (places of the items, x to the speaker's right and y away from the speaker, metres) and
`requests.csv` (table, target, request, and where known listeners_right, view, clicked).
"""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.documents import read_text
from fetch_pomdp.errors import InputError

NEAR = 0.4  # m, from the speaker to the table's edge
HEIGHT = 0.75  # m, of the table
HEAD = (0.0, 0.0, 1.25)  # m, the speaker's
ROBOT = (0.0, 1.5, 1.25)  # m, the listener's, who looks at the speaker
NAMES = ("block", "cube", "box")  # what people call any of the items
COLUMNS = ("table", "target", "request")


@dataclass(frozen=True, slots=True, eq=False)
class Request:
    """What somebody said about a table."""

    table: int
    target: int  # index of the item that was meant
    text: str
    clicked: Vector  # (n_items,), the share of the listeners who took it for each item; zeros where none were asked
    listeners_right: float = 0.0  # the share of all listeners who took it for what was meant
    view: str = ""  # whose view the words need, as annotators judged: neither, ambiguous, agent, user


@dataclass(frozen=True, slots=True, eq=False)
class Corpus:
    """Tables by number, and requests about them."""

    scenes: Mapping[int, Scene]
    requests: tuple[Request, ...]


def load_corpus(folder: Path) -> Corpus:
    """Read a folder. Raises InputError, with file and line, for what is none."""
    scenes = _scenes(folder / "tables.json")
    path = folder / "requests.csv"
    rows = csv.DictReader(read_text(path, InputError).splitlines())
    missing = [name for name in COLUMNS if name not in (rows.fieldnames or ())]
    if missing:
        expected = f"found no column {missing[0]}, expected {', '.join(COLUMNS)}"
        raise InputError(expected, source=str(path), line=1)
    requests = []
    for row in rows:
        try:
            requests.append(_request(row, scenes))
        except (KeyError, ValueError, TypeError) as error:
            found = f"found no request ({error}), expected a table, a target of its items and a request"
            raise InputError(found, source=str(path), line=rows.line_num) from None
    if not requests:
        raise InputError("found no requests, expected one or more", source=str(path))
    return Corpus(scenes, tuple(requests))


def _scenes(path: Path) -> dict[int, Scene]:
    try:
        data = json.loads(read_text(path, InputError))
        return {int(each["configuration"]): _scene(each["blocks"]) for each in data["scenes"]}
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"found no tables ({error}), expected scenes with blocks", source=str(path)) from None


def _scene(blocks: list[dict[str, Any]]) -> Scene:
    items = tuple(
        Item(id=str(each["id"]), position=(each["x"], NEAR + each["y"], HEIGHT), vocabulary=(*NAMES, each["colour"]))
        for each in blocks
    )
    return Scene(items=items, head=HEAD, robot=ROBOT)


def _request(row: Mapping[str, str], scenes: Mapping[int, Scene]) -> Request:
    table = int(row["table"])
    ids = {item.id: index for index, item in enumerate(scenes[table].items)}
    clicked = np.zeros(len(ids))
    for each in (row.get("clicked") or "").split(","):
        if each.strip() in ids:
            clicked[ids[each.strip()]] += 1.0
    if clicked.any():
        clicked /= clicked.sum()
    target = ids[row["target"].strip()]
    listeners = float(row.get("listeners_right") or clicked[target])
    return Request(table, target, row["request"], clicked, listeners, row.get("view") or "")

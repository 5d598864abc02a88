"""Model files: the parameters and rewards of a scene file alone, for any scene."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError, ModelError
from fetch_pomdp.files.writing import write_new


def with_model(scene: Scene, path: str | Path) -> Scene:
    """Return a scene under the [model] and [rewards] of a TOML file.

    Raises ModelError, with file, line and field, for a file that is not a model.
    """

    def read(data: Mapping[str, Any]) -> Scene:
        checks.known(data, ("model", "rewards"), "table", ModelError)
        return changed(scene, data, ModelError)

    return read_toml(path, ModelError).build(read)


def changed(scene: Scene, data: Mapping[str, Any], kind: type[InputError]) -> Scene:
    """Return a scene with the parameters under `model` and `rewards` in data changed.

    Raises ModelError, or `kind` for what is not a table, with the field.
    """
    try:
        section = "model"
        model = scene.model.with_changes(checks.mapping(data.get("model", {}), "", kind))
        section = "rewards"
        rewards = scene.rewards.with_changes(checks.mapping(data.get("rewards", {}), "", kind))
    except InputError as error:
        raise error.within(section) from None
    return dataclasses.replace(scene, model=model, rewards=rewards)


def write_model(
    path: str | Path,
    comments: Sequence[str],
    values: Mapping[str, tuple[float, str]],
    turns: Mapping[str, tuple[object, str]] | None = None,
) -> None:
    """Write a model file: comments first, then each parameter, and each of turn-taking, with a comment of its own.

    Raises ModelError if the file exists or cannot be written.
    """
    lines = [f"# {comment}" for comment in comments] + ["[model]"]
    lines += [f"{name} = {value!r}  # {comment}" for name, (value, comment) in values.items()]
    if turns is not None:
        lines += ["[model.turns]", *(f"{name} = {value!r}  # {comment}" for name, (value, comment) in turns.items())]
    write_new(path, lines, ModelError)

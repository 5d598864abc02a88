"""Model files: parameters for any scene."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import ModelError
from fetch_pomdp.files.models import with_model, write_model

SCENE = Scene.load("unambiguous")


def test_a_model_file_changes_what_it_names(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text("[model]\nsigma = 0.2\n[rewards]\npoint = -4.0\n")
    found = with_model(SCENE, path)
    assert found.model == SCENE.model.with_changes({"sigma": 0.2})
    assert found.rewards == SCENE.rewards.with_changes({"point": -4.0})
    assert dataclasses.replace(found, model=SCENE.model, rewards=SCENE.rewards) == SCENE


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    write_model(path, ["of a test"], {"sigma": (1 / 7, "rad"), "alpha": (0.3, "")})
    assert path.read_text().startswith("# of a test\n[model]\nsigma = 0.14285714285714285  # rad\n")
    assert with_model(SCENE, path).model == SCENE.model.with_changes({"sigma": 1 / 7, "alpha": 0.3})
    with pytest.raises(ModelError, match="found an existing file"):
        write_model(path, [], {})
    with pytest.raises(ModelError, match="cannot be written"):
        write_model(tmp_path / "none" / "model.toml", [], {})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[model]\nsigma = -1\n", ":2: model.sigma: found -1"),
        ("[model]\n\nsigme = 1\n", ":3: model.sigme: unknown parameter"),
        ("[rewards]\nwait = 1\n", ":2: rewards.wait: found 1"),
        ("head = [0, 0, 0]\n", ":1: head: unknown table"),
        ("model = 3\n", ":1: model: found 3"),
    ],
)
def test_what_is_no_model(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "model.toml"
    path.write_text(text)
    with pytest.raises(ModelError) as caught:
        with_model(SCENE, path)
    assert str(caught.value).startswith(f"{path}{message}")

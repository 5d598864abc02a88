"""Scenes written for other planners, read back and compared with numbers worked out by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import ExportError, ModelError
from fetch_pomdp.files import pomdp
from fetch_pomdp.files.export import export
from tests.files.formats import Pomdp, read_pomdp, read_pomdpx
from tests.tables import table

WORDS = [["cup", "red"], ["cup", "blue"], ["cup", "red"]]


def written(folder: Path, ending: str = ".pomdp", rings: int = 1, **model: Any) -> Path:
    path = folder / f"scene{ending}"
    export(Discrete(table(WORDS, **model), rings), path)
    return path


def chance(file: Pomdp, action: str, state: str, *parts: str) -> float:
    """The chance of all observations whose names have these parts."""
    columns = [index for index, name in enumerate(file.observations) if set(parts) <= set(name.split("-"))]
    return float(file.observation[file.actions.index(action), file.states.index(state), columns].sum())


@pytest.mark.parametrize("model", [{}, {"p_g": 0.0}, {"p_answer_again": 0.25, "p_truth": 1.0}])
def test_every_row_is_a_distribution(tmp_path: Path, model: dict[str, Any]) -> None:
    file = read_pomdp(written(tmp_path, **model))
    assert len(file.states) == 3 * 4 + 1
    assert len(file.actions) == 7
    assert len(file.observations) == 4 * 3 * (1 if "p_g" in model else 4) + 1
    assert file.start.tolist() == pytest.approx([1 / 3] * 3 + [0] * 10)
    for rows in (file.transition, file.observation):
        assert np.abs(rows.sum(axis=2) - 1).max() < 1e-6
        assert rows.min() >= 0
    assert (file.observation.sum(axis=(0, 1)) > 0).all()


def test_what_actions_lead_to_and_earn(tmp_path: Path) -> None:
    file = read_pomdp(written(tmp_path))

    def following(action: str, state: str) -> str:
        row = file.transition[file.actions.index(action), file.states.index(state)]
        assert row.max() == 1
        return file.states[int(row.argmax())]

    def earned(action: str, state: str) -> float:
        return float(file.reward[file.actions.index(action), file.states.index(state)])

    assert following("wait", "want1-asked2") == "want1-asked2"
    assert following("ask0", "want1-unasked") == "want1-asked0"
    assert following("ask0", "want1-asked2") == "want1-asked0"
    assert {following("pick2", state) for state in file.states} == {"end"}
    assert {following(action, "end") for action in file.actions} == {"end"}
    assert earned("wait", "want0-unasked") == -1
    assert earned("ask1", "want0-asked1") == -6
    assert [earned("pick1", f"want{item}-asked0") for item in range(3)] == [-12.5, 10, -12.5]
    assert {earned(action, "end") for action in file.actions} == {0}
    assert file.discount == 0.999


def test_words_and_answers_are_those_of_the_equations(tmp_path: Path) -> None:
    file = read_pomdp(written(tmp_path))
    # word1 blue, word2 cup, word3 red; every item has 2 of 3 words, so their own have chance 0.95 * 1.2 / 2.6.
    assert chance(file, "wait", "want0-unasked", "word3") == pytest.approx(0.95 * 1.2 / 2.6)
    assert chance(file, "wait", "want0-unasked", "word1") == pytest.approx(0.95 * 0.2 / 2.6)
    assert chance(file, "wait", "want1-asked1", "word2") == pytest.approx(0.95 * 1.2 / 2.6)
    assert chance(file, "ask2", "want1-asked2", "silence") == pytest.approx(0.05)
    red = [chance(file, "ask0", f"want{item}-asked0", "word3", "yes", "still") for item in (0, 1)]
    assert red[0] / red[1] == pytest.approx(6 * 99, rel=5e-3)  # the chance of no gesture is nearly the same
    assert chance(file, "wait", "want1-asked1", "yes") == pytest.approx(0.95 * 0.99)
    assert chance(file, "wait", "want1-asked0", "no") == pytest.approx(0.95 * 0.99)
    assert chance(file, "wait", "want1-unasked", "no") == pytest.approx(0.475)
    assert chance(file, "wait", "want1-unasked", "silent") == pytest.approx(0.05)
    # Half a metre apart at 2 m: hardly anyone points nearer to another item than to his own.
    assert 0.07 < chance(file, "wait", "want1-unasked", "at1") < 0.1
    assert chance(file, "wait", "want1-unasked", "still") == pytest.approx(0.9 + 0.1 * 0.0455, abs=3e-3)


def test_answers_that_do_not_come_again(tmp_path: Path) -> None:
    file = read_pomdp(written(tmp_path, p_answer_again=0.2))
    assert chance(file, "wait", "want1-asked1", "yes") == pytest.approx(0.19 * 0.99)
    assert chance(file, "ask1", "want1-asked1", "yes") == pytest.approx(0.95 * 0.99)
    assert chance(file, "wait", "want1-asked1", "silent") == pytest.approx(0.81)


@pytest.mark.parametrize("model", [{}, {"p_answer_again": 0.2}])
def test_the_factors_multiply_to_the_flat_file(tmp_path: Path, model: dict[str, Any]) -> None:
    flat = read_pomdp(written(tmp_path, rings=2, **model))
    values, tables = read_pomdpx(written(tmp_path, ".pomdpx", rings=2, **model))
    assert values["action"] == flat.actions
    assert tables["desired_0"] == pytest.approx([1 / 3] * 3)
    assert tables["asked_0"].tolist() == [1, 0, 0, 0, 0]
    for a, action in enumerate(flat.actions):
        for d, desired in enumerate(values["desired_0"]):
            assert tables["desired_1"][a, d].tolist() == [float(d == other) for other in range(3)]
            for q, asked in enumerate(values["asked_0"][:-1]):
                state = flat.states.index(f"{desired}-{asked}")
                after = values["asked_1"][int(tables["asked_1"][a, q].argmax())]
                assert tables["asked_1"][a, q].sum() == tables["asked_1"][a, q].max() == 1
                name = "end" if after == "over" else f"{desired}-{after}"
                assert flat.transition[a, state, flat.states.index(name)] == 1
                assert tables["reward"][a, d, q] == flat.reward[a, state]
                joint = np.einsum(
                    "w,r,g->wrg", tables["words"][a, d], tables["response"][a, d, q], tables["gesture"][a, d]
                )
                assert joint.ravel() == pytest.approx(flat.observation[a, state, :-1], abs=1e-10), action
    assert (tables["reward"][:, :, -1] == 0).all()
    assert (tables["asked_1"][:, -1, -1] == 1).all()


def test_names_survive_ids_that_no_format_could_hold(tmp_path: Path) -> None:
    items = [("wait <&> --", "grün"), ("T: *\n#", "tasse")]
    scene = Scene(
        items=tuple(Item(id=id, position=(x, 2, 1), vocabulary=(word,)) for x, (id, word) in enumerate(items)),
        head=(0, 0, 1.6),
        rewards=Rewards(wait=-0.125),
    )
    for ending in (".pomdp", ".pomdpx"):
        export(Discrete(Problem(scene)), tmp_path / f"scene{ending}")
    file = read_pomdp(tmp_path / "scene.pomdp")
    assert file.reward[0].tolist() == [-0.125] * 6 + [0]
    assert read_pomdpx(tmp_path / "scene.pomdpx")[0]["words"] == ["silence", "word1", "word2"]
    assert '# item 1: "T: *\\n#"' in (tmp_path / "scene.pomdp").read_text()


def test_items_in_one_direction_leave_no_observation_without_a_chance(tmp_path: Path) -> None:
    problem = table([["cup"], ["pen"]], places=[(0.0, 1.0, 1.6), (0.0, 2.0, 1.6)])
    export(Discrete(problem), tmp_path / "scene.pomdp")
    file = read_pomdp(tmp_path / "scene.pomdp")
    assert not [name for name in file.observations if name.endswith("at1")]
    assert np.abs(file.observation.sum(axis=2) - 1).max() < 1e-6


def test_a_file_that_is_there_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "scene.pomdp"
    path.write_text("mine")
    with pytest.raises(ExportError, match=r"scene\.pomdp: found an existing file, expected a new one"):
        written(tmp_path)
    assert path.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = Discrete(table(WORDS, p_g=0.0))
    with pytest.raises(ExportError, match=r"found '\.txt', expected a name that ends in \.pomdp or \.pomdpx"):
        export(model, tmp_path / "scene.txt")
    with pytest.raises(ExportError, match="cannot be written: No such file or directory"):
        export(model, tmp_path / "nowhere" / "scene.pomdp")
    for discount in (0.0, 1.01, float("nan")):
        with pytest.raises(ModelError, match=r"discount: found .*, expected a number above 0 and at most 1"):
            export(model, tmp_path / "scene.pomdp", discount)
    monkeypatch.setattr(pomdp, "MOST_NUMBERS", 100)
    for ending in (".pomdp", ".pomdpx"):
        with pytest.raises(ExportError, match=r"found 3 items and 4 x 3 x 1 observations, .* expected at most 100"):
            export(model, tmp_path / f"scene{ending}")
    monkeypatch.undo()

    def broken(*_: object) -> str:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pomdp, "_row", broken)
    with pytest.raises(ExportError, match="cannot be written: No space left on device"):
        export(model, tmp_path / "scene.pomdp")
    assert list(tmp_path.iterdir()) == []


def test_a_file_system_without_links_will_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(Path, "hardlink_to", refused)
    path = written(tmp_path, p_g=0.0)
    assert len(read_pomdp(path).states) == 13
    assert list(tmp_path.iterdir()) == [path]

"""Scenes, parameters, rewards and words, checked when built."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.language.phrases import Answers
from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import InputError, ModelError, SceneError
from tests.oracles.model import NO_WORDS, YES_WORDS

BOWL = ("bowl", "black", "plastic", "container")
MARKER = ("marker", "green", "expo", "pen")
SPOON = ("spoon", "silver", "metal", "utensil")


def test_ambiguous_layout() -> None:
    scene = Scene.load("ambiguous")
    assert scene.head == (0.0, 0.0, 1.6)
    assert [item.position for item in scene.items] == [
        (-0.375, 3.2, 0.75),
        (-0.225, 3.2, 0.75),
        (-0.075, 3.2, 0.75),
        (0.075, 3.2, 0.75),
        (0.225, 3.2, 0.75),
        (0.375, 3.2, 0.75),
    ]
    assert [item.vocabulary for item in scene.items] == [BOWL, BOWL, MARKER, MARKER, SPOON, SPOON]


def test_unambiguous_layout() -> None:
    scene = Scene.load("unambiguous")
    assert scene.head == (0.0, 0.0, 1.6)
    for index, item in enumerate(scene.items):
        a = (index - 2.5) * 0.45 / 1.22
        assert item.position == pytest.approx((1.22 * math.sin(a), 1.22 * math.cos(a), 0.75), abs=1e-12)
    assert [item.vocabulary for item in scene.items] == [BOWL, MARKER, SPOON, BOWL, MARKER, SPOON]
    assert sorted(LAYOUTS) == ["ambiguous", "unambiguous"]


def test_defaults_are_the_paper_s() -> None:
    assert dataclasses.asdict(Model()) == {
        "alpha": 0.2, "p_l": 0.95, "p_g": 0.1, "sigma": 0.15, "p_truth": 0.99, "gesture_threshold": 0.3,
        "gesture_likelihood": "eq7", "p_answer_again": 1.0, "turns": None,
    }  # fmt: skip
    assert dataclasses.asdict(Rewards()) == {"pick_correct": 10.0, "pick_wrong": -12.5, "point": -6.0, "wait": -1.0}
    assert list(POSITIVE) == YES_WORDS
    assert list(NEGATIVE) == NO_WORDS


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"alpha": 0.0}, "alpha: found 0.0, expected a number above 0"),
        ({"alpha": math.nan}, "alpha: found nan"),
        ({"alpha": "0.2"}, "alpha: found '0.2'"),
        ({"alpha": True}, "alpha: found True"),
        ({"p_l": 0.0}, "p_l: found 0.0, expected a probability above 0 and below 1"),
        ({"p_l": 1.0}, "p_l: found 1.0"),
        ({"p_g": -0.1}, "p_g: found -0.1, expected a probability from 0 to below 1"),
        ({"p_g": 1.0}, "p_g: found 1.0"),
        ({"sigma": -0.15}, "sigma: found -0.15, expected an angle above 0"),
        ({"sigma": 0.0}, "sigma: found 0.0"),
        ({"sigma": 0.71}, "sigma: found 0.71"),
        ({"sigma": math.inf}, "sigma: found inf"),
        ({"sigma": 10**400}, "sigma: found 1000"),
        ({"p_truth": 0.49}, "p_truth: found 0.49, expected a probability from 0.5 to 1"),
        ({"p_truth": 1.01}, "p_truth: found 1.01"),
        ({"gesture_threshold": 0.0}, "gesture_threshold: found 0.0"),
        ({"gesture_threshold": 3.2}, "gesture_threshold: found 3.2, expected an angle above 0 and at most pi rad"),
        ({"gesture_likelihood": "eq8"}, "gesture_likelihood: found 'eq8', expected 'eq7' or 'exact'"),
        ({"gesture_likelihood": ["eq7"]}, "gesture_likelihood: found ['eq7']"),
        ({"p_answer_again": -0.01}, "p_answer_again: found -0.01, expected a factor from 0 to 1"),
        ({"p_answer_again": 1.5}, "p_answer_again: found 1.5"),
        ({"sigmma": 0.1}, "sigmma: unknown parameter, expected one of alpha, p_l,"),
    ],
)
def test_parameters_out_of_range(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError) as caught:
        Model().with_changes(parameters)
    assert str(caught.value).startswith(message)


def test_a_misspelt_parameter_is_answered_with_the_likely_one() -> None:
    with pytest.raises(ModelError, match="did you mean 'sigma'"):
        Model().with_changes({"sigmma": 0.1})
    with pytest.raises(ModelError, match="did you mean 'point'"):
        Rewards().with_changes({"pont": -1})


@pytest.mark.parametrize(
    ("rewards", "message"),
    [
        ({"pick_wrong": 10.0}, "pick_wrong: found 10.0, expected below pick_correct (10.0)"),
        ({"wait": 0.1}, "wait: found 0.1, expected at most 0: waiting is no gain (0.0)"),
        ({"point": -0.5}, "point: found -0.5, expected at most the reward of wait (-1.0)"),
        ({"point": math.nan}, "point: found nan, expected a finite number"),
        ({"pick_correct": 1e7}, "pick_correct: found 10000000.0, expected a finite number within 1e+06"),
    ],
)
def test_prices_that_are_none(rewards: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError) as caught:
        Rewards().with_changes(rewards)
    assert str(caught.value).startswith(message)


def test_prices_at_their_limits() -> None:
    assert Rewards(wait=0.0, point=0.0) == Rewards().with_changes({"wait": 0, "point": 0})
    assert Rewards(wait=-3.0, point=-3.0).point == -3.0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"id": ""}, "id: found '', expected a name that is not empty"),
        ({"id": "  "}, "id: found ' '"),
        ({"id": 3}, "id: found 3"),
        ({"id": "\ud800"}, "id: found '\\ud800', expected text that UTF-8 can hold"),
        ({"position": (0.0, 1.0)}, "position: found (0.0, 1.0), expected [x, y, z], three finite numbers in metres"),
        ({"position": (0.0, 1.0, math.nan)}, "position: found nan"),
        ({"position": (0.0, 1.0, math.inf)}, "position: found inf"),
        ({"position": (0.0, 1.0, 1e7)}, "position: found 10000000.0"),
        ({"position": (0.0, 1.0, "2")}, "position: found '2'"),
        ({"position": "012"}, "position: found '012'"),
        ({"position": None}, "position: found None"),
        ({"vocabulary": ()}, "vocabulary: found (), expected a list of one word or more"),
        ({"vocabulary": "cup"}, "vocabulary: found 'cup'"),
        ({"vocabulary": ("cup", "")}, "vocabulary[1]: found '', expected a word"),
        ({"vocabulary": ("cup", 3)}, "vocabulary[1]: found 3"),
        ({"vocabulary": ("tea cup",)}, "vocabulary[0]: found 'tea cup', expected a single word without punctuation"),
        ({"vocabulary": ("cup!",)}, "vocabulary[0]: found 'cup!'"),
        ({"vocabulary": ("cup", "Yes")}, "vocabulary[1]: found 'Yes', expected a word that is no answer to a question"),
        ({"vocabulary": ("not",)}, "vocabulary[0]: found 'not'"),
    ],
)
def test_items_that_are_none(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Item(**{"id": "cup", "position": (0.0, 1.0, 0.0), "vocabulary": ("cup",), **fields})
    assert str(caught.value).startswith(message)


def test_vocabularies_are_lower_case_without_repeats() -> None:
    item = Item(id="cup", position=(0, 1, 0), vocabulary=("Cup", " MUG ", "cup", "it's", "T-shirt"))
    assert item.vocabulary == ("cup", "mug", "it's", "t-shirt")
    assert item.position == (0.0, 1.0, 0.0)
    assert Item(id="cup", position=np.array([0, 1, 0]), vocabulary=("cup",)).position == (0.0, 1.0, 0.0)  # type: ignore[arg-type]


def an_item(id: str = "cup", position: tuple[float, float, float] = (0.0, 1.0, 0.0)) -> Item:
    return Item(id=id, position=position, vocabulary=("cup",))


def test_scenes_that_are_none() -> None:
    head = (0.0, 0.0, 1.6)
    with pytest.raises(SceneError, match="items: found no items, expected one or more"):
        Scene(items=(), head=head)
    with pytest.raises(
        SceneError, match=r"items\[2\]\.id: found 'cup', which items\[0\] has, expected an id of its own"
    ):
        Scene(items=(an_item(), an_item("mug"), an_item()), head=head)
    with pytest.raises(SceneError, match=r"items\[1\]\.position: found the position of the head"):
        Scene(items=(an_item(), an_item("mug", head)), head=head)
    with pytest.raises(SceneError, match="head: found"):
        Scene(items=(an_item(),), head=(0.0, math.nan, 0.0))


def test_index_answers_an_unknown_id_with_the_known_ones() -> None:
    scene = Scene(items=tuple(an_item(f"cup-{index}") for index in range(25)), head=(0.0, 0.0, 1.6))
    assert scene.index("cup-7") == 7
    with pytest.raises(SceneError, match=r"^item: found 'pot', expected one of cup-0, cup-1, .*, cup-19 and 5 more$"):
        scene.index("pot")


def test_to_mapping_and_back() -> None:
    for name in LAYOUTS:
        scene = Scene.load(name)
        assert Scene.from_mapping(scene.to_mapping()) == scene
        assert "answers" not in scene.to_mapping()
        answering = dataclasses.replace(scene, answers=Answers(yes=("aye", "that'll do"), object=("arrête",)))
        assert answering.to_mapping()["answers"] == {"yes": ["aye", "that'll do"], "object": ["arrête"]}
        assert Scene.from_mapping(answering.to_mapping()) == answering


def test_answers_of_a_scene_file(tmp_path: Path) -> None:
    text = 'head = [0, 0, 1.6]\n[[items]]\nid = "a"\nposition = [0, 1, 1]\nvocabulary = ["cup"]\n[answers]\n'
    path = tmp_path / "scene.toml"
    path.write_text(text + 'yes = ["aye"]\n')
    assert Scene.load(path).answers == Answers(yes=("aye",))
    path.write_text(text + 'yes = ["aye", 3]\n')
    with pytest.raises(SceneError, match=r"scene.toml:7: answers\.yes\[1\]: found 3, expected a phrase"):
        Scene.load(path)


@pytest.mark.parametrize("name", ["ambigous", "a" * 5_000, "no\0where", ""])
def test_names_of_no_scene(name: str) -> None:
    with pytest.raises(SceneError) as caught:
        Scene.load(name)
    assert "expected" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_is_no_scene(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="cannot be read"):
        Scene.load(tmp_path)


def test_problem_holds_the_scene_as_arrays() -> None:
    items = (
        Item(id="a", position=(0, 3, 4), vocabulary=("cup", "red")),
        Item(id="b", position=(1, 0, 0), vocabulary=("mug", "cup", "tea")),
    )
    problem = Problem(Scene(items=items, head=(0.0, 0.0, 0.0), model=Model(p_answer_again=0.5)))
    assert problem.words == ("cup", "mug", "red", "tea")
    assert problem.n_items == 2
    tables = problem.tables
    assert tables.directions == pytest.approx(np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]]))
    assert tables.smoothing == pytest.approx([1 / 2.8, 1 / 3.8])
    assert tables.p_again == pytest.approx(0.475)
    owners = {
        word: sorted(tables.word_items[tables.word_starts[index] : tables.word_starts[index + 1]].tolist())
        for index, word in enumerate(problem.words)
    }
    assert owners == {"cup": [0, 1], "mug": [1], "red": [0], "tea": [1]}


def test_errors_gather_where_they_are() -> None:
    error = InputError("found 1, expected 2", field="x")
    assert str(error) == "x: found 1, expected 2"
    assert str(error.within("items[0]")) == "items[0].x: found 1, expected 2"
    assert str(error.within("items[0]").located("a.toml", 3)) == "a.toml:3: items[0].x: found 1, expected 2"
    assert str(error.located("a.toml", None)) == "a.toml: x: found 1, expected 2"
    assert str(InputError("p", field="[2].x").within("items")) == "items[2].x: p"
    assert str(InputError("p").within("items")) == "items: p"
    assert str(InputError("two\nlines\x1b", field="a\u2028b")) == "a b: two lines "


CUP = Item(id="cup", position=(0.0, 1.0, 1.0), vocabulary=("cup",))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"model": None}, r"^model: found None, expected Model\(\.\.\.\)$"),
        ({"model": {"sigma": 0.2}}, r"^model: found {'sigma': 0.2}, expected Model"),
        ({"rewards": Model()}, r"^rewards: found Model.*, expected Rewards\(\.\.\.\)$"),
        ({"items": None}, r"^items\[0\]: found None, expected Item\(\.\.\.\)$"),
        ({"items": ["cup"]}, r"^items\[0\]: found 'cup', expected Item"),
        ({"items": [CUP, {"id": "mug"}]}, r"^items\[1\]: found {'id': 'mug'}, expected Item"),
        ({"items": ()}, "^items: found no items, expected one or more$"),
    ],
)
def test_a_scene_is_of_items_model_and_rewards(given: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Scene(**{"items": [CUP], "head": (0.0, 0.0, 1.6), **given})


def test_a_misspelt_scene_is_answered_with_the_one_that_was_meant() -> None:
    for misspelt, meant in (("ambigous", "ambiguous"), ("unambigous", "unambiguous"), ("Ambiguous", "ambiguous")):
        with pytest.raises(SceneError, match=f"or a TOML file, did you mean '{meant}'$"):
            Scene.load(misspelt)
    with pytest.raises(SceneError, match=r"or a TOML file$"):
        Scene.load("kitchen")
    for wrong in (None, 3, b"ambiguous", True):
        with pytest.raises(SceneError, match=r"^scene: found .*, expected a Scene, its name, or the path"):
            Scene.load(wrong)  # type: ignore[arg-type]
    with pytest.raises(SceneError):
        Scene.load("a\0b")


def test_numbers_of_numpy_are_numbers() -> None:
    model = Model(p_l=np.float32(0.9), sigma=np.float64(0.2), alpha=np.int64(1))  # type: ignore[arg-type]
    assert model == Model(p_l=float(np.float32(0.9)), sigma=0.2, alpha=1.0)
    assert all(type(getattr(model, name)) is float for name in ("p_l", "sigma", "alpha"))
    assert Rewards(wait=np.int8(-2)).wait == -2.0  # type: ignore[arg-type]
    item = Item(id="cup", position=[np.float32(0.5), np.int64(2), 1], vocabulary=["cup"])  # type: ignore[arg-type]
    assert item.position == (0.5, 2.0, 1.0)


@pytest.mark.parametrize("wrong", [True, np.True_, "0.9", None, 0.9 + 0j, np.nan, np.float32("inf"), 10**400, [0.9]])
def test_truth_values_and_texts_are_no_numbers(wrong: Any) -> None:
    with pytest.raises(ModelError, match=r"^p_l: found .+, expected a probability above 0 and below 1$"):
        Model(p_l=wrong)


@pytest.mark.parametrize("changes", [3, "sigma", ["sigma"], {1: 2}])
def test_changes_are_a_mapping(changes: Any) -> None:
    for whole in (Model(), Rewards()):
        with pytest.raises(ModelError, match="expected a table of named fields"):
            whole.with_changes(changes)


def test_a_scene_may_say_where_the_robot_is_and_where_items_face() -> None:
    item = {"id": "car", "position": [0.0, 1.0, 0.75], "vocabulary": ["car"], "facing": [0, -2]}
    scene = Scene.from_mapping({"head": [0.0, 0.0, 1.6], "items": [item], "robot": [0.5, 2, 1.1]})
    assert (scene.robot, scene.items[0].facing) == ((0.5, 2.0, 1.1), (0.0, -2.0))
    assert Scene.from_mapping(scene.to_mapping()) == scene
    assert "robot" not in Scene.load("ambiguous").to_mapping()


@pytest.mark.parametrize("facing", [[0.0, 0.0], [1.0], "north", [1.0, 2.0, 3.0], [1.0, "x"]])
def test_what_is_no_direction_is_refused(facing: Any) -> None:
    with pytest.raises(SceneError, match="facing"):
        Item(id="car", position=(0.0, 1.0, 0.75), vocabulary=("car",), facing=facing)


def test_a_robot_is_somewhere() -> None:
    with pytest.raises(SceneError, match="robot"):
        dataclasses.replace(Scene.load("ambiguous"), robot=(0.0, 1.0))  # type: ignore[arg-type]

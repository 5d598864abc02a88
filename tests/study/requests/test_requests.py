"""A corpus, its scores and weights learnt from it, on a made-up table."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.weights import NAMES, Weights, shipped, theta_of, weights_of
from fetch_pomdp.errors import InputError
from fetch_pomdp.study.requests.corpus import Request, load_corpus
from fetch_pomdp.study.requests.fit import Learner
from fetch_pomdp.study.requests.scores import score

BLOCKS = [
    {"id": 1, "colour": "red", "x": -0.2, "y": 0.2},
    {"id": 2, "colour": "red", "x": 0.2, "y": 0.2},
    {"id": 3, "colour": "blue", "x": 0.0, "y": 0.4},
]
ROWS = """table,target,request,listeners_right,view,clicked
1,1,the red block on my left,1.0,user,"1, 1, 1, 2"
1,3,the blue block,1.0,neither,"3, 3"
2,2,the red block on my right,0.5,user,"2, 1"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    scenes = [{"configuration": number, "blocks": BLOCKS} for number in (1, 2)]
    (tmp_path / "tables.json").write_text(json.dumps({"scenes": scenes}))
    (tmp_path / "requests.csv").write_text(ROWS)
    return tmp_path


def test_a_corpus_has_tables_and_what_was_said(folder: Path) -> None:
    corpus = load_corpus(folder)
    assert sorted(corpus.scenes) == [1, 2]
    first = corpus.requests[0]
    assert (first.table, first.target, first.view) == (1, 0, "user")
    assert first.clicked.tolist() == [0.75, 0.25, 0.0]
    assert (first.listeners_right, corpus.requests[2].listeners_right) == (1.0, 0.5)
    assert corpus.scenes[1].items[2].position == (0.0, 0.8, 0.75)


def test_what_is_wrong_with_a_corpus_is_said_with_its_line(folder: Path) -> None:
    (folder / "requests.csv").write_text("table,target,request\n1,9,the green block\n")
    with pytest.raises(InputError, match=r"requests\.csv:2.*expected a table"):
        load_corpus(folder)
    (folder / "requests.csv").write_text("table,request\n")
    with pytest.raises(InputError, match="found no column target"):
        load_corpus(folder)


def request(target: int) -> Request:
    return Request(1, target, "", np.array([0.5, 0.5]), 0.7)


def test_scores_against_values_by_hand() -> None:
    chances = [np.array([0.8, 0.2]), np.array([0.6, 0.4]), np.array([0.5, 0.5])]
    found = score([request(0), request(1), request(0)], chances)
    assert found.right == pytest.approx((1 + 0 + 0.5) / 3)
    assert found.log_loss == pytest.approx(-(math.log(0.8) + math.log(0.4) + math.log(0.5)) / 3)
    assert found.calibration_error == pytest.approx((abs(0.8 - 1) + abs(0.6 - 0) + abs(0.5 - 0.5)) / 3)
    assert [found.listeners, found.agreeing] == pytest.approx([0.7, 0.5])


def test_learning_makes_what_was_meant_likelier(folder: Path) -> None:
    pytest.importorskip("scipy")
    corpus = load_corpus(folder)
    learner = Learner(corpus)
    theta = learner.fit([1], steps=4)

    def loss(point: np.ndarray, table: int) -> float:
        read = learner.read(point, [table])
        return -sum(math.log(read[index][corpus.requests[index].target]) for index in read)

    none = np.zeros(len(NAMES))
    assert loss(theta, 1) < loss(none, 1)
    assert loss(theta, 2) < loss(none, 2)
    assert sorted(learner.read(none, [2])) == [2]


def test_the_shipped_weights_are_those_of_their_file() -> None:
    theta = theta_of(shipped())
    values = Weights.at(theta).values
    for name, value in shipped().items():
        assert getattr(values, name) == pytest.approx(value)


def test_a_weight_that_does_not_exist_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "weights.toml"
    path.write_text("[weights]\nblurr = 1.0\n")
    with pytest.raises(InputError, match="blurr"):
        weights_of(path)
    path.write_text("[weights]\nrank_blur = -1.0\n")
    with pytest.raises(InputError, match="expected a number above 0"):
        weights_of(path)

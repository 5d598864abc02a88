"""A calibration that is fitted is that of the records it is fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.calibration import Calibration, calibration_of
from fetch_pomdp.errors import InputError
from fetch_pomdp.study.requests.calibration import Record, fitted, log_loss, write_calibration

N = 6


def records(truth: Calibration, count: int, seed: int = 0) -> list[Record]:
    """Requests whose targets have just the chances that a calibration believes."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        chances, own = rng.dirichlet(np.full(N, 0.4), size=2)
        target = int(rng.choice(N, p=truth.believed(chances, own)))
        made.append(Record(chances, own, target))
    return made


def test_what_is_believed_by_hand() -> None:
    chances, own = np.array([0.8, 0.2]), np.array([0.5, 0.5])
    found = Calibration(exponent=2.0, own=0.3, even=0.1).believed(chances, own)
    sharp = 0.64 / (0.64 + 0.04)
    assert found.tolist() == pytest.approx([0.15 + 0.05 + 0.6 * sharp, 0.15 + 0.05 + 0.6 * (1.0 - sharp)])
    assert np.isfinite(np.log(Calibration().believed(np.array([1.0, 0.0]), own))).all()


@pytest.mark.parametrize(
    "truth",
    [
        Calibration(exponent=0.5, own=0.2, even=0.1),
        Calibration(exponent=1.7, own=0.05, even=0.2),
        Calibration(exponent=1.0, own=0.7, even=0.05),
    ],
)
def test_the_calibration_that_made_the_records_is_found(truth: Calibration) -> None:
    pytest.importorskip("scipy")
    found = fitted(records(truth, 4000))
    assert found.exponent == pytest.approx(truth.exponent, rel=0.35)
    assert found.own == pytest.approx(truth.own, abs=0.08)
    assert found.even == pytest.approx(truth.even, abs=0.08)
    unseen = records(truth, 4000, seed=1)
    assert log_loss(unseen, found) < log_loss(unseen, truth) + 0.003
    assert log_loss(unseen, found) < log_loss(unseen, Calibration())


def test_a_reader_that_knows_nothing_leaves_it_to_ours() -> None:
    pytest.importorskip("scipy")
    rng = np.random.default_rng(0)
    own = [rng.dirichlet(np.full(N, 0.3)) for _ in range(600)]
    asked = [Record(rng.dirichlet(np.full(N, 0.1)), each, int(rng.choice(N, p=each))) for each in own]
    found = fitted(asked)
    assert log_loss(asked, found) < 1.02 * log_loss(asked, Calibration(own=0.999, even=0.001))


def test_few_records_leave_a_doubt() -> None:
    pytest.importorskip("scipy")
    always = [Record(np.array([0.9, 0.1]), np.array([0.5, 0.5]), 0)] * 3
    believed = fitted(always).believed(np.array([0.9, 0.1]), np.array([0.5, 0.5]))
    assert 0.6 < believed[0] < 0.95


def test_a_file_has_what_was_fitted_and_to_what(tmp_path: Path) -> None:
    path = tmp_path / "calibration.toml"
    write_calibration(path, Calibration(exponent=0.75, own=0.25, even=0.125), count=12, source="made\nup")
    assert path.read_text().startswith("# Fitted to 12 requests: made up\n")
    assert calibration_of(path) == Calibration(exponent=0.75, own=0.25, even=0.125)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[weights]\nlost = 1.0\n", "calibration: found no such field"),
        ("[calibration]\nexponent = -1.0\n", r"toml:2: calibration\.exponent: found -1\.0, expected a number above 0"),
        ("[calibration]\neven = 0.0\n", "expected a share above 0"),
        ("[calibration]\nown = 0.9\neven = 0.2\n", "at most 1 together"),
        ("[calibration]\nsharp = 1.0\n", "unknown number, expected one of exponent, own, even"),
    ],
)
def test_a_file_that_is_none_is_refused(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "calibration.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=why):
        calibration_of(path)

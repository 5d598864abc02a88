"""What may be heard next: chances sum to 1, beliefs are Bayes' and average to the belief before."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.action import Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.fitted.outlook import MOST_WORDS, distinct_words, look, outlook_size, rays_of
from fetch_pomdp.core.planners.kernels import smoothed_mass
from fetch_pomdp.core.problem import Problem
from tests.tables import live, table

UNEVEN = np.array([0.5, 0.3, 0.15, 0.05])
VOCABULARIES = [["cup", "red", "mug"], ["cup", "red"], ["pot", "cup"], ["pot"]]


def outlook(problem: Problem, belief: np.ndarray, rays: int, seed: int = 0) -> list[tuple[float, np.ndarray]]:
    distinct, state = distinct_words(problem, rays), np.array([seed], dtype=np.uint64)
    smoothed, found = smoothed_mass(belief, problem.tables), []
    for number in range(outlook_size(distinct, problem.tables)):
        heard = np.empty(len(belief))
        seen = look(number, belief, smoothed, 0, heard, state, distinct, problem.tables)
        assert seen.wait == seen.ask, "the paper's people say as much after a question"
        found.append((seen.wait, heard))
    return found


def test_words_of_the_same_owners_are_one() -> None:
    problem = table(VOCABULARIES)
    distinct = distinct_words(problem, 4)
    owners = {tuple(sorted(i for i, words in enumerate(VOCABULARIES) if w in words)) for w in problem.words}
    assert len(distinct.words) == len(owners) == 4
    assert distinct.sizes.sum() == len(problem.words)
    assert distinct_words(table([["a", "b", "c"]] * 2), 1).sizes.tolist() == [3.0]


@pytest.mark.parametrize("likelihood", ["eq7", "exact"])
@pytest.mark.parametrize("p_g", [0.0, 0.3])
def test_chances_sum_to_one_and_beliefs_are_distributions(likelihood: str, p_g: float) -> None:
    found = outlook(table(VOCABULARIES, p_g=p_g, gesture_likelihood=likelihood), UNEVEN, rays=5)
    assert len(found) == 1 + 4 + (5 if p_g else 0)
    assert sum(chance for chance, _ in found) == pytest.approx(1.0)
    for _, heard in found:
        assert heard.sum() == pytest.approx(1.0)
        assert (heard >= 0).all()


def test_without_pointing_the_outlook_is_exact() -> None:
    """Every word's belief is that of `Belief.updated`, and they average to the belief before."""
    problem = table(VOCABULARIES, p_g=0.0)
    found = outlook(problem, UNEVEN, rays=3)
    distinct = distinct_words(problem, 3)
    for (_, heard), words in zip(found, [(), *((problem.words[word],) for word in distinct.words)], strict=True):
        expected = Belief(UNEVEN).updated(Observation(words), None, problem).probabilities
        assert heard == pytest.approx(expected, abs=1e-12)
    assert sum(chance * heard for chance, heard in found) == pytest.approx(UNEVEN, abs=1e-12)


@pytest.mark.parametrize("vocabularies", [VOCABULARIES, [[f"w{i}", f"v{i}", f"u{i % 3}"] for i in range(20)]])
def test_sampled_beliefs_average_to_the_belief_before(vocabularies: list[list[str]]) -> None:
    """With the exact likelihood the belief is a martingale: few words are summed, many are drawn, rays always are."""
    problem = table(vocabularies, p_g=0.4, gesture_likelihood="exact")
    belief = np.random.default_rng(0).dirichlet(np.ones(len(vocabularies)))
    means = np.array([
        sum(chance * heard for chance, heard in outlook(problem, belief, rays=4, seed=seed)) for seed in range(2_000)
    ])  # fmt: skip
    error = means.std(axis=0) / np.sqrt(len(means))
    assert (np.abs(means.mean(axis=0) - belief) < 4.5 * error + 1e-9).all()
    assert (len(problem.words) > MOST_WORDS) == (len(vocabularies) == 20)


def kinds(problem: Problem, phase: int, rays: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Live people: chances after a wait and with a question, (size, 2), and the beliefs, (size, n)."""
    distinct, state = distinct_words(problem, rays_of(problem, rays)), np.array([seed], dtype=np.uint64)
    size, smoothed = outlook_size(distinct, problem.tables), smoothed_mass(UNEVEN, problem.tables)
    chances, heard = np.empty((size, 2)), np.empty((size, len(UNEVEN)))
    for number in range(size):
        seen = look(number, UNEVEN, smoothed, phase, heard[number], state, distinct, problem.tables)
        chances[number] = seen.wait, seen.ask
    return chances, heard


@pytest.mark.parametrize("phase", [0, 4, 12, 30, 37])
@pytest.mark.parametrize("p_g", [0.0, 0.3])
def test_with_live_people_chances_sum_to_one_for_a_wait_and_for_a_question(phase: int, p_g: float) -> None:
    problem = live(table(VOCABULARIES, p_g=p_g))
    chances, heard = kinds(problem, phase, rays=5)
    assert len(chances) == 1 + 4 + (10 if p_g else 0)  # each ray with a word and without
    assert chances.sum(axis=0) == pytest.approx([1.0, 1.0])
    assert heard.sum(axis=1) == pytest.approx(np.ones(len(heard)))
    silent = [problem.step_chances(action, phase) for action in (Wait(), Point(0))]
    assert chances[0] == pytest.approx([(1 - of.words) * (1 - of.points) for of in silent])
    if p_g == 0.0:
        assert chances.T @ heard == pytest.approx(np.array([UNEVEN] * 2), abs=1e-12)


@pytest.mark.parametrize("phase", [0, 8, 36])
def test_with_live_people_rays_bring_words_as_often_as_they_speak(phase: int) -> None:
    problem = live(table(VOCABULARIES, p_g=0.3))
    distinct = distinct_words(problem, rays_of(problem, 4))
    state, smoothed = np.array([0], dtype=np.uint64), smoothed_mass(UNEVEN, problem.tables)
    found = np.zeros(2)
    for number in range(outlook_size(distinct, problem.tables)):
        seen = look(number, UNEVEN, smoothed, phase, np.empty(4), state, distinct, problem.tables)
        found += seen.words * np.array([seen.wait, seen.ask])
    assert found == pytest.approx([problem.step_chances(action, phase).words for action in (Wait(), Point(0))])

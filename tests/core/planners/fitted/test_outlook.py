"""What may be heard next: chances sum to 1, beliefs are Bayes' and average to the belief before."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.fitted.outlook import MOST_WORDS, distinct_words, look, outlook_size
from fetch_pomdp.core.planners.kernels import smoothed_mass
from fetch_pomdp.core.problem import Problem
from tests.tables import table

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

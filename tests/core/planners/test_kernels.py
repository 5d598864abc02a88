"""The compiled sampler of words and pointing, against the oracle's posterior."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import numpy.typing as npt
import pytest

from fetch_pomdp.core.compiled import random_state, standard_normal, uniform
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, Turn, answered, draw_item, hear
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.turns import NO, SILENT, YES
from tests.oracles import model as oracle
from tests.oracles import rays as brute
from tests.tables import table, world_of

Array = npt.NDArray[np.float64]

VOCABULARIES = [["cup"], ["cup", "mug", "tea"], ["pot", "tea"]]
PLACES = [(0.0, 2.0, 1.2), (0.5, 2.0, 1.2), (-0.6, 1.8, 1.3)]
PRIOR = [0.5, 0.2, 0.3]


def heard(problem: Problem, desired: int, draws: int, prior: list[float] = PRIOR) -> Array:
    belief, found = np.array(prior), np.empty((draws, len(prior)))
    state, smoothed = random_state(5), float(belief @ problem.tables.smoothing)
    for draw in range(draws):
        hear(belief, smoothed, desired, Turn(NOBODY, 0, WAITED), found[draw], state, problem.tables)
    return found


@pytest.mark.parametrize("desired", [0, 1, 2])
def test_words_counted_against_the_oracle(desired: int) -> None:
    problem, draws = table(VOCABULARIES, p_g=0.0, alpha=0.35), 20_000
    world = world_of(problem)
    expected: dict[tuple[float, ...], float] = {}
    for words in [[], *([word] for word in world.words)]:
        belief = tuple(round(x, 9) for x in oracle.posterior(PRIOR, words, None, None, world))
        expected[belief] = expected.get(belief, 0.0) + oracle.base_chance(words, desired, world)
    counts = Counter(tuple(round(float(x), 9) for x in row) for row in heard(problem, desired, draws))
    assert set(counts) <= set(expected)
    for belief, chance in expected.items():
        assert abs(counts[belief] / draws - chance) <= 4 * math.sqrt(chance * (1 - chance) / draws)


def oracle_beliefs(problem: Problem, desired: int, draws: int, *, exact: bool) -> Array:
    """Posteriors after gestures drawn by the oracle, no word heard."""
    world, rng = world_of(problem), np.random.default_rng(1)
    items = brute.directions(world.head, world.places)
    angles = brute.angles(brute.draw(items[desired], world.sigma, draws, rng), items)
    missed = np.array([brute.miss_chance(items, i, world.sigma, world.threshold, rng)[0] for i in range(len(items))])
    null = 1 - world.p_g * (1 - missed) if exact else np.full(len(items), 1 - world.p_g)
    density = np.exp(-0.5 * (angles / world.sigma) ** 2)
    if exact:
        density /= np.sin(np.maximum(angles, 1e-3))
    seen = (rng.random(draws) < world.p_g) & (angles.min(axis=1) <= world.threshold)
    joint = np.array(PRIOR) * np.where(seen[:, None], density, null)
    return np.asarray(joint / joint.sum(axis=1)[:, None])


@pytest.mark.parametrize("likelihood", ["eq7", "exact"])
@pytest.mark.parametrize("desired", [0, 1, 2])
def test_pointing_has_the_moments_of_the_oracle(likelihood: str, desired: int) -> None:
    # Twins in their words, so that pointing alone moves the belief.
    problem = table([["cup"]] * 3, places=PLACES, p_g=0.7, sigma=0.2, gesture_likelihood=likelihood)
    draws = 10_000
    found = heard(problem, desired, draws)
    expected = oracle_beliefs(problem, desired, draws, exact=likelihood == "exact")
    for moment in (1, 2):
        gap = (found**moment).mean(axis=0) - (expected**moment).mean(axis=0)
        error = np.sqrt(((found**moment).var(axis=0) + (expected**moment).var(axis=0)) / draws)
        assert (np.abs(gap) <= 4 * error + 2e-4).all()
    assert found.sum(axis=1) == pytest.approx(np.ones(draws))


def test_pointing_has_the_spread_and_the_roll_of_the_model() -> None:
    """With items ahead, behind, to the right and above, a posterior gives away its ray: Eq. 7 solved for the angles."""
    sigma, draws = 0.4, 20_000
    places = [(0.0, 1.0, 1.6), (0.0, -1.0, 1.6), (1.0, 0.0, 1.6), (0.0, 0.0, 2.6)]
    problem = table([["cup"]] * 4, places=places, p_g=1 - 1e-9, sigma=sigma, gesture_threshold=math.pi)
    found = heard(problem, 0, draws, [0.25] * 4)
    gap = 2 * sigma**2 * np.log(found / found[:, :1])  # the square of the own angle less that of each item's
    own = (math.pi**2 + gap[:, 1]) / (2 * math.pi)  # the one behind is at pi less the own angle
    assert abs((own**2).mean() / sigma**2 - 1) <= 4 * math.sqrt(2 / draws)
    assert abs(np.mean(own > 2 * sigma) - 0.0455) <= 4 * math.sqrt(0.0455 / draws)
    sideways = np.cos(np.sqrt(own[:, None] ** 2 - gap[:, 2:])) / np.sin(own)[:, None]  # cosine and sine of the roll
    assert (sideways**2).sum(axis=1) == pytest.approx(np.ones(draws), abs=1e-3)
    assert np.abs(sideways.mean(axis=0)).max() <= 4 * math.sqrt(0.5 / draws)
    assert np.abs((sideways**2).mean(axis=0) - 0.5).max() <= 4 * math.sqrt(0.125 / draws)


@pytest.mark.parametrize("desired", [0, 2])
def test_exact_pointing_learns_from_no_gesture(desired: int) -> None:
    """An item alone is missed more often than two near one another: silence of the arm speaks for it."""
    places = [(-2.0, 0.5, 1.2), (0.5, 2.0, 1.2), (0.9, 1.8, 1.2)]
    problem = table([["cup"]] * 3, places=places, p_g=0.9, sigma=0.3, gesture_likelihood="exact")
    world, draws = world_of(problem), 4_000
    items, rng = brute.directions(world.head, world.places), np.random.default_rng(2)
    null = [1 - 0.9 * (1 - brute.miss_chance(items, item, 0.3, 0.3, rng)[0]) for item in range(3)]
    joint = np.array(PRIOR) * null
    expected = joint / joint.sum()
    assert abs(expected[0] - PRIOR[0]) > 0.03
    same = np.abs(heard(problem, desired, draws) - expected).max(axis=1) < 2e-3
    error = math.sqrt(null[desired] * (1 - null[desired]) / draws)
    assert abs(same.mean() - null[desired]) <= 4 * error + 2e-3


def test_exact_pointing_leaves_the_belief_where_it_was_on_average() -> None:
    problem = table(VOCABULARIES, places=PLACES, p_g=0.7, sigma=0.2, gesture_likelihood="exact")
    draws, total, variance = 8_000, np.zeros(3), np.zeros(3)
    for desired, chance in enumerate(PRIOR):
        found = heard(problem, desired, draws)
        total += chance * found.mean(axis=0)
        variance += chance**2 * found.var(axis=0) / draws
    assert (np.abs(total - PRIOR) <= 4 * np.sqrt(variance) + 1e-3).all()


def test_what_was_impossible_stays_so() -> None:
    problem = table(VOCABULARIES, places=PLACES, p_g=0.5)
    found = heard(problem, 2, 500, [0.0, 0.4, 0.6])
    assert (found[:, 0] == 0).all()
    assert np.isfinite(found).all()


@pytest.mark.parametrize("about", [0, 2])
@pytest.mark.parametrize(("answer", "words"), [(YES, ["yes"]), (NO, ["no"])])
def test_answers_equal_the_oracle(about: int, answer: int, words: list[str]) -> None:
    rate, belief = 0.4, np.empty(3)
    problem = table(VOCABULARIES, p_truth=0.85, p_l=rate)
    world = world_of(problem)
    chance = answered(np.array(PRIOR), Turn(about, 0, ASKED), answer, belief, problem.tables)
    assert belief.tolist() == pytest.approx(oracle.posterior(PRIOR, words, None, about, world), rel=1e-9)
    expected = sum(p * rate * oracle.class_chance(answer == YES, i, about, world) for i, p in enumerate(PRIOR))
    assert chance == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("about", "answer", "expected"), [(1, SILENT, 0.6), (NOBODY, SILENT, 1.0), (NOBODY, YES, 1.0)])
def test_silence_and_no_question_move_nothing(about: int, answer: int, expected: float) -> None:
    belief, tables = np.empty(3), table(VOCABULARIES, p_l=0.4).tables
    assert answered(np.array(PRIOR), Turn(about, 0, ASKED), answer, belief, tables) == pytest.approx(expected)
    assert belief.tolist() == PRIOR


def test_draw_item_inverts_the_distribution() -> None:
    belief = np.array([0.0, 0.25, 0.0, 0.75, 0.0])
    assert [draw_item(belief, x) for x in (0.0, 0.2499, 0.2501, 0.9999, 1.0)] == [1, 1, 3, 3, 3]


def test_uniform_and_normal_numbers() -> None:
    state = random_state(3)
    numbers = np.array([uniform(state) for _ in range(20_000)])
    assert numbers.min() >= 0
    assert numbers.max() < 1
    shares = np.histogram(numbers, 10, (0, 1))[0] / len(numbers)
    assert np.abs(shares - 0.1).max() <= 4 * math.sqrt(0.09 / len(numbers))
    normal = np.array([standard_normal(state) for _ in range(20_000)])
    assert abs(normal.mean()) <= 4 / math.sqrt(len(normal))
    assert abs((normal**2).mean() - 1) <= 4 * math.sqrt(2 / len(normal))
    assert abs(np.mean(np.abs(normal) > 2) - 0.0455) <= 4 * math.sqrt(0.0455 / len(normal))


def test_split_mix_by_its_published_numbers() -> None:
    """First output of SplitMix64 from seed 1234567 (Rosetta Code): 6457827717110365317."""
    assert uniform(random_state(1234567)) == (6457827717110365317 >> 11) * 2.0**-53

"""Eq. 7, and the density of the sampled rays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core import gesture
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.rays import LARGEST_EXACT, angle_between, miss_chances, turned
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.turns import constant_chances
from fetch_pomdp.errors import ModelError, ObservationError
from tests.oracles import model as oracle
from tests.oracles import rays as brute
from tests.tables import table, world_of

FORWARD = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)])  # a right angle apart, at head height
HEAD = (0.0, 0.0, 1.6)
CROWDED = table(
    [[word] for word in "abcde"],
    places=[(0.0, 2.0, 0.75), (0.5, 2.0, 0.75), (0.6, 1.9, 0.75), (-1.4, 1.0, 0.75), (0.2, -2.0, 0.9)],
    gesture_likelihood="exact",
    sigma=0.25,
)


def aimed(angle: float) -> Ray:
    """A ray at an angle off the first item of FORWARD, away from the second."""
    return Ray(HEAD, (-math.sin(angle), math.cos(angle), 1.6))


def density(ray: Ray | None, problem: Problem) -> list[float]:
    return [float(x) for x in np.exp(gesture.log_likelihood(ray, problem))]


def test_true_gaussian_density_by_hand() -> None:
    # 0.1 / (0.15 sqrt(2 pi)) = 0.26596152; one sigma off: times exp(-1/2).
    assert density(aimed(0.0), FORWARD)[0] == pytest.approx(0.26596152, rel=1e-7)
    assert density(aimed(0.15), FORWARD)[0] == pytest.approx(0.26596152 * 0.60653066, rel=1e-7)
    assert density(aimed(-0.3 + 1e-9), FORWARD)[0] == pytest.approx(0.26596152 * 0.13533528, rel=1e-6)


def test_every_item_is_judged_by_its_own_angle() -> None:
    found = density(aimed(0.1), FORWARD)
    assert found[1] == pytest.approx(0.26596152 * math.exp(-0.5 * ((math.pi / 2 + 0.1) / 0.15) ** 2), rel=1e-6)


def test_length_of_the_arm_does_not_matter() -> None:
    near, far = Ray(HEAD, (0.01, 0.1, 1.6)), Ray(HEAD, (1.0, 10.0, 1.6))
    assert density(near, FORWARD) == pytest.approx(density(far, FORWARD), rel=1e-9)


def test_no_gesture_by_hand() -> None:
    assert density(None, FORWARD) == pytest.approx([0.9, 0.9], rel=1e-12)


def test_a_ray_beyond_the_threshold_of_every_item_is_no_gesture() -> None:
    assert density(aimed(0.3 + 1e-6), FORWARD) == pytest.approx([0.9, 0.9], rel=1e-12)
    assert density(aimed(0.3 - 1e-6), FORWARD)[0] < 0.1
    assert not gesture.is_pointing(aimed(0.3 + 1e-6), FORWARD)
    assert gesture.is_pointing(aimed(0.3 - 1e-6), FORWARD)


def test_the_threshold_is_a_parameter() -> None:
    wide = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)], gesture_threshold=0.5)
    assert density(aimed(0.4), wide)[0] == pytest.approx(0.26596152 * math.exp(-0.5 * (0.4 / 0.15) ** 2), rel=1e-6)
    assert density(aimed(0.51), wide) == pytest.approx([0.9, 0.9])


def test_a_ray_in_a_model_without_pointing_says_nothing() -> None:
    nobody_points = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)], p_g=0.0)
    assert gesture.log_likelihood(aimed(0.0), nobody_points).tolist() == [0.0, 0.0]


coordinates = st.floats(-3, 3).map(lambda x: round(x, 3))


@given(head=st.tuples(coordinates, coordinates, coordinates), wrist=st.tuples(coordinates, coordinates, coordinates))
def test_against_the_oracle(head: tuple[float, float, float], wrist: tuple[float, float, float]) -> None:
    places = [item.position for item in CROWDED.scene.items]
    if math.dist(head, wrist) < 1e-6 or min(math.dist(head, place) for place in places) < 1e-6:
        return
    problem = table([[word] for word in "abcde"], places=places, p_g=0.3, sigma=0.2, gesture_threshold=0.4)
    world = world_of(problem)
    angles = [oracle.angle(head, wrist, place) for place in places]
    if abs(min(angles) - 0.4) < 1e-6:
        return
    assert gesture.angles(Ray(head, wrist), problem).tolist() == pytest.approx(angles, abs=1e-6)
    expected = [oracle.gesture_density(head, wrist, item, world) for item in range(5)]
    assert density(Ray(head, wrist), problem) == pytest.approx(expected, rel=1e-4)


def test_small_angles_are_precise() -> None:
    ray = Ray(HEAD, (-1e-9, 1.0, 1.6))
    assert gesture.angles(ray, FORWARD)[0] == pytest.approx(1e-9, rel=1e-5)


@pytest.mark.parametrize(
    "towards", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (0.6, 0.0, -0.8), (-0.48, 0.64, 0.6)]
)
def test_turned_vectors_lie_at_their_angle_all_around(towards: tuple[float, float, float]) -> None:
    direction = np.array(towards, dtype=float)
    for angle in (0.0, 1e-6, 0.3, 1.5, 3.0):
        turns = [np.array(turned(direction, angle, roll)) for roll in np.linspace(0, 2 * math.pi, 8, endpoint=False)]
        for vector in turns:
            assert np.linalg.norm(vector) == pytest.approx(1.0, abs=1e-12)
            assert angle_between(direction, *vector.tolist()) == pytest.approx(angle, abs=1e-9)
        assert np.mean(turns, axis=0) == pytest.approx(math.cos(angle) * direction, abs=1e-12)


# The exact density.


def test_exact_density_by_hand() -> None:
    # Twice the Gaussian, spread over a circle of 2 pi sin t: 0.1 * 2 * 1.6131382 / (2 pi sin 0.15) = 0.34360 per sr.
    exact = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)], gesture_likelihood="exact")
    assert density(aimed(0.15), exact)[0] == pytest.approx(0.343604, rel=1e-5)


def test_exact_density_is_floored_on_the_axis() -> None:
    exact = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)], gesture_likelihood="exact")
    assert density(aimed(0.0), exact)[0] == pytest.approx(0.1 * 2 * 2.6596152 / (2 * math.pi * 1e-3), rel=1e-5)
    assert density(aimed(5e-4), exact)[0] == pytest.approx(density(aimed(0.0), exact)[0], rel=1e-4)


def test_exact_chance_of_no_gesture_for_an_item_alone() -> None:
    # Alone, an item is missed beyond two sigma: 0.0455002639. The other is a right angle away.
    exact = table([["a"], ["b"]], places=[(0.0, 1.0, 1.6), (1.0, 0.0, 1.6)], gesture_likelihood="exact")
    assert density(None, exact) == pytest.approx([1 - 0.1 * (1 - 0.0455002639)] * 2, rel=1e-7)


def test_exact_density_integrates_with_the_chance_of_no_gesture_to_one() -> None:
    items = brute.directions(CROWDED.scene.head, [item.position for item in CROWDED.scene.items])
    null = density(None, CROWDED)
    for item in range(CROWDED.n_items):
        rays, areas = brute.sphere_grid(items[item], rings=220, rolls=60, widest=7 * 0.25)
        angles = brute.angles(rays, items)
        near = (angles <= 0.3).any(axis=1)
        head = np.array(CROWDED.scene.head)
        seen = [Ray(CROWDED.scene.head, tuple((head + ray).tolist())) for ray in rays[near]]
        heights = [math.exp(gesture.log_likelihood(ray, CROWDED)[item]) for ray in seen]
        pointing = float(np.dot(heights, areas[near]))
        assert pointing + null[item] == pytest.approx(1.0, abs=1e-3), item


@pytest.mark.parametrize(("sigma", "threshold"), [(0.15, 0.3), (0.4, 0.1), (0.7, 0.5), (0.7, 1.2)])
def test_miss_chances_against_rays_drawn_one_by_one(sigma: float, threshold: float) -> None:
    items = brute.directions(CROWDED.scene.head, [item.position for item in CROWDED.scene.items])
    found = miss_chances(items, sigma, threshold)
    for item in range(len(items)):
        expected, error = brute.miss_chance(items, item, sigma, threshold, np.random.default_rng(item))
        assert abs(found[item] - expected) <= 4 * error + 1e-5


def test_a_circle_of_rays_that_lies_wholly_near_another_item_is_covered() -> None:
    # From an item straight behind, every ray beyond 2 rad of the one ahead is within pi - 2 rad.
    behind = miss_chances(np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]), 0.7, 2.0)
    assert behind == pytest.approx([0.0, 0.0], abs=1e-12)


def test_miss_chances_of_items_in_one_place_are_those_of_one() -> None:
    one = miss_chances(np.array([[0.0, 1.0, 0.0]]), 0.2, 0.3)
    two = miss_chances(np.array([[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), 0.2, 0.3)
    assert two == pytest.approx([one[0], one[0]], abs=1e-12)
    assert one[0] == pytest.approx(math.erfc(1.5 / math.sqrt(2)), rel=1e-9)


def test_miss_chance_with_a_threshold_around_the_sphere_is_zero() -> None:
    assert miss_chances(np.array([[0.0, 1.0, 0.0]]), 0.7, math.pi) == pytest.approx([0.0], abs=1e-6)


def test_sampler_counted_against_the_exact_density() -> None:
    """Rays of each ring around the desired item, and the missed, within 4 standard errors of the density's integral."""
    problem = table([["a"], ["b"]], places=[(0.0, 2.0, 1.6), (0.8, 2.0, 1.6)], gesture_likelihood="exact", p_g=0.8)
    items = brute.directions(problem.scene.head, [item.position for item in problem.scene.items])
    rng, draws = np.random.default_rng(3), 8_000
    drawn = [gesture.sample(0, problem, constant_chances(0.5, 0.8), rng) for _ in range(draws)]
    edges = [0.0, 0.02, 0.1, 0.2, 0.3, 0.5, 1.2]
    chances = np.zeros(len(edges) - 1)
    rays, areas = brute.sphere_grid(items[0], rings=300, rolls=48, widest=1.2)
    angles = brute.angles(rays, items)
    near = angles.min(axis=1) <= 0.3
    for ray, area, own in zip(rays[near], areas[near], angles[near, 0], strict=True):
        seen = Ray(problem.scene.head, tuple((np.array(problem.scene.head) + ray).tolist()))
        chances[np.searchsorted(edges, own) - 1] += area * math.exp(gesture.log_likelihood(seen, problem)[0])
    seen_angles = [gesture.angles(ray, problem)[0] for ray in drawn if ray is not None]
    counts = np.histogram(seen_angles, edges)[0]
    for count, chance in zip(counts, chances, strict=True):
        assert abs(count / draws - chance) <= 4 * math.sqrt(chance * (1 - chance) / draws) + 2e-3
    missed = sum(ray is None for ray in drawn) / draws
    null = density(None, problem)[0]
    assert abs(missed - null) <= 4 * math.sqrt(null * (1 - null) / draws)


def test_sampled_rays_roll_evenly_around_the_item() -> None:
    problem = table([["a"]], places=[(0.0, 2.0, 1.6)], p_g=0.9, gesture_threshold=1.0)
    rng = np.random.default_rng(5)
    rays = [
        ray for _ in range(4_000) if (ray := gesture.sample(0, problem, constant_chances(0.5, 0.9), rng)) is not None
    ]
    sideways = np.array([[ray.wrist[0], ray.wrist[2] - 1.6] for ray in rays])
    quadrants = np.bincount(2 * (sideways[:, 0] > 0) + (sideways[:, 1] > 0), minlength=4) / len(rays)
    assert np.abs(quadrants - 0.25).max() <= 4 * math.sqrt(0.25 * 0.75 / len(rays))


def test_default_sampler_has_the_angles_of_a_gaussian() -> None:
    """Eq. 7, the default, is no density of these rays, and exempt; their angles are |N(0, sigma)|, cut off."""
    rng, draws = np.random.default_rng(11), 20_000
    drawn = [gesture.sample(0, FORWARD, constant_chances(0.5, 0.1), rng) for _ in range(draws)]
    angles = np.array([gesture.angles(ray, FORWARD)[0] for ray in drawn if ray is not None])
    for low, high in [(0.0, 0.05), (0.05, 0.15), (0.15, 0.3)]:
        chance = 0.1 * (math.erf(high / 0.15 / math.sqrt(2)) - math.erf(low / 0.15 / math.sqrt(2)))
        share = float(np.mean((angles > low) & (angles <= high))) * len(angles) / draws
        assert abs(share - chance) <= 4 * math.sqrt(chance * (1 - chance) / draws)


def test_exact_likelihood_is_refused_above_its_number_of_items() -> None:
    def crowd(count: int) -> Scene:
        items = tuple(Item(id=str(i), position=(i * 0.01, 1.0, 0.0), vocabulary=("a",)) for i in range(count))
        return Scene(items=items, head=HEAD, model=FORWARD.model.with_changes({"gesture_likelihood": "exact"}))

    with pytest.raises(ModelError, match=r"gesture_likelihood: found 'exact' with 1001 items, expected at most 1000"):
        Problem(crowd(LARGEST_EXACT + 1))


def test_rays_are_checked() -> None:
    with pytest.raises(ObservationError, match="wrist: found the position of the head"):
        Ray(HEAD, HEAD)
    with pytest.raises(ObservationError, match="head: found"):
        Ray((0.0, math.nan, 0.0), HEAD)
    with pytest.raises(ObservationError, match="wrist: found"):
        Ray(HEAD, (0.0, 1.0))  # type: ignore[arg-type]
    assert Ray(np.array([0, 0, 0]), np.array([0, 1, 0])) == Ray((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))  # type: ignore[arg-type]

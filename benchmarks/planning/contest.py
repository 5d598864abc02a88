"""Return and decision time of every planner, on the same people.

Contestants take turns in ten rounds, so that a busy minute of the machine falls on all of them. The person of episode k
draws from a stream of the seed and k alone, as in `fetch_pomdp.simulate`: differences between planners are paired.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from fetch_pomdp import (
    Belief,
    ExactAnswers,
    FittedValue,
    PaperAlwaysAsk,
    PaperNeverAsk,
    Problem,
    Scene,
    SparseSampling,
    Threshold,
    tuned,
)
from fetch_pomdp.core.simulation import Episode, run_episode
from planning import DEFAULT, Record
from planning.plain import PlainSparse, World
from planning.timed import Timed
from planning.uct import Style, Uct

SCENES = ("ambiguous", "unambiguous")
EXPLORATION = (5.0, 20.0, 60.0)  # of UCB1, in units of reward; a right pick and a wrong one are 22.5 apart
PARTICLES = 1_000
TUNED_ON = 77  # seed of the people that thresholds are tuned on
ROUNDS = 10
LEAST = 12  # episodes


@dataclass(slots=True)
class Contestant:
    """A planner with a budget; `episodes` is how many the full run plays."""

    name: str
    family: str
    planner: Timed
    episodes: int
    milliseconds: int = 0  # of POUCT, a decision
    exploration: float = 0.0
    played: list[Episode] = field(default_factory=list)


def ours(problem: Problem) -> Iterator[Contestant]:
    """Yield the package's planners and the plain sampler."""
    fitted: tuple[tuple[str, FittedValue], ...] = (
        (DEFAULT, FittedValue()),
        ("FittedValue, 32 rays", FittedValue(rays=32)),
        ("FittedValue, 2 rays", FittedValue(rays=2)),
        ("FittedValue, 1,000 beliefs", FittedValue(beliefs=1_000)),
        ("FittedValue, 40,000 beliefs", FittedValue(beliefs=40_000)),
    )
    for name, planner in fitted:
        yield Contestant(name, "FittedValue", Timed(planner), 6_000)
    yield Contestant("Threshold", "Threshold", Timed(Threshold()), 6_000)
    yield Contestant("Threshold, tuned", "Threshold", Timed(tuned(problem, TUNED_ON)), 6_000)
    yield Contestant("ExactAnswers, default", "ExactAnswers", Timed(ExactAnswers()), 6_000)
    for depth, width, episodes in ((2, 10, 6_000), (3, 10, 2_000)):
        family = "ExactAnswers" if depth == 2 else "ExactAnswers, depth 3"
        yield Contestant(f"ExactAnswers({depth}, {width})", family, Timed(ExactAnswers(depth, width)), episodes)
    pick = Timed(ExactAnswers(2, 10, "pick"))
    yield Contestant("ExactAnswers(2, 10), leaf pick", "ExactAnswers, leaf pick", pick, 6_000)
    for depth, width, episodes in ((2, 10, 6_000), (2, 100, 4_000), (3, 10, 2_000), (4, 10, 240)):
        family = "SparseSampling" if depth == 2 else "SparseSampling, deeper"
        yield Contestant(f"SparseSampling({depth}, {width})", family, Timed(SparseSampling(depth, width)), episodes)
    yield Contestant("PaperNeverAsk", "PaperNeverAsk", Timed(PaperNeverAsk()), 6_000)
    yield Contestant("PaperAlwaysAsk", "PaperAlwaysAsk", Timed(PaperAlwaysAsk()), 6_000)
    plain = Timed(PlainSparse(World(problem)))
    yield Contestant("plain NumPy sparse sampling (2, 10)", "plain NumPy", plain, 1_000)


def theirs(problem: Problem) -> Iterator[Contestant]:
    """Yield POUCT and POMCP by style, time and exploration constant."""
    field_: tuple[tuple[Style, int, int, int], ...] = (  # style, ms a decision, particles (0: POUCT), episodes
        ("random", 10, 0, 60),
        ("greedy", 10, 0, 60),
        ("greedy", 100, 0, 20),
        ("aided", 10, 0, 120),
        ("aided", 100, 0, 30),
        ("aided", 1_000, 0, 12),
        ("aided", 10, PARTICLES, 60),
        ("aided", 100, PARTICLES, 18),
        ("aided", 1_000, PARTICLES, 12),
    )
    for style, milliseconds, particles, episodes in field_:
        solver = "POMCP" if particles else "POUCT"
        for exploration in EXPLORATION:
            uct = Uct(problem, milliseconds / 1_000, exploration, style, particles)
            name = f"pomdp_py {solver}, {style}, {milliseconds:,} ms"
            rival = Contestant(name, f"{solver}, {style}", Timed(uct), episodes, milliseconds, exploration)
            yield rival


def contest(scene: str, share: float, seed: int, say: Callable[[str], None]) -> list[Record]:
    """Play a scene with all contestants. share: of the full number of episodes."""
    problem = Problem(Scene.load(scene))
    slowest = 1_000 if share == 1.0 else 10  # ms
    field_ = [*ours(problem), *(rival for rival in theirs(problem) if rival.milliseconds <= slowest)]
    warm = Belief.uniform(problem.n_items)
    for rival in field_:  # compiled and loaded before the clock starts
        rival.planner.planner.decide(problem, warm, None, rng=np.random.default_rng(0))
    robots = [np.random.default_rng((seed, number)) for number in range(len(field_))]
    for round_ in range(ROUNDS):
        for rival, robot in zip(field_, robots, strict=True):
            goal = max(LEAST, round(rival.episodes * share)) * (round_ + 1) // ROUNDS
            play(rival, problem, goal, (seed, robot))
        say(f"  {scene}: round {round_ + 1} of {ROUNDS}")
    reference = earned(next(rival for rival in field_ if rival.name == DEFAULT))
    return [record(rival, scene, reference) for rival in field_]


def play(rival: Contestant, problem: Problem, goal: int, chance: tuple[int, Generator]) -> None:
    """Play on until a number of episodes is reached; each item is the desired one equally often."""
    seed, robot = chance
    for episode in range(len(rival.played), goal):
        person = np.random.default_rng((seed, episode))
        desired = episode % problem.n_items
        rival.played.append(run_episode(problem, rival.planner, desired, person, robot))


def earned(rival: Contestant) -> list[float]:
    """Return the return of every episode."""
    return [episode.earned for episode in rival.played]


def record(rival: Contestant, scene: str, reference: list[float]) -> Record:
    """Return a contestant's means, with standard errors; `behind` is to the default planner on the same people."""
    returns, times = np.array(earned(rival)), np.array(rival.planner.times)
    behind = returns - np.array(reference[: len(returns)])
    root = np.sqrt(len(returns))
    simulations = rival.planner.planner.simulated if isinstance(rival.planner.planner, Uct) else 0
    return {
        "scene": scene,
        "planner": rival.name,
        "family": rival.family,
        "episodes": len(returns),
        "mean_return": float(returns.mean()),
        "standard_error": float(returns.std(ddof=1) / root),
        "behind": float(behind.mean()),
        "behind_error": float(behind.std(ddof=1) / root),
        "accuracy": float(np.mean([episode.correct for episode in rival.played])),
        "mean_steps": float(np.mean([episode.steps for episode in rival.played])),
        "mean_questions": float(np.mean([episode.questions for episode in rival.played])),
        "decide_median_s": float(np.median(times)),
        "decide_best_s": float(np.quantile(times, 0.05)),
        "milliseconds": rival.milliseconds,
        "simulations_per_s": simulations / float(times.sum()),
        "exploration": rival.exploration,
    }


def best_of_each(records: list[Record]) -> list[Record]:
    """Keep, of contestants that differ in the exploration constant alone, the one that earned most."""
    best: dict[tuple[str, str], Record] = {}
    for found in records:
        key = (found["scene"], found["planner"])
        if key not in best or found["mean_return"] > best[key]["mean_return"]:
            best[key] = found
    return list(best.values())

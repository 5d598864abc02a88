"""Logs of the model's own people, for the tests of fitting."""

from __future__ import annotations

import dataclasses

import numpy as np

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.calibrate.steps import Interaction
from fetch_pomdp.study.encounter import modelled

SCENES = (Scene.load("ambiguous"), Scene.load("unambiguous"))
TRUTH = {"sigma": 0.1, "p_g": 0.4, "p_l": 0.8, "p_answer_again": 0.4, "alpha": 0.1, "p_truth": 0.9}


def logs(truth: dict[str, float], people: int, trials: int, seed: int) -> list[Interaction]:
    rng, robot = np.random.default_rng(seed), Threshold()
    found = []
    for person in range(people):
        scene = SCENES[person % 2]
        problem = Problem(dataclasses.replace(scene, model=scene.model.with_changes(truth)))
        for trial in range(trials):
            events = modelled(Agent(scene, robot, seed=trial), problem, trial % 6, rng)
            found.append(Interaction(scene, trial % 6, str(person), events))
    return found

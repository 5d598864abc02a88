"""The sentences of an explanation on the page: the same English as Python's, and nothing left open in any language."""

from __future__ import annotations

import json
import math
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import playwright

import fetch_pomdp.adapters.web
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explain import explain
from fetch_pomdp.core.explanation import Explanation
from fetch_pomdp.core.observation import Parts
from fetch_pomdp.core.phrases import TEMPLATES
from fetch_pomdp.core.planners.base import Decision, pick_values
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.decisions import phrase_to_json

PAGE = Path(fetch_pomdp.adapters.web.__file__).parent / "page"
ENGINE = Path(playwright.__file__).parent / "driver" / "node"
TEXTS = json.loads((PAGE / "texts.json").read_text(encoding="utf-8"))
PRIORS = [np.zeros(6), np.array([0.0, 0.0, 0.0, -1.0, -2.0, -2.0]), np.array([0.0, *[-math.inf] * 5])]
# What the modules of the page ask of a browser when they are loaded, and their sentences in each language.
SCRIPT = """
import { readFileSync } from "node:fs";
globalThis.fetch = async () => ({ json: async () => JSON.parse(readFileSync(PAGE + "/texts.json", "utf8")) });
globalThis.localStorage = { setItem() {} };
globalThis.document = { documentElement: {}, querySelectorAll: () => [] };
const { phrase, setLanguage } = await import("file://" + PAGE + "/texts.js");
const phrases = JSON.parse(readFileSync(0, "utf8"));
const said = ["en", "de"].map((language) => { setLanguage(language); return [language, phrases.map(phrase)]; });
console.log(JSON.stringify(Object.fromEntries(said)));
"""


def said_by_the_page(phrases: list[dict[str, Any]]) -> dict[str, list[str]]:
    """Each phrase, by language, as the page fills it."""
    command = [str(ENGINE), "--input-type=module", "-e", f"const PAGE = {json.dumps(str(PAGE))};{SCRIPT}"]
    done = subprocess.run(command, input=json.dumps(phrases), check=True, capture_output=True, text=True, timeout=60)
    said: dict[str, list[str]] = json.loads(done.stdout)
    return said


def explanations(count: int) -> list[Explanation]:
    """Reasons of all kinds of decisions, at random beliefs from all kinds of evidence."""
    rng = np.random.default_rng(0)
    return [_explanation(rng) for _ in range(count)] + [_alone()]


def _explanation(rng: np.random.Generator) -> Explanation:
    rewards = rng.choice(["usual", "dear", "free"], p=[0.8, 0.1, 0.1])
    mapping = Scene.load("ambiguous").to_mapping()
    mapping["rewards"] = {
        "usual": {},
        "dear": {"pick_wrong": -1e6},
        "free": {"pick_wrong": 3.0, "point": 0, "wait": 0},
    }[rewards]
    problem = Problem(Scene.from_mapping(mapping))
    words, answers, pointing = (rng.choice([0.0, 0.001, 1.0, 5.0]) * rng.normal(size=6).round(1) for _ in "123")
    prior = PRIORS[rng.integers(len(PRIORS))]
    evidence = Evidence.none(prior).plus(Parts(words, answers, pointing), answered=False)
    if rng.random() < 0.2:
        evidence = evidence.asked(int(rng.integers(6)))
    weights = np.exp(prior + words + answers + pointing)
    belief = Belief(weights / weights.sum())
    likely, item = int(belief.probabilities.argmax()), int(rng.integers(6))
    actions: list[Action] = [Wait(), Point(likely), Point(item), Pick(likely), Pick(item)]
    action = actions[rng.integers(5)]
    wait, question = rng.choice([math.nan, -2.0, 0.75, 4.5], size=2)
    error = float(rng.choice([0.0, 2.0]))
    values = pick_values(belief.probabilities, problem)
    decision = Decision(action, float(wait), np.full(6, question), values, error, np.full(6, error))
    return explain(decision, belief, evidence, problem.scene)


def _alone() -> Explanation:
    scene = Scene.load("ambiguous")
    alone = Scene(items=scene.items[:1], head=scene.head)
    decision = Decision(Pick(0), math.nan, np.array([math.nan]), np.array([10.0]))
    return explain(decision, Belief([1.0]), Evidence.none(np.zeros(1)), alone)


def test_the_page_has_pythons_english() -> None:
    assert {key: text for key, text in TEXTS["en"].items() if key.startswith("why_")} == TEMPLATES


def test_the_page_says_what_python_prints_and_leaves_nothing_open() -> None:
    reasons = explanations(400)
    phrases = [phrase_to_json(why.phrase()) for why in reasons]
    assert set(re.findall(r'"key": "(\w+)"', json.dumps(phrases))) == TEMPLATES.keys()
    said = said_by_the_page(phrases)
    assert [sentence.replace("−", "-") for sentence in said["en"]] == [str(why) for why in reasons]
    assert [sentence for sentence in said["de"] if re.search("[{}]|undefined|null", sentence)] == []


def test_german_names_items_and_has_its_own_numbers() -> None:
    belief = np.array([0.05, 0.05, 0.04, 0.72, 0.07, 0.07])
    decision = Decision(Pick(3), 1.25, np.full(6, -4.5), 22.5 * belief - 12.5)
    why = explain(decision, Belief(belief), Evidence.none(np.log(belief)), Scene.load("ambiguous"))
    (german,) = said_by_the_page([phrase_to_json(why.phrase())])["de"]
    assert german == (
        "er gibt marker-2: marker-2 ist zu 72\N{NO-BREAK SPACE}% wahrscheinlich; "
        "Geben ist 3,70 wert, Warten 1,25 und Fragen −4,50"
    )

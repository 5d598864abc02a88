"""All parameters from a set of recorded interactions, for all people together and for each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.model import Model
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.calibrate.bias import Offset, offsets
from fetch_pomdp.study.calibrate.confusion import Confusion, confusion_of
from fetch_pomdp.study.calibrate.estimate import ENOUGH_PEOPLE, Estimate, Likelihood, Pieces, estimates
from fetch_pomdp.study.calibrate.likelihood import Modality, Records, records_of
from fetch_pomdp.study.calibrate.scales import ANSWERING, NAMING, POINTING, SPEAKING, Scale
from fetch_pomdp.study.calibrate.steps import Interaction

# Why logs may tell nothing, or only one limit, of a parameter.
NEEDS = {
    "sigma": "pointing",
    "p_g": "steps with pointing and steps without",
    "p_l": "steps with words and steps without",
    "p_answer_again": "answers, or their absence, in steps after a wait",
    "alpha": "words of the items, heard for items that they are not words of",
    "p_truth": "answers to questions, some of them false",
}


@dataclass(frozen=True, slots=True)
class Calibration:
    """What a set of interactions tells of the model's parameters."""

    interactions: int
    people: int
    steps: int
    estimates: tuple[Estimate, ...]
    bias: tuple[Offset, ...]  # to the right and up; empty where too few pointed
    confusion: Confusion

    def changes(self) -> dict[str, float]:
        """Return the parameters of which the logs tell anything, for `Model.with_changes`."""
        return {one.name: one.value for one in self.estimates if one.known != "none"}

    def unknown(self) -> dict[str, str]:
        """Return the parameters that the logs do not bound from both sides, and what it would take."""
        return {one.name: NEEDS[one.name] for one in self.estimates if one.known != "both"}


def calibrate(interactions: Sequence[Interaction]) -> Calibration:
    """Fit the model to interactions whose desired items are known. Raises StudyError if none of them has a step.

    People are the independent pieces where there are `ENOUGH_PEOPLE`, else interactions are (`estimate.estimates`).
    """
    records = records_of(interactions)
    if not len(records.interaction):
        raise StudyError("found no observations, expected recorded interactions with some", field="logs")
    people = len(np.unique(records.person))
    piece = records.person if people >= ENOUGH_PEOPLE else records.interaction
    pieces = _pieces(piece, records.scene)
    number = dict(zip(records.interaction.tolist(), pieces.of_step.tolist(), strict=True))
    heard = [(number[index], one) for index, one in enumerate(interactions) if index in number]
    return Calibration(
        interactions=len(interactions),
        people=people,
        steps=len(records.interaction),
        estimates=tuple(_estimates(records, pieces)),
        bias=offsets(heard, pieces.stratum),
        confusion=confusion_of(one.events for one in interactions),
    )


def _pieces(piece: Integers, scene: Integers) -> Pieces:
    """Return the pieces, with as strata the tables that each was at."""
    names, of_step = np.unique(piece, return_inverse=True)
    tables = [tuple(np.unique(scene[of_step == number]).tolist()) for number in range(len(names))]
    strata = {table: number for number, table in enumerate(dict.fromkeys(tables))}
    return Pieces(of_step, np.array([strata[table] for table in tables]))


def by_person(interactions: Sequence[Interaction]) -> dict[str, Calibration]:
    """Fit the model to each person's interactions, by the person's name; people without an observation are left out."""
    people: dict[str, list[Interaction]] = {}
    for one in interactions:
        people.setdefault(one.person, []).append(one)
    return {name: calibrate(theirs) for name, theirs in people.items() if len(records_of(theirs).interaction)}


def _estimates(records: Records, pieces: Pieces) -> list[Estimate]:
    found: list[Estimate] = []
    groups: tuple[tuple[tuple[Scale, ...], tuple[Modality, ...]], ...] = (
        (POINTING, (records.pointing,)),
        (SPEAKING, (records.naming, records.answering)),
        (NAMING, (records.naming,)),
        (ANSWERING, (records.answering,)),
    )
    for scales, modalities in groups:
        found += estimates(scales, _likelihood(scales, modalities), pieces)
    return found


def _likelihood(scales: tuple[Scale, ...], modalities: tuple[Modality, ...]) -> Likelihood:
    """Return the log-likelihood of each step at places on the lines of some parameters.

    The others stand still, at values that allow every observation.
    """
    still = {"p_l": 0.5, "p_answer_again": 0.5, "p_truth": 0.75, "alpha": Model().alpha}

    def likelihood(places: Vector) -> Vector:
        changes = {scale.name: scale.value(place) for scale, place in zip(scales, places.tolist(), strict=True)}
        return np.asarray(sum(modality.log_likelihood({**still, **changes}) for modality in modalities))

    return likelihood

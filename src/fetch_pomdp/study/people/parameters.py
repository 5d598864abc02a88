"""All parameters of a simulated population, and how its persons differ."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.people import traits
from fetch_pomdp.study.people.grammar import GRAMMARS
from fetch_pomdp.study.people.traits import Traits

CONFUSIONS: Mapping[str, Mapping[str, float]] = {
    "yes": {"hand": 0.05, "the": 0.01, "no": 0.003},
    "yeah": {"the": 0.02},
    "no": {"not": 0.02, "hand": 0.02},
    "not": {"that": 0.04},
    "other": {"that": 0.04},
    "the": {"that": 0.1},
    "that": {"the": 0.05},
}


def _in(low: float, high: float, expected: str, default: float) -> Any:
    return dataclasses.field(default=default, metadata={"low": low, "high": high, "expected": expected})


def _rate(default: float) -> Any:
    return _in(0.0, 1.0, "a probability from 0 to 1", default)


def _seconds(default: float) -> Any:
    return _in(0.0, 600.0, "a time from 0 to 600 s", default)


def _duration(default: float) -> Any:
    return _in(0.01, 600.0, "a time from 0.01 to 600 s", default)


def _spread(default: float) -> Any:
    return _in(0.0, 10.0, "a spread from 0 to 10", default)


def _angle(default: float) -> Any:
    return _in(0.0, 0.7, "an angle from 0 to 0.7 rad", default)


@dataclass(frozen=True, slots=True, kw_only=True)
class People:
    """A population. Raises StudyError for a parameter out of its range.

    Times are medians: a person's own is log-normal around it with the spread named beside it, and each single delay
    log-normal around the person's with `delay_spread`. A rate marked "persons" is that of the median person: persons
    differ by N(0, `rate_spread`) in its logit. Defaults start from our first fit to the paper's table, where it had the
    parameter ("fit"), or from the source named.
    """

    # Asking for the item.
    begin_delay: float = _seconds(0.5)  # s after the countdown, a reaction to it; sets the phase to the robot's steps
    word_time: float = _duration(0.35)  # s a word: 170 words a minute, at the slow end of talk
    word_time_spread: float = _spread(0.15)  # log, persons: most within 130 and 230 words a minute
    descriptors: tuple[float, ...] = (0.02, 0.28, 0.4, 0.3)  # chance of naming the item by 0, 1, 2 ... of its words
    p_name: float = _rate(0.9)  # chance that the item's first word is among them
    grammar: str = "study"  # of requests: of the published studies, or "reader", that of the robot's reader backwards
    p_place: float = _rate(0.05)  # chance of "next to the <other item>", persons: "many" did (Section V)
    p_unknown: float = _rate(0.0)  # chance, with the reader's grammar, that a phrase is a word that no reader knows
    p_reword: float = _rate(0.5)  # chance that a repeated request is worded anew
    patience: float = _duration(7.0)  # s of a silent robot before the request is repeated (fit: 7.0)
    patience_spread: float = _spread(0.3)  # log, persons
    p_heed: float = _rate(0.0)  # chance to repeat at once when told "I am listening": the paper's robot never said it
    delay_spread: float = _spread(0.25)  # log, of every single delay and duration of pointing
    rate_spread: float = _spread(0.5)  # logit, of every rate that differs between persons

    # Pointing, seen at 30 frames a second.
    p_point: float = _rate(0.96)  # chance to point with a request, persons (fit)
    p_point_again: float = _rate(0.8)  # chance to point while denying
    point_delay: float = _seconds(0.27)  # s, from the first word until the arm moves (fit)
    point_rise: float = _seconds(0.3)  # s, from rest to the item: frames of it sweep over the table
    point_time: float = _duration(1.56)  # s that the arm is held (fit)
    bias: float = _angle(0.012)  # rad, each axis: constant of a person
    bias_episode: float = _angle(0.008)  # rad, each axis: anew with each pointing
    jitter: float = _angle(0.03)  # rad, each axis: moves while the arm is held (fit: 0.042 with the tracker's; with the
    # two above it puts a fifth of all pointings nearer the wrong one of two items 15 cm apart, as in the fit)
    jitter_time: float = _duration(0.3)  # s, over which the jitter is correlated (fit: 1.9 frames/s count as different)
    tracker_noise: float = _in(0.0, 0.1, "a noise from 0 to 0.1 per m", 0.0014)  # m at 1 m, of depth, grows with its
    # square; random error of a Kinect: Khoshelham and Elberink 2012
    sight_latency: float = _seconds(0.15)  # s from a frame to its skeleton (Kinect, one person: Livingston et al. 2012)
    reach: float = _in(0.1, 2.0, "a length from 0.1 to 2 m", 0.65)  # m, from head to wrist

    # Answering.
    p_answer: float = _rate(0.97)  # chance of any answer, persons
    p_unsure: float = _rate(0.01)  # chance that it is "I don't know"
    answer_delay: float = _seconds(0.5)  # s after a question; 0.2 s between people (Stivers et al. 2009)
    answer_delay_spread: float = _spread(0.3)  # log, persons
    p_late: float = _rate(0.05)  # chance of an answer that takes `late_delay` more
    late_delay: float = _seconds(1.5)  # s
    p_elaborate: float = _rate(0.6)  # chance to say more than no to a wrong item: "no the other one", "no the bowl"
    p_repeat_answer: float = _rate(
        0.7
    )  # chance that patience lost after a question repeats the answer, not the request
    contrast: float = _in(0.0, 20.0, "a weight from 0 to 20", 1.0)  # of words that the item asked about lacks: 0 any
    # word, 1 the literal listener's odds, more the implicature speaker (Frank and Goodman 2012)
    reading: float = _angle(0.01)  # rad, each axis: how far off the robot's arm is read; "near perfect" (Section III-C)
    reading_correlation: float = _rate(0.5)  # of those errors within a trial
    p_flip: float = _rate(0.03)  # chance of the wrong answer, persons (fit: 0.07, with misreadings and late answers)
    flip_correlation: float = _rate(0.2)  # within a trial
    p_correct: float = _rate(0.3)  # chance to notice a wrong answer of one's own and to correct it unasked
    correct_delay: float = _seconds(1.2)  # s after the wrong answer

    # What is heard.
    p_miss: float = _rate(0.09)  # chance that a request is missed as a whole at 1 m, persons (fit: .13 and .25 at the
    # two layouts' 1.49 m and 3.31 m from head to items)
    miss_correlation: float = _rate(0.0)  # within a trial
    p_lost: float = _rate(0.025)  # chance that an answer is missed at 1 m, persons: said when it is listened for (fit)
    lost_correlation: float = _rate(0.2)  # within a trial
    miss_per_doubling: float = _in(0.0, 5.0, "a slope from 0 to 5", 0.7)  # logit of both, a doubling of distance: -6 dB
    latency: float = _seconds(0.5)  # s from the end of an utterance to its words: the silence that ends it
    p_substitute: float = _rate(0.05)  # a word of the scene heard as another word of the scene (fit)
    p_delete: float = _rate(0.03)  # a word not heard (5 in 100 words go wrong with clear voices in 20 dB)
    p_insert: float = _rate(0.02)  # a word heard that was not said, after each word
    confusions: Mapping[str, Mapping[str, float]] = dataclasses.field(default_factory=lambda: CONFUSIONS)
    # said, heard, chance; "yes" as "hand": Section V. Others: what PocketSphinx did to synthetic voices in noise

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            if rule := field.metadata:
                found = getattr(self, field.name)
                value = checks.within(found, rule["low"], rule["high"], field.name, rule["expected"], StudyError)
                object.__setattr__(self, field.name, value)
        if self.grammar not in GRAMMARS:
            found = f"found {checks.shown(self.grammar)}, expected one of {', '.join(GRAMMARS)}"
            raise StudyError(found, field="grammar")
        object.__setattr__(self, "descriptors", _shares(self.descriptors))
        object.__setattr__(self, "confusions", _table(self.confusions))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a TOML file of parameters; those it leaves out keep their defaults.

        Raises StudyError, with file, line and field, for what is no population.
        """
        return read_toml(path, StudyError).build(cls.from_mapping)

    @classmethod
    def from_mapping(cls, data: Mapping[str, Any]) -> Self:
        """Build a population from the fields of such a file. Raises StudyError for an unknown name."""
        checks.known(data, [field.name for field in dataclasses.fields(cls)], "parameter", StudyError)
        return cls(**data)

    def traits(self, rng: Generator) -> Traits:
        """Draw one person."""
        return traits.draw(self, rng)


def _shares(value: object) -> tuple[float, ...]:
    field, expected = "descriptors", "a list of probabilities that sum to 1"
    if isinstance(value, str) or not isinstance(value, list | tuple) or not value:
        raise StudyError(f"found {checks.shown(value)}, expected {expected}", field=field)
    shares = tuple(checks.within(part, 0.0, 1.0, field, expected, StudyError) for part in value)
    if abs(sum(shares) - 1.0) > 1e-9:
        raise StudyError(f"found a sum of {sum(shares):.6g}, expected {expected}", field=field)
    return shares


def _table(value: object) -> dict[str, dict[str, float]]:
    """Check a confusion table: words as they are tokenized, and chances that leave a word 0 or more of being right."""
    table: dict[str, dict[str, float]] = {}
    for said, row in checks.mapping(value, "confusions", StudyError).items():
        path = f"confusions.{said}"
        table[said] = {}
        for heard, chance in checks.mapping(row, path, StudyError).items():
            place = f"{path}.{heard}"
            for word in (said, heard):
                if tokenize(word) != (word,):
                    raise StudyError(f"found {checks.shown(word)}, expected a word in lower case", field=place)
            table[said][heard] = checks.within(chance, 0.0, 1.0, place, "a probability from 0 to 1", StudyError)
        if sum(table[said].values()) > 1.0 + 1e-9:
            raise StudyError("found chances of more than 1 together, expected at most 1", field=path)
    return table

"""Eq. 4-6 and Table I."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.action import Point, Wait
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.unigram import Utterance
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import constant_chances
from tests.oracles import model as oracle
from tests.tables import table, world_of

AMBIGUOUS = Problem(Scene.load("ambiguous"))
UNEQUAL = table([["cup"], ["cup", "mug", "tea"], ["pot", "tea"]], alpha=0.2)
ANSWERS = oracle.YES_WORDS + oracle.NO_WORDS


def base(words: str, problem: Problem) -> list[float]:
    return [float(x) for x in np.exp(unigram.base_log_likelihood(tuple(words.split()), problem))]


def response(words: str, asked: int | None, problem: Problem, rate: float = 0.95) -> list[float]:
    found = unigram.response_log_likelihood(tuple(words.split()), asked, problem, constant_chances(rate, 0.1))
    return [float(x) for x in np.exp(found)]


def test_one_base_word_by_hand() -> None:
    # 12 words in all, 4 an item: p(marker | marker) = 1.2 / (4 + 0.2 * 12) = 0.1875, p(marker | bowl) = 0.03125.
    own, other = 0.95 * 0.1875, 0.95 * 0.03125
    assert base("marker", AMBIGUOUS) == pytest.approx([other, other, own, own, other, other], rel=1e-12)


def test_words_multiply_and_speech_counts_once_by_hand() -> None:
    own, other = 0.95 * 0.1875**2, 0.95 * 0.03125**2
    mixed = 0.95 * 0.1875 * 0.03125
    assert base("green marker", AMBIGUOUS) == pytest.approx([other, other, own, own, other, other], rel=1e-12)
    assert base("marker spoon", AMBIGUOUS) == pytest.approx([other, other, mixed, mixed, mixed, mixed], rel=1e-12)
    assert base("marker marker", AMBIGUOUS) == pytest.approx([other, other, own, own, other, other], rel=1e-12)


def test_no_base_word_by_hand() -> None:
    assert base("", AMBIGUOUS) == pytest.approx([0.05] * 6, rel=1e-12)


def test_vocabularies_of_unequal_size_by_hand() -> None:
    # 4 words in all: denominators 1 + 0.8, 3 + 0.8 and 2 + 0.8.
    assert base("cup", UNEQUAL) == pytest.approx([0.95 * 1.2 / 1.8, 0.95 * 1.2 / 3.8, 0.95 * 0.2 / 2.8], rel=1e-12)
    assert base("tea", UNEQUAL) == pytest.approx([0.95 * 0.2 / 1.8, 0.95 * 1.2 / 3.8, 0.95 * 1.2 / 2.8], rel=1e-12)


@pytest.mark.parametrize("problem", [AMBIGUOUS, UNEQUAL])
def test_chances_of_single_words_and_silence_sum_to_one(problem: Problem) -> None:
    spoken = np.sum([base(word, problem) for word in (*problem.words, "")], axis=0)
    assert spoken == pytest.approx(np.ones(problem.n_items), abs=1e-12)


@pytest.mark.parametrize(
    ("words", "own", "other", "nobody"),
    [
        ("yes", 0.95 * 0.99 / 4, 0.95 * 0.01 / 4, 0.95 * 0.5 / 4),
        ("nope", 0.95 * 0.01 / 4, 0.95 * 0.99 / 4, 0.95 * 0.5 / 4),
        ("no no", 0.95 * 0.01**2 / 16, 0.95 * 0.99**2 / 16, 0.95 * 0.25 / 16),
        ("yes not", 0.95 * 0.99 * 0.01 / 16, 0.95 * 0.99 * 0.01 / 16, 0.95 * 0.25 / 16),
        ("", 0.05, 0.05, 0.05),
    ],
)
def test_table_one_by_hand(words: str, own: float, other: float, nobody: float) -> None:
    assert response(words, 1, UNEQUAL) == pytest.approx([other, own, other], rel=1e-12)
    assert response(words, None, UNEQUAL) == pytest.approx([nobody] * 3, rel=1e-12)


@pytest.mark.parametrize("word", oracle.YES_WORDS)
def test_positive_words(word: str) -> None:
    assert response(word, 0, UNEQUAL)[0] > response(word, 0, UNEQUAL)[1]


@pytest.mark.parametrize("word", oracle.NO_WORDS)
def test_negative_words(word: str) -> None:
    assert response(word, 0, UNEQUAL)[0] < response(word, 0, UNEQUAL)[1]


@pytest.mark.parametrize("asked", [None, 0, 2])
def test_chances_of_single_answers_and_silence_sum_to_one(asked: int | None) -> None:
    total = np.sum([response(word, asked, UNEQUAL, 0.3) for word in (*ANSWERS, "")], axis=0)
    assert total == pytest.approx(np.ones(3), abs=1e-12)


def test_rate_is_halved_after_a_wait_by_p_answer_again() -> None:
    problem = table([["cup"], ["mug"]], p_answer_again=0.5, p_l=0.9)
    assert problem.step_chances(Point(0)).other == pytest.approx(0.9)
    assert problem.step_chances(Wait()).other == pytest.approx(0.45)
    assert table([["cup"]]).step_chances(Wait()).other == pytest.approx(0.95)
    assert response("yes", 0, problem, 0.45) == pytest.approx([0.45 * 0.99 / 4, 0.45 * 0.01 / 4])
    assert response("", 0, problem, 0.45) == pytest.approx([0.55, 0.55])


def test_nobody_answers_at_rate_zero() -> None:
    assert response("yes", 0, UNEQUAL, 0.0) == [0.0, 0.0, 0.0]
    assert response("", 0, UNEQUAL, 0.0) == [1.0, 1.0, 1.0]


def test_a_person_who_never_errs() -> None:
    problem = table([["cup"], ["mug"]], p_truth=1.0)
    assert response("yes", 0, problem) == pytest.approx([0.95 / 4, 0.0])
    assert response("no", 0, problem) == pytest.approx([0.0, 0.95 / 4])
    assert response("yes no", 0, problem) == [0.0, 0.0]


def test_split_by_the_paper_s_lists() -> None:
    found = unigram.split(("the", "other", "cup", "yes", "left", "tea"), UNEQUAL)
    assert found.base == ("cup", "tea")
    assert found.response == ("other", "yes")
    assert found.unknown == ("the", "left")


@given(
    words=st.lists(st.sampled_from(UNEQUAL.words), max_size=6),
    answers=st.lists(st.sampled_from(ANSWERS), max_size=4),
    asked=st.sampled_from([None, 0, 1, 2]),
    rate=st.floats(0.01, 0.99),
)
def test_against_the_oracle(words: list[str], answers: list[str], asked: int | None, rate: float) -> None:
    world = world_of(UNEQUAL)
    assert base(" ".join(words), UNEQUAL) == pytest.approx(
        [oracle.base_chance(words, item, world) for item in range(3)], rel=1e-9
    )
    assert response(" ".join(answers), asked, UNEQUAL, rate) == pytest.approx(
        [oracle.response_chance(answers, item, asked, world, rate) for item in range(3)], rel=1e-9
    )


def assert_counts_match(counts: Counter[str], chances: dict[str, float], draws: int) -> None:
    """Every outcome within 4 standard errors of its chance, and none besides."""
    assert set(counts) <= {outcome for outcome, chance in chances.items() if chance > 0}
    for outcome, chance in chances.items():
        error = math.sqrt(chance * (1 - chance) / draws)
        assert abs(counts[outcome] / draws - chance) <= 4 * error + 1e-12, outcome


@pytest.mark.parametrize("desired", [0, 1, 2])
def test_base_sampler_counted_against_the_likelihood(desired: int) -> None:
    rng, draws = np.random.default_rng(desired), 20_000
    drawn = Counter(" ".join(unigram.sample_base(desired, UNEQUAL, 0.95, rng)) for _ in range(draws))
    chances = {word: base(word, UNEQUAL)[desired] for word in (*UNEQUAL.words, "")}
    assert_counts_match(drawn, chances, draws)


@pytest.mark.parametrize("asked", [None, 0, 1])
@pytest.mark.parametrize("rate", [0.95, 0.4, 0.0])
def test_response_sampler_counted_against_the_likelihood(asked: int | None, rate: float) -> None:
    rng, draws = np.random.default_rng(7), 20_000
    problem = table([["cup"], ["mug"]], p_truth=0.8)
    of = constant_chances(rate, 0.1)
    drawn = Counter(" ".join(unigram.sample_response(0, asked, problem, of, rng)) for _ in range(draws))
    chances = {word: response(word, asked, problem, rate)[0] for word in (*ANSWERS, "")}
    assert_counts_match(drawn, chances, draws)


def test_word_selected_by_the_largest_number_exists() -> None:
    almost = math.nextafter(1.0, 0.0)
    for problem in (AMBIGUOUS, UNEQUAL, table([["a"], ["b", "c"]], alpha=1e-9), table([["a"], ["b", "c"]], alpha=1e9)):
        for item in range(problem.n_items):
            assert 0 <= unigram.draw_word(item, almost, problem.tables) < len(problem.words)
            assert unigram.sample_base(item, problem, 0.0, np.random.default_rng(0)) == ()


def test_an_utterance_says_what_its_last_answer_means() -> None:
    meanings = {"cup": None, "": None, "yes": Meaning.YES, "no yes not": Meaning.NO, "pardon cup": Meaning.REPEAT}
    for words, meaning in meanings.items():
        assert unigram.split(tuple(words.split()), UNEQUAL).meaning is meaning
    unsure = unigram.split(("unsure", "cup", "left"), UNEQUAL)
    assert unsure == Utterance(("cup",), (), ("left",), Meaning.UNSURE)
    named = table([["unsure"], ["mug"]])
    assert unigram.split(("unsure",), named) == Utterance(("unsure",))

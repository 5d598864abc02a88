"""The value table: places, values after answers against plain enumeration, and how alike items are."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.planners.fitted.table import (
    ASK_FIRST,
    ASK_SECOND,
    COLUMNS,
    KINDS,
    OTHER,
    ROWS,
    SECOND,
    ValueTable,
    answered_value,
    class_breaks,
    classes_of,
    closed_form,
    closeness,
    kind_of,
    node_value,
    pair_class,
    place_of,
    table_action,
    with_other,
)
from fetch_pomdp.core.planners.kernels import ASKED, WAITED, Came, Turn, leading
from tests.oracles.model import word_chance
from tests.tables import table, world_of

PROBLEM = table([["cup"], ["cup"], ["pot"], ["pot", "tea"]], p_g=0.0, p_answer_again=0.5)
TABLE = ValueTable(np.random.default_rng(0).uniform(-10, 10, (2, ROWS, COLUMNS, KINDS)), np.array([0.98]))
FLAT = [0.4, 0.3, 0.2, 0.1]


def interpolated(cls: int, kind: int, b1: float, b2: float) -> float:
    """Bilinear interpolation written out with NumPy's, one axis after the other."""
    y = b2 / min(b1, 1 - b1) if min(b1, 1 - b1) > 0 else 0.0
    rows = [np.interp(y, np.linspace(0, 1, COLUMNS), TABLE.values[cls, row, :, kind]) for row in range(ROWS)]
    return float(np.interp(b1, np.linspace(0, 1, ROWS), rows))


def plain_value(belief: list[float], asked: int | None) -> float:
    order = sorted(range(4), key=lambda item: -belief[item])
    first, second = order[:2]
    b1, b2 = belief[first], belief[second]
    cls = 1 if {first, second} == {0, 1} else 0  # the only pair that shares all its words
    if asked is None:
        wait = interpolated(cls, 0, b1, b2)
    elif asked in (first, second):
        wait = interpolated(cls, 1 + (first, second).index(asked), b1, b2)
    else:
        share = belief[asked] / b2
        wait = (1 - share) * interpolated(cls, OTHER, b1, b2) + share * interpolated(cls, SECOND, b1, b2)
    asks = max(interpolated(cls, ASK_FIRST, b1, b2), interpolated(cls, ASK_SECOND, b1, b2))
    return max(22.5 * b1 - 12.5, -1 + wait, -6 + asks)


beliefs = st.permutations([0.43, 0.29, 0.19, 0.09]) | st.permutations([0.9, 0.07, 0.02, 0.01])


@given(belief=beliefs, about=st.sampled_from([None, 0, 1, 2, 3]), kind=st.sampled_from([ASKED, WAITED]))
def test_values_after_an_answer_are_sums_over_answers(belief: list[float], about: int | None, kind: int) -> None:
    heard, rate = np.array(belief), 0.95 if kind == ASKED else 0.475
    top = leading(heard)
    asked = -1 if about is None else about
    classes = with_other(classes_of(top, TABLE.breaks, PROBLEM.tables), asked, top, TABLE.breaks, PROBLEM.tables)
    own = 0.0 if about is None else belief[about]
    found = answered_value(TABLE, classes, top, own, Turn(asked, 0, kind), Came(0, 0), PROBLEM.tables)
    if about is None:
        assert found == pytest.approx(plain_value(belief, None))
        return
    expected = (1 - rate) * plain_value(belief, about)
    for true, false in ((0.99, 0.01), (0.01, 0.99)):
        joint = [p * (true if item == about else false) for item, p in enumerate(belief)]
        expected += rate * sum(joint) * plain_value([p / sum(joint) for p in joint], about)
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_share_of_ends_picks_the_first_item_now() -> None:
    """By hand: one interaction in ten ends with 22.5 b1 - 12.5, whatever going on is worth."""
    top = leading(np.array([0.43, 0.29, 0.19, 0.09]))
    here = (1, top.b1, top.b2, SECOND, 0.0, PROBLEM.tables)
    lasting, ending = (node_value(TABLE._replace(ends=ends), *here) for ends in (0.0, 0.1))
    assert lasting > 22.5 * 0.43 - 12.5
    assert ending == pytest.approx(0.9 * lasting + 0.1 * (22.5 * 0.43 - 12.5))


def test_cells_cover_all_beliefs() -> None:
    for b1, b2 in ((1.0, 0.0), (0.5, 0.5), (1e-5, 1e-5), (1 / 3, 1 / 3), (0.999, 0.001)):
        place = place_of(b1, b2)
        assert 0 <= place.row < ROWS - 1
        assert 0 <= place.column < COLUMNS - 1
        assert 0 <= place.down <= 1
        assert 0 <= place.along <= 1


def test_the_start_is_the_closed_form_of_a_question() -> None:
    """At a certain belief a wait and a question are worth a pick; between two, a question settles it."""
    problem = table([["cup"], ["cup"]], p_g=0.0)
    values = closed_form(problem.tables)
    assert values[0, -1, 0] == pytest.approx([10.0] * 4 + [0.95 * (22.5 * 0.99 - 12.5) + 0.05 * 10.0] * 2)
    middle = values[0, (ROWS - 1) // 2, COLUMNS - 1]
    settled = 22.5 * 0.99 - 12.5
    asked = 0.95 * settled + 0.05 * (settled - 1 / 0.95)
    assert middle[[ASK_FIRST, ASK_SECOND]] == pytest.approx([asked] * 2)
    assert middle[0] == pytest.approx(-6 + asked)


@given(belief=beliefs, asked=st.sampled_from([None, 0, 1, 2, 3]))
def test_the_tables_action_has_the_nodes_value(belief: list[float], asked: int | None) -> None:
    array, about = np.array(belief), -1 if asked is None else asked
    top = leading(array)
    action = table_action(array, about, 0, top, TABLE, PROBLEM.tables)
    kind = kind_of(about, top.first, top.second)
    share = 0.0 if asked is None else belief[asked] / top.b2
    cls = 1 if {top.first, top.second} == {0, 1} else 0
    value = node_value(TABLE, cls, top.b1, top.b2, kind, share, PROBLEM.tables)
    if action >= 4:
        assert action - 4 == top.first
        assert value == pytest.approx(22.5 * top.b1 - 12.5)
    elif action >= 0:
        kind = ASK_FIRST if action == top.first else ASK_SECOND
        assert value == pytest.approx(-6 + interpolated(cls, kind, top.b1, top.b2))
    assert value == pytest.approx(plain_value(belief, asked))


@pytest.mark.parametrize(("one", "other"), [(0, 1), (0, 2), (1, 2), (2, 3), (0, 3), (1, 1)])
def test_words_are_those_of_equation_5(one: int, other: int) -> None:
    problem = table([["cup", "red"], ["red", "cup"], ["cup", "blue", "small"], ["pot"]], p_g=0.0, alpha=0.3, p_l=0.8)
    world = world_of(problem)
    words = sum(math.sqrt(word_chance(w, one, world) * word_chance(w, other, world)) for w in world.words)
    assert closeness(one, other, problem.tables) == pytest.approx(0.2 + 0.8 * words, abs=1e-12)


def test_pointing_tells_items_apart_by_their_angle() -> None:
    near = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (0.01, 2.0, 1.6)], p_g=0.5, sigma=0.1)
    far = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (2.0, 0.0, 1.6)], p_g=0.5, sigma=0.1)
    assert closeness(0, 1, near.tables) == pytest.approx(1.0, abs=1e-3)
    assert closeness(0, 1, far.tables) == pytest.approx(0.5, abs=1e-9)  # a ray would settle it
    # A small angle t: the overlap of two normal densities in the plane is exp(-t^2 / 8 sigma^2).
    some = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (0.2, 2.0, 1.6)], p_g=0.5, sigma=0.1)
    assert closeness(0, 1, some.tables) == pytest.approx(0.5 + 0.5 * math.exp(-(0.1**2) / 0.08), abs=2e-3)


def test_classes_lie_between_the_kinds_seen() -> None:
    seen = np.array([0.999] * 50 + [0.9] * 50 + [0.2] * 50)
    breaks = class_breaks(seen)
    assert len(breaks) == 2
    assert 0.2 < breaks[0] < 0.9 < breaks[1] < 0.999
    assert len(class_breaks(np.full(9, 0.7))) == 0
    assert len(class_breaks(np.empty(0))) == 0
    assert len(class_breaks(np.array([0.9] * 99 + [0.1]))) == 0  # one in a hundred is too few for a class


def test_class_of_a_pair() -> None:
    problem = table([["cup"], ["cup"], ["pot"]], p_g=0.0)
    breaks = np.array([0.9])
    assert pair_class(0, 1, breaks, problem.tables) == 1
    assert pair_class(0, 2, breaks, problem.tables) == 0
    assert pair_class(0, 1, np.empty(0), problem.tables) == 0

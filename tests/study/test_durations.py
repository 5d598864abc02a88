from __future__ import annotations

import pytest

from fetch_pomdp.errors import ModelError
from fetch_pomdp.study.durations import Durations


def test_steps_are_made_of_the_robots_doings() -> None:
    timing = Durations(think=0.2, wait=0.5, listen=1.5, arm=0.75, speak=0.25, overhead=9.0).timing()
    assert (timing.wait, timing.question, timing.listen) == pytest.approx((0.7, 2.9, 1.7))


def test_a_clock_that_stands_still_is_none() -> None:
    with pytest.raises(ModelError, match=r"^timing: found wait 0"):
        Durations(think=0.0, wait=0.0).timing()

"""Fig. 1: the person says "marker", the robot asks about one, "no", and it hands over the other."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.planners.catalogue import planner_named

ASKING = ["exact", "sparse", "paper-always"]


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", ASKING)
def test_no_about_one_marker_means_the_other(name: str, seed: int) -> None:
    agent = Agent("ambiguous", planner_named(name), seed=seed)
    markers = {index for index, item in enumerate(agent.scene.items) if "marker" in item.vocabulary}
    wanted: int | None = None
    for _ in range(30):
        action = agent.act()
        if isinstance(action, Pick):
            break
        if isinstance(action, Point):
            if wanted is None and action.item in markers:
                (wanted,) = markers - {action.item}
            agent.observe("yes" if action.item == wanted else "no")
        else:
            agent.observe("marker")
    assert wanted is not None, "it asked about a marker"
    assert action == Pick(wanted)


def test_the_answer_says_nothing_about_the_other_marker_itself() -> None:
    """The belief in the wanted marker against the other kinds is that of the word alone: "no" only rules one out."""
    agent = Agent("ambiguous")
    agent.observe("marker")
    before = agent.belief
    agent.did(Point(2))
    agent.observe("no")
    assert agent.belief[3] / agent.belief[0] == pytest.approx(before[3] / before[0])
    assert agent.belief.argmax() == 3

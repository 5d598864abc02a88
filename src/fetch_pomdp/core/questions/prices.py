"""From seconds to reward: what a question costs that takes so long.

Choice: "the costs of the different actions were initially set to correspond to the number of seconds" (Section III-B).
So a question costs what pointing costs, `Rewards.point`, times its seconds over those of pointing, and never less than
a wait. With the paper's table a spoken question, of half the seconds, costs 3. Picks keep their rewards: a wrong one is
worth `seconds_worth` of the table's difference.
"""

from __future__ import annotations

from fetch_pomdp.core.model import Rewards

POINTING = 2.8  # s, `Timing.question`: the arm moves, "this one?", and listening
SPEAKING = 1.4  # s, a question without the arm, and listening
LISTENING = 2.8  # s, a short question with a long answer


def reward_of(seconds: float, rewards: Rewards) -> float:
    """Return the reward, below or at that of a wait, of a question that takes so many seconds."""
    return min(rewards.wait, rewards.point * seconds / POINTING)


def seconds_worth(reward: float, rewards: Rewards) -> float:
    """Return how many seconds of asking a difference of rewards is worth; infinite where asking costs nothing."""
    return abs(reward) * POINTING / -rewards.point if rewards.point < 0.0 else float("inf")

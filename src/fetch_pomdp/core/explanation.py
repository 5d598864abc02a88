"""Why a decision was taken: the numbers behind it, and one English sentence made from them alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.evidence import LogOdds
from fetch_pomdp.core.scene import Scene

AS_LIKELY = 0.02  # relative difference of beliefs below which two items count as equally likely
NEAR = math.log(1.5)  # log-odds below which two items count as almost equally likely
TELLING = math.log(2.0)  # log-odds from which a modality counts as favouring an item
CERTAIN = 0.9995  # belief that would be printed as 100.0%


@dataclass(frozen=True, slots=True)
class Option:
    """An action, its expected return, and the standard error of that; NaN where the planner does not value it.

    The error is 0 where nothing was sampled.
    """

    action: Action
    value: float
    error: float

    @property
    def valued(self) -> bool:
        """Whether the planner gave the action a value."""
        return not math.isnan(self.value)


@dataclass(frozen=True, slots=True)
class Rival:
    """The likeliest other item, its probability, and the log-odds of the item in question against it."""

    item: int
    belief: float
    log_odds: LogOdds


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """The reasons of a decision. Beliefs are probabilities, values expected returns."""

    chosen: Option
    item: int  # what the decision is about; a wait is about the likeliest item
    belief: float  # in `item`
    rival: Rival | None  # None on a table of one item
    as_likely: int  # how many items are as likely as `item`, itself included
    n_items: int
    wait: Option
    question: Option  # the best one
    pick: Option  # the best one
    unanswered: int | None  # the item of a question that no response has followed

    @property
    def action(self) -> Action:
        """What was decided."""
        return self.chosen.action

    @property
    def gain(self) -> float:
        """What the best question is expected to gain, net of its price, over the best action that is no question.

        NaN where the planner values no question, or nothing else.
        """
        return self.question.value - self._without.value

    @property
    def gain_error(self) -> float:
        """Standard error of the gain, as `margin_error` is that of the margin."""
        return _error(self.question, self._without)

    @property
    def _without(self) -> Option:
        return _highest(self.wait, self.pick)

    @property
    def runner_up(self) -> Option:
        """The best action of another kind: among questions about twins there is always a tie that means nothing."""
        kinds = (self.wait, self.question, self.pick)
        return _highest(*(option for option in kinds if type(option.action) is not type(self.action)))

    @property
    def margin(self) -> float:
        """How much more the chosen action is worth than the runner-up; NaN where one of them is not valued."""
        return self.chosen.value - self.runner_up.value

    @property
    def margin_error(self) -> float:
        """Standard error of the margin, as if the two values were sampled apart.

        Planners share samples among actions, so that the margin is mostly surer than this.
        """
        return _error(self.chosen, self.runner_up)

    @property
    def close(self) -> bool:
        """Whether the margin is within two standard errors."""
        return abs(self.margin) <= 2.0 * self.margin_error

    def sentence(self, scene: Scene) -> str:
        """Return the decision and why, in one sentence: `scene` gives the names of the items and the rewards."""
        return f"{deed(self.action, scene)}: {self.reason(scene)}"

    def reason(self, scene: Scene) -> str:
        """Return why, without the decision itself."""
        known = _knowledge(self, scene)
        if isinstance(self.action, Point) or (isinstance(self.action, Wait) and not self.chosen.valued):
            stake = _prices(self, scene)
        else:
            stake = _values(self, scene)
        return "; ".join(part for part in (known, stake) if part)


def deed(action: Action, scene: Scene) -> str:
    """Return an action in a few words."""
    if isinstance(action, Wait):
        return "waits"
    verb = "asks about" if isinstance(action, Point) else "picks"
    return f"{verb} {scene.items[action.item].id}"


def _highest(*options: Option) -> Option:
    """Return the option of the highest value, the first of equal ones; one without a value only if none has one."""
    return max(options, key=lambda option: option.value if option.valued else -math.inf)


def _error(first: Option, second: Option) -> float:
    return math.hypot(first.error, second.error) if first.valued and second.valued else math.nan


# What is known: the first half of a sentence.


def _knowledge(why: Explanation, scene: Scene) -> str:
    item = scene.items[why.item].id if isinstance(why.action, Wait) else "it"
    if why.unanswered is not None and _awaited(why.action, why.unanswered):
        about = scene.items[why.unanswered].id if isinstance(why.action, Wait) else "it"
        return f"the question about {about} is still unanswered"
    if why.rival is None:
        return f"{item} is the only item"
    if why.as_likely == why.n_items:
        return f"nothing tells the {why.n_items} items apart yet"
    if why.belief >= CERTAIN:
        return f"{item} is certain" if why.rival.belief == 0.0 else f"{item} is all but certain"
    return _standing(why, why.rival, item, scene)


def _standing(why: Explanation, against: Rival, item: str, scene: Scene) -> str:
    """Return how the item stands to its rival."""
    odds, named, rival = against.log_odds, scene.items[why.item].id, scene.items[against.item].id
    if min(odds.words, odds.pointing) <= -TELLING and max(odds.words, odds.pointing) >= TELLING:
        words, pointed = (named, rival) if odds.words > 0 else (rival, named)
        return f"speech favours {words} {_ratio(odds.words)} to 1, pointing {pointed} {_ratio(odds.pointing)} to 1"
    if isinstance(why.action, Pick) and odds.total >= NEAR:
        return f"{item} is {_percent(why.belief)} likely{_source(odds)}"
    if abs(why.belief - against.belief) <= AS_LIKELY * why.belief:
        others = rival if why.as_likely <= 2 else f"{why.as_likely - 1} others"
        return f"{item} and {others} are equally likely"
    if abs(odds.total) < NEAR:
        return f"{item} and {rival} are almost equally likely"
    likelier, other = (item, rival) if odds.total > 0 else (rival, item)
    return f"{likelier} is {_ratio(odds.total)} times as likely as {other}"


def _awaited(action: Action, asked: int) -> bool:
    return isinstance(action, Wait) or (isinstance(action, Point) and action.item == asked)


def _source(odds: LogOdds) -> str:
    """Return which modality gave more than half of the log-odds, if one did."""
    sources = (
        (odds.words, "what was said"),
        (odds.answers, "the answers"),
        (odds.pointing, "the pointing"),
    )
    most, name = max(sources)
    return f", mostly by {name}" if most >= TELLING and most > odds.total / 2 else ""


def _ratio(odds: float) -> str:
    """Return e to the absolute log-odds, to two digits."""
    if abs(odds) > math.log(1000.0):
        return "over 1,000"
    ratio = math.exp(abs(odds))
    return f"{ratio:.1f}".removesuffix(".0") if ratio < 9.95 else f"{ratio:.0f}"


def _percent(chance: float) -> str:
    return f"{chance:.0%}" if 0.015 <= chance < 0.985 else f"{chance:.1%}"


# What is at stake: the second half.


def _values(why: Explanation, scene: Scene) -> str:
    """Return what the three kinds of action are worth, the chosen one first."""
    if not why.chosen.valued:
        return ""
    kinds = (option for option in (why.wait, why.question, why.pick) if type(option.action) is not type(why.action))
    others = sorted((option for option in kinds if option.valued), key=lambda option: -option.value)
    said = [f"{_doing(why.action)} is worth {worth(why.chosen.value, scene)}"]
    said += [f"{_doing(option.action)} {worth(option.value, scene)}" for option in others]
    before = ", ".join(said[:-1])
    return (f"{before} and {said[-1]}" if before else said[-1]) + _doubt(why)


def _prices(why: Explanation, scene: Scene) -> str:
    """Return what a mistake and the action cost, and what a question gains by the planner's values."""
    rewards = scene.rewards
    asks = isinstance(why.action, Point)
    price = f"the question {_cost(rewards.point)}" if asks else f"the wait {_cost(rewards.wait)}"
    wrong = f"costs {_cost(rewards.pick_wrong)}" if rewards.pick_wrong <= 0 else f"earns {rewards.pick_wrong:.4g}"
    text = f"a wrong pick {wrong}, {price}"
    if math.isnan(why.margin):
        return text
    other, difference = _doing(why.runner_up.action), worth(abs(why.margin), scene)
    if why.margin < 0:
        return f"{text}, though {other} is worth {difference} more{_doubt(why)}"
    return f"{text}, and asking is worth {difference} more than {other}{_doubt(why)}"


def _doubt(why: Explanation) -> str:
    return ", a close call" if why.close else ""


def _doing(action: Action) -> str:
    return "waiting" if isinstance(action, Wait) else "asking" if isinstance(action, Point) else "picking"


def _cost(reward: float) -> str:
    return f"{-reward:,.0f}" if reward <= -10_000 else f"{-reward:.4g}" if reward else "nothing"


def worth(value: float, scene: Scene) -> str:
    """Return an expected return, to as many digits as the rewards of the scene call for."""
    spread = scene.rewards.pick_correct - scene.rewards.pick_wrong
    text = f"{value:.{min(max(3 - math.floor(math.log10(spread)), 0), 12)}f}"
    return text.removeprefix("-") if float(text) == 0 else text

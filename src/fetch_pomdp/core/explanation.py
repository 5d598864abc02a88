"""Why a decision was taken: the numbers behind it, and one sentence made from them alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.evidence import LogOdds
from fetch_pomdp.core.phrases import Figure, Phrase, Value, phrase
from fetch_pomdp.core.scene import Scene

AS_LIKELY = 0.02  # relative difference of beliefs below which two items count as equally likely
NEAR = math.log(1.5)  # log-odds below which two items count as almost equally likely
TELLING = math.log(2.0)  # log-odds from which a modality counts as favouring an item
CERTAIN = 0.9995  # belief that would be printed as 100.0%


@dataclass(frozen=True, slots=True)
class ValuedAction:
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
    """The reasons of a decision. Beliefs are probabilities, values expected returns. Prints as a sentence."""

    scene: Scene = field(repr=False)  # the names of the items, and the rewards
    chosen: ValuedAction
    item: int  # what the decision is about; a wait is about the likeliest item
    belief: float  # in `item`
    rival: Rival | None  # None on a table of one item
    as_likely: int  # how many items are as likely as `item`, itself included
    wait: ValuedAction
    question: ValuedAction  # the best one
    pick: ValuedAction  # the best one
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
    def _without(self) -> ValuedAction:
        return _highest(self.wait, self.pick)

    @property
    def runner_up(self) -> ValuedAction:
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

    def phrase(self) -> Phrase:
        """Return the decision and why, as one sentence that can be said in any language."""
        return phrase("why_sentence", deed=deed(self.action, self.scene), reason=self.reason())

    def reason(self) -> Phrase:
        """Return why, without the decision itself."""
        known = _knowledge(self)
        if isinstance(self.action, Point) or (isinstance(self.action, Wait) and not self.chosen.valued):
            stake = _prices(self)
        elif self.chosen.valued:
            stake = _values(self)
        else:
            return known
        return phrase("why_reason", known=known, stake=stake)

    def __str__(self) -> str:
        return str(self.phrase())


def deed(action: Action, scene: Scene) -> Phrase:
    """Return an action in a few words."""
    if isinstance(action, Wait):
        return phrase("why_waits")
    return phrase("why_asks" if isinstance(action, Point) else "why_picks", item=scene.items[action.item].id)


def _highest(*options: ValuedAction) -> ValuedAction:
    """Return the option of the highest value, the first of equal ones; one without a value only if none has one."""
    return max(options, key=lambda option: option.value if option.valued else -math.inf)


def _error(first: ValuedAction, second: ValuedAction) -> float:
    return math.hypot(first.error, second.error) if first.valued and second.valued else math.nan


# What is known: the first half of a sentence.


def _knowledge(why: Explanation) -> Phrase:
    item = _name(why, why.item)
    if why.unanswered is not None and _awaited(why.action, why.unanswered):
        return phrase("why_unanswered", item=_name(why, why.unanswered))
    if why.rival is None:
        return phrase("why_alone", item=item)
    if why.as_likely == len(why.scene.items):
        return phrase("why_even", count=Figure(str(why.as_likely)))
    if why.belief >= CERTAIN:
        return phrase("why_certain" if why.rival.belief == 0.0 else "why_almost_certain", item=item)
    return _standing(why, why.rival, item)


def _standing(why: Explanation, against: Rival, item: Value) -> Phrase:
    """Return how the item stands to its rival."""
    odds, rival = against.log_odds, why.scene.items[against.item].id
    if min(odds.words, odds.pointing) <= -TELLING and max(odds.words, odds.pointing) >= TELLING:
        named = why.scene.items[why.item].id
        said, shown = (named, rival) if odds.words > 0 else (rival, named)
        return phrase("why_torn", said=said, words=_ratio(odds.words), shown=shown, pointing=_ratio(odds.pointing))
    if isinstance(why.action, Pick) and odds.total >= NEAR:
        return _sourced(phrase("why_likely", item=item, chance=_percent(why.belief)), odds)
    if abs(why.belief - against.belief) <= AS_LIKELY * why.belief:
        if why.as_likely <= 2:
            return phrase("why_equal", item=item, other=rival)
        return phrase("why_equal_many", item=item, count=Figure(str(why.as_likely - 1)))
    if abs(odds.total) < NEAR:
        return phrase("why_near", item=item, other=rival)
    likelier, other = (item, rival) if odds.total > 0 else (rival, item)
    return phrase("why_times", likelier=likelier, ratio=_ratio(odds.total), other=other)


def _name(why: Explanation, item: int) -> Value:
    """Return the id of an item, or a pronoun where what was decided has just named it."""
    name = why.scene.items[item].id
    return name if isinstance(why.action, Wait) else phrase("why_it", item=name)


def _awaited(action: Action, asked: int) -> bool:
    return isinstance(action, Wait) or (isinstance(action, Point) and action.item == asked)


def _sourced(known: Phrase, odds: LogOdds) -> Phrase:
    """Add which modality gave more than half of the log-odds, if one did."""
    sources = (
        (odds.words, "why_by_words"),
        (odds.pointing, "why_by_pointing"),
        (odds.answers, "why_by_answers"),
    )
    most, key = max(sources, key=lambda source: source[0])
    return phrase(key, known=known) if most >= TELLING and most > odds.total / 2 else known


def _ratio(odds: float) -> Value:
    """Return e to the absolute log-odds, to two digits."""
    if abs(odds) > math.log(1000.0):
        return phrase("why_over", number=Figure("1,000"))
    ratio = math.exp(abs(odds))
    return Figure(f"{ratio:.1f}".removesuffix(".0") if ratio < 9.95 else f"{ratio:.0f}")


def _percent(chance: float) -> Figure:
    return Figure(f"{chance:.0%}" if 0.015 <= chance < 0.985 else f"{chance:.1%}")


# What is at stake: the second half.


def _values(why: Explanation) -> Phrase:
    """Return what the three kinds of action are worth, the chosen one first."""
    kinds = (option for option in (why.wait, why.question, why.pick) if type(option.action) is not type(why.action))
    others = sorted((option for option in kinds if option.valued), key=lambda option: -option.value)
    more = [phrase("why_other", doing=_doing(each.action), value=_worth(each.value, why.scene)) for each in others]
    key = ("why_worth_one", "why_worth_two", "why_worth_three")[len(more)]
    values: dict[str, Value] = {"doing": _doing(why.action), "value": _worth(why.chosen.value, why.scene)}
    return _doubted(phrase(key, **values, **dict(zip(("second", "third"), more, strict=False))), why)


def _prices(why: Explanation) -> Phrase:
    """Return what a mistake and the action cost, and what a question gains by the planner's values."""
    rewards = why.scene.rewards
    asks = isinstance(why.action, Point)
    price = (
        phrase("why_question_costs", cost=_cost(rewards.point))
        if asks
        else phrase("why_wait_costs", cost=_cost(rewards.wait))
    )
    wrong = (
        phrase("why_wrong_costs", cost=_cost(rewards.pick_wrong))
        if rewards.pick_wrong <= 0
        else phrase("why_wrong_earns", gain=Figure(f"{rewards.pick_wrong:.4g}"))
    )
    if math.isnan(why.margin):
        return phrase("why_prices", wrong=wrong, price=price)
    key = "why_prices_less" if why.margin < 0 else "why_prices_more"
    doing, difference = _doing(why.runner_up.action), _worth(abs(why.margin), why.scene)
    return _doubted(phrase(key, wrong=wrong, price=price, doing=doing, difference=difference), why)


def _doubted(stake: Phrase, why: Explanation) -> Phrase:
    return phrase("why_close", stake=stake) if why.close else stake


def _doing(action: Action) -> Phrase:
    return phrase(
        "why_waiting" if isinstance(action, Wait) else "why_asking" if isinstance(action, Point) else "why_picking"
    )


def _cost(reward: float) -> Value:
    if not reward:
        return phrase("why_nothing")
    return Figure(f"{-reward:,.0f}" if reward <= -10_000 else f"{-reward:.4g}")


def _worth(value: float, scene: Scene) -> Figure:
    return Figure(worth(value, scene))


def worth(value: float, scene: Scene) -> str:
    """Return an expected return, to as many digits as the rewards of the scene call for."""
    spread = scene.rewards.pick_correct - scene.rewards.pick_wrong
    text = f"{value:.{min(max(3 - math.floor(math.log10(spread)), 0), 12)}f}"
    return text.removeprefix("-") if float(text) == 0 else text

"""The robot's mind in one interaction: belief, last question and planner."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import overload

import numpy as np
import numpy.typing as npt

from fetch_pomdp import checks
from fetch_pomdp.checks import Point3, shown
from fetch_pomdp.core import observation as observations
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event, Likelihoods
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explain import explain
from fetch_pomdp.core.generative import asked_after
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.answers import AROUND, After, AnswerReader, lexicon
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader, meanwhile
from fetch_pomdp.core.language.reading.talk import AsHeard, Moment, said_by
from fetch_pomdp.core.language.reading.telling import LOST
from fetch_pomdp.core.language.unigram import Utterance
from fetch_pomdp.core.language.words import COURTESY, Meaning
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.observation import Meant, Observation, Parts, Said
from fetch_pomdp.core.planners.base import BudgetPlanner, Decision, Planner
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.turns import NO, YES, StepChances, constant_chances
from fetch_pomdp.errors import ActionError, ObservationError, PlannerError


@dataclass(frozen=True, slots=True, eq=False)
class Understood:
    """What an observation says.

    utterance: its words, split. meant: what all readings together most likely say. parts: the factors of Eq. 3. heard:
    what a reader made of the words beside an answer, None where there are none or no reader reads. read: what it said
    of the items, for `Observed`; () where words are read as in the paper.
    """

    utterance: Utterance
    meant: Meant
    parts: Parts
    heard: Heard | None = None
    read: Likelihoods = ()

    @property
    def lost(self) -> bool:
        """Whether something was said of which too little was understood."""
        said = self.utterance
        if said.base or said.meaning:
            return self.heard is not None and self.heard.lost > LOST and not said.meaning
        return not AROUND.union(COURTESY).issuperset(said.unknown)


class Agent:
    """Observes, keeps a belief and decides; everything else it leaves to its planner.

    scene: a Scene, the name of a built-in one, or the path of a TOML file. planner: FittedValue() unless given.
    model, rewards: those of the scene unless given, as a whole or as a mapping of changes. reader: what reads words
    other than answers, such as `TableReader()`; unless given the paper's, word by word (Eq. 4, 5). The decision after k
    observations and actions depends on the seed, on k and on what happened, not on how often `decide` was called.
    """

    def __init__(
        self,
        scene: Scene | str | Path,
        planner: Planner | None = None,
        *,
        model: Model | Mapping[str, object] | None = None,
        rewards: Rewards | Mapping[str, object] | None = None,
        seed: int = 0,
        prior: npt.ArrayLike | None = None,
        reader: Reader | None = None,
    ) -> None:
        table = scene if isinstance(scene, Scene) else Scene.load(scene)
        self.problem = Problem(_changed(table, model, rewards))
        self._lexicon = lexicon(table.answers, self.problem.words)
        self.answers: AnswerReader = self._lexicon if reader is None else AsHeard(self._lexicon)
        self.planner: Planner = FittedValue() if planner is None else _planner(planner)
        self.seed = checks.whole(seed, 0, 2**63 - 1, "seed", PlannerError)
        self.reader = reader
        self._prior = Belief.uniform(self.problem.n_items) if prior is None else Belief(prior)
        if len(self._prior.log_probabilities) != self.problem.n_items:
            found = len(self._prior.log_probabilities)
            raise ObservationError(f"found {found} probabilities, expected {self.problem.n_items}", field="prior")
        self._steps, self._context = 0, Context()
        self.begin()

    def begin(self) -> None:
        """Begin with a request: nothing of it was heard, seen or asked yet.

        Whose left the person means, and what was meant last, stay for who says "the other one" (`Context`).
        """
        self._belief = self._prior
        self.asked: int | None = None  # i_r, as an index into the scene's items
        self.handed: int | None = None  # the item that was handed over last, if nothing was done since
        self.phase = 0  # where the talk stands (`turns`)
        self._acted: Action = Wait()  # since the last observation
        self._stopped = False  # whether that was a pick that the person stopped
        self._evidence = Evidence.none(self._belief.log_probabilities)
        self.understood = self.understand(Observation())  # what the last observation said

    def copy(self) -> Agent:
        """Return an agent that goes on from here by itself; planner and reader are shared."""
        return copy.copy(self)  # all that changes is immutable

    def quick(self) -> Agent:
        """Return a `copy` that reads with the quick reader of a slow one."""
        agent = self.copy()
        agent.reader = meanwhile(agent.reader)
        return agent

    @property
    def belief(self) -> Vector:
        """The probability that each item is the desired one, (n_items,), in the order of `scene.items`."""
        return self._belief.probabilities

    @property
    def posterior(self) -> Belief:
        """The belief as the distribution that Bayes' rule updates; immutable, so that any thread may keep it."""
        return self._belief

    @property
    def evidence(self) -> Evidence:
        """What words, answers and pointing have each contributed to the belief."""
        return self._evidence

    @property
    def after(self) -> After:
        """What the words heard next follow: a hand-over, done or stopped; a question, as long as none has answered it;
        or nothing.
        """
        if self._stopped or self.handed is not None:
            return After.HANDED
        return After.NOTHING if self._evidence.unanswered is None else After.QUESTION

    @property
    def unanswered(self) -> int:
        """How often the robot has asked what nobody has answered for long (`turns`); 0 while an answer is due."""
        return int(self.problem.tables.late[self.phase])

    @property
    def chances(self) -> StepChances:
        """The chances under which the next observation is read."""
        if self.problem.model.turns:
            return self.problem.step_chances(self._acted, self.phase)
        return constant_chances(self.problem.model.p_l, self.problem.model.p_g)  # the action scales all items alike

    @property
    def scene(self) -> Scene:
        """The table, with the model and rewards in force."""
        return self.problem.scene

    def observe(
        self, utterance: str | None = None, *, head: Point3 | None = None, wrist: Point3 | None = None
    ) -> Utterance:
        """Take in what was said and seen in a step; return how the words were understood, answers as people give them.

        head, wrist: metres, both or neither. Raises ObservationError for a ray without length, or one of the two alone.
        """
        if utterance is not None and not isinstance(utterance, str):
            raise ObservationError(f"found {shown(utterance)}, expected text or None", field="utterance")
        if (head is None) != (wrist is None):
            missing = "head" if head is None else "wrist"
            raise ObservationError("found none, expected head and wrist, or neither", field=missing)
        ray = None if head is None or wrist is None else Ray(head, wrist)
        words = self.answers.read(self.answers.words(utterance or ""), self.after).words
        return self.update(Observation(words, ray))

    def update(self, observation: Observation) -> Utterance:
        """Take in an observation; return how its words were understood, by the paper's lists of answers.

        Who wants nothing any more ("never mind") begins anew, with whatever they say beside it. Raises
        ObservationError for anything else.
        """
        if not isinstance(observation, Observation):
            raise ObservationError(f"found {shown(observation)}, expected Observation(...)", field="observation")
        return self._update(observation, ())

    def _update(self, observation: Observation, read: Likelihoods) -> Utterance:
        understood = self.understand(observation, read)
        if understood.utterance.meaning is Meaning.CANCEL:
            self.begin()
            understood = self.understand(observation, read)
        self._take_in(observation, understood)
        return understood.utterance

    def understand(self, observation: Observation, read: Likelihoods = ()) -> Understood:
        """Return what an observation says as things stand; nothing changes.

        read: what a reader said of the words of each of its readings, where that is on record, (readings, n_items).

        Choice: a reader that takes its time (`reader.meanwhile`) reads the words as they stand, and a quick one the
        recogniser's other readings, and what is on record.
        """
        readings = observations.readings(observation)
        best = [each.words for each in readings].index(observation.words)
        quick = meanwhile(self.reader)
        said = [
            self._said(each.words, self.reader if place == best and not read else quick)
            for place, each in enumerate(readings)
        ]
        if read:
            said = [replace(each, words=np.array(words)) for each, words in zip(said, read, strict=True)]
        parts = observations.parts_of(observation, said, self.asked, self.problem, self.chances)
        spoken = self.reader is not None and any(each.words for each in readings)
        recorded = tuple(tuple(each.words.tolist()) for each in said) if spoken else ()
        heard = observations.meant(observation, said)
        return Understood(said[best].utterance, heard, parts, said[best].heard, recorded)

    def _said(self, words: tuple[str, ...], reader: Reader | None) -> Said:
        if reader is None:
            return observations.said_in(words, self.problem)
        return said_by(reader, words, self._lexicon, Moment(self.after, self.asked, self._context), self.problem)

    def _take_in(self, observation: Observation, understood: Understood) -> None:
        heard = understood.heard
        if heard is not None:
            self._context = heard.context
            if heard.corrects:
                self._evidence = self._evidence.without_talk()
                self._belief = Belief.of_logs(self._evidence.prior + self._evidence.pointing)
        self._belief = self._belief.updated(observation, self.asked, self.problem, parts=understood.parts)
        self.phase = observations.phase_following(
            understood.meant, observation.ray, self._acted, self.problem, self.phase, asked=self.asked
        )
        self._acted, self._stopped, self.understood = Wait(), False, understood
        self._evidence = self._evidence.plus(understood.parts, answered=understood.meant.answer in (YES, NO))
        self._steps += 1

    def decide(self, *, passes: int | None = None) -> Decision:
        """Return what the planner would do now, the value of every action, and why; nothing changes.

        passes: as many passes of sampling as a decision that was recorded took, in place of a planner's budget.
        """
        rng = np.random.default_rng((self.seed, self._steps))
        planner = self.planner
        if passes is not None and isinstance(planner, BudgetPlanner):
            planner = planner.with_passes(passes)
        decision = planner.decide(self.problem, self._belief, self.asked, rng=rng, phase=self.phase)
        if not self.problem.tables.begun[self.phase]:  # there is nothing to decide before the first word or gesture
            decision = dataclasses.replace(decision, action=Wait())
        why = explain(decision, self._belief, self._evidence, self.scene)
        return dataclasses.replace(decision, explanation=why)

    def act(self) -> Action:
        """Decide, and go on as if the robot had done it."""
        action = self.decide().action
        self.did(action)
        return action

    def did(self, action: Action) -> None:
        """Go on from an action that the robot did: a question asked is i_r from now on.

        Raises ActionError for anything but an action, or for one about an item that the scene does not have.
        """
        self._check(action)
        self.asked, self._acted, self._stopped = asked_after(action, self.asked), action, False
        self.handed = action.item if isinstance(action, Pick) else None
        if isinstance(action, Point):
            self._evidence = self._evidence.asked(action.item)
        self._steps += 1

    def take(self, event: Event) -> None:
        """Go on from an event: an observation, or what an action came to. Live and replayed alike."""
        if isinstance(event, Acted):
            if event.counts_as is not None:
                self.did(event.counts_as)
                self._stopped = event.objected
            return
        if event.anew:
            self._begin_again()
        self._update(event.observation, event.read)

    def begun(self) -> Agent:
        """Return an agent that begins with another request after a hand-over, which "the other one" may refer to."""
        agent = self.copy()
        agent._begin_again()
        return agent

    def _begin_again(self) -> None:
        self._context = self._context.after_question(self.handed)
        self.begin()

    @overload
    def item(self, action: Point | Pick) -> Item: ...
    @overload
    def item(self, action: Wait) -> None: ...

    def item(self, action: Action) -> Item | None:
        """Return the item that an action is about; a wait is about none. Raises ActionError as `did`."""
        self._check(action)
        return None if isinstance(action, Wait) else self.scene.items[action.item]

    def _check(self, action: Action) -> None:
        if not isinstance(action, Wait | Point | Pick):
            expected = "Wait(), Point(item) or Pick(item)"
            raise ActionError(f"found {shown(action)}, expected {expected}", field="action")
        if not isinstance(action, Wait) and not 0 <= action.item < self.problem.n_items:
            raise ActionError(f"found item {action.item}, expected an index below {self.problem.n_items}", field="item")


def _changed(
    table: Scene, model: Model | Mapping[str, object] | None, rewards: Rewards | Mapping[str, object] | None
) -> Scene:
    new_model = model if isinstance(model, Model) else table.model.with_changes({} if model is None else model)
    new_rewards = (
        rewards if isinstance(rewards, Rewards) else table.rewards.with_changes({} if rewards is None else rewards)
    )
    return dataclasses.replace(table, model=new_model, rewards=new_rewards)


def _planner(planner: Planner) -> Planner:
    if isinstance(planner, type) or not callable(getattr(planner, "decide", None)):
        expected = "an object that decides, such as FittedValue() or SparseSampling()"
        raise PlannerError(f"found {shown(planner)}, expected {expected}", field="planner")
    return planner

"""The robot's mind in one interaction: belief, last question and planner."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
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
from fetch_pomdp.core.events import Event, Observed
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explain import explain
from fetch_pomdp.core.generative import asked_after
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language import unigram
from fetch_pomdp.core.language.answers import After, Lexicon, lexicon
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader
from fetch_pomdp.core.language.reading.talk import divided
from fetch_pomdp.core.language.reading.tokens import STOP, words_of
from fetch_pomdp.core.language.unigram import Utterance
from fetch_pomdp.core.language.words import STAND_INS, Meaning, tokenize
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.observation import Observation, Parts
from fetch_pomdp.core.planners.base import BudgetPlanner, Decision, Planner
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.turns import NO, YES, StepChances, constant_chances
from fetch_pomdp.errors import ActionError, ObservationError, PlannerError


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
        self.answers: Lexicon = lexicon(table.answers, self.problem.words)
        self.planner: Planner = FittedValue() if planner is None else _planner(planner)
        self.seed = checks.whole(seed, 0, 2**63 - 1, "seed", PlannerError)
        self.reader = reader
        self._prior = Belief.uniform(self.problem.n_items) if prior is None else Belief(prior)
        if len(self._prior.log_probabilities) != self.problem.n_items:
            found = len(self._prior.log_probabilities)
            raise ObservationError(f"found {found} probabilities, expected {self.problem.n_items}", field="prior")
        self._steps = 0
        self.begin()

    def begin(self) -> None:
        """Begin with a request: nothing of it was heard, seen or asked yet."""
        self._belief = self._prior
        self.heard: Heard | None = None  # what the reader made of the last words
        self._context = Context()
        self.asked: int | None = None  # i_r, as an index into the scene's items
        self.handed: int | None = None  # the item that was handed over last, if nothing was done since
        self.phase = 0  # where the talk stands (`turns`)
        self._acted: Action = Wait()  # since the last observation
        self._evidence = Evidence.none(self._belief.log_probabilities)

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
        """What the words heard next follow: a question as long as none of them has answered it, or nothing."""
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
        if self.reader is not None:
            return self.update(Observation(words_of(utterance or ""), ray))
        return self.update(Observation(self.answers.read(tokenize(utterance or ""), self.after).words, ray))

    def update(self, observation: Observation) -> Utterance:
        """Take in an observation; return how its words were understood, by the paper's lists of answers.

        Who wants nothing any more ("never mind") begins anew, with whatever they say beside it. Raises
        ObservationError for anything else.
        """
        if not isinstance(observation, Observation):
            raise ObservationError(f"found {shown(observation)}, expected Observation(...)", field="observation")
        if self.reader is not None:
            return self._read(observation, self.reader)
        utterance = unigram.split(observation.words, self.problem)
        if utterance.meaning is Meaning.CANCEL:
            self.begin()
        parts = observations.log_likelihoods(observation, self.asked, self.problem, self.chances)
        self._take_in(observation, parts)
        return utterance

    def _read(self, observation: Observation, reader: Reader) -> Utterance:
        """Take in an observation whose words a reader reads; a correction takes back what was said before."""
        asked = self._evidence.unanswered
        answer, content = divided(observation.words, self.answers, asked is not None)
        if answer is Meaning.CANCEL:
            self.begin()
        heard = reader.read(content, self.scene, self._context.after_question(self.asked))
        self._context = heard.context
        response = () if answer is None or answer is Meaning.OBJECT else (STAND_INS[answer],)
        known = tuple(word for word in content if word not in heard.unknown and word != STOP)
        if heard.corrects:
            self._evidence = self._evidence.without_talk()
            self._belief = Belief.of_logs(self._evidence.prior + self._evidence.pointing)
        words = heard.log_likelihood if known else unigram.base_log_likelihood((), self.problem)
        answered = observations.log_likelihoods(
            Observation(response, observation.ray), self.asked, self.problem, self.chances
        )
        parts = Parts(words, answered.answers, answered.pointing)
        self.heard = heard if content else None
        spoken = (self.problem.words[0],) if known else ()  # for whose turn it is, any word of the scene will do
        self._take_in(Observation((*spoken, *response), observation.ray), parts)
        return Utterance(known, response if answer in {Meaning.YES, Meaning.NO} else (), heard.unknown, answer)

    def _take_in(self, observation: Observation, parts: Parts) -> None:
        self._belief = self._belief.updated(observation, self.asked, self.problem, parts=parts)
        self.phase = observations.phase_after(observation, self._acted, self.problem, self.phase, asked=self.asked)
        self._acted = Wait()
        answered = observations.meant(observation, self.problem).answer in (YES, NO)
        self._evidence = self._evidence.plus(parts, answered=answered)
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
        self.asked, self._acted = asked_after(action, self.asked), action
        self.handed = action.item if isinstance(action, Pick) else None
        if isinstance(action, Point):
            self._evidence = self._evidence.asked(action.item)
        self._steps += 1

    def take(self, event: Event) -> None:
        """Go on from an event: an observation, or what an action came to. Live and replayed alike."""
        if isinstance(event, Observed):
            if event.anew:
                self.begin()
            self.update(event.observation)
        elif event.counts_as is not None:
            self.did(event.counts_as)

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

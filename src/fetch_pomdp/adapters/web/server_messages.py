"""What the server sends to a page, as JSON objects."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.explain import even
from fetch_pomdp.core.hearing import texts
from fetch_pomdp.core.interaction import ASKING_AGAIN, CANCELLED, FAILED, LISTENING, NOT_UNDERSTOOD, OBJECTED
from fetch_pomdp.core.language.names import words_besides_name
from fetch_pomdp.core.language.reading.telling import whose_is_open
from fetch_pomdp.core.language.words import COURTESY
from fetch_pomdp.core.live import BeliefChanged, Decided, Did, Ended, Heard, SensorStatus, Update
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError, InputError, StoreError
from fetch_pomdp.files.decisions import decision_to_json, phrase_to_json
from fetch_pomdp.files.events import action_to_json, event_to_json

ServerMessage: TypeAlias = dict[str, Any]
Send: TypeAlias = Callable[[ServerMessage], None]  # from any thread; returns soon
View: TypeAlias = Callable[[Update, Agent], ServerMessage | None]  # what a page is told of an update

ASKS, HANDS_OVER = "This one?", "Here you are."
BROKEN = "broken"  # code of an error: the session has ended, and its page is disconnected
# All that the robot says aloud; the page has these sentences in its languages, the server as sound.
SENTENCES = {
    "asks": ASKS,
    "hands_over": HANDS_OVER,
    "listening": LISTENING,
    "failed": FAILED,
    "objected": OBJECTED,
    "cancelled": CANCELLED,
    "asking_again": ASKING_AGAIN,
    "not_understood": NOT_UNDERSTOOD.partition(" I know")[0],
}
_KEYS = {sentence: key for key, sentence in SENTENCES.items()}


def scene_to_json(scene: Scene) -> ServerMessage:
    """Return the table as a page draws it: items, head, and the noise of pointing (rad)."""
    fields = scene.to_mapping()
    for item, shown in zip(scene.items, fields["items"], strict=True):
        shown["vocabulary"] = list(words_besides_name(item))
    return {**fields, "sigma": scene.model.sigma, "threshold": scene.model.gesture_threshold}


def aloud(sentence: str) -> str:
    """Return what is said aloud of a sentence of the robot: of words that vary nothing, for they are to be read."""
    return SENTENCES["not_understood"] if sentence.startswith(NOT_UNDERSTOOD) else sentence


def say_message(sentence: str, *, audible: bool) -> ServerMessage:
    """Return a sentence of the robot, with the address of its sound if there is one, and the words that it knows."""
    key = _KEYS.get(aloud(sentence))
    audio = f"voice/{key}.wav" if audible and key is not None else None
    fields: ServerMessage = {"type": "say", "key": key, "text": sentence, "audio": audio}
    return fields | ({"words": sentence.removeprefix(NOT_UNDERSTOOD)} if key == "not_understood" else {})


def belief_by_id(belief: Vector, scene: Scene) -> dict[str, float]:
    """Return a belief, (n_items,), by the items' ids."""
    return dict(zip((item.id for item in scene.items), belief.tolist(), strict=True))


def with_insight(update: Update, agent: Agent) -> ServerMessage | None:
    """Return an update as a message, with what the robot believes and why; None if there is nothing to tell."""
    if isinstance(update, BeliefChanged):
        return {**_changed(update), "belief": belief_by_id(update.belief, agent.scene), "even": even(update.belief)}
    if isinstance(update, Decided):
        why = update.decision.explanation
        phrase = None if why is None else phrase_to_json(why.phrase())
        fields = decision_to_json(update.decision, agent.scene)
        return {"type": "decided", "t": update.time, **fields, "phrase": phrase}
    return _outward(update, agent)


def without_insight(update: Update, agent: Agent) -> ServerMessage | None:
    """Return an update as a message without beliefs and reasons; None if there is nothing to tell."""
    if isinstance(update, BeliefChanged):
        return _changed(update)
    if isinstance(update, Decided):
        return decided_message(update, agent)
    return _outward(update, agent)


def talk_state(agent: Agent) -> ServerMessage:
    """Return where the talk stands: the item of a question that waits for its answer, and whether a request goes on."""
    open_question = None if agent.handed is not None else agent.evidence.unanswered
    begun = agent.handed is None and bool(agent.problem.tables.begun[agent.phase])
    return {"asked": None if open_question is None else agent.scene.items[open_question].id, "begun": begun}


def decided_message(update: Decided, agent: Agent) -> ServerMessage:
    """Return the action that begins, without its reasons."""
    return {"type": "decided", "t": update.time, **action_to_json(update.decision.action, agent.scene)}


def _changed(update: BeliefChanged) -> ServerMessage:
    return {"type": "belief", "t": update.time, "provisional": update.provisional, "heard": list(update.words)}


def _outward(update: Did | Heard | SensorStatus | Ended, agent: Agent) -> ServerMessage | None:
    if isinstance(update, Did | Heard):
        message = event_message(update.event, agent)
        return None if message is None else message | talk_state(agent)
    if isinstance(update, SensorStatus):
        return status_message(update)
    return {"type": "ended", "picked": update.picked}


def status_message(update: SensorStatus) -> ServerMessage:
    """Return the state of a sensor."""
    return {"type": "status", "sensor": update.name, "state": update.state.value, "text": update.text}


def event_message(event: Event, agent: Agent) -> ServerMessage | None:
    """Return an event of the log as a message, None for a finished wait and for an observation of nothing."""
    if isinstance(event, Acted):
        if isinstance(event.action, Wait):
            return None
        return {"type": "action", "outcome": event.outcome.value, **event_to_json(event, agent.scene)}
    if not event.observation.words and event.observation.ray is None:
        return None
    said = agent.understood.utterance
    unknown = [word for word in said.unknown if word not in COURTESY]
    understood = bool(said.base or said.meaning) and not agent.understood.lost
    fields = event_to_json(event, agent.scene)
    if event.words:
        fields["observation"]["utterance"] = " ".join(texts(event.words))  # as it was heard, not as it was read
    return {"type": "observed", "unknown": unknown, "understood": understood, "reading": _reading(agent), **fields}


def _reading(agent: Agent) -> ServerMessage | None:
    """Return what a reader made of the last words, None where it made nothing of them."""
    heard = agent.understood.heard
    if heard is None or agent.understood.lost or not heard.readings or not heard.readings[0].meaning.parts:
        return None
    return {"meaning": str(heard.readings[0].meaning), "whose": whose_is_open(heard)}


def error_message(error: Exception, code: str = "refused") -> ServerMessage:
    """Return an error as a page is told of it; one that the page did not cause is not described."""
    caused_by_page = isinstance(error, InputError) and not isinstance(error, EventError | StoreError)
    text = str(error) if caused_by_page else "something went wrong on the server"
    return {"type": "error", "code": code, "message": text}

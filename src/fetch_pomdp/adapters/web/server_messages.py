"""What the server tells a page, as JSON objects."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.interaction import FAILED, LISTENING, OBJECTED
from fetch_pomdp.core.language import split
from fetch_pomdp.core.live import BeliefChanged, Decided, Did, Ended, Heard, SensorStatus, Update
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.words import COURTESY
from fetch_pomdp.errors import EventError, InputError, StoreError
from fetch_pomdp.files.decisions import decision_to_json
from fetch_pomdp.files.events import action_to_json, event_to_json

Told = dict[str, Any]
View: TypeAlias = Callable[[Update, Agent], Told | None]  # what a page is told of an update

ASKS, HANDS_OVER = "This one?", "Here you are."
BROKEN = "broken"  # code of a complaint: the party is at its end, and its page is let go
# All that the robot says; the page has these sentences in its languages, the server as sound.
SENTENCES = {
    "asks": ASKS,
    "hands_over": HANDS_OVER,
    "listening": LISTENING,
    "failed": FAILED,
    "objected": OBJECTED,
}
_KEYS = {sentence: key for key, sentence in SENTENCES.items()}


def scene_to_json(scene: Scene) -> Told:
    """Return the table as a page draws it: items, head, and the noise of pointing (rad)."""
    fields = scene.to_mapping()
    return {**fields, "sigma": scene.model.sigma, "threshold": scene.model.gesture_threshold}


def saying(sentence: str, *, audible: bool) -> Told:
    """Return what the robot says now, and where its sound is, if there is one."""
    key = _KEYS.get(sentence)
    audio = f"voice/{key}.wav" if audible and key is not None else None
    return {"type": "say", "key": key, "text": sentence, "audio": audio}


def belief_by_id(belief: Vector, scene: Scene) -> dict[str, float]:
    """Return a belief, (n_items,), by the items' ids."""
    return dict(zip((item.id for item in scene.items), belief.tolist(), strict=True))


def with_insight(update: Update, agent: Agent) -> Told | None:
    """Return an update as a message, with what the robot believes and why; None where there is nothing to tell."""
    if isinstance(update, BeliefChanged):
        return {**_changed(update), "belief": belief_by_id(update.belief, agent.scene)}
    if isinstance(update, Decided):
        return {"type": "decided", "t": update.time, **decision_to_json(update.decision, agent.scene)}
    return _outward(update, agent)


def without_insight(update: Update, agent: Agent) -> Told | None:
    """Return an update as a message that says nothing of the robot's mind; None where there is nothing to tell."""
    if isinstance(update, BeliefChanged):
        return _changed(update)
    if isinstance(update, Decided):
        return decided(update, agent)
    return _outward(update, agent)


def decided(update: Decided, agent: Agent) -> Told:
    """Return the action that begins, without its reasons."""
    return {"type": "decided", "t": update.time, **action_to_json(update.decision.action, agent.scene)}


def _changed(update: BeliefChanged) -> Told:
    return {"type": "belief", "t": update.time, "provisional": update.provisional, "heard": list(update.words)}


def _outward(update: Did | Heard | SensorStatus | Ended, agent: Agent) -> Told | None:
    if isinstance(update, Did | Heard):
        return event_message(update.event, agent)
    if isinstance(update, SensorStatus):
        return sensor_status(update)
    return {"type": "ended", "picked": update.picked}


def sensor_status(update: SensorStatus) -> Told:
    """Return how a sensor does."""
    return {"type": "status", "sensor": update.name, "state": update.state.value, "text": update.text}


def event_message(event: Event, agent: Agent) -> Told | None:
    """Return an event of the log as a message; silent observations and finished waits are nobody's news."""
    if isinstance(event, Acted):
        if isinstance(event.action, Wait):
            return None
        return {"type": "action", "outcome": event.outcome.value, **event_to_json(event, agent.scene)}
    if not event.observation.words and event.observation.ray is None:
        return None
    parts = split(event.observation.words, agent.problem)
    unknown = [word for word in parts.unknown if word not in COURTESY]
    understood = bool(parts.base or parts.response)
    return {"type": "observed", "unknown": unknown, "understood": understood, **event_to_json(event, agent.scene)}


def complaint(error: Exception, code: str = "refused") -> Told:
    """Return an error as a page is told of it; what is none of the person's making is not described."""
    theirs = isinstance(error, InputError) and not isinstance(error, EventError | StoreError)
    text = str(error) if theirs else "something went wrong on the server"
    return {"type": "error", "code": code, "message": text}

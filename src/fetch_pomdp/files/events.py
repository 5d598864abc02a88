"""Events as JSON objects, one a line, and back."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.events import Acted, Event, Likelihoods, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Outcome, Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import ActionError, EventError, InputError

Made = TypeVar("Made")

ACTIONS = ("wait", "point", "pick")
OUTCOMES = tuple(outcome.value for outcome in Outcome)
FLAGS = ("early", "anew")  # of an observation


def event_from_json(data: Mapping[str, Any], scene: Scene) -> Event:
    """Build an event from the fields of a line. Raises EventError, ActionError, SceneError or ObservationError."""
    if "action" in data and "observation" in data:
        raise EventError("found an action and an observation, expected one line for each", field="action")
    if "action" in data:
        return _acted(data, scene)
    checks.known(data, ("observation", "t", *FLAGS), "field", EventError)
    checks.required(data, ("observation",), EventError)
    time = _time(data.get("t"), "t")
    for name in FLAGS:
        if not isinstance(data.get(name, False), bool):
            raise EventError(f"found {shown(data[name])}, expected true or false", field=name)
    try:
        observed = _observed(checks.mapping(data["observation"], "", EventError), time, len(scene.items))
    except InputError as error:
        raise error.within("observation") from None
    return dataclasses.replace(observed, **{name: data.get(name, False) for name in FLAGS})


def _acted(data: Mapping[str, Any], scene: Scene) -> Acted:
    checks.known(data, ("action", "item", "outcome", "reason", "t", "passes"), "field", EventError)
    name = data["action"]
    if name not in ACTIONS:
        raise ActionError(f"found {shown(name)}, expected one of {', '.join(ACTIONS)}", field="action")
    if name == "wait" and data.get("item") is not None:
        raise ActionError(f"found {shown(data['item'])}, expected none: a wait is about no item", field="item")
    outcome = data.get("outcome", "done")
    if outcome not in OUTCOMES:
        raise EventError(f"found {shown(outcome)}, expected one of {', '.join(OUTCOMES)}", field="outcome")
    reason = data.get("reason", "")
    if reason and outcome != "failed":
        raise EventError(f"found {shown(reason)}, expected none: this action did not fail", field="reason")
    if not isinstance(reason, str):
        raise EventError(f"found {shown(reason)}, expected text", field="reason")
    passes = data.get("passes")
    if passes is not None and (not isinstance(passes, int) or isinstance(passes, bool) or passes < 1):
        raise EventError(f"found {shown(passes)}, expected a whole number from 1", field="passes")
    action: Action = Wait()
    if name != "wait":
        checks.required(data, ("item",), EventError)
        item = item_index(data["item"], scene, "item")
        action = Point(item) if name == "point" else Pick(item)
    return Acted(action, Outcome(outcome), time=_time(data.get("t"), "t"), passes=passes, reason=reason)


def _observed(data: Mapping[str, Any], time: float | None, n_items: int) -> Observed:
    known = ("utterance", "words", "alternatives", "read", "head", "wrist", "spoken")
    checks.known(data, known, "field", EventError)
    utterance, spoken = (_text(data.get(name), name) for name in ("utterance", "spoken"))
    words = _listed(data.get("words"), "words", _word)
    if utterance is None:
        utterance = " ".join(word.text for word in words)
    head, wrist = data.get("head"), data.get("wrist")
    if (head is None) != (wrist is None):
        missing = "head" if head is None else "wrist"
        raise EventError("found none, expected head and wrist, or neither", field=missing)
    ray = None if head is None or wrist is None else Ray(head, wrist)
    said = None if spoken is None else tokenize(spoken)
    in_words = tokenize if data.get("read") is None else words_of
    alternatives = _listed(data.get("alternatives"), "alternatives", partial(_alternative, in_words=in_words))
    observation = Observation(in_words(utterance), ray, alternatives)
    read = _read(data.get("read"), max(len(alternatives), 1), n_items)
    return Observed(observation, words, time, said, read=read)


def _read(value: object, n_readings: int, n_items: int) -> Likelihoods:
    """Return what a reader said of each reading, a number for each item."""
    if value is None:
        return ()
    expected = f"expected a list for each of {n_readings} readings"
    if not isinstance(value, list) or len(value) != n_readings:
        raise EventError(f"found {shown(value)}, {expected}", field="read")
    for place, row in enumerate(value):
        if not isinstance(row, list) or len(row) != n_items:
            raise EventError(
                f"found {shown(row)}, expected a number for each of {n_items} items", field=f"read[{place}]"
            )
    return tuple(
        tuple(checks.number(each, f"read[{place}]", "a log-likelihood", EventError) for each in row)
        for place, row in enumerate(value)
    )


def _text(value: object, field: str) -> str | None:
    if value is not None and not isinstance(value, str):
        raise EventError(f"found {shown(value)}, expected text or null", field=field)
    return value


def _listed(value: object, field: str, make: Callable[[Mapping[str, Any]], Made]) -> tuple[Made, ...]:
    """Return what is made of each object of a list, () where there is none; errors name the place in it."""
    if value is None:
        return ()
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise EventError(f"found {shown(value)}, expected a list of {field}", field=field)
    made: list[Made] = []
    for index, each in enumerate(value):
        try:
            made.append(make(checks.mapping(each, "", EventError)))
        except InputError as error:
            raise error.within(f"{field}[{index}]") from None
    return tuple(made)


def _alternative(data: Mapping[str, Any], *, in_words: Callable[[str], tuple[str, ...]]) -> Alternative:
    checks.known(data, ("utterance", "weight"), "field", EventError)
    checks.required(data, ("utterance", "weight"), EventError)
    weight = checks.within(data["weight"], 0.0, 1.0, "weight", "a probability above 0", EventError)
    return Alternative(in_words(_text(data["utterance"], "utterance") or ""), weight)


def _word(data: Mapping[str, Any]) -> Word:
    checks.known(data, ("text", "start", "end", "posterior"), "field", EventError)
    checks.required(data, ("text", "start", "end"), EventError)
    posterior = data.get("posterior", 1.0)
    return Word(
        checks.text(data["text"], "text", "a word", EventError),
        checks.number(data["start"], "start", "a time in seconds", EventError),
        checks.number(data["end"], "end", "a time in seconds", EventError),
        checks.within(posterior, 0.0, 1.0, "posterior", "a probability", EventError),
    )


def _time(value: object, field: str) -> float | None:
    return None if value is None else checks.number(value, field, "a time in seconds", EventError)


def item_index(value: object, scene: Scene, field: str) -> int:
    """Return the index of the item with an id. Raises SceneError, naming the field, if there is none."""
    return scene.index(checks.text(value, field, "the id of an item", EventError), field)


def event_to_json(event: Event, scene: Scene) -> dict[str, Any]:
    """Return the fields of an event's line."""
    fields = _observed_to_json(event) if isinstance(event, Observed) else _acted_to_json(event, scene)
    return fields if event.time is None else {**fields, "t": round(event.time, 3)}


def _acted_to_json(event: Acted, scene: Scene) -> dict[str, Any]:
    fields = action_to_json(event.action, scene)
    if not event.done:
        fields["outcome"] = event.outcome.value
    if event.reason:
        fields["reason"] = event.reason
    return fields if event.passes is None else {**fields, "passes": event.passes}


def action_to_json(action: Action, scene: Scene) -> dict[str, Any]:
    """Return an action's name and, unless it is a wait, the id of its item."""
    if isinstance(action, Wait):
        return {"action": "wait"}
    name = "point" if isinstance(action, Point) else "pick"
    return {"action": name, "item": scene.items[action.item].id}


def _observed_to_json(event: Observed) -> dict[str, Any]:
    observation = event.observation
    nothing = "" if observation.alternatives else None  # null is what `words` say
    fields: dict[str, Any] = {"utterance": " ".join(observation.words) or nothing}
    if event.words:
        fields["words"] = [
            {"text": word.text, "start": word.start, "end": word.end, "posterior": word.posterior}
            for word in event.words
        ]
    if observation.alternatives:
        fields["alternatives"] = [
            {"utterance": " ".join(each.words) or None, "weight": each.weight} for each in observation.alternatives
        ]
    if event.read:
        fields["read"] = [list(each) for each in event.read]
    if observation.ray is not None:
        fields |= {"head": list(observation.ray.head), "wrist": list(observation.ray.wrist)}
    if event.spoken is not None:
        fields["spoken"] = " ".join(event.spoken)
    return {"observation": fields} | {name: True for name in FLAGS if getattr(event, name)}

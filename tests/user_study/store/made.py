"""What the tests of the store share."""

from __future__ import annotations

import secrets

import pytest

from fetch_pomdp.core.action import Pick, Wait
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header
from fetch_pomdp.user_study.store.participants import Agreement, Participant
from fetch_pomdp.user_study.store.store import Store

BOTH = ["sqlite", pytest.param("postgres", marks=pytest.mark.postgres)]
SCENE = Scene.load("ambiguous")
WAITED, PICKED = Acted(Wait(), time=1.0), Acted(Pick(1), time=2.5)


def header(person: int, order: int, target: str = "bowl-2", paradigm: str = "never") -> Header:
    return Header(
        scene=SCENE, scene_name="ambiguous", planner="paper-never", target=target, person=person, layout="ambiguous",
        paradigm=paradigm, order=order, begun=0.0,
    )  # fmt: skip


AGREED = Agreement(language="en", given={"taking_part": True, "sound": True}, text="You talk to a robot.")


def enrolled(store: Store, study: str = "pilot", people: int = 4, digest: str = "d1") -> tuple[Participant, str]:
    secret = secrets.token_urlsafe(24)
    return store.enrol(study, digest, people, AGREED, secret=secret, trials=lambda person: 6 + person), secret


def joined(store: Store, study: str = "pilot") -> Participant:
    return enrolled(store, study)[0]

"""The real-time loop behind every live mode: sensors push, the interaction listens, a screen is told."""

from fetch_pomdp.core.live.body import LiveRobot
from fetch_pomdp.core.live.clock import Clock, RealClock
from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.outbox import Outbox
from fetch_pomdp.core.live.session import LIVE, LiveSession
from fetch_pomdp.core.live.updates import BeliefChanged, Decided, Did, Ended, Heard, SensorStatus, State, Update

__all__ = [
    "LIVE",
    "BeliefChanged",
    "Clock",
    "Decided",
    "Did",
    "Ended",
    "Heard",
    "Inbox",
    "LiveRobot",
    "LiveSession",
    "Outbox",
    "RealClock",
    "SensorStatus",
    "State",
    "Update",
]

"""The real-time loop behind every live mode: sensors push, the interaction listens, a screen is told."""

from fetch_pomdp.core.live.body import LiveRobot
from fetch_pomdp.core.live.clock import Clock, RealClock
from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.session import LIVE, LiveSession
from fetch_pomdp.core.live.updates import (
    BeliefChanged,
    Decided,
    Did,
    Ended,
    Heard,
    SensorState,
    SensorStatus,
    Update,
    UpdateQueue,
)

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
    "RealClock",
    "SensorState",
    "SensorStatus",
    "Update",
    "UpdateQueue",
]

"""What the robot, and what it carries, touches while it moves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fetch_pomdp.adapters.robot.mujoco.model import FLOOR, PERSON, TABLE, body_of

Flags = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.int64]
NOTHING, ROBOT, FURNITURE, SOMEBODY, FIRST_ITEM = -1, 0, 1, 2, 3


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact's beginning. what: the robot's body, or the item in its hand. with_what: an item, table, person, or
    another body of the robot.
    """

    time: float  # s of the world's clock
    phase: str  # what the robot was doing
    what: str
    with_what: str


class Owners:
    """Whose each geom of a model is: the robot's, an item's, the table's or the person's.

    owner: (n_geoms,) int. of_hand: by arm, which geoms are its gripper's, (n_geoms,) bool.
    """

    def __init__(self, model: Any, root: str, items: Iterable[str], arms: Iterable[str]) -> None:
        self.items = tuple(items)
        self.body_of: Numbers = np.array(model.geom_bodyid, dtype=np.int64)
        roots = model.body_rootid[self.body_of]
        owner: Numbers = np.full(model.ngeom, NOTHING)
        owner[roots == model.body(root).id] = ROBOT
        owner[roots == model.body(TABLE).id] = FURNITURE
        owner[model.geom(FLOOR).id] = FURNITURE
        owner[roots == model.body(PERSON).id] = SOMEBODY
        for index, item in enumerate(self.items):
            owner[roots == model.body(body_of(item)).id] = FIRST_ITEM + index
        self.owner = owner
        names = [model.body(index).name for index in self.body_of]
        self.of_hand: dict[str, Flags] = {arm: np.array([name.startswith(f"{arm}/") for name in names]) for arm in arms}
        self._bodies: list[str] = [model.body(index).name for index in range(model.nbody)]

    def geoms(self, item: str) -> Flags:
        """Return which geoms are an item's, (n_geoms,) bool."""
        found: Flags = self.owner == self.number(item)
        return found

    def within_a_hand(self, pairs: Numbers) -> Flags:
        """Return which pairs of geoms (n, 2) are of one gripper, whose links meet when it closes, (n,) bool."""
        found: Flags = np.any([hand[pairs].all(axis=1) for hand in self.of_hand.values()], axis=0)
        return found

    def number(self, item: str) -> int:
        """Return the number that marks an item's geoms in `owner`."""
        return FIRST_ITEM + self.items.index(item)

    def name(self, geom: int) -> str:
        """Return the name of a geom's body, or of the item, the table or the person that it is part of."""
        owner = int(self.owner[geom])
        if owner >= FIRST_ITEM:
            return self.items[owner - FIRST_ITEM]
        bodies = {FURNITURE: TABLE, SOMEBODY: PERSON}
        return bodies.get(owner, self._bodies[int(self.body_of[geom])])


class ContactLog:
    """All contacts of the robot and of what it holds, each when it begins; what it is meant to take is left out."""

    def __init__(self, owners: Owners) -> None:
        self._owners = owners
        self._going: set[tuple[str, str]] = set()
        self.contacts: list[Contact] = []

    def watch(self, data: Any, phase: str, target: str | None, *, carried: str | None) -> None:
        """Look at the contacts of a step. target: the item that the fingers may touch. carried: that in the hand,
        whose contacts count as the robot's.
        """
        pairs = data.contact.geom[: data.ncon]
        owner = self._owners.owner[pairs]
        mine, taken = owner == ROBOT, self._owners.within_a_hand(pairs)
        for item in (target, carried):
            if item is None:
                continue
            taken |= (owner == self._owners.number(item)).any(axis=1) & mine.any(axis=1)
        if carried is not None:
            mine |= owner == self._owners.number(carried)
        going = set()
        for index in np.flatnonzero(mine.any(axis=1) & ~taken):
            first, second = pairs[index] if mine[index, 0] else pairs[index][::-1]
            pair = (self._owners.name(int(first)), self._owners.name(int(second)))
            if pair not in self._going and pair not in going:
                self.contacts.append(Contact(float(data.time), phase, *pair))
            going.add(pair)
        self._going = going

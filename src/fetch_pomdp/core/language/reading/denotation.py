"""From a meaning to degrees: how far each item of a table is what a description says, in every view.

All degrees have the axes (variants, views, items), of length 1 where nothing differs. A description's restricting parts
(words, sides, relations) are multiplied; what ranks (closest, second from the left, in the middle) then ranks the items
by how far these hold. Landmarks are descriptions with degrees of their own: what is uncertain about them stays so.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.language.reading import degrees
from fetch_pomdp.core.language.reading.degrees import Array
from fetch_pomdp.core.language.reading.form import (
    Alone,
    Anaphor,
    Between,
    Cluster,
    Count,
    Crowded,
    Description,
    Form,
    Known,
    Middle,
    Not,
    Person,
    Relation,
    Seen,
    Select,
    Side,
    Superlative,
    Union,
    Within,
    extent,
)
from fetch_pomdp.core.language.reading.grammar import Grammar
from fetch_pomdp.core.language.reading.groups import Groups, groups
from fetch_pomdp.core.language.reading.table import LISTENER, SPEAKER, VIEWS, Table, person_in
from fetch_pomdp.core.language.reading.weights import Weights

UNLIKELY = 0.1  # degree, of the best landmark's, below which an item is no end of what is between
ENDS = 24  # items that are looked at as an end of what is between
DEEPEST = 6  # landmarks of landmarks
ALIKE = 1e-6  # nats between groups that are as likely
MOST_ALIKE = 24  # groups that are looked at, where more are as likely
LIKELIEST = 4  # groups that are looked at
SWAPPED, WIDE, DEEP = (np.array(column) for column in zip(*VIEWS, strict=True))
LATERAL = {"left": -1.0, "right": 1.0, "west": -1.0, "east": 1.0}
UPRIGHT = {"top": 1.0, "bottom": -1.0}
UPON = {"front": -1.0, "back": 1.0}
WAYS = {
    "left of": ("left",), "right of": ("right",), "above": ("top",), "below": ("bottom",), "behind": ("back",),
    "in front of": ("front",),
}  # fmt: skip
# Of a landmark with a front of its own: how far ahead of it, and how far to its left.
FACING = {"in front of": (1.0, 0.0), "behind": (-1.0, 0.0), "left of": (0.0, 1.0), "right of": (0.0, -1.0)}
REACHES = {"next to": "near_reach", "touching": "touch_reach", "near": "about_reach", "among": "about_reach"}
RANKING = (Superlative, Middle, Alone, Crowded)


class Denotation:
    """The degrees of meanings on one table under some weights; what was computed once is kept."""

    def __init__(self, table: Table, grammar: Grammar, weights: Weights) -> None:
        self.table, self.grammar, self.w = table, grammar, weights.values
        self._kept: dict[Any, Array] = {}
        self._grouped: dict[Any, tuple[Array, Array]] = {}
        self.numbers = 0  # that are kept
        self._people: dict[Person, Array] = {
            whom: np.array([person_in(view, whom) for view in VIEWS]) for whom in Person
        }

    def of(self, said: Description, depth: int = 0) -> Array:
        """Return how far each item is what is said."""
        return self._once(_key(said, depth), lambda: self._of(said, depth))

    def _once(self, key: Any, make: Callable[[], Array]) -> Array:
        """Return what is kept under a key, made if it is not yet."""
        found = self._kept.get(key)
        if found is None:
            found = self._kept[key] = make()
            self.numbers += found.size
        return found

    def _of(self, said: Description, depth: int) -> Array:
        if depth > DEEPEST:
            return np.ones((1, 1, self.table.size))
        if said.plural:
            members, chances = self.groups(said, depth)
            return (chances[..., None] * members).sum(axis=-2)
        holds: Array = np.ones((1, 1, self.table.size))
        ranking: list[Form] = []
        inside: list[Description] = []
        for part in said.parts:
            if isinstance(part, Within) and isinstance(part.group, Description) and part.group.plural:
                inside.append(part.group)
            elif ranks(part):
                ranking.append(part)
            else:
                holds = holds * self._part(part, depth)
        if inside:
            return self._within(inside, holds, ranking, depth)
        return self._ranked(holds, ranking, depth)

    def _within(self, inside: list[Description], holds: Array, ranking: list[Form], depth: int) -> Array:
        """Return the degrees of one of a group: what ranks does so among its members."""
        members, chances = self.groups(inside[0], depth + 1)
        for other in inside[1:]:
            holds = holds * np.maximum(self.of(other, depth + 1), self.w.group_outside)
        total: Array = np.zeros((1, 1, self.table.size))
        for index in range(members.shape[-2]):
            member = np.maximum(members[index], 0.0)
            local = self._ranked(holds * (member + 1e-9), ranking, depth, group=True)
            total = total + chances[..., index : index + 1] * local
        return total + self.w.group_outside * self._ranked(holds, ranking, depth) * 0.1

    def _ranked(self, holds: Array, ranking: list[Form], depth: int, *, group: bool = False) -> Array:
        candidates = degrees.share(holds)
        for part in ranking:
            holds = holds * self._rank(part, candidates, depth, group)
        return holds

    def groups(self, said: Description, depth: int) -> tuple[Array, Array]:
        """Return the likeliest groups that a plural description may mean: (g, n) members and (..., g) chances."""
        key = _key(said, depth)
        found = self._grouped.get(key)
        if found is None:
            found = self._grouped[key] = self._groups(said, depth)
        return found

    def _groups(self, said: Description, depth: int) -> tuple[Array, Array]:
        hard = np.ones(self.table.size)
        number, shape = None, ""
        holds: Array = np.ones((1, 1, self.table.size))
        ranking: list[Form] = []
        for part in said.parts:
            if isinstance(part, Select):
                hard = hard * self.table.called(part.word, self.grammar)
            elif isinstance(part, Count):
                number = part.number
            elif isinstance(part, Cluster):
                shape = shape or part.shape
            elif isinstance(part, Within) and isinstance(part.group, Description):
                holds = holds * np.maximum(self.of(part.group, depth + 1), self.w.group_outside)
            elif ranks(part):
                ranking.append(part)
            else:
                holds = holds * self._part(part, depth)
        candidates = hard > 0.3 * max(float(hard.max()), 1e-9)
        found = self._sets(candidates, number, shape)
        holds = holds * np.where(candidates, 1.0, 1e-6)
        for part in ranking:
            holds = holds * self._rank(part, degrees.share(holds), depth, False)
        return self._chances(found, holds)

    def _sets(self, candidates: Array, number: int | None, shape: str) -> Groups:
        table, key = self.table, ("sets", candidates.tobytes(), number, shape)
        found = table.kept.get(key)
        if found is None:
            across = {"row": table.away, "column": table.right}.get(shape)
            along = None if across is None else across[SPEAKER] * table.spread / table.spacing
            found = table.kept[key] = groups(candidates, number, table.distances, along)
        return found

    def _chances(self, found: Groups, holds: Array) -> tuple[Array, Array]:
        w, sizes = self.w, np.maximum(found.members.sum(axis=1), 1.0)
        fit = np.log(np.maximum(holds, 1e-12)) @ found.members.T / sizes
        log = fit - w.group_near * found.near - w.group_spread * found.spread + w.group_apart * found.apart
        best = _best(log.max(axis=(0, 1)), LIKELIEST)
        log = log[..., best]
        chances = np.exp(log - np.logaddexp.reduce(log, axis=-1, keepdims=True))
        quality = np.exp(np.minimum(fit[..., best].max(axis=-1, keepdims=True), 0.0))
        return found.members[best], chances * quality

    def _part(self, part: Form, depth: int) -> Array:
        return self._once(_key(part, depth), lambda: self._restricting(part, depth))

    def _restricting(self, part: Form, depth: int) -> Array:
        w = self.w
        if isinstance(part, Select):
            called = self.table.called(part.word, self.grammar)
            return np.maximum(called, w.word_missing) if called.any() else np.ones(self.table.size)
        if isinstance(part, Side):
            return self._side(part)
        if isinstance(part, Relation | Between):
            held = self._relation(part, depth) if isinstance(part, Relation) else self._between(part, depth)
            return w.missing + (1.0 - w.missing) * held
        return self._composed(part, depth)

    def _composed(self, part: Form, depth: int) -> Array:
        result: Array = np.ones((1, 1, self.table.size))
        if isinstance(part, Not):
            result = self._negated(part, depth)
        elif isinstance(part, Seen):
            person = self._people[part.viewer]
            result = np.exp(-self.w.seen_view * ~((person == WIDE) & (person == DEEP))[:, None])
        elif isinstance(part, Within):
            result = np.maximum(degrees.share(self._landmark(part.group, depth)), self.w.group_outside)
        elif isinstance(part, Union):
            result = np.maximum(self._landmark(part.first, depth), self._landmark(part.second, depth))
        elif isinstance(part, Description):
            result = self.of(part, depth + 1)
        elif isinstance(part, Known):
            result = np.where(np.arange(self.table.size) == part.index, 1.0, self.w.word_missing)
        return result

    def _negated(self, part: Not, depth: int) -> Array:
        inner = part.form if isinstance(part.form, Description) else Description((part.form,))
        held = degrees.share(self.of(inner, depth + 1))
        return np.maximum(1.0 - held, self.w.not_floor)

    def _landmark(self, landmark: Person | Description | Anaphor, depth: int) -> Array:
        if isinstance(landmark, Description):
            return degrees.share(self.of(landmark, depth + 1))
        return np.ones((1, 1, self.table.size))

    def _along(self, side: str, viewer: Person | None) -> Array:
        """Return how far to a side each item is, (views, n) in spreads: the side's own direction is positive."""
        table = self.table
        pick = None if viewer is None else self._people[viewer]
        if side in LATERAL:
            return LATERAL[side] * table.right[WIDE if pick is None else pick]
        if side in UPRIGHT:
            return UPRIGHT[side] * table.away[WIDE if pick is None else pick]
        return UPON[side] * table.away[DEEP if pick is None else pick]

    def _side(self, side: Side) -> Array:
        """Return how far each item is on a side, of all items: softly beyond a border, and more the farther."""
        w, result = self.w, np.ones((1, 1, 1))
        for name in side.sides:
            along = self._along(name, side.viewer)
            result = result * degrees.sigmoid((along - w.side_border) / w.side_blur)
            before = degrees.before(self._order(name, side.viewer), np.ones((1, 1, self.table.size)))
            result = result * np.exp(-w.side_fall * before / 3.0)
        return result

    def _rank(self, part: Form, candidates: Array, depth: int, group: bool) -> Array:
        w = self.w
        result: Array = np.ones((1, 1, self.table.size))
        if isinstance(part, Side):
            for name in part.sides:
                order = self._order(name, part.viewer)
                result = result * degrees.ranked(order, candidates, 1, w.extreme_fall)
        elif isinstance(part, Superlative):
            result = self._superlative(part, candidates, depth)
        elif isinstance(part, Middle):
            result = self._middle(part, candidates, depth, group)
        elif isinstance(part, Alone):
            result = self._lonely(candidates, -1.0, w.alone_fall)
        elif isinstance(part, Crowded):
            result = self._lonely(candidates, 1.0, w.crowd_fall)
        elif isinstance(part, Relation):
            result = self._before_person(part, candidates)
        return result

    def _ordered(self, key: Any, values: Callable[[], Array]) -> Array:
        """Return the soft order of the items by values, (..., n, n); kept under a key."""
        return self._once(("order", key), lambda: degrees.precedes(values(), self.w.rank_blur))

    def _order(self, side: str, viewer: Person | None) -> Array:
        """Return the order of the items from the farthest on a side."""
        return self._ordered((side, viewer), lambda: -self._along(side, viewer))

    def _nearest(self, person: int) -> Array:
        """Return the order of the items from the nearest to a person, 0 or 1."""
        return self._ordered(person, lambda: self._nearness(person))

    def _nearest_to(self, whom: Person) -> Array:
        """Return the order of the items from the nearest to who is called so, in each view."""
        return self._ordered(whom, lambda: self._nearness_to(whom))

    def _lonely(self, candidates: Array, sign: float, fall: Array) -> Array:
        apart = np.sort(self.table.distances, axis=1)[:, min(1, self.table.size - 1) : 2 if sign < 0 else 5].mean(
            axis=1
        )
        return degrees.ranked(self._ordered(("apart", sign), lambda: sign * apart), candidates, 1, fall)

    def _superlative(self, part: Superlative, candidates: Array, depth: int) -> Array:
        w = self.w
        fall = w.rank_fall if part.rank == 1 else w.count_fall

        def ranked(order: Array, *, far: bool) -> Array:
            return degrees.ranked(np.swapaxes(order, -1, -2) if far else order, candidates, part.rank, fall)

        if part.by is None:
            chance = np.where(SWAPPED[:, None] > 0, 1.0 - degrees.sigmoid(w.near_you), degrees.sigmoid(w.near_you))
            one, other = (ranked(self._nearest(person), far=part.far) for person in (LISTENER, SPEAKER))
            return chance * one + (1.0 - chance) * other
        if isinstance(part.by, Side):
            side = part.by
            order = self._ordered(side, lambda: -self._sum_along(side))
        elif isinstance(part.by, Person):
            order = self._nearest_to(part.by)
        else:
            landmark = part.by
            order = self._ordered(landmark, lambda: self._distance(landmark, depth))
        return ranked(order, far=part.far)

    def _sum_along(self, side: Side) -> Array:
        return sum((self._along(name, side.viewer) for name in side.sides), start=np.zeros(self.table.size))

    def _nearness(self, person: int) -> Array:
        """Return the distance from a person, (variants, 1, n): between how deep and how far, in spreads."""
        share = self.w.depth / (1.0 + self.w.depth)
        return share * self.table.away[person] + (1.0 - share) * self.table.remote[person] + np.zeros((1, 1, 1))

    def _nearness_to(self, whom: Person) -> Array:
        """Return the distance from who is called so, (variants, views, n), in spreads."""
        of = np.concatenate([self._nearness(SPEAKER), self._nearness(LISTENER)], axis=-2)
        return of[..., self._people[whom], :]

    def _distance(self, landmark: Description, depth: int) -> Array:
        """Return the distance from landmarks that are uncertain, in spreads."""
        where = self._landmark(landmark, depth)
        where = where / np.maximum(where.sum(axis=-1, keepdims=True), 1e-12)
        close = np.exp(-self.table.distances / 0.5) * (1.0 - np.eye(self.table.size))
        held = np.matmul(where, close)  # the distances are the same both ways
        return -0.5 * np.log(np.maximum(held, 1e-12)) * self.table.spacing / self.table.spread

    def _middle(self, part: Middle, candidates: Array, depth: int, group: bool) -> Array:
        w, table = self.w, self.table
        points = table.points / table.spread
        if part.of is not None:
            return self._middle_of(part.of, candidates, depth)
        inner = degrees.precedes(degrees.middle(points, candidates), w.rank_blur)
        own = degrees.ranked(inner, candidates, 1, w.group_middle_fall)
        if group:
            return own
        everything = self._ordered("middle", lambda: degrees.middle(points, np.ones(table.size)))
        share = w.middle_own / (1.0 + w.middle_own)
        return share * own + (1.0 - share) * degrees.ranked(everything, candidates, 1, w.middle_fall)

    def _middle_of(self, of: Description | Anaphor, candidates: Array, depth: int) -> Array:
        w, points = self.w, self.table.points / self.table.spread
        if isinstance(of, Description) and of.plural:
            members, chances = self.groups(of, depth + 1)
            total: Array = np.zeros((1, 1, 1))
            for index, member in enumerate(members):
                inside = np.maximum(member, w.group_outside)
                order = degrees.precedes(degrees.middle(points, member), w.rank_blur)
                rank = degrees.ranked(order, degrees.share(candidates * inside), 1, w.group_middle_fall)
                total = total + chances[..., index : index + 1] * rank * inside
            return total
        order = degrees.precedes(degrees.middle(points, self._landmark(of, depth)), w.rank_blur)
        return degrees.ranked(order, candidates, 1, w.middle_fall)

    def _before_person(self, part: Relation, candidates: Array) -> Array:
        """Return how far each item is in front of a person, next to, or on a side of them."""
        w, whom = self.w, part.landmark
        if not isinstance(whom, Person):
            return np.ones((1, 1, self.table.size))
        if part.name in ("left of", "right of"):
            return degrees.ranked(self._order(part.name.split()[0], whom), candidates, 1, w.extreme_fall)
        order = self._nearest_to(whom)
        if part.name == "away from":
            order = np.swapaxes(order, -1, -2)
        elif part.name == "in front of":
            aside = np.abs(self.table.right[self._people[whom]])
            order = self._ordered(("before", whom), lambda: self._nearness_to(whom) + w.aside * aside)
        return degrees.ranked(order, candidates, 1, w.front_fall)

    def _relation(self, part: Relation, depth: int) -> Array:
        both = (
            part.landmark.parts[0] if isinstance(part.landmark, Description) and len(part.landmark.parts) == 1 else None
        )
        if isinstance(both, Union):  # "next to the red one and the blue one" holds of both
            one, other = (dataclasses.replace(part, landmark=each) for each in (both.first, both.second))
            return self._relation(one, depth) * self._relation(other, depth)
        where = self._landmark(part.landmark, depth)
        if part.name == "away from":
            return 1.0 - degrees.related(where, self._holds(dataclasses.replace(part, name="near")))
        return degrees.related(where, self._holds(part))

    def _holds(self, part: Relation) -> Array:
        return self._once(("relation", part.name, part.viewer, part.direct), lambda: self._relations(part))

    def _relations(self, part: Relation) -> Array:
        """Return how far a relation holds of each item and each landmark, (variants, views, n, n)."""
        w, table, name, direct = self.w, self.table, part.name, part.direct
        if name in REACHES:
            return degrees.beside(table.near, getattr(w, REACHES[name]) * (w.direct_reach if direct else 1.0))
        ways = WAYS.get(name) or tuple(each for each in name.split() if each in LATERAL | UPRIGHT | UPON)
        axis = sum((self._axis(way, part.viewer) for way in ways), start=np.zeros((len(VIEWS), 2)))
        axis = axis / np.maximum(np.sqrt((axis**2).sum(axis=-1, keepdims=True)), 1e-9)
        offsets = table.points[:, None] - table.points[None]
        turn = w.way_turn * (w.direct_turn if direct else 1.0)
        reach = w.way_reach * (w.direct_reach if direct else 1.0)
        seen = degrees.toward(offsets, table.near, axis[..., None, :], turn, reach)
        if part.viewer is not None or name not in FACING or not table.facing.any():
            return seen
        ahead, left = FACING[name]
        facing = table.facing
        own = ahead * facing + left * np.stack([-facing[:, 1], facing[:, 0]], axis=1)
        return np.where(facing.any(axis=1), (seen + degrees.toward(offsets, table.near, own, turn, reach)) / 2.0, seen)

    def _axis(self, way: str, viewer: Person | None) -> Array:
        axes = self.table.axes
        whose = None if viewer is None else self._people[viewer]
        if way in LATERAL:
            return LATERAL[way] * axes[WIDE if whose is None else whose, 0]
        if way in UPRIGHT:
            return UPRIGHT[way] * axes[WIDE if whose is None else whose, 1]
        return UPON[way] * axes[DEEP if whose is None else whose, 1]

    def _between(self, part: Between, depth: int) -> Array:
        w = self.w
        first, second = part.first, part.second
        if second is None and isinstance(first, Description) and len(first.parts) == 1:
            only = first.parts[0]
            if isinstance(only, Union):
                first, second = only.first, only.second
        one = self._landmark(first, depth)
        other = one if second is None else self._landmark(second, depth)
        some, others = _likely(one), _likely(other)
        holds = degrees.between(self.table.distances, some, others, (w.between_wide, w.between_reach, w.between_even))
        return (holds * one[..., None, some, None] * other[..., None, None, others]).max(axis=(-1, -2))


def _best(values: Vector, count: int) -> Integers:
    """Return the indices of the largest values, largest first: `count` of them, and those that are as large (`ALIKE`).

    Else the order of the items would choose among groups that a table has by symmetry.
    """
    order: Integers = np.argsort(-values, kind="stable")
    least = values[order[min(count, len(order)) - 1]] - ALIKE
    return order[: min(int((values >= least).sum()), MOST_ALIKE)]


def _key(form: Form, depth: int) -> Any:
    """Return what degrees are kept under: with their depth, where what is deepest in them is left out because of it."""
    return form if depth + extent(form)[1] <= DEEPEST else (form, depth)


def _likely(landmarks: Array) -> Integers:
    """Return the indices of the items that may be a landmark, at most ENDS, the likeliest; of all if none is."""
    degree = landmarks.max(axis=tuple(range(landmarks.ndim - 1)))
    found = np.flatnonzero(degree > UNLIKELY) if (degree > UNLIKELY).any() else np.arange(landmarks.shape[-1])
    return found if len(found) <= ENDS else np.sort(found[np.argsort(-degree[found], kind="stable")[:ENDS]])


def ranks(part: Form) -> bool:
    """Return whether a part ranks items among others, instead of holding of each by itself."""
    if isinstance(part, Side):
        return part.extreme
    return isinstance(part, RANKING) or (isinstance(part, Relation) and isinstance(part.landmark, Person))

"""A robot in MuJoCo before seeded tables: does it point right, fetch, touch nothing, plan fast, stop soon?

    python benchmarks/robot.py --robot baxter --tables 300 --seed 1000

Each table has six cups, markers, bowls and spoons in random places, turned at random. The robot asks about one item and
then fetches another, as in an interaction. With --stops it is also stopped, at as many tables, at a random moment of a
fetch. Exits with 1 where it falls short of its aims.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator, default_rng

from fetch_pomdp.adapters.robot.mujoco.contacts import Contact
from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.adapters.robot.mujoco.kinds import kind_of
from fetch_pomdp.adapters.robot.mujoco.layout import layout
from fetch_pomdp.adapters.robot.mujoco.model import PERSON, TABLE
from fetch_pomdp.adapters.robot.mujoco.robot import MujocoRobot
from fetch_pomdp.adapters.robot.mujoco.world import World
from fetch_pomdp.core.ports import Failure, Outcome
from fetch_pomdp.core.scene import Item, Scene

KINDS = ("cup", "marker", "bowl", "spoon")
COLORS = ("red", "green", "blue", "yellow")
HEAD = (0.0, 0.0, 1.6)  # m
TABLE_MIDDLE, TABLE_TOP = 1.2, 0.75  # m, from the person, and high
REGION = (0.175, 0.5)  # m, half of where items may be: along the line to the person, and across
GAP = 0.035  # m, between the circles that items need
STILL = 0.02  # rad/s
MOVED = 0.02  # m


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """What happened at one table. Times in s of the robot's clock, but for those of planning and the wall."""

    seed: int
    asked: str
    wanted: str
    pointed: str  # "" or why not
    angle: float  # degrees, from the hand's axis to the item asked about
    nearest: bool  # whether no other item is nearer to the hand's axis
    fetched: str  # "" or why not
    slip: float  # m, at a pull of 1.5 N
    moved: float  # m, of the other item that moved most
    touched: list[str]
    plans: list[tuple[str, float]]
    movements: list[tuple[str, float, float]]
    simulated: float
    wall: float
    processor: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """A fetch that was stopped. still: s until the arms stood. back: m, of the item from where it stood."""

    seed: int
    phase: str
    still: float
    back: float
    rested: str
    moved: float
    touched: list[str] = field(default_factory=list)


def table(rng: Generator) -> Scene:
    """Return a table with six items that do not touch."""
    while True:
        kinds = rng.choice(KINDS, size=6)
        places: list[tuple[np.ndarray, float]] = []
        for kind in kinds:
            radius = kind_of((str(kind),)).radius
            for _ in range(200):
                place = rng.uniform(-1.0, 1.0, 2) * REGION
                if all(np.linalg.norm(place - other) > radius + wide + GAP for other, wide in places):
                    places.append((place, radius))
                    break
        if len(places) == len(kinds):
            break
    items = []
    for index, (kind, (place, _)) in enumerate(zip(kinds, places, strict=True)):
        position = (float(place[1]), TABLE_MIDDLE + float(place[0]), TABLE_TOP)
        items.append(Item(id=f"{kind}-{index}", position=position, vocabulary=(str(kind), COLORS[index % 4])))
    return Scene(items=tuple(items), head=HEAD)


def world_of(scene: Scene, robot: RobotDescription, rng: Generator) -> World:
    """Return the world of a table whose things are turned at random."""
    return World(robot, layout(scene, robot, rng))


def angles(world: World) -> dict[str, float]:
    """Return the angle (degrees) between each item and the axis of the hand that is nearest to pointing at it."""
    found = {}
    for item in world.items.values():
        each = []
        for arm in world.arms:
            hand = world.hand_pose(arm)
            way = world.middle(item) - hand.place
            each.append(np.degrees(np.arccos(np.clip(hand.axes[:, 2] @ way / np.linalg.norm(way), -1.0, 1.0))))
        found[item.id] = float(min(each))
    return found


def reason(outcome: Outcome | Failure) -> str:
    """Return "" for what was done, else why it was not."""
    return outcome.reason if isinstance(outcome, Failure) else "" if outcome is Outcome.DONE else outcome.value


def touched(contacts: Sequence[Contact]) -> list[str]:
    """Return contacts as text, but for those of a lifted or lowered item with the table that it stands on."""
    return [
        f"{contact.phase}: {contact.what} {contact.with_what}"
        for contact in contacts
        if not (contact.with_what == TABLE and is_item(contact.what) and contact.phase in {"lift", "lower"})
    ]


def is_item(name: str) -> bool:
    """Return whether what touched is an item."""
    return name.rpartition("-")[0] in KINDS


def displaced(world: World, before: dict[str, np.ndarray], but: str) -> float:
    """Return how far (m) the other item moved that moved most."""
    return max(float(np.linalg.norm(world.item_pose(id).place - place)) for id, place in before.items() if id != but)


def fetch(seed: int, description: RobotDescription) -> Row:
    """Ask about one item of a seeded table, then fetch another."""
    rng = default_rng(seed)
    scene = table(rng)
    world = world_of(scene, description, rng)
    asked, wanted = (scene.items[int(index)] for index in rng.integers(len(scene.items), size=2))
    before = {item.id: world.item_pose(item.id).place for item in scene.items}
    robot = MujocoRobot(world, lambda _: None, seed=seed)
    begun, worked, clock = time.perf_counter(), time.process_time(), world.time
    pointed = reason(robot.point(asked))
    found = angles(world)
    fetched = reason(robot.pick(wanted))
    return Row(
        seed=seed, asked=asked.id, wanted=wanted.id, pointed=pointed, angle=found[asked.id],
        nearest=min(found, key=found.__getitem__) == asked.id, fetched=fetched,
        slip=robot.given[-1].slip if robot.given else -1.0, moved=displaced(world, before, wanted.id),
        touched=touched(world.log.contacts), plans=[(plan.phase, plan.seconds) for plan in robot.plans],
        movements=[(move.phase, move.planned, move.executed) for move in robot.mover.movements if move.completed],
        simulated=world.time - clock, wall=time.perf_counter() - begun,
        processor=time.process_time() - worked,
    )  # fmt: skip


def stop(seed: int, description: RobotDescription) -> Stop:
    """Stop a fetch of a seeded table at a random moment, see when the arms stand, and have everything put back."""
    rng = default_rng(seed)
    scene = table(rng)
    world = world_of(scene, description, rng)
    wanted = scene.items[int(rng.integers(len(scene.items)))]
    before = {item.id: world.item_pose(item.id).place for item in scene.items}
    moment = world.time + float(rng.uniform(0.05, 6.0))
    speeds: list[tuple[float, float]] = []

    def watch() -> None:
        if world.time >= moment:
            if not speeds:
                robot.stop()
            speeds.append((world.time, max(world.fastest(arm) for arm in world.arms)))

    robot = MujocoRobot(world, lambda _: None, watch, seed=seed)
    outcome = robot.pick(wanted)
    phase = (
        robot.mover.movements[-1].phase if outcome is Outcome.STOPPED else f"not stopped: {reason(outcome) or 'done'}"
    )
    moving = [time for time, speed in speeds if speed > STILL] if outcome is Outcome.STOPPED else []
    still = max(moving) - moment if moving else 0.0
    given = bool(robot.given)
    moment = np.inf
    rested = reason(robot.rest())
    for _ in range(200):
        world.step()
    back = -1.0 if given else float(np.linalg.norm(world.item_pose(wanted.id).place - before[wanted.id]))
    return Stop(
        seed=seed, phase=phase, still=still, back=back, rested=rested, moved=displaced(world, before, wanted.id),
        touched=touched(world.log.contacts),
    )  # fmt: skip


def percent(found: Sequence[Any]) -> str:
    """Return how many of a list are true, as text."""
    return f"{sum(map(bool, found))}/{len(found)} = {100 * sum(map(bool, found)) / max(1, len(found)):.1f} %"


def report(rows: Sequence[Row]) -> str:
    """Return what was measured at all tables as text."""
    planning = np.array([sum(seconds for _, seconds in row.plans) for row in rows])
    each = np.array([seconds for row in rows for _, seconds in row.plans])
    pointed = [row for row in rows if not row.pointed]
    lines = [
        f"pointed: {percent([not row.pointed for row in rows])}; within 1.5 degrees: "
        f"{percent([not row.pointed and row.angle <= 1.5 for row in rows])}; right item nearest: "
        f"{percent([row.nearest for row in pointed])}",
        f"angle: median {np.median([row.angle for row in pointed]):.2f}, "
        f"max {max(row.angle for row in pointed):.2f} degrees",
        f"fetched: {percent([not row.fetched for row in rows])}",
    ]
    for kind in KINDS:
        lines.append(f"  {kind}: {percent([not row.fetched for row in rows if row.wanted.startswith(kind)])}")
    lines += [
        f"contacts with table or person: {sum(_with_us(text) for row in rows for text in row.touched)}; others: "
        f"{dict(Counter(text for row in rows for text in row.touched if not _with_us(text)).most_common(8))}",
        f"another item moved by 2 cm: {sum(row.moved > MOVED for row in rows)}; "
        f"most {max(row.moved for row in rows):.3f} m",
        f"slip at 1.5 N above 2 cm: {sum(row.slip > MOVED for row in rows)}",
        f"planning, a plan: median {np.median(each):.3f}, p95 {np.quantile(each, 0.95):.3f}, max {each.max():.2f} s; "
        f"a table: p95 {np.quantile(planning, 0.95):.2f} s",
        f"faster than time, planning included: {_faster(rows, 'wall'):.1f} times by the wall's clock, "
        f"{_faster(rows, 'processor'):.1f} times by the processor's",
        f"why not: {dict(Counter(row.fetched for row in rows if row.fetched))}",
    ]  # fmt: skip
    for row in rows:
        if row.fetched or row.pointed or row.angle > 1.5 or row.touched or row.moved > MOVED:
            lines.append(
                f"  {row.seed}: {row.asked} {row.pointed} {row.angle:.2f}; {row.wanted} {row.fetched}; "
                f"moved {row.moved:.3f}; {row.touched[:3]}"
            )
    return "\n".join([*lines, *durations(rows)])


def _faster(rows: Sequence[Row], clock: str) -> float:
    return sum(row.simulated for row in rows) / sum(float(getattr(row, clock)) for row in rows)


def _with_us(text: str) -> bool:
    return text.endswith((TABLE, PERSON))


def durations(rows: Sequence[Row]) -> list[str]:
    """Return the table of planned and executed times, a row a phase."""
    phases = dict.fromkeys(phase for row in rows for phase, _, _ in row.movements)
    lines = [
        "| movement | planned, median s | executed, median s | executed, p95 s | number |",
        "|---|---|---|---|---|",
    ]
    for phase in phases:
        times = np.array(
            [(planned, executed) for row in rows for name, planned, executed in row.movements if name == phase]
        )
        planned, executed = np.median(times, axis=0)
        late = np.quantile(times[:, 1], 0.95)
        lines.append(f"| {phase} | {planned:.2f} | {executed:.2f} | {late:.2f} | {len(times)} |")
    return lines


def report_stops(stops: Sequence[Stop]) -> str:
    """Return what was measured of stopping as text."""
    stopped = [one for one in stops if not one.phase.startswith("not")]
    put_back = [one for one in stopped if one.back >= 0]
    lines = [
        f"stopped: {percent([not one.phase.startswith('not') for one in stops])}; "
        f"still within 0.2 s: {percent([one.still <= 0.2 for one in stopped])}; "
        f"latest {max((one.still for one in stopped), default=0.0):.3f} s; "
        f"in {dict(Counter(one.phase for one in stopped))}",
        f"rested afterwards: {percent([not one.rested for one in stopped])}; item within 2 cm of its place: "
        f"{percent([one.back <= MOVED for one in put_back])}; "
        f"another moved: {sum(one.moved > MOVED for one in stopped)}; "
        f"contacts with table or person: {sum(_with_us(text) for one in stopped for text in one.touched)}",
    ]
    for one in stopped:
        if one.still > 0.2 or one.rested or one.back > MOVED or one.moved > MOVED or one.touched:
            lines.append(f"  {one}")
    return "\n".join(lines)


def short_of_aims(rows: Sequence[Row], stops: Sequence[Stop]) -> list[str]:
    """Return which aims were missed: pointing 99 %, fetching 95 %, no contact, nothing moved, every stop in 0.2 s."""
    both: list[Row | Stop] = [*rows, *stops]
    stopped = [one for one in stops if not one.phase.startswith("not")]
    aims = {
        "99 % within 1.5 degrees": np.mean([not row.pointed and row.angle <= 1.5 for row in rows] or [True]) >= 0.99,
        "95 % fetched": np.mean([not row.fetched for row in rows] or [True]) >= 0.95,
        "no contact with table or person": not any(_with_us(text) for one in both for text in one.touched),
        "no other item moved by 2 cm": all(one.moved <= MOVED for one in both),
        "still within 0.2 s": all(one.still <= 0.2 for one in stopped),
        "put back within 2 cm": all(not one.rested and one.back <= MOVED for one in stopped),
    }
    return [name for name, met in aims.items() if not met]


def main() -> None:
    """Measure, and print what was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="baxter")
    parser.add_argument("--tables", type=int, default=100)
    parser.add_argument("--stops", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, help="JSON Lines: each table, when it is done")
    options = parser.parse_args()
    description = RobotDescription.load(options.robot)
    seeds = range(options.seed, options.seed + options.tables)
    rows = []
    for seed in seeds:
        rows.append(fetch(seed, description))
        if options.out:
            with options.out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(asdict(rows[-1])) + "\n")
    if rows:
        print(report(rows))
    stops = [stop(seed, description) for seed in range(options.seed, options.seed + options.stops)]
    if stops:
        print(report_stops(stops))
    if missed := short_of_aims(rows, stops):
        sys.exit(f"missed: {', '.join(missed)}")


if __name__ == "__main__":
    main()

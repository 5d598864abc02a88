"""The MuJoCo model of a layout: the robot from its package, the table, the items and the person."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.description import Arm, Box, Gripper, RobotDescription
from fetch_pomdp.adapters.robot.mujoco.kinds import Part
from fetch_pomdp.adapters.robot.mujoco.layout import Body, Layout
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.extras import load

EXTRA = "robot"
TIMESTEP = 0.002  # s
EVERYTHING = 0xFF  # the collision bits of table, items and person: they meet whatever is solid
TABLE, PERSON, FLOOR = "table", "person", "floor"
LEG = 0.025  # m
FRICTION = (1.0, 0.02, 0.001)
FIRM = {"solref": [0.004, 1.0], "solimp": [0.95, 0.99, 0.001, 0.5, 2.0]}  # a contact that hardly gives
COLLISION_GROUP, VISIBLE_GROUP = 3, 1
LAG = 0.12  # s, damping over stiffness of an arm's servos


def tcp(arm: Arm) -> str:
    """Return the name of the site between an arm's fingers: z is the way the hand looks, x the way fingers close."""
    return f"{arm.name}/tcp"


def body_of(item: str) -> str:
    """Return the name of an item's body and joint, which no part of a robot has."""
    return f"item/{item}"


def robot_spec(robot: RobotDescription) -> Any:
    """Return the robot with its grippers and servos, at the origin, as an MjSpec."""
    mujoco = load("mujoco", EXTRA)
    spec = mujoco.MjSpec.from_file(str(robot.file(robot.model)))
    _strip(spec)
    for name in robot.without:
        spec.delete(spec.geom(name))
    for box in robot.boxes:
        _add_box(spec, box)
    for arm in robot.arms:
        _mount(spec, robot, arm)
        for joint, stiffness, torque in zip(arm.joints, arm.stiffness, arm.torque, strict=True):
            servo = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            _servo(servo, stiffness, LAG * stiffness, torque)
    for body in spec.bodies:
        body.gravcomp = 1.0  # the real arms hold themselves up, too
    for geom in spec.geoms:
        solid = geom.contype or geom.conaffinity
        geom.group = COLLISION_GROUP if solid else VISIBLE_GROUP
    return spec


def world_model(robot: RobotDescription, layout: Layout) -> Any:
    """Return the compiled model of a layout."""
    mujoco, spec = load("mujoco", EXTRA), robot_spec(robot)
    place_robot(spec, robot, layout)
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    _room(spec, layout)
    _table(spec, layout)
    _person(spec, layout)
    for item in layout.bodies:
        _item(spec, item)
    return spec.compile()


def place_robot(spec: Any, robot: RobotDescription, layout: Layout) -> None:
    """Move a robot from the origin to its place in a layout."""
    root = spec.body(robot.root)
    root.pos = np.array(layout.base) + np.array([0.0, 0.0, root.pos[2]])
    turn = layout.yaw / 2
    root.quat = quaternion_product((math.cos(turn), 0.0, 0.0, math.sin(turn)), root.quat)


def quaternion_product(left: Any, right: Any) -> Vector:
    """Return the rotation `left` after `right`, quaternions with w first."""
    a, b = np.asarray(left, float), np.asarray(right, float)
    w = a[0] * b[0] - a[1:] @ b[1:]
    return np.concatenate([[w], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def _strip(spec: Any) -> None:
    """Take away what is not of the robot's body: motors (ours are servos), sensors, lights, cameras, key frames.

    What is left has contacts as grasping needs them, the same in a robot and in the gripper that it gets.
    """
    spec.option.cone = load("mujoco", EXTRA).mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10
    for part in (*spec.actuators, *spec.sensors, *spec.lights, *spec.cameras, *spec.keys):
        spec.delete(part)


def _add_box(spec: Any, box: Box) -> None:
    low, high = np.array(box.low), np.array(box.high)
    shape = load("mujoco", EXTRA).mjtGeom.mjGEOM_BOX
    spec.body(box.body).add_geom(
        type=shape, size=(high - low) / 2, pos=(low + high) / 2, contype=1, conaffinity=1, mass=0.0
    )


def _mount(spec: Any, robot: RobotDescription, arm: Arm) -> None:
    """Put a gripper on an arm's hand, which then collides as the hand does."""
    mujoco, gripper = load("mujoco", EXTRA), robot.gripper
    solid = [geom for geom in spec.geoms if geom.contype and _is_under(geom.parent, spec.body(arm.shoulder))]
    contype, conaffinity = solid[-1].contype, solid[-1].conaffinity
    hand = mujoco.MjSpec.from_file(str(robot.file(gripper.model)))
    _strip(hand)
    for body, by in gripper.shift.items():
        hand.body(body).pos = hand.body(body).pos + np.array(by)
    for geom in hand.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype, geom.conaffinity = contype, conaffinity
            geom.solref, geom.condim = FIRM["solref"], 4
    for drive in gripper.drives:
        if drive.joint is not None:
            _change_joint(hand.joint(drive.joint), drive.armature, drive.friction)
    site = hand.body(gripper.root).add_site(name="tcp", pos=gripper.tcp, quat=closing_turn(gripper))
    site.group = 5
    frame = spec.body(arm.hand).add_frame(pos=arm.mount, quat=arm.mount_rotation)
    frame.attach_body(hand.body(gripper.root), f"{arm.name}/", "")
    for added in list(spec.actuators):
        if added.name.startswith(f"{arm.name}/"):
            spec.delete(added)
    for index, drive in enumerate(gripper.drives):
        kind = mujoco.mjtTrn.mjTRN_JOINT if drive.joint is not None else mujoco.mjtTrn.mjTRN_TENDON
        servo = spec.add_actuator(
            name=f"{arm.name}/fingers{index}", target=f"{arm.name}/{drive.joint or drive.tendon}", trntype=kind
        )
        _servo(servo, drive.stiffness, drive.damping, drive.force)


def closing_turn(gripper: Gripper) -> Vector:
    """Return the quaternion, w first, of a frame at the gripper's root whose x axis is the way the fingers close."""
    angle = math.atan2(gripper.closing[1], gripper.closing[0])
    return np.array([math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)])


def _change_joint(joint: Any, armature: float | None, friction: float | None) -> None:
    if armature is not None:
        joint.armature = armature
    if friction is not None:
        joint.frictionloss = friction


def _servo(servo: Any, stiffness: float, damping: float, force: float) -> None:
    servo.set_to_position(kp=stiffness, kv=damping)
    servo.forcelimited, servo.forcerange = 1, [-force, force]


def _is_under(body: Any, above: Any) -> bool:
    while body is not None and body.name != "world":
        if body.name == above.name:
            return True
        body = body.parent
    return False


def _room(spec: Any, layout: Layout) -> None:
    mujoco, world = load("mujoco", EXTRA), spec.worldbody
    spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.4] * 3, [0.4] * 3
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 960
    sky = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT
    spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=sky, rgb1=[0.9, 0.93, 0.96], rgb2=[0.6, 0.65, 0.7],
        width=64, height=64 * 6,
    )  # fmt: skip
    for side in (1.0, -1.0):
        world.add_light(
            type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, pos=[0.0, 0.0, 3.0], dir=[-0.3 * side, 0.3 * side, -1.0],
            diffuse=[0.35] * 3, castshadow=False,
        )  # fmt: skip
    grey = [0.75, 0.75, 0.72, 1.0]
    world.add_geom(
        name=FLOOR, type=mujoco.mjtGeom.mjGEOM_PLANE, size=[8.0, 8.0, 0.1], rgba=grey, group=VISIBLE_GROUP,
        contype=EVERYTHING, conaffinity=EVERYTHING,
    )  # fmt: skip
    half = layout.base[2] / 2
    world.add_geom(
        name="pedestal", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.12, half - 0.05, 0.0], contype=0, conaffinity=0,
        pos=[layout.base[0], layout.base[1], half - 0.05], rgba=[0.25, 0.25, 0.27, 1.0], group=VISIBLE_GROUP,
    )  # fmt: skip


def _table(spec: Any, layout: Layout) -> None:
    mujoco = load("mujoco", EXTRA)
    x, y, top = layout.table
    deep, wide = layout.table_half
    turn = [math.cos(layout.yaw / 2), 0.0, 0.0, math.sin(layout.yaw / 2)]
    body = spec.worldbody.add_body(name=TABLE, pos=[x, y, top - 0.02], quat=turn)
    body.add_geom(
        name=TABLE, type=mujoco.mjtGeom.mjGEOM_BOX, size=[deep, wide, 0.02], rgba=[0.72, 0.55, 0.38, 1.0],
        friction=FRICTION, contype=EVERYTHING, conaffinity=EVERYTHING, group=VISIBLE_GROUP,
    )  # fmt: skip
    half = (top - 0.04) / 2
    for ahead in (-deep + 2 * LEG, deep - 2 * LEG):
        for aside in (-wide + 2 * LEG, wide - 2 * LEG):
            body.add_geom(
                type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[LEG, half, 0.0], pos=[ahead, aside, -half - 0.02],
                rgba=[0.4, 0.3, 0.2, 1.0], group=VISIBLE_GROUP, contype=0, conaffinity=0,
            )  # fmt: skip


def _person(spec: Any, layout: Layout) -> None:
    """Add somebody who stands under their head.

    Choice: a scene says where the head is and no more; the body is a head and a trunk, down to the floor.
    """
    mujoco = load("mujoco", EXTRA)
    x, y, height = layout.head
    body = spec.worldbody.add_body(name=PERSON, pos=[x, y, 0.0])
    solid = {"contype": EVERYTHING, "conaffinity": EVERYTHING, "group": VISIBLE_GROUP}
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.11, 0.0, 0.0], pos=[0.0, 0.0, height], rgba=[0.85, 0.65, 0.55, 1.0],
        **solid,
    )  # fmt: skip
    shoulder = max(height - 0.25, 0.3)
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=[0.17, (shoulder - 0.17) / 2, 0.0],
        pos=[0.0, 0.0, shoulder / 2], rgba=[0.3, 0.35, 0.5, 1.0], **solid,
    )  # fmt: skip


def _item(spec: Any, item: Body) -> None:
    turn = [math.cos(item.yaw / 2), 0.0, 0.0, math.sin(item.yaw / 2)]
    name = body_of(item.id)
    body = spec.worldbody.add_body(name=name, pos=item.place, quat=turn)
    body.add_freejoint(name=name)
    for part in item.kind.parts:
        _part(body, part, item)


def _part(body: Any, part: Part, item: Body) -> None:
    mujoco = load("mujoco", EXTRA)
    shapes = {
        "box": mujoco.mjtGeom.mjGEOM_BOX,
        "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
        "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    }
    body.add_geom(
        type=shapes[part.shape], size=part.size, pos=part.place, quat=part.rotation, mass=part.mass, rgba=item.color,
        friction=FRICTION, condim=4, group=VISIBLE_GROUP, contype=EVERYTHING, conaffinity=EVERYTHING, **FIRM,
    )  # fmt: skip

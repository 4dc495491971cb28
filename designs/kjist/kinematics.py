"""The kinematics of the KJIST haptic device, written once over any number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..chains.dyad import rate_row
from ..chains.pantograph import KiteAngles, locate_kite_tip, solve_kite
from ..chains.tripod import DELTAS, leg_link
from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_z
from ..language.vocabulary import Number, Require, acos, atan2, cos, fabs, hypot, sin
from .parameters import KjistLimits, KjistParameters

#: Working modes of a leg: (bar, elbow) signs; +1 carries the plate above the joint, and has its elbows outside.
BRANCHES: dict[str, tuple[float, float]] = {
    "standing-out": (1.0, 1.0),
    "standing-in": (1.0, -1.0),
    "hanging-out": (-1.0, 1.0),
    "hanging-in": (-1.0, -1.0),
}


class LegState(NamedTuple):
    """One leg at a pose.

    Attributes:
        joint: centre S of the 3R joint [mm].
        axes: of the pantograph's plane: radial, tangential, up.
        pin_axis: y of the bar, along the platform's pin.
        bar: unit vector from S to the platform's pin.
        arc: direction in which S would run about the platform's pin.
        gamma: the bar's angle at the platform [rad], -90 degrees upright.
        links: directions of the pantograph's links [rad].
    """

    joint: Vec
    axes: Rot
    pin_axis: Vec
    bar: Vec
    arc: Vec
    gamma: Number
    links: KiteAngles


class KjistState(NamedTuple):
    """The device at a pose."""

    origin: Vec
    Q: Rot
    legs: tuple[LegState, ...]


def solve_state(
    p: KjistParameters, pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> KjistState:
    """All legs at a pose x, y, z [mm], rx, ry, rz [rad], each in its branch (bar, elbow) of +-1.

    The joint centre S runs on a circle about the platform's pin and in a fixed upright plane of the base.

    Source: derived; Zhang et al. describe the device in words.
    """
    x, y, z, rx, ry, rz = pose
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    legs = []
    for i, (delta, (stand, elbow)) in enumerate(zip(DELTAS, branch, strict=True)):

        def need(margin: Number, name: str, leg: str = f"leg_{i + 1}") -> None:
            require(margin, f"{leg} {name}")

        legs.append(_solve_leg(p, origin, Q, delta, stand, elbow, need))
    return KjistState(origin, Q, tuple(legs))


def _solve_leg(
    p: KjistParameters, origin: Vec, Q: Rot, delta: float, stand: float, elbow: float, require: Require
) -> LegState:
    axes = rot_z(delta)
    # The leg's axes of the platform: radial, tangential, normal, in the base.
    out, tangent, normal = Q.apply(axes.x), Q.apply(axes.y), Q.z
    pin = origin + out * p.platform_radius
    A, B = axes.x.dot(out), axes.x.dot(normal)
    size = hypot(A, B)
    C = (p.base_radius - axes.x.dot(pin)) / p.bar_length
    require(size - fabs(C) - 1e-9, "bar too short")
    gamma = atan2(B, A) - stand * acos(C / size)
    to_joint = out * cos(gamma) + normal * sin(gamma)
    arc = normal * cos(gamma) - out * sin(gamma)
    joint = pin + to_joint * p.bar_length
    links = solve_kite(
        axes.y.dot(joint), joint.z - p.chain_height, p.lower_link_length, p.upper_link_length, elbow, require
    )
    return LegState(joint, axes, -tangent, -to_joint, arc, gamma, links)


def require_held(limits: KjistLimits, state: KjistState, require: Require) -> None:
    """State that the plate is held in the working assembly mode: every bar's arc crosses its pantograph's plane."""
    for i, leg in enumerate(state.legs):
        require(leg.axes.x.dot(leg.arc) - sin(limits.hold_min), f"leg_{i + 1} bar held")


def joint_values(state: KjistState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    active = [angle for leg in state.legs for angle in (leg.links.lower_left, leg.links.lower_right)]
    return (*active, *(value for leg in state.legs for value in _passive_values(leg)))


def _fork_direction(leg: LegState) -> Number:
    """The fork's direction in the pantograph's plane [rad]: the bar as seen along the top pin."""
    return atan2(leg.bar.dot(leg.axes.z), leg.bar.dot(leg.axes.y))


def _passive_values(leg: LegState) -> tuple[Number, ...]:
    links, fork = leg.links, _fork_direction(leg)
    y, z = leg.bar.dot(leg.axes.y), leg.bar.dot(leg.axes.z)
    across = leg.axes.z * cos(fork) - leg.axes.y * sin(fork)
    return (
        links.upper_left - links.lower_left,
        links.upper_right - links.lower_right,
        links.upper_right - links.upper_left,
        fork - links.upper_right,
        atan2(-leg.bar.dot(leg.axes.x), hypot(y, z)),
        atan2(leg.bar.dot(across.cross(leg.pin_axis)), across.dot(leg.pin_axis)),
        leg.gamma,
    )


def locate_joint(p: KjistParameters, delta: float, theta_1: Number, theta_2: Number, require: Require) -> Vec:
    """Joint centre S in the base [mm] from a leg's motors; told "closed"."""
    y, w, _ = locate_kite_tip(theta_1, theta_2, p.lower_link_length, p.upper_link_length, require)
    axes = rot_z(delta)
    return axes.x * p.base_radius + axes.y * y + axes.z * (w + p.chain_height)


def rate_rows(p: KjistParameters, state: KjistState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian in motor order: rate = row . [v; omega].

    A motor pushes S along its upper link in the plane; the bar passes on a force along itself and along the
    platform's pin only, hence the term that takes out the part along the bar's arc.

    Source: derived.
    """
    rows = []
    for leg in state.legs:
        arm, links = leg.joint - state.origin, leg.links
        for lower, upper in ((links.lower_left, links.upper_left), (links.lower_right, links.upper_right)):
            along_y, along_z = rate_row(upper, lower, p.lower_link_length)
            push = leg.axes.y * along_y + leg.axes.z * along_z
            force = push - leg.axes.x * (push.dot(leg.arc) / leg.axes.x.dot(leg.arc))
            rows.append((*force, *arm.cross(force)))
    return tuple(rows)


def body_frames(p: KjistParameters, state: KjistState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, seven bodies a leg, platform.

    Links, fork: x along it, z along the motors; block: x along the bar, y along the fork's pins; bar: x along it, y
    along the platform's pin (of the two directions the one that points against the tangent).
    """
    frames = [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
    h, length = p.chain_height, p.lower_link_length
    for delta, leg in zip(DELTAS, state.legs, strict=True):
        axes, (t1, t2, up_left, up_right) = leg.axes, leg.links
        foot = Vec(p.plane_radius * math.cos(delta), p.plane_radius * math.sin(delta), 0.0)
        fork, _ = leg_link(axes, foot, _fork_direction(leg), 0.0, 0.0)
        frames += [
            leg_link(axes, foot, t1, 0.0, h),
            leg_link(axes, foot, t2, 0.0, h),
            leg_link(axes, foot, up_left, length * cos(t1), h + length * sin(t1)),
            leg_link(axes, foot, up_right, length * cos(t2), h + length * sin(t2)),
            (fork, leg.joint),
            (Rot(leg.bar, fork.y, leg.bar.cross(fork.y)), leg.joint),
            (Rot(leg.bar, leg.pin_axis, leg.bar.cross(leg.pin_axis)), leg.joint),
        ]
    return (*frames, (state.Q, state.origin))

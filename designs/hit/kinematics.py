"""The kinematics of the HIT device, written once over any number: floats, batches, later nodes and intervals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..chains.pantograph import KiteAngles, solve_kite
from ..chains.tripod import DELTAS, leg_axes, locate_ball, solve_pin
from ..language.vectors import Rot, Vec, rot_fixed_xyz
from ..language.vocabulary import Number, Require, atan2, cos, sin
from .parameters import HitParameters


class LegState(NamedTuple):
    """One leg at a pose: ball [mm], axes and lean of its plane [rad], tip in the plane [mm], link directions [rad]."""

    ball: Vec
    axes: Rot
    alpha: Number
    y: Number
    w: Number
    links: KiteAngles


class HitState(NamedTuple):
    """The device at a pose."""

    origin: Vec
    Q: Rot
    legs: tuple[LegState, ...]


def solve_state(
    p: HitParameters, pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> HitState:
    """All legs at a pose x, y, z [mm], rx, ry, rz [rad], each in its branch (pin, elbow) of +-1.

    Source: Zhang et al., eqs. (5)-(11), corrected as the chains' docstrings say.
    """
    x, y, z, rx, ry, rz = pose
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    legs = []
    for i, (delta, (pin, elbow)) in enumerate(zip(DELTAS, branch, strict=True)):

        def need(margin: Number, name: str, leg: str = f"leg_{i + 1}") -> None:
            require(margin, f"{leg} {name}")

        ball = locate_ball(origin, Q, delta, p.platform_radius)
        tip = solve_pin(ball, delta, p.base_radius, p.chain_height, pin, need)
        links = solve_kite(tip.y, tip.w, p.lower_link_length, p.upper_link_length, elbow, need)
        legs.append(LegState(ball, leg_axes(tip.alpha, delta), tip.alpha, tip.y, tip.w, links))
    return HitState(origin, Q, tuple(legs))


def joint_values(state: HitState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    active = [angle for leg in state.legs for angle in (leg.links.lower_left, leg.links.lower_right)]
    return (*active, *(value for leg in state.legs for value in _passive_values(leg, state.Q)))


def _passive_values(leg: LegState, Q: Rot) -> tuple[Number, ...]:
    t1, t2, left, right = leg.links
    # The angle between ball-bar (along the leg) and socket (the platform's normal); exact near zero, unlike an acos.
    cone = atan2(leg.axes.z.cross(Q.z).norm(), leg.axes.z.dot(Q.z))
    return leg.alpha, left - t1, right - t2, t1, t1, t1, left, left, left, right, cone


def rate_rows(p: HitParameters, state: HitState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian in motor order: rate = row . [v; omega].

    A motor alone pushes the ball along its upper link, so its row is that line, divided by the lower link's lever.

    Source: Zhang et al., eq. (16). Printed: columns of J^-1. Used: rows; (J1) of the vector loop, valid for L2 != L3.
    """
    rows = []
    for leg in state.legs:
        arm = leg.ball - state.origin
        links = leg.links
        for lower, upper in ((links.lower_left, links.upper_left), (links.lower_right, links.upper_right)):
            along = leg.axes.y * cos(upper) + leg.axes.z * sin(upper)
            lever = 1.0 / (p.lower_link_length * sin(upper - lower))
            rows.append((*(along * lever), *(arm.cross(along) * lever)))
    return tuple(rows)


def body_frames(p: HitParameters, state: HitState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, nine links a leg, platform; a link's x is along it, its z along the motors."""
    still = Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    frames = [(still, Vec(0.0, 0.0, 0.0))]
    for delta, leg in zip(DELTAS, state.legs, strict=True):
        frames += _leg_frames(p, leg, Vec(p.base_radius * math.cos(delta), p.base_radius * math.sin(delta), 0.0))
    return (*frames, (state.Q, state.origin))


def _leg_frames(p: HitParameters, leg: LegState, foot: Vec) -> list[tuple[Rot, Vec]]:
    axes, e, h, length = leg.axes, p.frame_width / 2.0, p.pivot_height, p.lower_link_length

    def link(angle: Number, y: Number, z: Number) -> tuple[Rot, Vec]:
        along = axes.y * cos(angle) + axes.z * sin(angle)
        across = axes.z * cos(angle) - axes.y * sin(angle)
        return Rot(along, across, axes.x), foot + axes.y * y + axes.z * z

    t1, t2, up_left, up_right = leg.links
    left_y, left_z = -e + length * cos(t1), h + length * sin(t1)
    right_y, right_z = e + length * cos(t2), h + length * sin(t2)
    v1, v2 = p.lower_offset, p.upper_offset
    return [
        (axes, foot),
        link(t1, -e, h),
        link(t2, e, h),
        link(up_left, left_y, left_z),
        link(up_right, right_y, right_z),
        link(0.0, leg.y, h + leg.w),
        link(t1, -e + v1 * cos(p.lower_offset_angle), h + v1 * sin(p.lower_offset_angle)),
        link(0.0, left_y, left_z),
        link(up_left, left_y + v2 * cos(p.upper_offset_angle), left_z + v2 * sin(p.upper_offset_angle)),
    ]

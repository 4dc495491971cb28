"""The kinematics of the KAIST master hand, written once over any number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..chains.dyad import DyadAngles, rate_row, solve_dyad
from ..chains.dyad_pair import meet_circles
from ..chains.tripod import DELTAS, leg_axes, leg_link, locate_ball, push_row, solve_offset_pin
from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_z
from ..language.vocabulary import Number, Require, atan2, cos, sin
from .parameters import KaistParameters

#: Working modes of a leg: signs of pin and of left and right elbow; +1 stands up, and has an elbow left of its line.
BRANCHES: dict[str, tuple[float, float, float]] = {
    f"{stand}-{posture}": (pin, *sides)
    for stand, pin in (("up", 1.0), ("down", -1.0))
    for posture, sides in (("out", (1.0, -1.0)), ("in", (-1.0, 1.0)), ("left", (1.0, 1.0)), ("right", (-1.0, -1.0)))
}


class LegState(NamedTuple):
    """One leg at a pose.

    Attributes:
        ball: F [mm].
        axes, alpha: axes and lean of the leg's plane [rad].
        rho: height of the ball over the pin, in the plane [mm].
        left, right: directions of both sides' links [rad]; their first are theta_1 and theta_2.
    """

    ball: Vec
    axes: Rot
    alpha: Number
    rho: Number
    left: DyadAngles
    right: DyadAngles


class KaistState(NamedTuple):
    """The device at a pose."""

    origin: Vec
    Q: Rot
    legs: tuple[LegState, ...]


def solve_state(
    p: KaistParameters, pose: Sequence[Number], branch: Sequence[tuple[float, float, float]], require: Require
) -> KaistState:
    """All legs at a pose x, y, z [mm], rx, ry, rz [rad], each in its branch (pin, left elbow, right elbow) of +-1.

    Source: Zhang et al., eqs. (5)-(7) as corrected; the five-bar by two laws of cosines.
    """
    x, y, z, rx, ry, rz = pose
    origin, Q, half = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz), 0.5 * p.motor_distance
    legs = []
    for i, (delta, (pin, left, right)) in enumerate(zip(DELTAS, branch, strict=True)):

        def need(margin: Number, name: str, leg: str = f"leg_{i + 1}") -> None:
            require(margin, f"{leg} {name}")

        ball = locate_ball(origin, Q, delta, p.platform_radius)
        tip = solve_offset_pin(ball, delta, p.base_radius, p.chain_height, -p.ball_inset, pin, need)
        sides = [
            solve_dyad(tip.y - at, tip.w, p.lower_link_length, p.upper_link_length, side, need)
            for at, side in ((-half, left), (half, right))
        ]
        legs.append(LegState(ball, leg_axes(tip.alpha, delta), tip.alpha, tip.w + p.chain_height, *sides))
    return KaistState(origin, Q, tuple(legs))


def locate_tip(p: KaistParameters, theta_1: Number, theta_2: Number, require: Require) -> tuple[Number, Number]:
    """Top pin (y, w) [mm] above the elbows in the leg's plane, from the motors; told "apart" and "inside"."""
    half, length = 0.5 * p.motor_distance, p.lower_link_length
    left = (-half + length * cos(theta_1), length * sin(theta_1))
    right = (half + length * cos(theta_2), length * sin(theta_2))
    return meet_circles(left, right, p.upper_link_length, p.upper_link_length, 1.0, require)


def joint_values(state: KaistState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    active = [side.pivot for leg in state.legs for side in (leg.left, leg.right)]
    return (*active, *(value for i in range(3) for value in _passive_values(state.legs[i], state.Q, DELTAS[i])))


def _passive_values(leg: LegState, Q: Rot, delta: float) -> tuple[Number, ...]:
    (t1, up_left), (t2, up_right) = leg.left, leg.right
    socket, bar = Q.apply(rot_z(delta).x), leg.axes.x
    # Exact near zero, unlike an acos.
    cone = atan2(bar.cross(socket).norm(), bar.dot(socket))
    return leg.alpha, up_left - t1, up_right - t2, up_right - up_left, cone


def rate_rows(p: KaistParameters, state: KaistState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian in motor order: rate = row . [v; omega].

    A motor pushes along its upper link; because the ball lies aside of the plane, leaning lifts it.

    Source: derived; eq. (16) of Zhang et al. with theta_2 = omega_1 + omega_2 does not hold for a five-bar.
    Shown by: tests/papers/test_zhang_family.py.
    """
    rows = []
    for leg in state.legs:
        arm, slope = leg.ball - state.origin, -p.ball_inset / leg.rho
        for side in (leg.left, leg.right):
            in_plane = rate_row(side.tip, side.pivot, p.lower_link_length)
            rows.append(push_row(leg.axes, in_plane, arm, slope))
    return tuple(rows)


def body_frames(p: KaistParameters, state: KaistState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, five bodies a leg (frame, lower left, right, upper left, right), platform."""
    frames = [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
    half, h, length = 0.5 * p.motor_distance, p.chain_height, p.lower_link_length
    for delta, leg in zip(DELTAS, state.legs, strict=True):
        foot = Vec(p.base_radius * math.cos(delta), p.base_radius * math.sin(delta), 0.0)
        axes, (t1, up_left), (t2, up_right) = leg.axes, leg.left, leg.right
        frames += [
            (axes, foot),
            leg_link(axes, foot, t1, -half, h),
            leg_link(axes, foot, t2, half, h),
            leg_link(axes, foot, up_left, -half + length * cos(t1), h + length * sin(t1)),
            leg_link(axes, foot, up_right, half + length * cos(t2), h + length * sin(t2)),
        ]
    return (*frames, (state.Q, state.origin))

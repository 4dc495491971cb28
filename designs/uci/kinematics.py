"""The kinematics of the UCI hand controller, written once over any number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..chains.dyad import DyadAngles, rate_row, solve_dyad
from ..chains.tripod import DELTAS, leg_axes, leg_link, locate_ball, push_row, solve_pin
from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_z
from ..language.vocabulary import Number, Require, atan2, cos, sin
from .parameters import UciParameters


class LegState(NamedTuple):
    """One leg at a pose: ball [mm], axes and lean of its plane [rad], theta_1 and theta_2 [rad]."""

    ball: Vec
    axes: Rot
    alpha: Number
    links: DyadAngles


class UciState(NamedTuple):
    """The device at a pose."""

    origin: Vec
    Q: Rot
    legs: tuple[LegState, ...]


def solve_state(
    p: UciParameters, pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> UciState:
    """All legs at a pose x, y, z [mm], rx, ry, rz [rad], each in its branch (pin, elbow) of +-1.

    Source: Zhang et al., eqs. (5)-(11), which hold for this device; the dyad D-E-F solves unequal links too.
    """
    x, y, z, rx, ry, rz = pose
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    legs = []
    for i, (delta, (pin, elbow)) in enumerate(zip(DELTAS, branch, strict=True)):

        def need(margin: Number, name: str, leg: str = f"leg_{i + 1}") -> None:
            require(margin, f"{leg} {name}")

        ball = locate_ball(origin, Q, delta, p.platform_radius)
        tip = solve_pin(ball, delta, p.base_radius, p.chain_height, pin, need)
        links = solve_dyad(tip.y, tip.w, p.lower_link_length, p.upper_link_length, elbow, need)
        legs.append(LegState(ball, leg_axes(tip.alpha, delta), tip.alpha, links))
    return UciState(origin, Q, tuple(legs))


def locate_tip(p: UciParameters, theta_1: Number, theta_2: Number) -> tuple[Number, Number]:
    """Ball (y, w) [mm] in the leg's plane from the motors: F = D + L_2 u(theta_1) + L_3 u(theta_2)."""
    y = p.lower_link_length * cos(theta_1) + p.upper_link_length * cos(theta_2)
    return y, p.lower_link_length * sin(theta_1) + p.upper_link_length * sin(theta_2)


def joint_values(p: UciParameters, state: UciState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    active = [angle for leg in state.legs for angle in leg.links]
    return (*active, *(value for i in range(3) for value in _passive_values(p, state.legs[i], state.Q, DELTAS[i])))


def _passive_values(p: UciParameters, leg: LegState, Q: Rot, delta: float) -> tuple[Number, ...]:
    t1, t2 = leg.links
    socket = Q.apply(rot_z(delta).apply(Vec(0.0, sin(p.socket_tilt), cos(p.socket_tilt))))
    bar = leg.axes.y * cos(t2 + p.ball_bar_angle) + leg.axes.z * sin(t2 + p.ball_bar_angle)
    # Exact near zero, unlike an acos.
    cone = atan2(bar.cross(socket).norm(), bar.dot(socket))
    return leg.alpha, t2 - t1, t1 - t2, t1 - t2, cone


def rate_rows(p: UciParameters, state: UciState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian in motor order: rate = row . [v; omega].

    Motor 1 pushes along E-F, motor 2 along the parallel of D-E.

    Source: Zhang et al., eq. (16), corrected (rows of the inverse).
    """
    rows = []
    for leg in state.legs:
        arm, (t1, t2) = leg.ball - state.origin, leg.links
        rows.append(push_row(leg.axes, rate_row(t2, t1, p.lower_link_length), arm))
        rows.append(push_row(leg.axes, rate_row(t1, t2, p.upper_link_length), arm))
    return tuple(rows)


def body_frames(p: UciParameters, state: UciState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, five bodies a leg (frame, D-E, D-H, E-F, H-G), platform."""
    frames = [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
    for delta, leg in zip(DELTAS, state.legs, strict=True):
        foot = Vec(p.base_radius * math.cos(delta), p.base_radius * math.sin(delta), 0.0)
        axes, h, a, (t1, t2) = leg.axes, p.chain_height, p.inner_link_length, leg.links
        frames += [
            (axes, foot),
            leg_link(axes, foot, t1, 0.0, h),
            leg_link(axes, foot, t2, 0.0, h),
            leg_link(axes, foot, t2, p.lower_link_length * cos(t1), h + p.lower_link_length * sin(t1)),
            leg_link(axes, foot, t1, a * cos(t2), h + a * sin(t2)),
        ]
    return (*frames, (state.Q, state.origin))

"""The kinematics of the HIT device, written once over any number: floats, batches, later nodes and intervals."""

from __future__ import annotations

from typing import NamedTuple

from ..chains.pantograph import KiteAngles, solve_kite
from ..chains.tripod import DELTAS, leg_axes, locate_ball, solve_pin
from ..language.vectors import Rot, Vec, rot_fixed_xyz
from ..language.vocabulary import Number, Require, cos, sin
from .parameters import HitParameters


class LegState(NamedTuple):
    """One leg at a pose: its ball [mm], lean [rad], tip in its plane [mm], link directions [rad]."""

    ball: Vec
    alpha: Number
    y: Number
    w: Number
    links: KiteAngles


def solve_leg(p: HitParameters, pose: tuple[Number, ...], leg: int, pin: float, elbow: float, require: Require) -> LegState:
    """Leg `leg` (0, 1, 2) at a pose x, y, z [mm], rx, ry, rz [rad] in the branch (pin, elbow) of +-1 each.

    Source: Zhang et al., eqs. (5)-(11), corrected as the chains' docstrings say.
    """
    x, y, z, rx, ry, rz = pose
    delta = DELTAS[leg]
    ball = locate_ball(Vec(x, y, z), rot_fixed_xyz(rx, ry, rz), delta, p.platform_radius)
    tip = solve_pin(ball, delta, p.base_radius, p.chain_height, pin, require)
    links = solve_kite(tip.y, tip.w, p.lower_link_length, p.upper_link_length, elbow, require)
    return LegState(ball, tip.alpha, tip.y, tip.w, links)


def rate_rows(p: HitParameters, pose: tuple[Number, ...], leg: int, state: LegState) -> tuple[tuple[Vec, Vec], ...]:
    """Rows of the inverse Jacobian for both motors of a leg: rate = row[0].v + row[1].omega.

    A motor alone pushes the ball along its upper link, so its row is that line, divided by the lower link's lever.

    Source: Zhang et al., eq. (16). Printed: columns of J^-1. Used: rows; (J1) of the vector loop, valid for L2 != L3.
    """
    x, y, z = pose[:3]
    axes = leg_axes(state.alpha, DELTAS[leg])
    arm = state.ball - Vec(x, y, z)
    rows = []
    for lower, upper in (
        (state.links.lower_left, state.links.upper_left),
        (state.links.lower_right, state.links.upper_right),
    ):
        along = axes.y * cos(upper) + axes.z * sin(upper)
        lever = 1.0 / (p.lower_link_length * sin(upper - lower))
        rows.append((along * lever, arm.cross(along) * lever))
    return tuple(rows)


def cone_cosine(pose: tuple[Number, ...], state: LegState, leg: int) -> Number:
    """Cosine of the angle between the ball-bar (along the leg) and the socket's axis (the platform's normal)."""
    _, _, _, rx, ry, rz = pose
    Q: Rot = rot_fixed_xyz(rx, ry, rz)
    return leg_axes(state.alpha, DELTAS[leg]).z.dot(Q.z)

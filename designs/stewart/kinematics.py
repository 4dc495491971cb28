"""The kinematics of the paired Stewart platform.

The two legs of a pair and their base line span a plane that swings about that line. In it the legs are joined by a
scissor pin; the ball sits on the pin's extension, x_T beside the plane towards the middle. With x_T = 0 pin and ball
are the one point of the paper; with it every leg pushes along the same line through the ball's projection.

Source: Stocco, Salcudean, Sassani, Fig. 10; the paper prints no equation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..chains.hinged_triad import ASSEMBLY_MARGIN, TriadLeg, assembly_margin
from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_x
from ..language.vocabulary import Number, Require, atan2, cos, hypot, sin, sqrt
from .parameters import StewartParameters

#: Least distance [mm] of a pin from its base line.
REACH_MARGIN = 1e-6

#: Least cosine of ry: at a quarter turn rx and rz stop being two coordinates.
PITCH_MARGIN = 0.05


class PairState(NamedTuple):
    """A pair at a pose: ball and pin [mm], axes of its plane, lean [rad], lengths [mm] and directions [rad] of legs."""

    ball: Vec
    pin: Vec
    axes: Rot
    waist: Number
    lengths: tuple[Number, Number]
    directions: tuple[Number, Number]

    @property
    def normal(self) -> Vec:
        """Axis of the stages and of the scissor pin, towards the middle at home."""
        return -self.axes.y

    def leg_axes(self, k: int) -> Rot:
        """Axes of leg k: x along it, z along the pins."""
        c, s = cos(self.directions[k]), sin(self.directions[k])
        return Rot(self.axes.x * c + self.axes.z * s, self.axes.z * c - self.axes.x * s, self.normal)


class StewartState(NamedTuple):
    """The platform at a pose."""

    origin: Vec
    Q: Rot
    pairs: tuple[PairState, ...]


def rest_axes(leg: TriadLeg) -> Rot:
    """Axes of a pair's plane at rest: x the base line, z the base's z."""
    x, y, _ = leg.axis
    return Rot(Vec(x, y, 0.0), Vec(-y, x, 0.0), Vec(0.0, 0.0, 1.0))


def solve_state(
    p: StewartParameters, legs: Sequence[TriadLeg], pose: Sequence[Number], require: Require
) -> StewartState:
    """All pairs at a pose x, y, z [mm], rx, ry, rz [rad]; the platform stands before the base."""
    x, y, z, rx, ry, rz = pose
    require(cos(ry) - PITCH_MARGIN, "ry near a quarter turn")
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    pairs = []
    for i, leg in enumerate(legs):
        ball = origin + Q.apply(Vec(*leg.p_hand))
        pairs.append(_solve_pair(p, leg, ball, f"leg_{i + 1}", require))
    swings = [_swing(leg, pair) for leg, pair in zip(legs, pairs, strict=True)]
    require(assembly_margin([pair.ball for pair in pairs], swings) - ASSEMBLY_MARGIN, "other assembly")
    return StewartState(origin, Q, tuple(pairs))


def _solve_pair(p: StewartParameters, leg: TriadLeg, ball: Vec, name: str, require: Require) -> PairState:
    rest, foot = rest_axes(leg), Vec(*leg.foot)
    local = rest.inverse_apply(ball - foot)
    away = hypot(local.y, local.z)
    require(away - p.ball_offset - REACH_MARGIN, f"{name} on its base line")
    radius = sqrt(away * away - p.ball_offset * p.ball_offset)
    waist = atan2(-local.y, local.z) - atan2(p.ball_offset, radius)
    axes = rest @ rot_x(waist)
    assert isinstance(axes, Rot)
    pin = foot + axes.x * local.x + axes.z * radius
    left, right = local.x + p.pair_half_spacing, local.x - p.pair_half_spacing
    return PairState(
        ball, pin, axes, waist, (hypot(left, radius), hypot(right, radius)), (atan2(radius, left), atan2(radius, right))
    )


def _swing(leg: TriadLeg, pair: PairState) -> Vec:
    across = Vec(*leg.axis).cross(pair.ball - Vec(*leg.foot))
    return across * (1.0 / across.norm())


def socket_direction(p: StewartParameters, pair: PairState) -> Vec:
    """Where a pair's socket opens at home, in base axes."""
    return pair.normal * cos(p.socket_cant) + pair.axes.z * sin(p.socket_cant)


def joint_values(state: StewartState, sockets: Sequence[tuple[Vec, Vec]]) -> tuple[Number, ...]:
    """Six leg lengths [mm], then per pair: waist, stages, scissor, ball [rad].

    Args:
        state: the platform at a pose.
        sockets: per pair the socket's axis in its left rod and the ball's axis in the platform.
    """
    lengths = [q for pair in state.pairs for q in pair.lengths]
    passive: list[Number] = []
    for pair, (socket, bar) in zip(state.pairs, sockets, strict=True):
        s, b = pair.leg_axes(0).apply(socket), state.Q.apply(bar)
        left, right = pair.directions
        passive += [pair.waist, left, right, right - left, atan2(s.cross(b).norm(), s.dot(b))]
    return (*lengths, *passive)


def rate_rows(p: StewartParameters, legs: Sequence[TriadLeg], state: StewartState) -> tuple[tuple[Number, ...], ...]:
    """Rows d(length)/d(twist): the line from the leg's gimbal to the ball, over the length.

    Source: Stocco et al., eq. (23). With x_T = 0 the line has unit length.
    """
    rows = []
    for leg, pair in zip(legs, state.pairs, strict=True):
        arm = pair.ball - state.origin
        for side, q in zip((-1.0, 1.0), pair.lengths, strict=True):
            gimbal = Vec(*leg.foot) + Vec(*leg.axis) * (side * p.pair_half_spacing)
            line = (pair.ball - gimbal) * (1.0 / q)
            rows.append((*line, *arm.cross(line)))
    return tuple(rows)


def body_frames(p: StewartParameters, legs: Sequence[TriadLeg], state: StewartState) -> tuple[tuple[Rot, Vec], ...]:
    """Base; per pair waist (origin in its middle), stages (in the gimbals), rods (in the scissor pin); platform."""
    still = Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    frames = [(still, Vec(0.0, 0.0, 0.0))]
    for leg, pair in zip(legs, state.pairs, strict=True):
        foot, along = Vec(*leg.foot), pair.axes.x * p.pair_half_spacing
        left, right = pair.leg_axes(0), pair.leg_axes(1)
        frames += [(pair.axes, foot), (left, foot - along), (right, foot + along), (left, pair.pin), (right, pair.pin)]
    return (*frames, (state.Q, state.origin))


def locate_pins(p: StewartParameters, lengths: Sequence[Number], require: Require) -> tuple[list[Number], list[Number]]:
    """Per pair, from its two lengths: the ball along the base line and its distance from it [mm]."""
    along, radius = [], []
    for i in range(3):
        left, right = lengths[2 * i], lengths[2 * i + 1]
        x = (left * left - right * right) / (4.0 * p.pair_half_spacing)
        square = left * left - (x + p.pair_half_spacing) * (x + p.pair_half_spacing)
        require(square - REACH_MARGIN, f"leg_{i + 1} closed")
        along.append(x)
        radius.append(hypot(sqrt(square), p.ball_offset))
    return along, radius

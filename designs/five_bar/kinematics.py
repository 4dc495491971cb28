"""The kinematics of the plain five-bar, written once over any number: floats, batches, nodes and intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..chains.dyad import DyadAngles, rate_row, solve_dyad
from ..chains.dyad_pair import meet_circles
from ..chains.dyad_pair_mechanism import link_frame
from ..language.vectors import Rot, Vec, rot_z
from ..language.vocabulary import Number, Require, cos, sin
from .parameters import FiveBarParameters


class FiveBarState(NamedTuple):
    """The device at a pose: tip [mm]; the right arm holds theta_1, theta_2, the left one theta_3, theta_4 [rad]."""

    x: Number
    y: Number
    right: DyadAngles
    left: DyadAngles


def solve_state(
    p: FiveBarParameters, pose: Sequence[Number], posture: tuple[float, float], require: Require
) -> FiveBarState:
    """Both arms for a tip at x, y [mm], with their elbows on the sides (right arm, left arm) of +-1.

    Source: Chung, Choo, Lee, eqs. (3)-(10), corrected as `solve_dyad` says.
    """
    x, y = pose
    arms = []
    for arm_name, pivot, side in (("right", 0.5, posture[0]), ("left", -0.5, posture[1])):

        def need(margin: Number, name: str, arm: str = arm_name) -> None:
            require(margin, f"{arm} arm {name}")

        arms.append(solve_dyad(x - pivot * p.pivot_distance, y, p.arm_length, p.tip_link_length, side, need))
    return FiveBarState(x, y, *arms)


def joint_values(state: FiveBarState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    (t1, t2), (t3, t4) = state.right, state.left
    return t1, t3, t2 - t1, t4 - t3, t4 - t2


def rate_rows(p: FiveBarParameters, state: FiveBarState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian: rates of theta_1, theta_3 from the tip's velocity.

    Source: Chung, Choo, Lee, eqs. (13)-(17) with BP, DP in place of AB, CD.
    """
    return tuple(rate_row(arm.tip, arm.pivot, p.arm_length) for arm in (state.right, state.left))


def locate_tip(p: FiveBarParameters, theta_1: Number, theta_3: Number, require: Require) -> tuple[Number, Number]:
    """Tip (x, y) [mm] beyond the elbows: where the tip links about B and D meet."""
    half, length = 0.5 * p.pivot_distance, p.arm_length
    right = (half + length * cos(theta_1), length * sin(theta_1))
    left = (-half + length * cos(theta_3), length * sin(theta_3))
    return meet_circles(right, left, p.tip_link_length, p.tip_link_length, -1.0, require)


def body_frames(p: FiveBarParameters, state: FiveBarState) -> tuple[tuple[Rot, Vec], ...]:
    """Base, and per arm its link on the base (A-B) and its tip link (B-P)."""
    frames = [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
    for pivot, angles in ((0.5 * p.pivot_distance, state.right), (-0.5 * p.pivot_distance, state.left)):
        elbow_x, elbow_y = pivot + p.arm_length * cos(angles.pivot), p.arm_length * sin(angles.pivot)
        frames += [link_frame(angles.pivot, pivot, 0.0), link_frame(angles.tip, elbow_x, elbow_y)]
    return tuple(frames)

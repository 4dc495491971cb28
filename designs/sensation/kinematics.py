"""The kinematics of SenSation, written once over any number: floats, batches, nodes and intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..chains.dyad import DyadAngles, rate_row, solve_dyad
from ..chains.dyad_pair import meet_circles
from ..chains.dyad_pair_mechanism import link_frame
from ..language.vectors import Rot, Vec, rot_z
from ..language.vocabulary import Number, Require, cos, sin
from .parameters import SensationLimits, SensationParameters


class SensationState(NamedTuple):
    """The device at a pose: tip [mm]; the right arm holds theta_1, theta_2, the left one theta_3, theta_4 [rad]."""

    x: Number
    y: Number
    right: DyadAngles
    left: DyadAngles


def solve_state(
    p: SensationParameters, pose: Sequence[Number], posture: tuple[float, float], require: Require
) -> SensationState:
    """Both arms for a tip at x, y [mm], with their elbows on the sides (right arm, left arm) of +-1.

    Source: Chung, Choo, Lee, eqs. (3)-(10), corrected as `solve_dyad` says.
    """
    x, y = pose
    arms = []
    for arm_name, pivot, side in (("right", 0.5, posture[0]), ("left", -0.5, posture[1])):

        def need(margin: Number, name: str, arm: str = arm_name) -> None:
            require(margin, f"{arm} arm {name}")

        arms.append(solve_dyad(x - pivot * p.pivot_distance, y, p.arm_length, p.tip_link_length, side, need))
    return SensationState(x, y, *arms)


def require_held(limits: SensationLimits, state: SensationState, require: Require) -> None:
    """State that the tip is held, in the working assembly mode: the arms AB and CD are far from parallel.

    The left arm leans left of the right one: det J_p = l_1 l_5 sin(theta_3 - theta_1) > 0.

    Source: Chung, Choo, Lee, eq. (16): direct singularity where AB is parallel to CD.
    """
    apart = sin(state.left.pivot - state.right.pivot)
    require(apart - sin(limits.arms_apart_min), "arms apart")


def joint_values(state: SensationState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`."""
    (t1, t2), (t3, t4) = state.right, state.left
    return (t2, t4, *_arm_values(t1, t2), *_arm_values(t3, t4), t4 - t2)


def _arm_values(arm: Number, tip: Number) -> tuple[Number, ...]:
    return arm, tip - arm, arm - tip, tip - arm


def rate_rows(p: SensationParameters, state: SensationState) -> tuple[tuple[Number, ...], ...]:
    """Rows of J_theta^-1 J_p: rates of theta_2, theta_4 from the tip's velocity.

    Source: Chung, Choo, Lee, eqs. (13)-(17).
    """
    return tuple(rate_row(arm.pivot, arm.tip, p.tip_link_length) for arm in (state.right, state.left))


def locate_tip(p: SensationParameters, theta_2: Number, theta_4: Number, require: Require) -> tuple[Number, Number]:
    """Tip (x, y) [mm] of the working assembly mode: where the arms l_1, l_5 about two points placed by the motors meet.

    Source: derived; the paper gives no forward kinematics.
    """
    half, length = 0.5 * p.pivot_distance, p.tip_link_length
    right = (half + length * cos(theta_2), length * sin(theta_2))
    left = (-half + length * cos(theta_4), length * sin(theta_4))
    return meet_circles(right, left, p.arm_length, p.arm_length, 1.0, require)


def body_frames(p: SensationParameters, state: SensationState) -> tuple[tuple[Rot, Vec], ...]:
    """Base, and per arm crank (A-E), arm (A-B), rod (E-F) and tip link (F-B-P, origin at B)."""
    frames = [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
    for pivot, angles in ((0.5 * p.pivot_distance, state.right), (-0.5 * p.pivot_distance, state.left)):
        elbow_x, elbow_y = pivot + p.arm_length * cos(angles.pivot), p.arm_length * sin(angles.pivot)
        crank_x, crank_y = pivot + p.crank_length * cos(angles.tip), p.crank_length * sin(angles.tip)
        frames += [
            link_frame(angles.tip, pivot, 0.0),
            link_frame(angles.pivot, pivot, 0.0),
            link_frame(angles.pivot, crank_x, crank_y),
            link_frame(angles.tip, elbow_x, elbow_y),
        ]
    return tuple(frames)

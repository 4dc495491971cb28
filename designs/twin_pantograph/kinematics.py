"""The kinematics of the 6-DOF Twin-Pantograph: waist B is passive, a motor in wrist A rolls the pen.

Source: Stocco, Salcudean, Sassani, section V. Printed: the motors' places, no equation. Used: roll is measured between
pen and hub, whose first axis is the host forearm. Shown by: tests/papers/test_stocco_platforms.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..chains.hinged_arm import Arm, arm_values, host_side
from ..chains.hinged_five_bar import (
    Side,
    forearm_rate,
    locate_hinged_tip,
    shoulder_rates,
    waist_rate,
)
from ..chains.swivel_wrist import solve_wrist, turn_rate_axis
from ..chains.twin_arms import TwinState, locate_arm_tip, solve_twin_state, tip_offset
from ..language.vectors import Rot, Vec, rot_x
from ..language.vocabulary import Number, Require, acos, atan2, cos, hypot, sin

#: Least sine between the pen and the plane of arm B: in that plane tip B gives no force across it (the singularity that
#: the redundant waist removes).
OUT_OF_PLANE_MARGIN = 0.05

#: Least cosine of ry: at a quarter turn rx and rz stop being two coordinates.
PITCH_MARGIN = 0.05


def solve_state(
    arms: Sequence[Arm], pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> TwinState:
    """Pen and arms at a pose x, y, z [mm], rx, ry, rz [rad], with the pen above the plane of arm B."""
    require(cos(pose[4]) - PITCH_MARGIN, "ry near a quarter turn")
    state = solve_twin_state(arms, pose, branch, require)
    require(-state.Q.y.dot(state.arms[1].five_bar.normal) - OUT_OF_PLANE_MARGIN, "pen in the plane of arm_b")
    return state


def joint_values(arms: Sequence[Arm], state: TwinState) -> tuple[Number, ...]:
    """Waist and shoulders of A, shoulders of B, roll; then the passive joints of A and of B [rad]."""
    a, b = (arm_values(arm, s) for arm, s in zip(arms, state.arms, strict=True))
    return (*a[:3], *b[1:3], a[8], *a[3:8], b[0], *b[3:])


def rate_rows(arms: Sequence[Arm], state: TwinState) -> tuple[tuple[Number, ...], ...]:
    """Rows d(motor)/d(twist) in the order q1, q2, q3, q5, q6, q7: columns v [mm/s], omega [rad/s].

    Source: Stocco et al., eq. (23).
    """
    a, b = (s.five_bar for s in state.arms)
    off_a, off_b = (tip_offset(arm, state) for arm in arms)
    gradients = [(waist_rate(a), off_a)]
    gradients += [(g, off_a) for g in shoulder_rates(a, arms[0].links)]
    gradients += [(g, off_b) for g in shoulder_rates(b, arms[1].links)]
    rows = [(*g, *off.cross(g)) for g, off in gradients]
    return (*rows, _roll_row(arms[0], state))


def _roll_row(arm: Arm, state: TwinState) -> tuple[Number, ...]:
    """d(roll)/d(twist): u . (omega - omega of the forearm), which turns with the waist and in its plane."""
    bar, off = state.arms[0].five_bar, tip_offset(arm, state)
    host = host_side(arm, bar)
    u = turn_rate_axis(bar.link_axes(host.forearm), -state.Q.y) * arm.hub_sign
    fore = forearm_rate(bar, host, arm.links)
    h = -(waist_rate(bar) * u.dot(bar.axes.x) + fore * u.dot(bar.normal))
    return (*h, *(off.cross(h) + u))


def locate_pen(arms: Sequence[Arm], active: Sequence[Number], pen_half: float, require: Require) -> tuple[Vec, Rot]:
    """Origin [mm] and axes of the pen from the six motors, in closed form.

    Tip A follows from its three motors. Tip B lies on a circle about waist B, a pen's length from A: of the two points
    the lower one belongs to the assembly. The roll motor turns the pen on the hub that forearm A and pen set.
    """
    arm_a, arm_b = arms
    waist_a, left_a, right_a, left_b, right_b, roll = active
    tip_a = locate_arm_tip(arm_a, waist_a, left_a, right_a, require)
    x, radius, _, _ = locate_hinged_tip(left_b, right_b, arm_b.links, require)
    require(radius, "arm_b on the waist axis")
    apart = tip_a - Vec(*arm_b.foot) - Vec(x, 0.0, 0.0)
    out = hypot(apart.y, apart.z)
    share = (apart.dot(apart) + radius * radius - 4.0 * pen_half * pen_half) / (2.0 * radius * out)
    require(1.0 - share * share, "pen's length from tip A")
    waist_b = atan2(-apart.y, apart.z) + acos(share)
    tip_b = Vec(*arm_b.foot) + Vec(x, -radius * sin(waist_b), radius * cos(waist_b))
    along = tip_a - tip_b
    along = along * (1.0 / along.norm())
    host = _host_forearm(arm_a, left_a, right_a, require)
    direction = rot_x(waist_a).apply(Vec(cos(host.forearm), 0.0, sin(host.forearm)))
    normal = rot_x(waist_a).apply(Vec(0.0, -1.0, 0.0))
    fore = Rot(direction, normal.cross(direction), normal)
    hub = solve_wrist(fore, -along, fore.x, require).hub_axes
    turn = roll * arm_a.hub_sign
    across = hub.x * cos(turn) + hub.y * sin(turn)
    return (tip_a + tip_b) * 0.5, Rot(across, along, across.cross(along))


def _host_forearm(arm: Arm, left: Number, right: Number, require: Require) -> Side:
    _, _, left_side, right_side = locate_hinged_tip(left, right, arm.links, require)
    return left_side if arm.host == "left" else right_side

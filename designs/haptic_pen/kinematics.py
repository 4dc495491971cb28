"""The kinematics of the haptic pen: two arms hold the tips, the pen's roll is nobody's.

The task has five coordinates: x, y, z of the pen's middle and the turns rx, rz with Q = Rz(rz) Rx(rx). That is the
house's Q = Rz Ry Rx with ry = 0, and the paper's end-effector frame: at zero roll the pen's x is normal to the base's
z. A hand may roll the pen further; motors neither see nor hold it, the bodies are placed at zero roll.

Source: Stocco, Salcudean, Sassani, sections V and VI. Printed: only that the Jacobian is expressed in the end-effector
frame. Used: this frame; a frame by plain tilt gives 0.239 instead of Table VII's 0.234. Shown by:
tests/papers/test_stocco_haptic_pen.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..chains.hinged_arm import Arm, arm_values
from ..chains.hinged_five_bar import shoulder_rates, waist_rate
from ..chains.twin_arms import TwinState, locate_arm_tip, solve_twin_state, tip_offset
from ..language.vectors import Vec
from ..language.vocabulary import Number, Require, atan2, cos, fabs, hypot

#: Least cosine of rx: beyond, rz loses its meaning (the pen points along the base's z, and at the hand).
UPRIGHT_MARGIN = 0.05


def solve_state(
    arms: Sequence[Arm], pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> TwinState:
    """Pen and arms at a pose x, y, z [mm], rx, rz [rad]."""
    x, y, z, rx, rz = pose
    require(cos(rx) - UPRIGHT_MARGIN, "pen along the base's z")
    return solve_twin_state(arms, (x, y, z, rx, 0.0, rz), branch, require)


def joint_values(arms: Sequence[Arm], state: TwinState) -> tuple[Number, ...]:
    """Waist, left and right shoulder of A, then of B; then the passive joints of A and of B [rad]."""
    a, b = (arm_values(arm, s) for arm, s in zip(arms, state.arms, strict=True))
    return (*a[:3], *b[:3], *a[3:], *b[3:])


def tip_gradients(arms: Sequence[Arm], state: TwinState) -> list[tuple[Vec, Vec]]:
    """Of every motor: d(angle)/d(tip) [rad/mm] and the tip's offset from the pen's middle [mm], in base axes."""
    rows = []
    for arm, arm_state in zip(arms, state.arms, strict=True):
        offset = tip_offset(arm, state)
        gradients = (waist_rate(arm_state.five_bar), *shoulder_rates(arm_state.five_bar, arm.links))
        rows += [(g, offset) for g in gradients]
    return rows


def rate_rows(arms: Sequence[Arm], state: TwinState) -> tuple[tuple[Number, ...], ...]:
    """Rows d(motor)/d(x, y, z, rx, rz): rx turns about the pen's x, rz about the base's z."""
    rows = []
    for g, offset in tip_gradients(arms, state):
        moment = offset.cross(g)
        rows.append((*g, moment.dot(state.Q.x), moment.z))
    return tuple(rows)


def force_rows(arms: Sequence[Arm], state: TwinState) -> tuple[tuple[Number, ...], ...]:
    """Rows of J with q_dot = J (v_i, v_j, v_k, omega_i, omega_k) in pen axes, so that f = J^T tau.

    Source: Stocco et al., eqs. (22) and (23), without the column of roll.
    """
    rows = []
    for g, offset in tip_gradients(arms, state):
        moment = state.Q.inverse_apply(offset.cross(g))
        rows.append((*state.Q.inverse_apply(g), moment.x, moment.z))
    return tuple(rows)


def locate_pen(
    arms: Sequence[Arm], active: Sequence[Number], pen_half: float, require: Require
) -> tuple[tuple[Number, ...], Number]:
    """Pose x, y, z [mm], rx, rz [rad] from six motors, and by how much the tips' distance misses the pen [mm].

    The assembly: both tips beyond their elbows. Six angles tell five coordinates; the pen lies in the middle.
    """
    tips = []
    for k, arm in enumerate(arms):

        def need(margin: Number, name: str, arm_name: str = arm.name) -> None:
            require(margin, f"{arm_name} {name}")

        waist, left, right = active[3 * k : 3 * k + 3]
        tips.append(locate_arm_tip(arm, waist, left, right, need))
    middle, along = (tips[0] + tips[1]) * 0.5, tips[0] - tips[1]
    pose = (*middle, atan2(along.z, hypot(along.x, along.y)), atan2(-along.x, along.y))
    return pose, fabs(along.norm() - 2.0 * pen_half)

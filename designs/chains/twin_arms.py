"""A pen between two hinged arms: what the haptic pen and the 6-DOF Twin-Pantograph share.

Base axes as in the paper: x = i to the right, y = j upwards along the line of the waists, z = k towards the hand. Arm A
stands at (0, l_4, 0), arm B at (0, -l_4, 0), both waist axes along x. The pen lies along its own y; tip A is at +l_6.

Source: Stocco, Salcudean, Sassani, Fig. 11; l_1, l_4 and l_6 are half lengths (with full lengths the tables' global
isotropy indices do not come out).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_x
from ..language.vocabulary import Number, Require
from .hinged_arm import Arm, ArmState, arm_frames, host_side, rest_axes
from .hinged_five_bar import FiveBarLinks, locate_hinged_tip, solve_hinged_five_bar
from .swivel_wrist import solve_wrist


class TwinState(NamedTuple):
    """Pen and arms at a pose."""

    origin: Vec
    Q: Rot
    arms: tuple[ArmState, ArmState]


def twin_arms(
    links: FiveBarLinks,
    base_half: float,
    pen_half: float,
    turns: tuple[tuple[float, float], tuple[float, float]],
    hand: str = "pen",
) -> tuple[Arm, Arm]:
    """Arms A (above) and B (below); turns count about the pen's y. The pole of both is -y of the pen."""
    arm_a, arm_b = (
        Arm(
            name=name,
            foot=(0.0, side * base_half, 0.0),
            axis=(1.0, 0.0, 0.0),
            links=links,
            host="left",
            side=side,
            hand=hand,
            p_hand=(0.0, side * pen_half, 0.0),
            axis_hand=(0.0, 1.0, 0.0),
            hub_sign=-1.0,
            turn=turn,
        )
        for name, side, turn in zip(("arm_a", "arm_b"), (1.0, -1.0), turns, strict=True)
    )
    return arm_a, arm_b


def solve_twin_state(
    arms: Sequence[Arm], pose: Sequence[Number], branch: Sequence[tuple[float, float]], require: Require
) -> TwinState:
    """Both arms at a pose x, y, z [mm], rx, ry, rz [rad], each in its branch of elbow signs."""
    x, y, z, rx, ry, rz = pose
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    states = []
    for arm, elbows in zip(arms, branch, strict=True):

        def need(margin: Number, name: str, arm_name: str = arm.name) -> None:
            require(margin, f"{arm_name} {name}")

        tip = origin + Q.apply(Vec(*arm.p_hand))
        bar = solve_hinged_five_bar(tip, Vec(*arm.foot), rest_axes(arm), arm.links, elbows, need)
        fore = bar.link_axes(host_side(arm, bar).forearm)
        states.append(ArmState(bar, solve_wrist(fore, -Q.y, Q.x, need)))
    return TwinState(origin, Q, (states[0], states[1]))


def tip_offset(arm: Arm, state: TwinState) -> Vec:
    """From the pen's middle to the arm's tip, in base axes [mm]."""
    return state.Q.apply(Vec(*arm.p_hand))


def twin_frames(arms: Sequence[Arm], state: TwinState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, seven bodies an arm, pen."""
    still = Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    frames = [(still, Vec(0.0, 0.0, 0.0))]
    for arm, arm_state in zip(arms, state.arms, strict=True):
        frames += arm_frames(arm, arm_state)
    return (*frames, (state.Q, state.origin))


def locate_arm_tip(arm: Arm, waist: Number, left: Number, right: Number, require: Require) -> Vec:
    """Tip in the base [mm] from the three driven angles of an arm [rad], beyond the elbows."""
    x, radius, _, _ = locate_hinged_tip(left, right, arm.links, require)
    require(radius, "on the waist axis")
    return Vec(*arm.foot) + rest_axes(arm).apply(rot_x(waist).apply(Vec(x, 0.0, radius)))

"""The kinematics of the Inoue platform: three five-bars on passive hinges, two shoulders each are driven.

Source: Stocco, Salcudean, Sassani, Fig. 10; the paper prints no equation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..chains.hinged_arm import Arm, ArmState, arm_frames, arm_values, host_side, rest_axes
from ..chains.hinged_five_bar import locate_hinged_tip, shoulder_rates, solve_hinged_five_bar
from ..chains.hinged_triad import ASSEMBLY_MARGIN, assembly_margin
from ..chains.swivel_wrist import solve_wrist
from ..language.vectors import Rot, Vec, rot_fixed_xyz
from ..language.vocabulary import Number, Require, cos

#: Least cosine of ry: at a quarter turn rx and rz stop being two coordinates.
PITCH_MARGIN = 0.05


class InoueState(NamedTuple):
    """The platform at a pose."""

    origin: Vec
    Q: Rot
    arms: tuple[ArmState, ...]


def solve_state(
    arms: Sequence[Arm],
    zeros: Sequence[Vec],
    pose: Sequence[Number],
    branch: Sequence[tuple[float, float]],
    require: Require,
) -> InoueState:
    """All arms at a pose x, y, z [mm], rx, ry, rz [rad].

    Args:
        arms: what is fixed about them; the pole of a wrist is the platform's stem.
        zeros: per arm the direction in the platform, across the stem, from which its turn is measured.
        pose: of the platform.
        branch: elbow signs per arm.
        require: told each arm's limits, and "other assembly".
    """
    x, y, z, rx, ry, rz = pose
    require(cos(ry) - PITCH_MARGIN, "ry near a quarter turn")
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    states = []
    for arm, zero, elbows in zip(arms, zeros, branch, strict=True):

        def need(margin: Number, name: str, arm_name: str = arm.name) -> None:
            require(margin, f"{arm_name} {name}")

        tip = origin + Q.apply(Vec(*arm.p_hand))
        bar = solve_hinged_five_bar(tip, Vec(*arm.foot), rest_axes(arm), arm.links, elbows, need)
        fore = bar.link_axes(host_side(arm, bar).forearm)
        states.append(ArmState(bar, solve_wrist(fore, Q.apply(Vec(*arm.axis_hand)), Q.apply(zero), need)))
    bars = [state.five_bar for state in states]
    require(assembly_margin([b.tip for b in bars], [b.normal for b in bars]) - ASSEMBLY_MARGIN, "other assembly")
    return InoueState(origin, Q, tuple(states))


def joint_values(arms: Sequence[Arm], state: InoueState) -> tuple[Number, ...]:
    """Six shoulders, then per arm waist, elbows, tip, swivel, bend, turn [rad]."""
    values = [arm_values(arm, s) for arm, s in zip(arms, state.arms, strict=True)]
    active = [v for own in values for v in own[1:3]]
    return (*active, *(v for own in values for v in (own[0], *own[3:])))


def rate_rows(arms: Sequence[Arm], state: InoueState) -> tuple[tuple[Number, ...], ...]:
    """Rows d(shoulder)/d(twist): columns v [mm/s], omega [rad/s].

    Source: Stocco et al., eq. (23).
    """
    rows = []
    for arm, arm_state in zip(arms, state.arms, strict=True):
        offset = state.Q.apply(Vec(*arm.p_hand))
        rows += [(*g, *offset.cross(g)) for g in shoulder_rates(arm_state.five_bar, arm.links)]
    return tuple(rows)


def body_frames(arms: Sequence[Arm], state: InoueState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, seven bodies an arm, platform."""
    still = Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    frames = [(still, Vec(0.0, 0.0, 0.0))]
    for arm, arm_state in zip(arms, state.arms, strict=True):
        frames += arm_frames(arm, arm_state)
    return (*frames, (state.Q, state.origin))


def locate_tips(arms: Sequence[Arm], active: Sequence[Number], require: Require) -> tuple[list[Number], list[Number]]:
    """Per arm, from its two shoulders: the tip along the hinge and its distance from it [mm]."""
    along, radius = [], []
    for i, arm in enumerate(arms):

        def need(margin: Number, name: str, arm_name: str = arm.name) -> None:
            require(margin, f"{arm_name} {name}")

        x, r, _, _ = locate_hinged_tip(active[2 * i], active[2 * i + 1], arm.links, need)
        need(r, "on the waist axis")
        along.append(x)
        radius.append(r)
    return along, radius

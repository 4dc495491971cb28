"""An arm: the hinged five-bar with its wrist, as bodies and joints (the haptic pen has two, the Inoue platform three).

Seven bodies, nine revolute joints: waist, two upper arms, two forearms that share the tip pin, swivel, hub. The swivel
sits on one forearm, the host.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ..language.bodies import Body
from ..language.joints import Joint, JointKind, Point
from ..language.parameters import angle
from ..language.units import DEG
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number
from .hinged_five_bar import FiveBarLinks, FiveBarState, Side, five_bar_frames, five_bar_values
from .swivel_wrist import WristState
from .triples import Triple, point

BODY_NAMES = ("waist", "upper_arm_left", "upper_arm_right", "forearm_left", "forearm_right", "swivel", "hub")

_X: Point = (1.0, 0.0, 0.0)
_Z: Point = (0.0, 0.0, 1.0)
_ORIGIN: Point = (0.0, 0.0, 0.0)


#: Ranges of `ArmLimits` whose lower end must stay below the upper.
ARM_RANGES = ("shoulder", "elbow", "opening", "bend")


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmLimits:
    """The declared joint limits of every arm: what the workspaces of the paper need, with some room."""

    waist_max: float = angle(45.0 * DEG, "hinge to either side; the workspaces need 39", least=0.0, most=90.0 * DEG)
    shoulder_min: float = angle(
        80.0 * DEG, "left upper arm from the waist axis; the right one is its mirror", least=-90.0 * DEG, most=270 * DEG
    )
    shoulder_max: float = angle(225.0 * DEG, "left upper arm: needs 220 behind the axis", least=0.0, most=270.0 * DEG)
    elbow_min: float = angle(25.0 * DEG, "bend of an elbow: away from stretched", least=0.0, most=180.0 * DEG)
    elbow_max: float = angle(155.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    opening_min: float = angle(25.0 * DEG, "between the forearms at the tip", least=0.0, most=180.0 * DEG)
    opening_max: float = angle(150.0 * DEG, "between the forearms: away from in line", least=0.0, most=180.0 * DEG)
    swivel_max: float = angle(85.0 * DEG, "swivel about the host forearm to either side", least=0.0, most=180.0 * DEG)
    bend_min: float = angle(
        -60.0 * DEG, "bend towards the swivel's housing behind the tip", least=-90.0 * DEG, most=0.0
    )
    bend_max: float = angle(
        85.0 * DEG, "bend away from the housing: the paper's limit of the universal joint", least=0.0, most=90.0 * DEG
    )


class Arm(NamedTuple):
    """What is fixed about an arm.

    Attributes:
        name: prefix of its bodies and joints ("arm_a").
        foot: waist point in the base [mm].
        axis: waist axis in the base.
        links: lengths of the five-bar.
        host: "left" or "right": the forearm that carries the swivel.
        side: +1 if the hand extends from the tip along the pole, -1 if against it; bends count from that side.
        hand: body at the wrist; p_hand, axis_hand: tip and turn axis in its frame; hub_sign: that axis in the hub's z.
        turn: limits of the turn [rad].
    """

    name: str
    foot: Triple
    axis: Triple
    links: FiveBarLinks
    host: str
    side: float
    hand: str
    p_hand: Triple
    axis_hand: Triple
    hub_sign: float
    turn: tuple[float, float]


class ArmState(NamedTuple):
    """An arm at a pose."""

    five_bar: FiveBarState
    wrist: WristState


def host_side(arm: Arm, state: FiveBarState) -> Side:
    """The side whose forearm carries the swivel."""
    return state.left if arm.host == "left" else state.right


def rest_axes(arm: Arm) -> Rot:
    """Axes of the arm at rest in the base: x the waist axis, z the base's z."""
    x, y, _ = arm.axis
    return Rot(Vec(*arm.axis), Vec(-y, x, 0.0), Vec(0.0, 0.0, 1.0))


def arm_joints(arm: Arm, limits: ArmLimits, *, is_active: Callable[[str], bool]) -> tuple[Joint, ...]:
    """Waist, both shoulders, both elbows, tip pin, swivel, bend, turn."""
    l_1, l_2, l_3 = arm.links
    pin: Point = (0.0, -1.0, 0.0)
    straight = limits.shoulder_min, limits.shoulder_max
    pi = 180.0 * DEG
    mirrored = pi - straight[1], pi - straight[0]
    bend = limits.elbow_min, limits.elbow_max
    tip: Point = (l_3, 0.0, 0.0)
    across: Point = (0.0, arm.side, 0.0)
    bends = limits.bend_min, limits.bend_max

    def hinge(
        name: str,
        parent: str,
        child: str,
        p_parent: Point,
        axis_parent: Point,
        p_child: Point,
        axis_child: Point,
        span: Sequence[float],
    ) -> Joint:
        return Joint(
            name=f"{arm.name}_{name}",
            kind=JointKind.REVOLUTE,
            parent=parent if parent == "base" else f"{arm.name}_{parent}",
            child=child if child == arm.hand else f"{arm.name}_{child}",
            p_parent=p_parent,
            axis_parent=axis_parent,
            p_child=p_child,
            axis_child=axis_child,
            lower=span[0],
            upper=span[1],
            is_active=is_active(name),
        )

    fore = f"forearm_{arm.host}"
    turn_axis: Point = (0.0, 0.0, arm.hub_sign)
    waist = (-limits.waist_max, limits.waist_max)
    swivel = (-limits.swivel_max, limits.swivel_max)
    return (
        hinge("waist", "base", "waist", point(arm.foot), point(arm.axis), _ORIGIN, _X, waist),
        hinge("shoulder_left", "waist", "upper_arm_left", (-l_1, 0.0, 0.0), pin, _ORIGIN, _Z, straight),
        hinge("shoulder_right", "waist", "upper_arm_right", (l_1, 0.0, 0.0), pin, _ORIGIN, _Z, mirrored),
        hinge("elbow_left", "upper_arm_left", "forearm_left", (l_2, 0.0, 0.0), _Z, _ORIGIN, _Z, (-bend[1], -bend[0])),
        hinge("elbow_right", "upper_arm_right", "forearm_right", (l_2, 0.0, 0.0), _Z, _ORIGIN, _Z, bend),
        hinge("tip", "forearm_left", "forearm_right", tip, _Z, tip, _Z, (limits.opening_min, limits.opening_max)),
        hinge("swivel", fore, "swivel", tip, _X, _ORIGIN, _X, swivel),
        hinge("bend", "swivel", "hub", _ORIGIN, across, _ORIGIN, across, bends),
        hinge("turn", "hub", arm.hand, _ORIGIN, turn_axis, point(arm.p_hand), point(arm.axis_hand), arm.turn),
    )


def arm_values(arm: Arm, state: ArmState) -> tuple[Number, ...]:
    """Values in the order of `arm_joints` [rad]."""
    bar, wrist = state
    driven = (bar.waist, bar.left.upper_arm, bar.right.upper_arm)
    return (
        *driven,
        *five_bar_values(bar),
        wrist.swivel,
        wrist.bend * arm.side,
        wrist.turn * arm.hub_sign,
    )


def arm_bodies(arm: Arm, kind: str) -> tuple[Body, ...]:
    """Its seven bodies; arms of one `kind` have equal parts."""
    return tuple(
        Body(name=f"{arm.name}_{name}", kind=f"{kind}_{name}", group=arm.name, parts=()) for name in BODY_NAMES
    )


def arm_frames(arm: Arm, state: ArmState) -> list[tuple[Rot, Vec]]:
    """Axes and origins in the order of `BODY_NAMES`; swivel and hub have their origins in the tip."""
    bar, wrist = state
    frames = five_bar_frames(bar, Vec(*arm.foot), arm.links)
    return [*frames, (wrist.swivel_axes, bar.tip), (wrist.hub_axes, bar.tip)]

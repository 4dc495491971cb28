"""Joints and bodies of the Inoue platform: nine hinges an arm, motors on the six shoulders."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..chains.hinged_arm import Arm, ArmLimits, arm_bodies, arm_joints
from ..chains.hinged_triad import TriadLeg, triad_legs
from ..language.bodies import Body
from ..language.errors import ParameterError
from ..language.joints import Joint, Point
from .parameters import InoueParameters, InoueStems

ACTIVE = ("shoulder_left", "shoulder_right")

#: Forearms that carry the wrists: those of legs 2 and 3 that diverge below, so that their housings do not meet.
HOSTS = ("left", "left", "right")


def build_legs(p: InoueParameters) -> tuple[TriadLeg, ...]:
    """Hinges and platform points."""
    return triad_legs(
        p.base_single_radius,
        p.base_pair_radius,
        p.base_angle,
        p.platform_single_radius,
        p.platform_pair_radius,
        p.platform_angle,
    )


def build_arms(p: InoueParameters, stems: InoueStems, legs: Sequence[TriadLeg]) -> tuple[Arm, ...]:
    """The three arms; a stem is the pole of its wrist."""
    single = _unit("single", stems.single_x, stems.single_y, stems.single_z)
    x, y, z = _unit("pair", stems.pair_x, stems.pair_y, stems.pair_z)
    return tuple(
        Arm(
            name=f"arm_{i + 1}",
            foot=leg.foot,
            axis=leg.axis,
            links=p.links,
            host=HOSTS[i],
            side=1.0,
            hand="platform",
            p_hand=leg.p_hand,
            axis_hand=stem,
            hub_sign=1.0,
            turn=(-stems.turn_max, stems.turn_max),
        )
        for i, (leg, stem) in enumerate(zip(legs, (single, (x, y, z), (-x, y, z)), strict=True))
    )


def _unit(name: str, x: float, y: float, z: float) -> Point:
    size = math.sqrt(x * x + y * y + z * z)
    if size < 1e-3:
        raise ParameterError(f"stems.{name}_x", x, "the stem's three components must not all vanish")
    return x / size, y / size, z / size


def build_joints(arms: Sequence[Arm], limits: ArmLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, arm by arm."""
    joints = [j for arm in arms for j in arm_joints(arm, limits, is_active=ACTIVE.__contains__)]
    return (*(j for j in joints if j.is_active), *(j for j in joints if not j.is_active))


def build_bodies(arms: Sequence[Arm]) -> tuple[Body, ...]:
    """Base, seven bodies an arm, platform; arms 1 and 2 are equal, arm 3 has its wrist on the other forearm."""
    links = [body for arm in arms for body in arm_bodies(arm, f"{arm.host}_hosted")]
    return (
        Body(name="base", kind="base", group="", parts=()),
        *links,
        Body(name="platform", kind="platform", group="", parts=()),
    )

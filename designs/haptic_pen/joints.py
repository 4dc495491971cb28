"""Joints and bodies of the haptic pen: nine hinges an arm; one motor on each waist and on each shoulder."""

from __future__ import annotations

from ..chains.hinged_arm import Arm, ArmLimits, arm_bodies, arm_joints
from ..chains.twin_arms import twin_arms
from ..language.bodies import Body
from ..language.joints import Joint
from ..language.units import DEG
from .parameters import HapticPenParameters

ACTIVE = ("waist", "shoulder_left", "shoulder_right")

#: The pen rolls freely in both hubs; one may turn on the other without end, a value is named within half a turn.
FREE_TURN = (-180.0 * DEG, 180.0 * DEG)


def build_arms(p: HapticPenParameters) -> tuple[Arm, Arm]:
    """Arm A above, arm B below."""
    return twin_arms(p.links, p.waist_half_spacing, p.pen_half_length, (FREE_TURN, FREE_TURN))


def build_joints(arms: tuple[Arm, Arm], limits: ArmLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, arm by arm."""
    joints = [j for arm in arms for j in arm_joints(arm, limits, is_active=ACTIVE.__contains__)]
    return (*(j for j in joints if j.is_active), *(j for j in joints if not j.is_active))


def build_bodies(arms: tuple[Arm, Arm]) -> tuple[Body, ...]:
    """Base, seven bodies an arm, pen; the arms are mirror images, so their parts differ."""
    links = [body for arm in arms for body in arm_bodies(arm, arm.name)]
    return (
        Body(name="base", kind="base", group="", parts=()),
        *links,
        Body(name="pen", kind="pen", group="", parts=()),
    )

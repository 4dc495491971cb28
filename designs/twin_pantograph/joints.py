"""Joints and bodies of the 6-DOF Twin-Pantograph: as the haptic pen, but waist B is passive and wrist A rolls."""

from __future__ import annotations

from ..chains.hinged_arm import Arm, ArmLimits, arm_bodies, arm_joints
from ..chains.twin_arms import twin_arms
from ..language.bodies import Body
from ..language.joints import Joint
from ..language.units import DEG
from .parameters import TwinPantographParameters, TwinPantographRoll

ACTIVE = {"arm_a": ("waist", "shoulder_left", "shoulder_right", "turn"), "arm_b": ("shoulder_left", "shoulder_right")}

#: In hub B the pen rolls freely.
FREE_TURN = (-180.0 * DEG, 180.0 * DEG)


def build_arms(p: TwinPantographParameters, roll: TwinPantographRoll) -> tuple[Arm, Arm]:
    """Arm A above with the roll motor, arm B below."""
    turns = ((roll.roll_min, roll.roll_max), FREE_TURN)
    return twin_arms(p.links, p.waist_half_spacing, p.pen_half_length, turns)


def build_joints(arms: tuple[Arm, Arm], limits: ArmLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first: q1, q2, q3, q5, q6, q7 of the paper."""
    a, b = (arm_joints(arm, limits, is_active=ACTIVE[arm.name].__contains__) for arm in arms)
    return (*a[:3], *b[1:3], a[8], *a[3:8], b[0], *b[3:])


def build_bodies(arms: tuple[Arm, Arm]) -> tuple[Body, ...]:
    """Base, seven bodies an arm, pen; the arms are mirror images and differ in waist and wrist."""
    links = [body for arm in arms for body in arm_bodies(arm, arm.name)]
    return (
        Body(name="base", kind="base", group="", parts=()),
        *links,
        Body(name="pen", kind="pen", group="", parts=()),
    )

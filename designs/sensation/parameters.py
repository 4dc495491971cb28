"""The numbers of SenSation, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class SensationParameters:
    """The kinematic dimensions (Chung, Choo, Lee, section 4), equal on both sides."""

    pivot_distance: float = length(180.0, "between the motor axes A and C", symbol="d")
    arm_length: float = length(180.0, "A to B: the passive link on the base", symbol="l_1, l_3, l_5, l_7")
    tip_link_length: float = length(180.0, "B to the tip P: the driven link", symbol="l_4, l_8")
    crank_length: float = length(
        -60.0,
        "A to E: the driven side of the parallelogram, towards the tip; below zero away from it. Does not enter the "
        "kinematics. The printed 300 puts the pin F 120 beyond the tip and sweeps the rod through the other motor's "
        "axis; -60 needs the smallest counterweights",
        symbol="l_2, l_6",
        above=None,
    )


#: Chung, Choo, Lee, section 4 (the last "l_3 = 0.18" of the print is d).
SENSATION_SECTION_4 = SensationParameters(crank_length=300.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensationLimits:
    """The declared joint limits: 20 degrees away from flat parallelograms and from parallel arms."""

    theta_2_min: float = angle(90.0 * DEG, "right tip link from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_2_max: float = angle(250.0 * DEG, "right tip link from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_4_min: float = angle(-70.0 * DEG, "left tip link from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_4_max: float = angle(90.0 * DEG, "left tip link from +x", least=-180.0 * DEG, most=360.0 * DEG)
    elbow_min: float = angle(
        20.0 * DEG,
        "bend of an elbow: at 0 the parallelogram is flat and may flip",
        least=0.0,
        most=180.0 * DEG,
    )
    elbow_max: float = angle(160.0 * DEG, "bend of an elbow: at 180 it is flat again", least=0.0, most=180.0 * DEG)
    arms_apart_min: float = angle(
        20.0 * DEG, "least angle between the two arms' lines: at 0 the tip is not held", least=0.0, most=90.0 * DEG
    )

"""The numbers of the plain five-bar, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class FiveBarParameters:
    """The kinematic dimensions, equal on both sides; the comparison of Chung, Choo, Lee, section 4."""

    pivot_distance: float = length(180.0, "between the motor axes A and C", symbol="d")
    arm_length: float = length(180.0, "A to B: the driven link on the base", symbol="l_1, l_5")
    tip_link_length: float = length(180.0, "B to the tip P: the free link", symbol="l_4, l_8")


@dataclass(frozen=True, slots=True, kw_only=True)
class FiveBarLimits:
    """The declared joint limits: 20 degrees away from stretched arms and from tip links in one line."""

    theta_1_min: float = angle(-90.0 * DEG, "right arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_1_max: float = angle(150.0 * DEG, "right arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_3_min: float = angle(30.0 * DEG, "left arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    theta_3_max: float = angle(270.0 * DEG, "left arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    elbow_min: float = angle(20.0 * DEG, "bend of an elbow: away from stretched", least=0.0, most=180.0 * DEG)
    elbow_max: float = angle(160.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    tip_min: float = angle(
        20.0 * DEG,
        "angle between the tip links: at 0 they lie on each other and do not hold the tip",
        least=0.0,
        most=180.0 * DEG,
    )
    tip_max: float = angle(
        160.0 * DEG, "angle between the tip links: at 180 they do not hold the tip", least=0.0, most=180.0 * DEG
    )

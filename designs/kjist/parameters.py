"""The numbers of the KJIST haptic device, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class KjistParameters:
    """The kinematic dimensions.

    None are published, so the pantographs are those of the HIT device, for comparison.

    Source: Yoon, Ryu, as described by Zhang, Kong, Sun, Du.
    """

    base_radius: float = length(110.0, "centre of the base to the plane in which a joint centre S moves", symbol="R")
    platform_radius: float = length(
        110.0, "centre of the platform to its pins; equal to R keeps the bars farthest from singular", symbol="r"
    )
    chain_height: float = length(40.0, "z = 0 of the base to the common axis of both motors", symbol="L_1")
    lower_link_length: float = length(150.0, "motor axis to elbow", symbol="L_2")
    upper_link_length: float = length(150.0, "elbow to the top pin", symbol="L_3")
    bar_length: float = length(
        80.0, "joint centre S to the platform's pin: sideways travel is about its length", symbol="L_c"
    )
    joint_inset: float = length(
        40.0,
        "pantograph's plane to S, inwards along the extended top pin; only shifts that plane outwards. 0 puts three "
        "links and a joint in one place, and at 30 the joint's fork meets the links",
        symbol="x_S",
        least=0.0,
    )

    @property
    def plane_radius(self) -> float:
        """R + x_S [mm]: centre of the base to the pantographs' planes."""
        return self.base_radius + self.joint_inset


#: The device as printed: the joint's centre in the pantograph's plane. It cannot be built.
KJIST_LITERAL = KjistParameters(joint_inset=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class KjistLimits:
    """The declared joint limits."""

    theta_1_min: float = angle(60.0 * DEG, "left lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    theta_1_max: float = angle(180.0 * DEG, "left lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_min: float = angle(0.0, "right lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_max: float = angle(120.0 * DEG, "right lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    elbow_min: float = angle(
        20.0 * DEG, "bend of an elbow (opening of the pantograph): away from stretched", least=0.0, most=180.0 * DEG
    )
    elbow_max: float = angle(150.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    swing_max: float = angle(
        120.0 * DEG, "first turn of the 3R joint, against the right upper link", least=0.0, most=180.0 * DEG
    )
    fork_max: float = angle(
        60.0 * DEG, "second turn: the bar meets the fork beyond; at 90 the joint locks", least=0.0, most=90.0 * DEG
    )
    twist_max: float = angle(80.0 * DEG, "third turn, about the bar", least=0.0, most=180.0 * DEG)
    bar_lean_max: float = angle(
        60.0 * DEG, "bar from upright to the platform, at the platform's pin", least=0.0, most=90.0 * DEG
    )
    hold_min: float = angle(
        20.5 * DEG,
        "angle of the bar's arc to the pantograph's plane: at 0 the plate is not held",
        least=0.0,
        most=90.0 * DEG,
    )

"""The numbers of the KAIST master hand, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class KaistParameters:
    """The kinematic dimensions.

    None are published, so the legs are those of the HIT device, for comparison.

    Source: Woo, Jin, Kwon, as described by Zhang, Kong, Sun, Du.
    """

    base_radius: float = length(
        144.0, "centre of the base to the pins; platform_radius plus ball_inset stands the legs upright", symbol="R"
    )
    platform_radius: float = length(110.0, "centre of the platform to the balls", symbol="r")
    chain_height: float = length(40.0, "pin axis to the motor axes", symbol="L_1")
    lower_link_length: float = length(150.0, "motor to elbow", symbol="L_2")
    upper_link_length: float = length(150.0, "elbow to the top pin F", symbol="L_3")
    motor_distance: float = length(60.0, "left to right motor axis: room for a motor of 36", symbol="e", least=0.0)
    ball_inset: float = length(
        34.0,
        "leg's plane to the ball, inwards along the extended top pin; 0 puts pin, two links and ball in one place, and "
        "at 30 the pin's head meets the socket",
        symbol="-x_F",
        least=0.0,
    )


#: The device as printed: the ball in the leg's plane, upright legs. It cannot be built.
KAIST_LITERAL = KaistParameters(base_radius=110.0, ball_inset=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class KaistLimits:
    """The declared joint limits, those of the HIT study and 30 degrees between and around the upper links."""

    theta_1_min: float = angle(60.0 * DEG, "left lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    theta_1_max: float = angle(180.0 * DEG, "left lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_min: float = angle(0.0, "right lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_max: float = angle(120.0 * DEG, "right lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    elbow_min: float = angle(20.0 * DEG, "bend of an elbow: away from stretched", least=0.0, most=180.0 * DEG)
    elbow_max: float = angle(150.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    top_min: float = angle(30.0 * DEG, "between the upper links: they must hold the ball", least=0.0, most=180.0 * DEG)
    top_max: float = angle(150.0 * DEG, "between the upper links: away from one line", least=0.0, most=180.0 * DEG)
    pin_max: float = angle(60.0 * DEG, "lean of a leg to either side", least=0.0, most=90.0 * DEG)
    cone_max: float = angle(55.0 * DEG, "half angle of the ball joint's cone", least=0.0, most=90.0 * DEG)

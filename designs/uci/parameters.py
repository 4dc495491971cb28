"""The numbers of the UCI hand controller, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class UciParameters:
    """The kinematic dimensions.

    None are published, so the legs are those of the HIT device, for comparison.

    Source: Long, Collins, as described by Zhang, Kong, Sun, Du.
    """

    base_radius: float = length(
        110.0, "centre of the base to the pins; at 95 a motor meets the neighbour's links", symbol="R"
    )
    platform_radius: float = length(110.0, "centre of the platform to the balls", symbol="r")
    chain_height: float = length(40.0, "pin axis to the common axis of both motors", symbol="L_1")
    lower_link_length: float = length(150.0, "D to E, and its parallel H to G", symbol="L_2")
    upper_link_length: float = length(150.0, "E to the ball F", symbol="L_3")
    tip_setback: float = length(
        45.0,
        "ball F to the pin G where the links meet: 0 puts a pin and a ball in one place, below 45 the link meets the "
        "socket; does not enter the kinematics, for F = D + L_2 u(theta_1) + L_3 u(theta_2) holds",
        symbol="b",
        least=0.0,
    )
    ball_bar_angle: float = angle(
        45.573 * DEG,
        "link E-F to the ball-bar: upright at the height of 250, so that the sockets look straight down; 0 lies along "
        "the link",
        least=-180.0 * DEG,
        most=180.0 * DEG,
    )
    socket_tilt: float = angle(
        0.0,
        "sockets from the platform's normal, from upright towards the leg's +y; a "
        "straight ball-bar needs 45.573 to be free at the height of 250",
        least=-90.0 * DEG,
        most=90.0 * DEG,
    )

    @property
    def inner_link_length(self) -> float:
        """A = L_3 - b [mm]: D to H, and its parallel E to G."""
        return self.upper_link_length - self.tip_setback


#: The device as printed: pin and ball in one point, the ball-bar along its link, sockets that look along the bars at
#: the height of 250. It cannot be built.
UCI_LITERAL = UciParameters(tip_setback=0.0, ball_bar_angle=0.0, socket_tilt=45.573 * DEG)


@dataclass(frozen=True, slots=True, kw_only=True)
class UciLimits:
    """The declared joint limits, those of the HIT study."""

    theta_1_min: float = angle(60.0 * DEG, "left lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    theta_1_max: float = angle(180.0 * DEG, "left lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_min: float = angle(0.0, "right lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_max: float = angle(120.0 * DEG, "right lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    elbow_min: float = angle(20.0 * DEG, "opening theta_1 - theta_2: away from stretched", least=0.0, most=180.0 * DEG)
    elbow_max: float = angle(150.0 * DEG, "opening theta_1 - theta_2: away from folded", least=0.0, most=180.0 * DEG)
    pin_max: float = angle(45.0 * DEG, "lean of a leg to either side", least=0.0, most=90.0 * DEG)
    cone_max: float = angle(55.0 * DEG, "half angle of the ball joint's cone", least=0.0, most=90.0 * DEG)

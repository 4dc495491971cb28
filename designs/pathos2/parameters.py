"""The numbers of PATHOS-II, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length, number
from ..language.units import CM, DEG
from ..language.vocabulary import Number, cos, sin


@dataclass(frozen=True, slots=True, kw_only=True)
class PathosParameters:
    """The kinematic dimensions (Kim, Chung, Fig. 3, section 3.2 and Table 1 where it applies)."""

    base_distance: float = length(
        45.0 * CM, "between the base plates: leaves room for the hand (section 3.2)", symbol="l_0"
    )
    base_radius: float = length(10.0 * CM, "centre of a base plate to the motors", symbol="l_b")
    motor_tilt: float = angle(
        30.0 * DEG,
        "lean of a motor's axis outwards: similar stiffness in all directions (section 4)",
        symbol="theta_t",
        least=-80.0 * DEG,
        most=80.0 * DEG,
    )
    lower_link_length: float = length(7.0 * CM, "motor's foot to R2", symbol="l_1")
    middle_link_length: float = length(14.0 * CM, "R2 to elbow R3", symbol="l_2")
    upper_link_length: float = length(6.0 * CM, "elbow R3 to globular joint", symbol="l_3")
    plate_radius: float = length(2.0 * CM, "centre of a top plate to the globular joints", symbol="l_p")
    globular_tilt: float = angle(
        0.0,
        "lean of a globular joint's last axis in its plate, outwards",
        symbol="theta_g",
        least=-90.0 * DEG,
        most=90.0 * DEG,
    )
    home_grip: float = length(7.0 * CM, "half the distance of the top plates, at home", symbol="h_0")
    home_turn: float = angle(
        30.0 * DEG, "initial orientation of the platform about Z", symbol="R_z", least=-180.0 * DEG, most=180.0 * DEG
    )

    @property
    def shift_along(self) -> Number:
        """l_x = l_b / cos(theta_t) [mm]: along the tilted plane to the motor."""
        return self.base_radius / cos(self.motor_tilt)

    @property
    def shift_up(self) -> Number:
        """l_t [mm]: along the plate's normal to where the tilted plane starts, so that the motor lies in the plate.

        Source: Kim, Chung, Table 1. Printed: l_b / sin(theta_t), which lifts the motors 142 mm off the plate and makes
        the workspace shrink with l_0. Used: l_b tan(theta_t). Shown by: tests/papers/test_kim_chung_pathos2.py.
        """
        return self.base_radius * sin(self.motor_tilt) / cos(self.motor_tilt)


#: Table 1: the set in which link lengths were optimised (section 3.1); the device itself has l_0 = 45 cm.
PATHOS2_TABLE_1 = PathosParameters(base_distance=50.0 * CM)


@dataclass(frozen=True, slots=True, kw_only=True)
class PathosLimits:
    """The declared joint limits of the lower legs; the upper ones are their mirror images (theta_1, 3, 4, 6 negated).

    The paper states none. These hold all but a few of a thousand poses that a handle at rest reaches in a sphere of
    100 mm, and they leave one assembly only to a set of motor angles.
    """

    theta_1_min: float = angle(-60.0 * DEG, "motor", least=-180.0 * DEG, most=180.0 * DEG)
    theta_1_max: float = angle(15.0 * DEG, "motor", least=-180.0 * DEG, most=180.0 * DEG)
    theta_2_min: float = angle(-110.0 * DEG, "R2: middle link outwards", least=-180.0 * DEG, most=0.0)
    theta_2_max: float = angle(-45.0 * DEG, "R2: middle link upright", least=-180.0 * DEG, most=0.0)
    theta_3_min: float = angle(8.0 * DEG, "elbow R3: away from stretched", least=0.0, most=180.0 * DEG)
    theta_3_max: float = angle(145.0 * DEG, "elbow R3: away from folded", least=0.0, most=180.0 * DEG)
    theta_4_min: float = angle(
        -40.0 * DEG, "globular joint, along the upper link", least=-180.0 * DEG, most=180.0 * DEG
    )
    theta_4_max: float = angle(90.0 * DEG, "globular joint, along the upper link", least=-180.0 * DEG, most=180.0 * DEG)
    theta_5_min: float = angle(28.0 * DEG, "globular joint, lean: away from aligned axes", least=0.0, most=180.0 * DEG)
    theta_5_max: float = angle(130.0 * DEG, "globular joint, lean: away from its plate", least=0.0, most=180.0 * DEG)
    theta_6_min: float = angle(
        -105.0 * DEG, "globular joint, along the plate's normal", least=-180.0 * DEG, most=180.0 * DEG
    )
    theta_6_max: float = angle(
        60.0 * DEG, "globular joint, along the plate's normal", least=-180.0 * DEG, most=180.0 * DEG
    )
    least_determinant: float = number(
        0.15,
        "",
        "least determinant of the six unit forces and moments (1.43 at home): away from the parallel singularity, "
        "beyond which other assemblies have the same motor angles",
        least=0.0,
    )
    gap_min: float = length(10.0 * CM, "least distance of the top plates, 2 h_0")
    gap_max: float = length(15.0 * CM, "largest distance of the top plates, 2 h_0")

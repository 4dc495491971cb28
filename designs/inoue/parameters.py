"""The numbers of the Inoue platform, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..chains.hinged_arm import ArmLimits
from ..chains.hinged_five_bar import FiveBarLinks
from ..language.parameters import angle, length, number
from ..language.units import CM, DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class InoueParameters:
    """The kinematic dimensions: Table V, with room for motors and for the forks of legs 2 and 3."""

    shoulder_half_spacing: float = length(
        2.4 * CM, "hinge point to either shoulder; Table V's 2 cm leave no room for two motors", symbol="l_1"
    )
    upper_arm_length: float = length(16.0 * CM, "shoulder to elbow", symbol="l_2")
    forearm_length: float = length(24.0 * CM, "elbow to tip; above l_1 + l_2 no forearms in line", symbol="l_3")
    base_single_radius: float = length(2.0 * CM, "base to the hinge of leg 1", symbol="l_4")
    base_pair_radius: float = length(2.0 * CM, "base to the hinges of legs 2 and 3", symbol="l_5")
    platform_single_radius: float = length(2.0 * CM, "platform to the tip of leg 1", symbol="l_6")
    platform_pair_radius: float = length(4.0 * CM, "platform to the tips of legs 2 and 3", symbol="l_7")
    base_angle: float = angle(120.0 * DEG, "leg 1 to legs 2 and 3", symbol="eta_1", least=5.0 * DEG, most=175.0 * DEG)
    platform_angle: float = angle(
        165.0 * DEG,
        "the same on the platform; Table V's 170 degrees put two wrists 14 mm apart",
        symbol="eta_2",
        least=5.0 * DEG,
        most=179.0 * DEG,
    )
    home_distance: float = length(25.0 * CM, "base to the centre of the workspace", symbol="k_0")
    near_scale: float = number(
        0.75, "", "torque of the motors of legs 2, 3 next to leg 1 against leg 1's", symbol="Q_1", above=0.0
    )
    far_scale: float = number(0.75, "", "torque of their other motors", symbol="Q_2", above=0.0)

    @property
    def links(self) -> FiveBarLinks:
        """Lengths of all five-bars [mm]."""
        return FiveBarLinks(self.shoulder_half_spacing, self.upper_arm_length, self.forearm_length)


#: Table V: the optimum of the comparison. Printed: global isotropy index 0.215. Ours: 0.2133, for the same optimum.
STOCCO_TABLE_5 = InoueParameters(shoulder_half_spacing=2.0 * CM, platform_angle=170.0 * DEG)
STOCCO_TABLE_5_GII = 0.215

#: S_T (eq. 19) by force and torque of the hand, [-, -, -, cm, cm, cm], in platform axes.
STOCCO_HAND_FORCE = (1.0, 1.0, 1.5, 3.6, 0.5, 3.9)


@dataclass(frozen=True, slots=True, kw_only=True)
class InoueLimits(ArmLimits):
    """The declared joint limits; the swivels of legs 2 and 3 stand 39 degrees off at home."""

    swivel_max: float = angle(115.0 * DEG, "swivel about the host forearm to either side", least=0.0, most=180.0 * DEG)


@dataclass(frozen=True, slots=True, kw_only=True)
class InoueStems:
    """Where the platform holds its three wrists: the last wrist axis, tip to platform, in the platform's axes.

    Chosen so that no stem comes near the swivel's housing behind the tip; leg 3 mirrors leg 2.
    """

    single_x: float = number(0.21, "", "stem of leg 1, x")
    single_y: float = number(-0.95, "", "stem of leg 1, y")
    single_z: float = number(0.22, "", "stem of leg 1, z")
    pair_x: float = number(-0.54, "", "stem of leg 2, x; leg 3 has the other sign")
    pair_y: float = number(0.50, "", "stem of legs 2 and 3, y")
    pair_z: float = number(0.67, "", "stem of legs 2 and 3, z")
    turn_max: float = angle(90.0 * DEG, "turn about a stem to either side of home", least=0.0, most=180.0 * DEG)

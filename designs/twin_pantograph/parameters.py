"""The numbers of the 6-DOF Twin-Pantograph, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..chains.hinged_five_bar import FiveBarLinks
from ..language.parameters import angle, length, number
from ..language.units import CM, DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinPantographParameters:
    """The kinematic dimensions: Table III with a pen that can be held."""

    shoulder_half_spacing: float = length(3.0 * CM, "waist point to either shoulder", symbol="l_1")
    upper_arm_length: float = length(16.0 * CM, "shoulder to elbow", symbol="l_2")
    forearm_length: float = length(22.0 * CM, "elbow to tip; above l_1 + l_2 no forearms in line", symbol="l_3")
    waist_half_spacing: float = length(2.0 * CM, "centre of the base to either waist axis", symbol="l_4")
    pen_half_length: float = length(
        4.0 * CM, "middle of the pen to either tip; Table III's 3 cm leave no room for fingers", symbol="l_6"
    )
    home_distance: float = length(25.0 * CM, "base to the centre of the workspace", symbol="k_0")
    waist_scale: float = number(1.8, "", "torque of the waist motor against a shoulder motor", symbol="Q_1", above=0.0)
    roll_scale: float = number(0.03, "", "torque of the roll motor against a shoulder motor", symbol="Q_2", above=0.0)

    @property
    def links(self) -> FiveBarLinks:
        """Lengths of both five-bars [mm]."""
        return FiveBarLinks(self.shoulder_half_spacing, self.upper_arm_length, self.forearm_length)


#: Table III: the optimum of the 6-DOF comparison; global isotropy index 0.327. (Q_2 = 0.035 is as good to 4e-6.)
STOCCO_TABLE_3 = TwinPantographParameters(pen_half_length=3.0 * CM, waist_scale=1.9)
STOCCO_TABLE_3_GII = 0.327

#: S_T (eq. 19) by force and torque of the hand, [-, -, -, cm, cm, cm], in pen axes.
STOCCO_HAND_FORCE = (1.0, 1.0, 1.5, 3.6, 0.5, 3.9)


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinPantographRoll:
    """Limits of the roll actuator, whose zero is the host forearm."""

    roll_min: float = angle(
        -45.0 * DEG, "pen against hub; 41 at home, and the workspace needs 67 to either side", least=-180.0 * DEG
    )
    roll_max: float = angle(130.0 * DEG, "pen against hub", most=180.0 * DEG)

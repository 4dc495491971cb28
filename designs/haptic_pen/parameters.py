"""The numbers of the haptic pen, each with its unit, its letter and its reason; the paper's tables as constants."""

from __future__ import annotations

from dataclasses import dataclass

from ..chains.hinged_five_bar import FiveBarLinks
from ..language.parameters import length, number
from ..language.units import CM


@dataclass(frozen=True, slots=True, kw_only=True)
class HapticPenParameters:
    """The kinematic dimensions (Table VII: the 25 cm design)."""

    shoulder_half_spacing: float = length(
        2.4 * CM, "waist point to either shoulder; the paper's least value leaves room for the motors", symbol="l_1"
    )
    upper_arm_length: float = length(17.0 * CM, "shoulder to elbow", symbol="l_2")
    forearm_length: float = length(23.0 * CM, "elbow to tip; above l_1 + l_2 no forearms in line", symbol="l_3")
    waist_half_spacing: float = length(8.0 * CM, "centre of the base to either waist axis", symbol="l_4")
    pen_half_length: float = length(7.0 * CM, "middle of the pen to either tip; held by a hand", symbol="l_6")
    home_distance: float = length(25.0 * CM, "base to the centre of the workspace", symbol="k_0")
    waist_scale: float = number(1.6, "", "torque of a waist motor against a shoulder motor", symbol="Q_1", above=0.0)

    @property
    def links(self) -> FiveBarLinks:
        """Lengths of both five-bars [mm]."""
        return FiveBarLinks(self.shoulder_half_spacing, self.upper_arm_length, self.forearm_length)


#: Table VII: the optimum at 25 cm; global isotropy index 0.234.
STOCCO_TABLE_7 = HapticPenParameters()

#: Table VIII: optima by workspace distance (15, 20, 25, 30 cm); global isotropy indices beside them.
STOCCO_TABLE_8 = tuple(
    HapticPenParameters(
        home_distance=k0 * CM,
        shoulder_half_spacing=l1 * CM,
        upper_arm_length=l2 * CM,
        forearm_length=l3 * CM,
        waist_scale=q1,
    )
    for k0, l1, l2, l3, q1 in (
        (15.0, 2.4, 13.0, 16.0, 1.6),
        (20.0, 2.4, 14.5, 20.0, 1.7),
        (25.0, 2.4, 17.0, 23.0, 1.6),
        (30.0, 3.6, 19.5, 27.0, 1.6),
    )
)
STOCCO_TABLE_8_GII = (0.089, 0.182, 0.234, 0.262)

#: Table IX: ratio of waist to shoulder resolution R_w/R_s, and the velocity index, for the designs of Table VIII.
STOCCO_TABLE_9 = ((1.63, 0.105), (1.67, 0.186), (1.63, 0.232), (1.64, 0.269))

#: The prototype of Table X. The paper states none of its lengths: these give every row of spatial resolution, but so do
#: others (l_2, l_3 lie on a curve); l_6 = 8.2 cm follows from the rows alone.
STOCCO_TABLE_10 = HapticPenParameters(
    upper_arm_length=15.0 * CM,
    forearm_length=19.75 * CM,
    waist_half_spacing=8.2 * CM,
    pen_half_length=8.2 * CM,
    home_distance=20.0 * CM,
    waist_scale=1.7,
)

#: S_T of the 5-DOF device by force and torque of the hand (eq. 19 without j), [-, -, -, cm, cm], in pen axes.
STOCCO_HAND_FORCE = (1.0, 1.0, 1.5, 3.6, 3.9)


@dataclass(frozen=True, slots=True, kw_only=True)
class HapticPenForward:
    """What the forward kinematics takes for one pose: six motors tell five coordinates."""

    closure_tolerance: float = length(
        1e-6,
        "largest misfit of the tips' distance to the pen that still counts as closed; raise it for encoder angles",
    )

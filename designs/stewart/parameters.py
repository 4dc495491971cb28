"""The numbers of the paired Stewart platform, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, length, number
from ..language.units import CM, DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class StewartParameters:
    """The kinematic dimensions: Table IV, with room at the corners of the base and at the platform's points."""

    pair_half_spacing: float = length(
        7.0 * CM, "middle of a pair to either leg; Table IV's 10 cm run the gimbals into each other", symbol="l_1"
    )
    base_single_radius: float = length(6.0 * CM, "base to the middle of pair 1", symbol="l_4")
    base_pair_radius: float = length(6.0 * CM, "base to the middles of pairs 2 and 3", symbol="l_5")
    platform_single_radius: float = length(3.0 * CM, "platform to the point of pair 1", symbol="l_6")
    platform_pair_radius: float = length(4.0 * CM, "platform to the points of pairs 2 and 3", symbol="l_7")
    base_angle: float = angle(120.0 * DEG, "pair 1 to pairs 2 and 3", symbol="eta_1", least=5.0 * DEG, most=175.0 * DEG)
    platform_angle: float = angle(
        170.0 * DEG, "the same on the platform", symbol="eta_2", least=5.0 * DEG, most=179.0 * DEG
    )
    ball_offset: float = length(
        18.0,
        "plane of a pair to its ball: two legs and a ball do not fit into one point; 0 in the paper",
        symbol="x_T",
        least=0.0,
    )
    socket_cant: float = angle(
        40.0 * DEG, "socket's axis from the plane's normal towards the legs' tip", least=0.0, most=90.0 * DEG
    )
    home_distance: float = length(25.0 * CM, "base to the centre of the workspace", symbol="k_0")
    near_scale: float = number(0.5, "", "force of the legs of pairs 2, 3 next to pair 1", symbol="Q_1", above=0.0)
    far_scale: float = number(0.9, "", "force of their other legs", symbol="Q_2", above=0.0)


#: Table IV: the optimum of the comparison; global isotropy index 0.096. Two legs and a ball share each platform point.
STOCCO_TABLE_4 = StewartParameters(pair_half_spacing=10.0 * CM, ball_offset=0.0)
STOCCO_TABLE_4_GII = 0.096

#: S_T (eq. 19) by force and torque of the hand, [-, -, -, cm, cm, cm], in platform axes.
STOCCO_HAND_FORCE = (1.0, 1.0, 1.5, 3.6, 0.5, 3.9)


@dataclass(frozen=True, slots=True, kw_only=True)
class StewartLimits:
    """The declared joint limits."""

    length_min: float = length(220.0, "shortest leg: a one-piece stage of 95 mm stroke does not reach lower")
    length_max: float = length(315.0, "longest leg")
    waist_max: float = angle(40.0 * DEG, "plane of a pair to either side", least=0.0, most=90.0 * DEG)
    stage_max: float = angle(45.0 * DEG, "leg in its plane, from square to the hinge", least=0.0, most=90.0 * DEG)
    scissor_min: float = angle(15.0 * DEG, "between the legs of a pair", least=0.0, most=180.0 * DEG)
    scissor_max: float = angle(65.0 * DEG, "between the legs of a pair", least=0.0, most=180.0 * DEG)
    cone_max: float = angle(60.0 * DEG, "half angle of a ball joint's cone", least=0.0, most=90.0 * DEG)


#: Limits under which the whole grid of the paper is served (its actuators have no stated stroke there).
WIDE_LIMITS = StewartLimits(
    length_min=100.0,
    length_max=500.0,
    waist_max=85.0 * DEG,
    stage_max=85.0 * DEG,
    scissor_min=1.0 * DEG,
    scissor_max=120.0 * DEG,
    cone_max=90.0 * DEG,
)

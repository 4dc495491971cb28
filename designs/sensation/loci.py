"""Where SenSation is singular, as curves of the tip."""

from __future__ import annotations

from ..chains.dyad_pair import direct_locus_opposed, direct_locus_parallel, inverse_locus
from ..language.vocabulary import Number, Require
from .parameters import SensationParameters


def stretched_locus(p: SensationParameters, side: float, angle: Number) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with the right (+1) or left (-1) arm stretched and its parallelogram flat, by its angle [rad].

    With equal links the folded arm has its tip on its motor axis, a point and no curve.
    """
    return inverse_locus(side, p.arm_length + p.tip_link_length, p.pivot_distance, angle)


def parallel_arms_locus(p: SensationParameters, sheet: float, angle: Number) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with both arms in one direction [rad]: theta_3 = theta_1 = angle.

    Two circles of radius l_1 about (0, +-sqrt(l_4^2 - d^2/4)). With the elbows out and the tip above 30 mm only the
    arc from 60 to 120 degrees of the upper one occurs, close to the boundary.
    """
    return direct_locus_parallel(p.arm_length, p.tip_link_length, p.pivot_distance, sheet, angle)


def opposed_arms_locus(p: SensationParameters, sheet: float, angle: Number, require: Require) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with the arms in opposite directions: theta_3 = theta_1 + 180 degrees, theta_1 = angle [rad]."""
    return direct_locus_opposed(p.arm_length, p.tip_link_length, p.pivot_distance, sheet, angle, require)

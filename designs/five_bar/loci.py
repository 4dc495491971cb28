"""Where the five-bar is singular, as curves of the tip."""

from __future__ import annotations

from ..chains.dyad_pair import direct_locus_opposed, direct_locus_parallel, inverse_locus
from ..language.vocabulary import Number, Require
from .parameters import FiveBarParameters


def stretched_locus(p: FiveBarParameters, side: float, angle: Number) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with the right (+1) or left (-1) arm stretched, by its angle [rad]."""
    return inverse_locus(side, p.arm_length + p.tip_link_length, p.pivot_distance, angle)


def parallel_tip_links_locus(p: FiveBarParameters, sheet: float, angle: Number) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with both tip links in one direction [rad], one on the other: the elbows coincide."""
    return direct_locus_parallel(p.tip_link_length, p.arm_length, p.pivot_distance, sheet, angle)


def opposed_tip_links_locus(
    p: FiveBarParameters, sheet: float, angle: Number, require: Require
) -> tuple[Number, Number]:
    """Tips (x, y) [mm] with the tip links in one line: theta_4 = theta_2 + 180 degrees, theta_2 = angle [rad]."""
    return direct_locus_opposed(p.tip_link_length, p.arm_length, p.pivot_distance, sheet, angle, require)

"""The dyad: two links from a pivot to a tip in a plane. Angles run from the first axis towards the second."""

from __future__ import annotations

from typing import NamedTuple

from ..language.vocabulary import Number, Require, acos, atan2, cos, fabs, hypot, sin

#: Least distance [mm] from stretched and folded at which an arm still counts as reachable.
REACH_MARGIN = 1e-6


class DyadAngles(NamedTuple):
    """Directions of an arm's links [rad]: pivot to elbow, elbow to tip."""

    pivot: Number
    tip: Number


def solve_dyad(
    x: Number, y: Number, pivot_length: Number, tip_length: Number, side: float, require: Require
) -> DyadAngles:
    """Link directions of one arm whose tip is at (x, y) from its pivot [mm].

    Args:
        x, y: tip as seen from the pivot [mm].
        pivot_length, tip_length: link lengths [mm].
        side: +1 with the elbow left of the line from pivot to tip, -1 right of it.
        require: told "stretched" and "folded" [mm].

    Source: Chung, Choo, Lee, eqs. (5)-(10). Printed: beta_1 = 2 P_y l_4, and half tangents that fail for
    gamma = alpha. Used: beta_1 = -2 P_y l_4, as the law of cosines, which has no such hole.
    Shown by: tests/papers/test_chung_sensation.py.
    """
    d, gamma = hypot(x, y), atan2(y, x)
    require(pivot_length + tip_length - d - REACH_MARGIN, "stretched")
    require(d - fabs(pivot_length - tip_length) - REACH_MARGIN, "folded")
    at_pivot = acos((d * d + pivot_length * pivot_length - tip_length * tip_length) / (2.0 * d * pivot_length))
    at_tip = acos((d * d + tip_length * tip_length - pivot_length * pivot_length) / (2.0 * d * tip_length))
    return DyadAngles(gamma + side * at_pivot, gamma - side * at_tip)


def rate_row(free: Number, driven: Number, driven_length: Number) -> tuple[Number, Number]:
    """Row (x, y) of the inverse Jacobian: rate of a driven link = row . velocity of the tip.

    The tip's velocity along the free link comes from the driven link alone.

    Args:
        free, driven: directions of the arm's two links [rad].
        driven_length: length of the driven one [mm].

    Source: Chung, Choo, Lee, eqs. (13)-(16); S_{i-j} there is sin(theta_i - theta_j).
    """
    lever = 1.0 / (driven_length * sin(free - driven))
    return cos(free) * lever, sin(free) * lever

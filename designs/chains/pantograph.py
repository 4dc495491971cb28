"""The pantograph as a kite D-E-F-H: two lower links from one point D, two upper links that meet in F.

Angles are measured in the plane from +y towards +z. With equal links the kite is a rhombus, and the nine-bar chain
whose top bar only translates (frame width and top bar width equal) has the same kinematics.
"""

from __future__ import annotations

from typing import NamedTuple

from ..language.vocabulary import Number, Require, acos, asin, atan2, cos, fabs, hypot, sin, sqrt

#: Least distance [mm] from the folded and the stretched pose at which the chain still counts as reachable.
REACH_MARGIN = 1e-6


class KiteAngles(NamedTuple):
    """Directions of the four links [rad]: lower left (D to E), lower right (D to H), E to F, H to F."""

    lower_left: Number
    lower_right: Number
    upper_left: Number
    upper_right: Number


def solve_kite(y: Number, w: Number, lower: Number, upper: Number, elbow: float, require: Require) -> KiteAngles:
    """Link directions for the tip F at (y, w) from D [mm].

    Args:
        y, w: tip in the plane, sideways and upwards [mm].
        lower, upper: link lengths L2, L3 [mm].
        elbow: +1 with E on the left (+ side of DF), -1 with the elbows exchanged.
        require: told "stretched" (L2 + L3 - d) and "folded" (d - |L2 - L3|).

    Source: Zhang et al., eqs. (8)-(11). Printed: (8) with y' in the root, (9) without arccos and with L1, L2 for
    L2, L3, (10) with a minus. Used: cosine law in triangle D-E-F. Shown by: tests/papers/test_zhang_hit.py.
    """
    d, gamma = hypot(w, y), atan2(w, y)
    require(lower + upper - d - REACH_MARGIN, "stretched")
    require(d - fabs(lower - upper) - REACH_MARGIN, "folded")
    kappa = elbow * acos((d * d + lower * lower - upper * upper) / (2.0 * d * lower))
    mu = elbow * acos((d * d + upper * upper - lower * lower) / (2.0 * d * upper))
    return KiteAngles(gamma + kappa, gamma - kappa, gamma - mu, gamma + mu)


def locate_kite_tip(
    lower_left: Number, lower_right: Number, lower: Number, upper: Number, require: Require
) -> tuple[Number, Number, KiteAngles]:
    """Tip (y, w) [mm] and all link directions from the two driven directions [rad]; the tip lies beyond the elbows.

    Told "closed": L3 - |half the distance of the elbows|, the upper links must reach each other.
    """
    middle, half = 0.5 * (lower_left + lower_right), 0.5 * (lower_left - lower_right)
    across = lower * sin(half)
    require(upper - fabs(across) - REACH_MARGIN, "closed")
    d = lower * cos(half) + sqrt(upper * upper - across * across)
    bend = asin(across / upper)
    return d * cos(middle), d * sin(middle), KiteAngles(lower_left, lower_right, middle - bend, middle + bend)

"""Two arms of two links each, from two pivots to one tip: the planar five-bar, however it is driven.

Angles are measured from +x towards +y. An arm has a link at the pivot and a link at the tip; if the pivot links are
driven this is the plain five-bar, if the tip links are driven (through parallelograms) it is the SenSation. In both
the driven links place two points, and two free links of known length meet in the tip.

Source: Chung, Choo, Lee, eqs. (3)-(17); a link's free partner exchanges the roles of the two (see `direct_locus_*`).
"""

from __future__ import annotations

from ..language.vocabulary import Number, Require, cos, fabs, fmax, hypot, sin, sqrt
from .dyad import REACH_MARGIN

#: Postures by the elbows' side (first arm on the right, second on the left): +1 left of the line from pivot to tip.
POSTURES: dict[str, tuple[float, float]] = {
    "out": (-1.0, 1.0),
    "in": (1.0, -1.0),
    "left": (1.0, 1.0),
    "right": (-1.0, -1.0),
}


def meet_circles(
    first: tuple[Number, Number],
    second: tuple[Number, Number],
    first_radius: Number,
    second_radius: Number,
    side: float,
    require: Require,
) -> tuple[Number, Number]:
    """The point (x, y) [mm] at given distances from two points, on one side of their line.

    Args:
        first, second: the points (x, y) [mm].
        first_radius, second_radius: the distances [mm].
        side: +1 left of the line from first to second, -1 right of it: the two assembly modes.
        require: told "apart" and "inside" [mm].
    """
    dx, dy = second[0] - first[0], second[1] - first[1]
    d = hypot(dx, dy)
    require(first_radius + second_radius - d, "apart")
    require(d - fabs(first_radius - second_radius) - REACH_MARGIN, "inside")
    # Where the points coincide there is no answer; the margin says so, and the numbers stay finite.
    d = fmax(d, REACH_MARGIN)
    along = (d * d + first_radius * first_radius - second_radius * second_radius) / (2.0 * d)
    across = side * sqrt(first_radius * first_radius - along * along)
    return first[0] + (dx * along - dy * across) / d, first[1] + (dy * along + dx * across) / d


def inverse_locus(side: float, reach: Number, pivot_distance: Number, angle: Number) -> tuple[Number, Number]:
    """Points (x, y) [mm] where an arm is stretched or folded (inverse singularity).

    Args:
        side: +1 for the arm on the right (pivot at x = +d/2), -1 for the left one.
        reach: sum of its links, or their difference [mm].
        pivot_distance: d [mm].
        angle: direction from the pivot [rad].

    Source: Chung, Choo, Lee, eq. (17).
    """
    return 0.5 * side * pivot_distance + reach * cos(angle), reach * sin(angle)


def direct_locus_parallel(
    free: Number, driven: Number, pivot_distance: Number, sheet: float, angle: Number
) -> tuple[Number, Number]:
    """Points (x, y) [mm] where both free links lie in one direction (direct singularity, first kind).

    With equal links on both sides the two driven links then end in one point of the middle line, so the tip runs on a
    circle about that point.

    Args:
        free, driven: lengths of the free and the driven links, equal on both sides [mm].
        pivot_distance: d [mm], below 2 driven.
        sheet: +1 for the circle above the pivots, -1 below.
        angle: direction of both free links towards the tip [rad].

    Source: Chung, Choo, Lee, eq. (16), made explicit here.
    """
    return free * cos(angle), sheet * sqrt(driven * driven - 0.25 * pivot_distance * pivot_distance) + free * sin(angle)


def direct_locus_opposed(
    free: Number, driven: Number, pivot_distance: Number, sheet: float, angle: Number, require: Require
) -> tuple[Number, Number]:
    """Points (x, y) [mm] where the free links lie in opposite directions (direct singularity, second kind).

    Args:
        free, driven: lengths of the free and the driven links, equal on both sides [mm].
        pivot_distance: d [mm].
        sheet: +1 or -1, the side of the line that the point lies on.
        angle: direction of the right arm's free link towards the tip [rad].
        require: told "closed" [mm2]: outside, no such posture exists at this angle.

    Source: Chung, Choo, Lee, eq. (16), made explicit here.
    """
    # Half of the isosceles triangle's base, whose sides are the driven links and whose apex is the tip.
    base_x, base_y = 0.5 * pivot_distance + free * cos(angle), free * sin(angle)
    half = hypot(base_x, base_y)
    require(driven * driven - half * half, "closed")
    height = sheet * sqrt(driven * driven - half * half)
    return -height * base_y / half, height * base_x / half

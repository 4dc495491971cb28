"""How far the bar may lean before it meets the rim: the formula, and where it claims too much."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .dimensions import SphericalJointDimensions

#: Below this the formula and a condition are the same to the eye of a gauge [rad].
_SLACK = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class FormulaWarning:
    """A condition under which the joint leans less than the formula says.

    Attributes:
        name: of the condition ("countersink too narrow").
        field: key of the design file that cures it.
        allows: half angle at which this condition stops the bar, never more than the true one [rad].
        needed: what would be right, in words.
    """

    name: str
    field: str
    allows: float
    needed: str


def cone_half_angle(d: SphericalJointDimensions) -> float:
    """Half angle r of the cone that the bar may fill when the rim's edge stops its root [rad].

    The edge lies at the polar angle arctan(p / (2 (a - t))) and the distance rho_e; the root's surface at that
    distance is arcsin((d / 2) / rho_e) away from the bar's axis.

    Printed: d / h with the root's diameter d and h left open. Used: the root's radius, h = sqrt(rho_e^2 - d^2 / 4).
    Shown by: tests/analysis/test_cone_angle.py, on the solids.

    Source: Zhang et al., eqs. (1)-(2), corrected (S1).
    """
    return _edge_stop(d.rim_diameter / 2.0, d.rim_height, d.root_diameter / 2.0)


def _edge_stop(radius: float, height: float, root: float) -> float:
    """Lean at which a cylinder of radius `root` through the centre touches a circular edge of the socket [rad]."""
    return math.atan2(radius, height) - math.asin(min(1.0, root / math.hypot(radius, height)))


def bar_polar_angle(d: SphericalJointDimensions, distance: float) -> float:
    """Angle between the bar's axis and its surface at a distance from the ball's centre, on fillet or root [rad].

    The fillet is an arc of radius f about (q + f, z_f), which touches the ball and the root of radius q.
    """
    q, f = d.root_diameter / 2.0, d.root_fillet
    centre = d.ball_radius + f
    end = math.hypot(q, math.sqrt(centre**2 - (q + f) ** 2))
    if f == 0.0 or distance >= end:
        return math.asin(q / distance)
    between = math.acos((centre**2 + distance**2 - f**2) / (2.0 * centre * distance))
    return math.asin((q + f) / centre) - between


def formula_warnings(d: SphericalJointDimensions) -> tuple[FormulaWarning, ...]:
    """The conditions in which `cone_half_angle` claims more than the solids allow; empty if it holds.

    Each says at which angle it stops the bar. For edges that is exact; for the shoulder the cover's face is taken as
    a plane without opening, which may understate the angle where the shoulder reaches into the countersink.
    """
    r = cone_half_angle(d)
    conditions = (_countersink(d, r), _fillet(d), _ring_edge(d, r), _land_edge(d), _shoulder(d, r))
    return tuple(c for c in conditions if c.allows < r - _SLACK)


def _countersink(d: SphericalJointDimensions, r: float) -> FormulaWarning:
    stop = _edge_stop(d.mouth_radius, d.cover_face, d.root_diameter / 2.0)
    name = "plain hole instead of a countersink" if d.countersink_angle == 0.0 else "countersink too narrow"
    return FormulaWarning(
        name=name,
        field="countersink_angle_deg",
        allows=stop,
        needed=f"an included angle of at least {math.degrees(2.0 * r):.1f} deg",
    )


def _fillet(d: SphericalJointDimensions) -> FormulaWarning:
    rim = math.hypot(d.rim_diameter / 2.0, d.rim_height)
    stop = math.atan2(d.rim_diameter / 2.0, d.rim_height) - bar_polar_angle(d, rim)
    return FormulaWarning(
        name="root fillet reaches the rim",
        field="root_fillet_mm",
        allows=stop,
        needed=f"a fillet that ends {rim - d.ball_radius:.3f} mm off the ball",
    )


def _ring_edge(d: SphericalJointDimensions, r: float) -> FormulaWarning:
    reach = bar_polar_angle(d, d.seat_radius)
    return FormulaWarning(
        name="edge of the upper ring too high",
        field="land_mm",
        allows=d.upper_ring_mouth - reach,
        needed=f"a seat that ends at a polar angle of at least {math.degrees(r + reach):.1f} deg: "
        "a thicker land or a deeper cover",
    )


def _land_edge(d: SphericalJointDimensions) -> FormulaWarning:
    edge = math.hypot(d.rim_diameter / 2.0, d.cover_inner_face)
    stop = math.atan2(d.rim_diameter / 2.0, d.cover_inner_face) - bar_polar_angle(d, edge)
    return FormulaWarning(
        name="root fillet reaches the land", field="root_fillet_mm", allows=stop, needed="a smaller fillet"
    )


def _shoulder(d: SphericalJointDimensions, r: float) -> FormulaWarning:
    R, c, h, a = d.stem_diameter / 2.0, d.shoulder_chamfer, d.shoulder_height, d.cover_face
    corners = ((R - c, h), (R, h + c))
    stop = min(math.acos(min(1.0, a / math.hypot(x, z))) - math.atan2(x, z) for x, z in corners)
    least = max((a + x * math.sin(r)) / math.cos(r) - (z - h) for x, z in corners)
    return FormulaWarning(
        name="shoulder too near",
        field="shoulder_height_mm",
        allows=stop,
        needed=f"a shoulder at {least:.2f} mm or more",
    )

"""The numbers of a wide ball joint, the heights that follow from them, and the sets that cannot be made.

Section through the axis, origin at the ball's centre, +z out of the opening (figure in docs of the HIT device):

    shell cover    outer face z = a, countersink down to the rim (diameter p) at a - t, land down to the inner face
    upper ring     from the cover's inner face down to `upper_ring_foot`, spherical seat
    lower ring     from `lower_ring_mouth` down to `lower_ring_foot`, spherical seat
    shim           under the lower ring: its thickness sets the running clearance
    bushing        holds all of them; tapped from behind for the screw that mounts the socket
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...language.errors import ParameterError
from ...language.parameters import angle, choice, count, length
from ...language.supplies import Screw, ScrewKind, names, screw
from ...language.units import DEG

_COUNTERSUNK = tuple(name for name in names("screws") if screw(name).kind is ScrewKind.COUNTERSUNK)

#: Thinnest wall that is turned or drilled without breaking out [mm].
LEAST_WALL = 0.4


@dataclass(frozen=True, slots=True, kw_only=True)
class SphericalJointDimensions:
    """Ball-bar and socket; the defaults are the set with a ball of 16 mm."""

    ball_diameter: float = length(16.0, "a standard ball's size: gauges and laps for it exist", symbol="2 R_b")
    root_diameter: float = length(
        3.5, "where the bar leaves the ball: thin for a wide cone, 100 MPa in bending at 30 N", symbol="d"
    )
    root_fillet: float = length(0.4, "radius between ball and root; above 0.4 it costs cone", least=0.0)
    shoulder_height: float = length(
        14.0, "ball's centre to the thick part of the bar: must pass over the cover's face", symbol="h_s"
    )
    shoulder_chamfer: float = length(0.5, "chamfer on that shoulder, 45 degrees", least=0.0)
    stem_diameter: float = length(8.0, "thick part of the bar: seat on the top bar around the M5 stud")
    stem_length: float = length(
        22.0, "ball's centre to the seat on the top bar: its pins lie 30 below the centre, its eyes are 16 wide"
    )
    tommy_hole: float = length(2.5, "cross hole in the stem for the pin that tightens the stud; 0 for none", least=0.0)
    stud_diameter: float = length(5.0, "thread that holds the bar, M5")
    stud_length: float = length(10.0, "of that thread: twice its diameter, for aluminium")
    cover_diameter: float = length(34.0, "outside of cover and bushing: leaves 0.4 mm around the countersinks")
    cover_face: float = length(4.2, "ball's centre to the cover's outer face", symbol="a")
    cover_thickness: float = length(3.3, "cover outside of the rings: the countersunk heads and 1 mm under them")
    rim_diameter: float = length(
        15.5, "narrowest edge of the opening: smaller than the ball, so it catches it", symbol="p"
    )
    land: float = length(0.7, "height of the cylinder below that edge: a sharp edge would chip")
    countersink_depth: float = length(1.0, "outer face down to the narrowest edge", symbol="t")
    countersink_angle: float = angle(
        120.0 * DEG, "included; half of it must not be below the cone's half angle", least=0.0, most=170.0 * DEG
    )
    seat_clearance: float = length(0.02, "seat's radius less the ball's: grease film, set by the shim")
    ring_outer: float = length(22.0, "outside of both rings and bore of the bushing, H7/h6: wall of 3 mm")
    upper_ring_foot: float = angle(
        88.0 * DEG, "polar angle where the upper seat ends", least=45.0 * DEG, most=89.9 * DEG
    )
    lower_ring_mouth: float = angle(
        92.0 * DEG, "polar angle where the lower seat begins", least=90.1 * DEG, most=135.0 * DEG
    )
    lower_ring_foot: float = angle(
        140.0 * DEG, "polar angle where the lower seat ends", least=100.0 * DEG, most=170.0 * DEG
    )
    shim_thickness: float = length(0.5, "nominal; made up in steps of 0.05 until the ball runs without play")
    grease_pocket: float = length(1.0, "room under the ball")
    floor: float = length(7.5, "bushing below that room: the mounting thread and 1.5 mm above it")
    mount_diameter: float = length(6.0, "thread from behind, M6: one central screw, for the joint needs no direction")
    mount_depth: float = length(6.0, "of that thread: its diameter")
    n_screws: int = count(4, "screws that hold the cover", least=3, most=12)
    screw_circle: float = length(27.5, "their circle: equal walls to the bore and to the outside")
    screw: str = choice("ISO10642-M2.5", "countersunk, so that nothing stands out of the cover's face", _COUNTERSUNK)
    screw_length: float = length(8.0, "of those: reaches 4.7 into the bushing, 1.9 times its thread")
    screw_depth: float = length(6.0, "threaded hole in the bushing: the screw does not reach its bottom")

    @property
    def screw_row(self) -> Screw:
        """The cover's screw with its true dimensions."""
        return screw(self.screw)

    @property
    def ball_radius(self) -> float:
        """R_b [mm]."""
        return self.ball_diameter / 2.0

    @property
    def seat_radius(self) -> float:
        """Radius of both spherical seats [mm]."""
        return self.ball_radius + self.seat_clearance

    @property
    def rim_height(self) -> float:
        """Ball's centre to the narrowest edge: a - t [mm]."""
        return self.cover_face - self.countersink_depth

    @property
    def cover_inner_face(self) -> float:
        """Ball's centre to the face that lies on the upper ring [mm]."""
        return self.rim_height - self.land

    @property
    def mouth_radius(self) -> float:
        """Radius of the countersink at the outer face [mm]."""
        return self.rim_diameter / 2.0 + self.countersink_depth * math.tan(self.countersink_angle / 2.0)

    @property
    def upper_ring_mouth(self) -> float:
        """Polar angle of the upper seat's edge, where it meets the ring's top face [rad]."""
        return math.acos(self.cover_inner_face / self.seat_radius)

    @property
    def bushing_top(self) -> float:
        """Height of the face on which the cover lies [mm]."""
        return self.cover_face - self.cover_thickness

    @property
    def upper_ring_bottom(self) -> float:
        """Height of the upper ring's lower face [mm]."""
        return self.seat_radius * math.cos(self.upper_ring_foot)

    @property
    def lower_ring_top(self) -> float:
        """Height of the lower ring's upper face [mm]."""
        return self.seat_radius * math.cos(self.lower_ring_mouth)

    @property
    def lower_ring_bottom(self) -> float:
        """Height of the lower ring's lower face, on the shim [mm]."""
        return self.seat_radius * math.cos(self.lower_ring_foot)

    @property
    def pocket_radius(self) -> float:
        """Opening of the lower ring, of the shim and of the room below [mm]."""
        return self.seat_radius * math.sin(self.lower_ring_foot)

    @property
    def pocket_bottom(self) -> float:
        """Height of the bottom of the room under the ball [mm]."""
        return -self.ball_radius - self.grease_pocket

    @property
    def back(self) -> float:
        """Height of the bushing's flat back, where the socket is mounted; negative [mm]."""
        return self.pocket_bottom - self.floor


#: Zhang et al. print no dimensions; this set gives a cone half angle of 55.52 degrees (S1).
SOCKET_16 = SphericalJointDimensions()

#: A larger ball for higher loads: 0.60 instead of 0.25 mm of catch on each side of the rim, 55.66 degrees by S1.
SOCKET_20 = SphericalJointDimensions(
    ball_diameter=20.0,
    root_diameter=4.0,
    rim_diameter=18.8,
    cover_face=5.0,
    land=0.5,
    root_fillet=0.25,
    shoulder_height=15.0,
    cover_diameter=38.0,
    ring_outer=26.0,
    screw_circle=31.5,
)


def check_dimensions(d: SphericalJointDimensions) -> None:
    """Refuse sets whose parts cannot be made, cannot be put together, or do not hold the ball.

    Raises:
        ParameterError: names the key of the design file, its value and what would be right.
    """
    if d.ball_diameter <= d.rim_diameter:
        raise ParameterError(
            "ball_diameter_mm",
            d.ball_diameter,
            f"ball smaller than the opening: must be above rim_diameter_mm = {d.rim_diameter:g}, "
            "else the ball falls out",
        )
    _check_bar(d)
    _check_rim(d)
    _check_rings(d)
    _check_walls(d)


def _refuse(wrong: bool, field: str, value: float, allowed: str) -> None:
    if wrong:
        raise ParameterError(field, value, allowed)


def _check_bar(d: SphericalJointDimensions) -> None:
    _refuse(
        d.root_diameter >= d.ball_diameter,
        "root_diameter_mm",
        d.root_diameter,
        f"must be below ball_diameter_mm = {d.ball_diameter:g}",
    )
    _refuse(
        d.stem_diameter - 2.0 * d.shoulder_chamfer < d.root_diameter,
        "stem_diameter_mm",
        d.stem_diameter,
        f"must be at least root_diameter_mm plus two chamfers = {d.root_diameter + 2.0 * d.shoulder_chamfer:g}",
    )
    fillet_end = math.sqrt((d.ball_radius + d.root_fillet) ** 2 - (d.root_diameter / 2.0 + d.root_fillet) ** 2)
    _refuse(
        d.shoulder_height <= fillet_end,
        "shoulder_height_mm",
        d.shoulder_height,
        f"must be above {fillet_end:.3f}, where the root's fillet ends",
    )
    least = d.shoulder_height + d.shoulder_chamfer + d.tommy_hole + (1.0 if d.tommy_hole else 0.0)
    _refuse(
        d.stem_length <= least,
        "stem_length_mm",
        d.stem_length,
        f"must be above {least:g}: shoulder, chamfer and tommy hole",
    )
    _refuse(
        d.stud_diameter >= d.stem_diameter,
        "stud_diameter_mm",
        d.stud_diameter,
        f"must be below stem_diameter_mm = {d.stem_diameter:g}, which is its seat",
    )
    _refuse(
        d.tommy_hole > d.stem_diameter / 2.0,
        "tommy_hole_mm",
        d.tommy_hole,
        f"must be at most half of stem_diameter_mm = {d.stem_diameter:g}",
    )


def _check_rim(d: SphericalJointDimensions) -> None:
    _refuse(
        d.cover_inner_face <= 0.0,
        "cover_face_mm",
        d.cover_face,
        f"wall below zero: must be above countersink_depth_mm plus land_mm = {d.countersink_depth + d.land:g}, "
        "or the cover reaches below the ball's centre",
    )
    gap = math.hypot(d.rim_diameter / 2.0, d.cover_inner_face) - d.ball_radius
    _refuse(
        gap <= d.seat_clearance,
        "rim_diameter_mm",
        d.rim_diameter,
        f"must be above {2.0 * math.sqrt(max(d.seat_radius**2 - d.cover_inner_face**2, 0.0)):.3f}, "
        "or its land rubs on the ball",
    )
    _refuse(
        d.cover_thickness < d.countersink_depth + d.land,
        "cover_thickness_mm",
        d.cover_thickness,
        f"must be at least countersink_depth_mm plus land_mm = {d.countersink_depth + d.land:g}",
    )
    cone = (d.screw_row.countersink_diameter - d.screw_row.clearance_hole) / 2.0
    _refuse(
        d.cover_thickness < cone + LEAST_WALL,
        "cover_thickness_mm",
        d.cover_thickness,
        f"must be at least {cone + LEAST_WALL:g}, or the countersunk heads break through",
    )


def _check_rings(d: SphericalJointDimensions) -> None:
    wall = d.ring_outer / 2.0 - d.seat_radius
    _refuse(
        wall < 2.0 * LEAST_WALL,
        "ring_outer_mm",
        d.ring_outer,
        f"must be at least {2.0 * (d.seat_radius + 2.0 * LEAST_WALL):g}, or the rings' wall is {wall:.3f} mm",
    )
    _refuse(
        d.cover_inner_face - d.upper_ring_bottom < LEAST_WALL,
        "upper_ring_foot_deg",
        math.degrees(d.upper_ring_foot),
        "too small: the upper ring would be "
        f"{d.cover_inner_face - d.upper_ring_bottom:.3f} mm high, least {LEAST_WALL:g}",
    )
    _refuse(
        d.lower_ring_foot <= d.lower_ring_mouth,
        "lower_ring_foot_deg",
        math.degrees(d.lower_ring_foot),
        f"must be above lower_ring_mouth_deg = {math.degrees(d.lower_ring_mouth):g}",
    )
    _refuse(
        d.pocket_bottom >= d.lower_ring_bottom - d.shim_thickness - LEAST_WALL,
        "grease_pocket_mm",
        d.grease_pocket,
        "too small: the shim's seat would lie below the room under the ball",
    )
    _refuse(
        d.bushing_top <= d.lower_ring_top,
        "cover_thickness_mm",
        d.cover_thickness,
        f"must be below {d.cover_face - d.lower_ring_top:.3f}, or the cover reaches down to the lower ring",
    )


def _check_walls(d: SphericalJointDimensions) -> None:
    row = d.screw_row
    inner = d.ring_outer + row.clearance_hole + 2.0 * LEAST_WALL
    outer = d.cover_diameter - row.countersink_diameter - 2.0 * LEAST_WALL
    _refuse(
        not inner <= d.screw_circle <= outer,
        "screw_circle_mm",
        d.screw_circle,
        f"must be within {inner:g} and {outer:g}: walls to the rings and to the outside",
    )
    mouth = d.screw_circle - row.countersink_diameter - 2.0 * LEAST_WALL
    _refuse(
        2.0 * d.mouth_radius > mouth,
        "countersink_depth_mm",
        d.countersink_depth,
        f"the countersink is {2.0 * d.mouth_radius:.3f} mm wide at the outer face; the screw heads allow {mouth:g}",
    )
    pitch = d.screw_circle * math.sin(math.pi / d.n_screws)
    _refuse(
        pitch < row.countersink_diameter + LEAST_WALL,
        "n_screws",
        d.n_screws,
        f"too many: they would be {pitch:.3f} mm apart and take {row.countersink_diameter:g} mm each",
    )
    _check_threads(d, row)


def _check_threads(d: SphericalJointDimensions, row: Screw) -> None:
    _refuse(
        d.screw_length not in row.lengths,
        "screw_length_mm",
        d.screw_length,
        "must be one of " + ", ".join(f"{known:g}" for known in row.lengths),
    )
    engaged = d.screw_length - d.cover_thickness
    _refuse(
        engaged < row.diameter,
        "screw_length_mm",
        d.screw_length,
        f"must be at least {d.cover_thickness + row.diameter:g}: cover and one diameter of thread",
    )
    deepest = d.bushing_top - d.back - LEAST_WALL
    _refuse(
        not engaged <= d.screw_depth <= deepest,
        "screw_depth_mm",
        d.screw_depth,
        f"must be within {engaged:g}, which the screw reaches, and {deepest:.3f}, or it comes out at the back",
    )
    _refuse(
        d.mount_depth > d.floor - LEAST_WALL,
        "mount_depth_mm",
        d.mount_depth,
        f"must be at most floor_mm less {LEAST_WALL:g} = {d.floor - LEAST_WALL:g}",
    )
    _refuse(
        d.mount_diameter > d.cover_diameter / 2.0,
        "mount_diameter_mm",
        d.mount_diameter,
        f"must be at most half of cover_diameter_mm = {d.cover_diameter:g}: the rest is the seat of the socket",
    )

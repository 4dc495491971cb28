"""The separate parts of a wide ball joint, each in the socket's frame: origin at the ball's centre, +z outwards."""

from __future__ import annotations

import math

from ...language.features import CrossHole, Hole, Turned, Vertex
from .dimensions import SphericalJointDimensions, check_dimensions

#: The bar's end of a tommy hole lies this far below the seat on the top bar [mm].
_TOMMY_MARGIN = 1.0


def _polar(radius: float, angle: float) -> tuple[float, float]:
    """(r, z) at a distance from the centre and an angle from +z; exactly on the axis at 0 and pi."""
    return (radius * math.sin(angle) if 0.0 < angle < math.pi else 0.0), radius * math.cos(angle)


def _ring(d: SphericalJointDimensions, mouth: float, foot: float) -> Turned:
    """A ring whose bore is the spherical seat between two polar angles and whose faces are flat."""
    R, outer = d.seat_radius, d.ring_outer / 2.0
    (r0, z0), (r1, z1) = _polar(R, mouth), _polar(R, foot)
    return Turned(
        profile=(
            Vertex(r=outer, z=z1),
            Vertex(r=outer, z=z0),
            Vertex(r=r0, z=z0),
            Vertex(r=r1, z=z1, mid=_polar(R, (mouth + foot) / 2.0)),
        )
    )


def ball_bar(d: SphericalJointDimensions) -> Turned:
    """Ball, thin root with its fillet, shoulder, stem, and the stud that goes into the top bar; +z along the bar."""
    check_dimensions(d)
    R, q, f, c = d.ball_radius, d.root_diameter / 2.0, d.root_fillet, d.shoulder_chamfer
    z_f = math.sqrt((R + f) ** 2 - (q + f) ** 2)
    touch = math.asin((q + f) / (R + f))
    profile = [
        Vertex(r=0.0, z=-R),
        Vertex(r=R * math.sin(touch), z=R * math.cos(touch), mid=_polar(R, (math.pi + touch) / 2.0)),
    ]
    if f > 0.0:
        # The arc turns from the direction of the ball's centre to that of the axis.
        toward = (-math.sin(touch) - 1.0, -math.cos(touch))
        scale = f / math.hypot(*toward)
        profile.append(Vertex(r=q, z=z_f, mid=(q + f + scale * toward[0], z_f + scale * toward[1])))
    stem, stud, end = d.stem_diameter / 2.0, d.stud_diameter / 2.0, d.stem_length + d.stud_length
    corners = [
        (q, d.shoulder_height),
        (stem - c, d.shoulder_height),
        (stem, d.shoulder_height + c),
        (stem, d.stem_length),
        (stud, d.stem_length),
        (stud, end),
        (0.0, end),
    ]
    profile += [Vertex(r=r, z=z) for r, z in _without_repeats(corners)]
    tommy: tuple[CrossHole, ...] = ()
    if d.tommy_hole:
        height = d.stem_length - d.tommy_hole / 2.0 - _TOMMY_MARGIN
        tommy = (
            CrossHole(
                origin=(-stem - 1.0, 0.0, height),
                direction=(1.0, 0.0, 0.0),
                diameter=d.tommy_hole,
                depth=2.0 * stem + 2.0,
            ),
        )
    return Turned(profile=tuple(profile), cross_holes=tommy)


def _without_repeats(corners: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Corners without those that a chamfer of zero leaves twice."""
    return [b for a, b in zip([None, *corners], corners, strict=False) if a != b]


def upper_ring(d: SphericalJointDimensions) -> Turned:
    """The ring that retains the ball, under the cover."""
    check_dimensions(d)
    return _ring(d, d.upper_ring_mouth, d.upper_ring_foot)


def lower_ring(d: SphericalJointDimensions) -> Turned:
    """The deep ring that carries the ball when it is pushed."""
    check_dimensions(d)
    return _ring(d, d.lower_ring_mouth, d.lower_ring_foot)


def shim(d: SphericalJointDimensions) -> Turned:
    """The washer under the lower ring."""
    check_dimensions(d)
    inner, outer, top = d.pocket_radius, d.ring_outer / 2.0, d.lower_ring_bottom
    low = top - d.shim_thickness
    corners = ((inner, low), (outer, low), (outer, top), (inner, top))
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners))


def shell_cover(d: SphericalJointDimensions) -> Turned:
    """The cover: flat outside, countersunk opening, land, recess that centres it on the upper ring."""
    check_dimensions(d)
    rim, bore, outer = d.rim_diameter / 2.0, d.ring_outer / 2.0, d.cover_diameter / 2.0
    corners = [
        (rim, d.cover_inner_face),
        (bore, d.cover_inner_face),
        (bore, d.bushing_top),
        (outer, d.bushing_top),
        (outer, d.cover_face),
        (d.mouth_radius, d.cover_face),
    ]
    if d.mouth_radius > rim:
        corners.append((rim, d.rim_height))
    if d.bushing_top >= d.cover_inner_face:  # as thick as its lip: no recess, and no step
        corners[1:3] = []
    row = d.screw_row
    holes = (
        Hole(
            top=d.cover_face,
            diameter=row.clearance_hole,
            head_diameter=row.countersink_diameter,
            head_depth=(row.countersink_diameter - row.clearance_hole) / 2.0,
            countersink=True,
            n=d.n_screws,
            pitch_radius=d.screw_circle / 2.0,
        ),
    )
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners), holes=holes)


def bushing(d: SphericalJointDimensions) -> Turned:
    """The housing: bore for rings and shim, room under the ball, threads for the cover and for one screw behind."""
    check_dimensions(d)
    bore, outer, seat = d.ring_outer / 2.0, d.cover_diameter / 2.0, d.lower_ring_bottom - d.shim_thickness
    corners = (
        (0.0, d.back),
        (outer, d.back),
        (outer, d.bushing_top),
        (bore, d.bushing_top),
        (bore, seat),
        (d.pocket_radius, seat),
        (d.pocket_radius, d.pocket_bottom),
        (0.0, d.pocket_bottom),
    )
    holes = (
        Hole(
            top=d.bushing_top,
            diameter=d.screw_row.diameter,
            depth=d.screw_depth,
            thread=d.screw_row.thread,
            n=d.n_screws,
            pitch_radius=d.screw_circle / 2.0,
        ),
        Hole(top=d.back, diameter=d.mount_diameter, depth=d.mount_depth, upwards=True, thread=f"M{d.mount_diameter:g}"),
    )
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners), holes=holes)

from __future__ import annotations

import math
from dataclasses import fields, replace

import pytest

from linkwright.designs.chains.pivot import Lay
from linkwright.designs.chains.spherical_joint import (
    SOCKET_16,
    SOCKET_20,
    SphericalJointDimensions,
    ball_bar,
    bushing,
    check_dimensions,
    cone_half_angle,
    formula_warnings,
    lower_ring,
    shell_cover,
    shim,
    socket_parts,
    upper_ring,
)
from linkwright.designs.chains.spherical_joint.cone import bar_polar_angle
from linkwright.designs.language.errors import ParameterError
from linkwright.designs.language.parameters import check_section, fields_of
from linkwright.generator.solids import build_solid

DEG = math.pi / 180.0
SETS = pytest.mark.parametrize("d", [SOCKET_16, SOCKET_20], ids=["ball of 16", "ball of 20"])


def test_the_formula_gives_the_reference_value():
    assert math.degrees(cone_half_angle(SOCKET_16)) == pytest.approx(55.517, abs=5e-4)
    assert math.degrees(cone_half_angle(SOCKET_20)) == pytest.approx(55.66, abs=5e-3)


@pytest.mark.parametrize(
    ("change", "degrees"),
    [
        ({"rim_diameter": 15.6}, 0.20),
        ({"cover_face": 4.3}, -0.57),
        ({"countersink_depth": 1.1}, 0.58),
        ({"root_diameter": 3.6}, -0.35),
    ],
)
def test_the_formula_has_the_sensitivities_of_the_reference(change, degrees):
    moved = cone_half_angle(replace(SOCKET_16, **change)) - cone_half_angle(SOCKET_16)
    assert math.degrees(moved) == pytest.approx(degrees, abs=0.012)


@SETS
def test_named_sets_can_be_made_and_keep_the_formula(d):
    check_section(d)
    check_dimensions(d)
    assert formula_warnings(d) == ()


def test_every_number_has_a_reason():
    assert all(len(f.meta.doc) > 10 for f in fields_of(SphericalJointDimensions))
    assert len(list(fields_of(SphericalJointDimensions))) == len(fields(SphericalJointDimensions))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"rim_diameter": 16.0}, "ball_diameter_mm"),
        ({"ball_diameter": 15.0}, "ball_diameter_mm"),
        ({"root_diameter": 17.0}, "root_diameter_mm"),
        ({"stem_diameter": 4.0}, "stem_diameter_mm"),
        ({"shoulder_height": 8.0}, "shoulder_height_mm"),
        ({"stem_length": 15.0}, "stem_length_mm"),
        ({"stud_diameter": 8.0}, "stud_diameter_mm"),
        ({"tommy_hole": 4.5}, "tommy_hole_mm"),
        ({"cover_face": 1.6}, "cover_face_mm"),
        ({"rim_diameter": 15.0, "cover_face": 4.0}, "rim_diameter_mm"),
        ({"cover_thickness": 1.6}, "cover_thickness_mm"),
        ({"cover_thickness": 4.6}, "cover_thickness_mm"),
        ({"ring_outer": 17.0}, "ring_outer_mm"),
        ({"upper_ring_foot": 73.0 * DEG}, "upper_ring_foot_deg"),
        ({"lower_ring_foot": 91.0 * DEG}, "lower_ring_foot_deg"),
        ({"lower_ring_foot": 165.0 * DEG, "grease_pocket": 0.2}, "grease_pocket_mm"),
        ({"screw_circle": 24.0}, "screw_circle_mm"),
        ({"cover_diameter": 33.0}, "screw_circle_mm"),
        ({"countersink_angle": 150.0 * DEG}, "countersink_depth_mm"),
        ({"n_screws": 12, "screw": "ISO10642-M4"}, "screw_circle_mm"),
        ({"screw_length": 7.0}, "screw_length_mm"),
        ({"screw_depth": 4.0}, "screw_depth_mm"),
        ({"screw_depth": 30.0}, "screw_depth_mm"),
        ({"mount_depth": 7.4}, "mount_depth_mm"),
        ({"mount_diameter": 20.0}, "mount_diameter_mm"),
    ],
)
def test_a_set_that_cannot_be_made_is_refused_by_name(change, field):
    with pytest.raises(ParameterError) as caught:
        check_dimensions(replace(SOCKET_16, **change))
    assert caught.value.field == field


def test_a_ball_that_falls_out_is_called_so_by_every_builder():
    loose = replace(SOCKET_16, ball_diameter=15.4)
    for build in (ball_bar, upper_ring, lower_ring, shim, shell_cover, bushing):
        with pytest.raises(ParameterError, match="ball smaller than the opening"):
            build(loose)


def test_the_bar_is_tangent_to_ball_and_root():
    d = replace(SOCKET_16, root_fillet=1.0)
    R, q, f = 8.0, 1.75, 1.0
    touch = math.asin((q + f) / (R + f))
    assert bar_polar_angle(d, R) == pytest.approx(touch, abs=1e-12)
    end = math.hypot(q, math.sqrt((R + f) ** 2 - (q + f) ** 2))
    assert bar_polar_angle(d, end - 1e-9) == pytest.approx(math.asin(q / end), abs=1e-7)
    assert bar_polar_angle(d, 12.0) == pytest.approx(math.asin(q / 12.0), abs=1e-12)
    # On the ball a tangent fillet leaves it without a step: its polar angle falls with the square root of the way.
    assert touch - bar_polar_angle(d, R + 1e-6) < 1e-3


def volume_between(r2: float, R: float, low: float, high: float) -> float:
    """A disc of squared radius r2 less the sphere of radius R, both from z = low to high [mm3]."""
    return math.pi * ((r2 - R * R) * (high - low) + (high**3 - low**3) / 3.0)


@SETS
def test_rings_have_the_volume_of_their_closed_form(d):
    upper = build_solid(upper_ring(d), 0.05, where="upper ring")
    lower = build_solid(lower_ring(d), 0.05, where="lower ring")
    outer2, R = (d.ring_outer / 2.0) ** 2, d.seat_radius
    assert upper.volume == pytest.approx(volume_between(outer2, R, d.upper_ring_bottom, d.cover_inner_face), rel=1e-9)
    assert lower.volume == pytest.approx(volume_between(outer2, R, d.lower_ring_bottom, d.lower_ring_top), rel=1e-9)
    assert upper.upper[2] == pytest.approx(d.cover_inner_face, abs=1e-9)


@SETS
def test_cover_and_bushing_have_the_volume_of_their_closed_form(d):
    row = d.screw_row
    cover = build_solid(shell_cover(d), 0.05, where="cover").volume
    rim, mouth, R, bore = d.rim_diameter / 2.0, d.mouth_radius, d.cover_diameter / 2.0, d.ring_outer / 2.0
    head, hole = row.countersink_diameter / 2.0, row.clearance_hole / 2.0
    full = R * R * d.cover_thickness - rim * rim * d.land - bore * bore * (d.cover_inner_face - d.bushing_top)
    full -= d.countersink_depth * (rim * rim + rim * mouth + mouth * mouth) / 3.0
    cone = (head - hole) * (head * head + head * hole + hole * hole) / 3.0
    full -= d.n_screws * (cone + hole * hole * (d.cover_thickness - (head - hole)))
    assert cover == pytest.approx(math.pi * full, rel=1e-9)

    seat = d.lower_ring_bottom - d.shim_thickness
    full = R * R * (d.bushing_top - d.back) - bore * bore * (d.bushing_top - seat)
    full -= d.pocket_radius**2 * (seat - d.pocket_bottom) + (d.mount_diameter / 2.0) ** 2 * d.mount_depth
    full -= d.n_screws * (row.diameter / 2.0) ** 2 * d.screw_depth
    assert build_solid(bushing(d), 0.05, where="bushing").volume == pytest.approx(math.pi * full, rel=1e-9)


def test_a_bar_without_fillet_and_holes_has_the_volume_of_its_closed_form():
    d = replace(SOCKET_16, root_fillet=0.0, tommy_hole=0.0)
    R, q, c, stem = 8.0, 1.75, d.shoulder_chamfer, d.stem_diameter / 2.0
    z = math.sqrt(R * R - q * q)
    ball = math.pi * (2.0 * R**3 / 3.0 + R * R * z - z**3 / 3.0)
    root = math.pi * q * q * (d.shoulder_height - z)
    cone = math.pi * c * (stem**2 + stem * (stem - c) + (stem - c) ** 2) / 3.0
    rest = math.pi * (stem**2 * (d.stem_length - d.shoulder_height - c) + (d.stud_diameter / 2.0) ** 2 * d.stud_length)
    assert build_solid(ball_bar(d), 0.05, where="bar").volume == pytest.approx(ball + root + cone + rest, rel=1e-9)
    filled = build_solid(ball_bar(replace(d, root_fillet=0.4)), 0.05, where="bar").volume
    assert 0.0 < filled - (ball + root + cone + rest) < 2.0


def test_a_socket_lies_where_its_frame_is_put():
    lay = Lay(z=(0.0, 0.0, -1.0), x=(0.0, 1.0, 0.0), origin=(120.0, 0.0, 5.0))
    parts = socket_parts(SOCKET_16, "socket_2", lay, housing="aluminium_6082", seats="bronze_cusn8")
    assert len({p.name for p in parts}) == len(parts) == 5 + SOCKET_16.n_screws
    assert all(p.at.origin == (120.0, 0.0, 5.0) for p in parts[:5]) and all(p.runs_in_joint for p in parts[:5])
    for p in parts[5:]:
        assert not p.runs_in_joint and p.purchased == "ISO10642-M2.5x8"
        assert p.at.origin[2] == pytest.approx(5.0 - SOCKET_16.cover_face) and p.at.z == pytest.approx((0.0, 0.0, 1.0))
        assert math.dist(p.at.origin[:2], (120.0, 0.0)) == pytest.approx(SOCKET_16.screw_circle / 2.0)


def test_warnings_name_the_field_that_cures_them():
    cured = {
        "countersink_angle_deg": replace(SOCKET_16, countersink_angle=80.0 * DEG),
        "root_fillet_mm": replace(SOCKET_16, root_fillet=0.8),
        "land_mm": replace(SOCKET_16, land=0.3),
        "shoulder_height_mm": replace(SOCKET_16, shoulder_height=11.0),
    }
    for field, d in cured.items():
        (warning,) = formula_warnings(d)
        assert warning.field == field and 0.0 < warning.allows < cone_half_angle(d)

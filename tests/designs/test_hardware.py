"""Hardware as features: volumes by Pappus against closed forms, profiles that close, and pins that cannot be made."""

from __future__ import annotations

import math
from itertools import combinations

import pytest

from linkwright.designs.language import hardware, supplies
from linkwright.designs.language.bodies import Placement
from linkwright.designs.language.errors import ParameterError
from linkwright.designs.language.features import Turned

Corner = tuple[float, float]

ALL: dict[str, Turned] = {
    **{name: hardware.bearing(name) for name in supplies.names("bearings")},
    **{name: hardware.clip(name) for name in supplies.names("clips")},
    **{name: hardware.shim(name, 0.2) for name in supplies.names("shims")},
    **{
        f"{name}x{x:g}": hardware.screw(name, x)
        for name in supplies.names("screws")
        for x in supplies.screw(name).lengths
    },
    **{
        f"{name}:{part.__name__}": part(name)
        for name in supplies.names("motors")
        for part in (hardware.motor, hardware.motor_body, hardware.motor_shaft)
    },
    "pin": hardware.pin(4.0, 20.0),
    "sharp pin": hardware.pin(4.0, 20.0, chamfer=0.0),
    "pin with all": hardware.pin(
        6.0,
        30.0,
        head_diameter=9.0,
        head_height=2.0,
        bore=3.0,
        bore_depth=10.0,
        thread="M3",
        thread_depth=8.0,
        grooves=((26.0, 5.0, 0.7), (2.0, 5.5, 1.0)),
    ),
    "tube": hardware.pin(6.0, 30.0, bore=3.0),
    "spacer": hardware.spacer(4.0, 6.0, 3.0),
}


def corners(feature: Turned) -> list[Corner]:
    return [(v.r, v.z) for v in feature.profile]


def pappus(feature: Turned) -> float:
    """Volume [mm3] swept by the profile, positive for one that runs counter-clockwise in (r, z)."""
    points = corners(feature)
    return (
        math.pi
        / 3.0
        * sum(
            (r1 + r2) * (r1 * z2 - r2 * z1) for (r1, z1), (r2, z2) in zip(points, points[1:] + points[:1], strict=True)
        )
    )


def crosses(a: Corner, b: Corner, c: Corner, d: Corner) -> bool:
    """Whether the segments ab and cd cross or touch."""

    def side(p: Corner, q: Corner, s: Corner) -> float:
        return (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0])

    if any(max(a[k], b[k]) < min(c[k], d[k]) or max(c[k], d[k]) < min(a[k], b[k]) for k in (0, 1)):
        return False
    return side(a, b, c) * side(a, b, d) <= 0.0 and side(c, d, a) * side(c, d, b) <= 0.0


def faults(feature: Turned) -> list[str]:
    """What is wrong with a profile as a closed polygon."""
    points = corners(feature)
    edges = list(zip(points, points[1:] + points[:1], strict=True))
    found = [f"radius {r}" for r, _ in points if not (math.isfinite(r) and r >= 0.0)]
    found += [f"edge at {a} has no length" for a, b in edges if math.dist(a, b) < 1e-6]
    for (i, (a, b)), (j, (c, d)) in combinations(enumerate(edges), 2):
        if j - i > 1 and not (i == 0 and j == len(edges) - 1) and crosses(a, b, c, d):
            found.append(f"edges {i} and {j} meet")
    return found


def cylinder(diameter: float, length: float) -> float:
    return math.pi / 4.0 * diameter**2 * length


def frustum(d_1: float, d_2: float, length: float) -> float:
    return math.pi / 12.0 * length * (d_1**2 + d_1 * d_2 + d_2**2)


def span(feature: Turned) -> tuple[float, float]:
    heights = [v.z for v in feature.profile]
    return min(heights), max(heights)


@pytest.mark.parametrize("feature", ALL.values(), ids=ALL.keys())
def test_a_profile_is_a_simple_polygon_beside_the_axis(feature: Turned) -> None:
    assert faults(feature) == []
    assert pappus(feature) > 0.0


def test_the_look_at_a_profile_finds_a_crossing_and_a_negative_radius() -> None:
    def turned(*points: Corner) -> Turned:
        return hardware._turned(*points)

    assert faults(turned((1, 0), (2, 1), (2, 0), (1, 1))) == ["edges 0 and 2 meet"]
    assert faults(turned((-1, 0), (2, 0), (2, 1))) == ["radius -1"]
    assert "edge at (1, 0) has no length" in faults(turned((1, 0), (2, 0), (2, 1), (1, 0)))


def test_a_plain_pin_has_the_volume_of_a_cylinder() -> None:
    assert pappus(hardware.pin(4.0, 20.0, chamfer=0.0)) == pytest.approx(cylinder(4.0, 20.0), rel=1e-12)


def test_a_pin_with_everything_has_the_volume_of_its_pieces() -> None:
    volume = (
        frustum(8.4, 9.0, 0.3)
        + cylinder(9.0, 1.7)  # head, chamfered below
        + cylinder(6.0, 29.7)
        + frustum(6.0, 5.4, 0.3)
        - (cylinder(6.0, 1.0) - cylinder(5.5, 1.0))
        - (cylinder(6.0, 0.7) - cylinder(5.0, 0.7))  # grooves
        - cylinder(3.0, 10.0)
    )
    feature = ALL["pin with all"]
    assert pappus(feature) == pytest.approx(volume, rel=1e-12)
    assert span(feature) == (-2.0, 30.0)
    (hole,) = feature.holes
    assert (hole.top, hole.diameter, hole.depth, hole.thread, hole.upwards) == (30.0, 3.0, 8.0, "M3", False)


def test_a_blind_bore_opens_at_the_lower_end() -> None:
    feature = hardware.pin(8.0, 30.0, bore=4.0, bore_depth=12.0, chamfer=0.0)
    assert pappus(feature) == pytest.approx(cylinder(8.0, 30.0) - cylinder(4.0, 12.0), rel=1e-12)
    assert (0.0, 12.0) in corners(feature) and (2.0, 0.0) in corners(feature)


def test_a_bore_without_depth_goes_through() -> None:
    volume = cylinder(6.0, 30.0) - 2.0 * (cylinder(6.0, 0.3) - frustum(6.0, 5.4, 0.3)) - cylinder(3.0, 30.0)
    assert pappus(ALL["tube"]) == pytest.approx(volume, rel=1e-12)
    assert min(v.r for v in ALL["tube"].profile) == 1.5


def test_a_spacer_has_the_volume_of_a_tube() -> None:
    assert pappus(ALL["spacer"]) == pytest.approx(cylinder(6.0, 3.0) - cylinder(4.0, 3.0), rel=1e-12)
    assert span(ALL["spacer"]) == (0.0, 3.0)


def test_a_bearing_has_the_volume_of_a_ring_less_two_recesses() -> None:
    for name in supplies.names("bearings"):
        row = supplies.bearing(name)
        ring = cylinder(row.outer, row.width) - cylinder(row.bore, row.width)
        recess = cylinder(row.outer_land, hardware.SHIELD_RECESS) - cylinder(row.inner_land, hardware.SHIELD_RECESS)
        assert pappus(ALL[name]) == pytest.approx(ring - 2.0 * recess, rel=1e-12)
        assert span(ALL[name]) == (0.0, row.width)


def test_a_cap_screw_lies_with_its_head_below_and_its_shank_above_zero() -> None:
    feature = hardware.screw("ISO4762-M4", 16.0)
    assert span(feature) == (-4.0, 16.0)
    assert max(v.r for v in feature.profile if v.z <= 0.0) == 3.5
    assert max(v.r for v in feature.profile if v.z > 0.0) == 2.0
    flats, top, depth = feature.hex_socket
    assert (flats, top - depth, depth) == (3.0, -4.0, 2.0)


def test_a_countersunk_screw_is_flush_and_its_cone_has_90_degrees() -> None:
    feature = hardware.screw("ISO10642-M3", 8.0)
    assert span(feature) == (0.0, 8.0)
    (r_1, z_1), (r_2, z_2) = corners(feature)[2:4]
    assert r_1 - r_2 == pytest.approx(z_2 - z_1, rel=1e-12)
    assert r_1 + z_1 == pytest.approx(6.72 / 2.0, rel=1e-12)
    flats, top, depth = feature.hex_socket
    assert (flats, top - depth) == (2.0, 0.0)
    assert depth < 8.0


def test_the_mass_of_a_screw_is_near_that_of_its_shape() -> None:
    for name in supplies.names("screws"):
        row = supplies.screw(name)
        for length in row.lengths:
            socket = math.sqrt(3.0) / 2.0 * row.socket**2 * row.socket_depth
            shape = (pappus(ALL[f"{name}x{length:g}"]) - socket) * 7.9e-6
            assert 0.75 * shape < row.mass_of(length) < shape, (name, length)


def test_a_motor_is_its_body_and_its_shaft_apart_by_air() -> None:
    for name in supplies.names("motors"):
        row = supplies.motor(name)
        body, shaft = hardware.motor_body(name), hardware.motor_shaft(name)
        assert span(body) == pytest.approx((-row.body_length - row.rear_length, row.pilot_length))
        assert span(shaft) == (0.0, row.shaft_length)
        around = [v.r for v in body.profile if v.z >= -hardware.SHAFT_GAP_DEPTH and v.r > 0.0]
        assert min(around) - max(v.r for v in shaft.profile) == pytest.approx(hardware.SHAFT_GAP)
        assert span(hardware.motor(name)) == pytest.approx((-row.body_length - row.rear_length, row.shaft_length))


def test_the_holes_of_a_motor_lie_on_their_circle_inside_the_face_and_outside_the_pilot() -> None:
    for name in supplies.names("motors"):
        row = supplies.motor(name)
        for feature in (hardware.motor(name), hardware.motor_body(name)):
            (hole,) = feature.holes
            assert (hole.top, hole.n, hole.thread, hole.depth) == (0.0, row.n_mount, row.mount_screw, row.mount_depth)
            assert hole.pitch_radius + hole.diameter / 2.0 < row.body_diameter / 2.0
            assert hole.pitch_radius - hole.diameter / 2.0 > row.pilot_diameter / 2.0


def test_the_holes_of_a_flipped_motor_are_where_they_were() -> None:
    for name in supplies.names("motors"):
        row = supplies.motor(name)
        angles = [row.first_hole + k * math.tau / row.n_mount for k in range(row.n_mount)]
        assert sorted(a % math.tau for a in angles) == pytest.approx(sorted(-a % math.tau for a in angles))


@pytest.mark.parametrize(
    ("field", "numbers"),
    [
        ("pin.diameter", {"diameter": 0.0}),
        ("pin.diameter", {"diameter": math.nan}),
        ("pin.length", {"length": 0.5}),
        ("pin.length", {"length": -20.0}),
        ("pin.chamfer", {"chamfer": -0.1}),
        ("pin.bore", {"bore": 3.4}),
        ("pin.bore", {"bore": -1.0}),
        ("pin.bore_depth", {"bore": 2.0, "bore_depth": 20.0}),
        ("pin.head_diameter", {"head_diameter": 4.0, "head_height": 2.0}),
        ("pin.head_height", {"head_diameter": 6.0, "head_height": 0.2}),
        ("pin.grooves[0].z", {"grooves": ((0.1, 3.2, 0.6),)}),
        ("pin.grooves[1].z", {"grooves": ((5.3, 3.2, 0.6), (5.0, 3.2, 0.6))}),
        ("pin.grooves[0].width", {"grooves": ((19.2, 3.2, 0.6),)}),
        ("pin.grooves[0].width", {"grooves": ((10.0, 3.2, 0.0),)}),
        ("pin.grooves[0].diameter", {"grooves": ((10.0, 4.0, 0.6),)}),
        ("pin.grooves[0].diameter", {"grooves": ((10.0, 1.9, 0.6),), "bore": 2.0}),
        ("pin.thread", {"thread": "M4", "thread_depth": 5.0}),
        ("pin.thread_depth", {"thread": "M2", "thread_depth": 20.0}),
        ("pin.thread_depth", {"thread": "M3", "thread_depth": 5.0, "bore": 2.0}),
        ("pin.thread_depth", {"thread": "M3", "thread_depth": 12.0, "bore": 2.0, "bore_depth": 8.0}),
    ],
)
def test_a_pin_that_cannot_be_turned_is_refused_by_the_number_at_fault(field: str, numbers: dict) -> None:
    with pytest.raises(ParameterError) as caught:
        hardware.pin(**{"diameter": 4.0, "length": 20.0, **numbers})
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("field", "numbers"),
    [("spacer.bore", (0.0, 6.0, 1.0)), ("spacer.outer", (4.0, 4.0, 1.0)), ("spacer.length", (4.0, 6.0, 0.0))],
)
def test_a_spacer_without_wall_or_length_is_refused(field: str, numbers: tuple[float, float, float]) -> None:
    with pytest.raises(ParameterError) as caught:
        hardware.spacer(*numbers)
    assert caught.value.field == field


def test_a_screw_or_shim_that_is_not_sold_is_refused() -> None:
    with pytest.raises(ParameterError, match="ISO4762-M4"):
        hardware.screw("ISO4762-M4", 17.0)
    with pytest.raises(ParameterError, match="DIN988-4x8"):
        hardware.shim("DIN988-4x8", 0.25)


def test_a_purchased_part_carries_designation_mass_and_material() -> None:
    at = Placement(origin=(1.0, 2.0, 3.0))
    row = supplies.bearing("688ZZ")
    part = hardware.purchased_part("bearing_1", hardware.bearing(row.name), row, at, fit="press N7")
    assert (part.purchased, part.mass, part.material, part.runs_in_joint, part.at) == (
        "688ZZ",
        row.mass,
        "steel_100cr6",
        True,
        at,
    )
    bolt = supplies.screw("ISO4762-M4")
    part = hardware.purchased_part("screw_1", hardware.screw(bolt.name, 16.0), bolt, length=16.0)
    assert (part.purchased, part.mass, part.material, part.runs_in_joint) == (
        "ISO4762-M4x16",
        bolt.mass_of(16.0),
        "stainless_1_4301",
        False,
    )
    ring = supplies.shim("DIN988-4x8")
    part = hardware.purchased_part("shim_1", hardware.shim(ring.name, 0.2), ring, length=0.2)
    assert (part.purchased, part.mass) == ("DIN988-4x8x0.2", None)
    drive = supplies.motor("maxon-RE30-60W")
    part = hardware.purchased_part("motor", hardware.motor(drive.name), drive, material="steel_c45")
    assert (part.mass, part.material, part.runs_in_joint) == (drive.mass, "steel_c45", False)


def test_a_screw_without_length_is_no_purchased_part() -> None:
    bolt = supplies.screw("ISO4762-M4")
    with pytest.raises(ParameterError, match="bought by its length"):
        hardware.purchased_part("screw_1", hardware.screw(bolt.name, 16.0), bolt)

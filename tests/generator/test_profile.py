import math

import pytest

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Vertex
from linkwright.generator.parts.profile import build_profile, outer_walls, profile_span, swept_volume


def _profile(*corners):
    return tuple(Vertex(r=c[0], z=c[1], mid=c[2] if len(c) > 2 else None) for c in corners)


def _torus():
    """A circle of radius 2 about r = 7, whose lowest and highest points are no corners."""
    c = math.sqrt(2.0)
    corners = [(7 + c, -c, (7.0, -2.0)), (7 + c, c, (9.0, 0.0)), (7 - c, c, (7.0, 2.0)), (7 - c, -c, (5.0, 0.0))]
    return tuple(corners)


def _volume(*corners):
    return swept_volume(build_profile(_profile(*corners), "x"))


def test_pappus_gives_cylinder_cone_ball_and_torus():
    assert _volume((0, 0), (5, 0), (5, 10), (0, 10)) == pytest.approx(250 * math.pi, rel=1e-14)
    assert _volume((0, 0), (5, 0), (0, 10)) == pytest.approx(math.pi * 25 * 10 / 3, rel=1e-14)
    assert _volume(
        (0, -4), (4, 0, (4 * math.sqrt(0.5), -4 * math.sqrt(0.5))), (0, 4, (4 * math.sqrt(0.5), 4 * math.sqrt(0.5)))
    ) == pytest.approx(4 / 3 * math.pi * 64, rel=1e-13)
    assert _volume(*_torus()) == pytest.approx(2 * math.pi**2 * 7 * 4, rel=1e-13)


def test_an_arc_that_turns_inwards_takes_volume_away():
    # A cylinder with a groove of half a torus.
    groove = _volume((0, 0), (6, 0), (6, 3), (6, 7, (4, 5)), (6, 10), (0, 10))
    half_disc = math.pi * 4 / 2
    assert groove == pytest.approx(360 * math.pi - 2 * math.pi * half_disc * (6 - 4 * 2 / (3 * math.pi)), rel=1e-13)


def test_the_span_of_a_ball_reaches_beyond_its_corners():
    edges = build_profile(_profile((0, -12), (6, -12), (6, -8), (0, 10, (10, 0))), "x")
    assert profile_span(edges) == (-12.0, 10.0)
    ring = build_profile(_profile(*_torus()), "x")
    assert profile_span(ring) == pytest.approx((-2.0, 2.0))


def test_only_straight_outer_cylinders_count_as_walls():
    edges = build_profile(_profile((2, 0), (6, 0), (6, 5), (4, 7), (4, 10), (2, 10)), "x")
    assert outer_walls(edges, 0, 10) == [6, 4]
    assert outer_walls(edges, 0, 4) == [6]
    assert outer_walls(edges, 5, 7) == []


@pytest.mark.parametrize(("corners", "says"), [
    (((0, 0), (5, 0)), "at least 3 corners"),
    (((0, 0), (-5, 0), (-5, 10), (0, 10)), "negative"),
    (((0, 0), (5, 0), (5, 0), (5, 10), (0, 10)), "corners 1 and 2 of the profile coincide"),
    (((0, 0), (5, 10), (5, 0), (0, 10)), "crosses or touches itself"),
    (((0, 0), (5, 0), (5, 10), (3, 10), (3, 0), (2, 0), (2, 10), (0, 10)), "crosses or touches itself"),
    (((0, 0), (0, 10), (5, 10), (5, 0)), "clockwise"),
    (((0, 0), (5, 0), (5, -10), (0, -10)), "clockwise"),
    (((0, 0), (5, -5), (10, 0), (5, 5)), "in one point only"),
    (((2, 0), (5, 0), (8, 0)), "crosses or touches itself"),
    (((2, 0), (5, 0), (8, 3), (8, 10, (8, 6)), (2, 10)), "no circle does"),
    (((3, 0), (3, 10, (-4, 5)), (1, 10)), "beyond the axis"),
    (((0, 0), (math.nan, 0), (5, 10), (0, 10)), "not a number"),
])  # fmt: skip
def test_a_profile_that_makes_no_part_is_refused(corners, says):
    with pytest.raises(BuildError, match=says) as caught:
        build_profile(_profile(*corners), "hit: lower_left: pin")
    assert caught.value.where == "hit: lower_left: pin"


def test_a_wall_of_no_thickness_between_bore_and_groove_is_refused():
    good = ((3, 0), (6, 0), (6, 4), (3.5, 4), (3.5, 6), (6, 6), (6, 10), (3, 10))
    build_profile(_profile(*good), "x")
    bad = tuple((3.0 if r == 3.5 else r, z) for r, z in good)
    with pytest.raises(BuildError, match="crosses or touches itself"):
        build_profile(_profile(*bad), "x")


def test_an_arc_centre_that_rounding_moved_off_the_axis_is_put_back():
    R, a = 10.0, 0.3
    start, mid, end = ((R * math.sin(t), R * math.cos(t)) for t in (math.pi - a, 1.1, 0.4))
    edges = build_profile(_profile((0, start[1]), start, (*end, mid), (0, end[1])), "x")
    assert [e.centre[0] for e in edges if e.centre] == [0.0]

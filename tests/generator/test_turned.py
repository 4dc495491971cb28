import math
from dataclasses import replace

import numpy as np
import pytest

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import CrossHole, Hole, Turned, Vertex
from linkwright.generator.solids import build_solid
from linkwright.generator.surfaces import SurfaceKind, is_revolved_about, is_sphere_at


def _build(feature):
    return build_solid(feature, 0.05, where="hit: frame: part")


def test_a_ball_with_a_neck_has_the_volume_and_centre_of_its_pieces(ball_with_neck):
    solid = _build(ball_with_neck)
    z = math.sqrt(91.0)
    cap = math.pi * (10 - z) ** 2 * (30 - (10 - z)) / 3
    ball, neck = 4 / 3 * math.pi * 1000 - cap, math.pi * 9 * (30 - z)
    assert solid.volume == pytest.approx(ball + neck, rel=1e-12)
    # The cap that the neck hides has its centroid at 3 (2R - h)^2 / (4 (3R - h)).
    h = 10 - z
    cap_centre = -3 * (20 - h) ** 2 / (4 * (30 - h))
    assert solid.centre == pytest.approx([0, 0, (-cap * cap_centre + neck * -(30 + z) / 2) / (ball + neck)], abs=1e-9)
    assert solid.lower == pytest.approx([-10, -10, -30], abs=1e-6)
    assert solid.upper == pytest.approx([10, 10, 10], abs=1e-6)


def test_a_ball_is_a_true_sphere_about_its_centre_and_its_neck_a_true_cylinder(ball_with_neck):
    kinds = [s.kind for s in _build(ball_with_neck).surfaces]
    assert sorted(kinds) == [SurfaceKind.CYLINDER, SurfaceKind.PLANE, SurfaceKind.SPHERE]
    sphere = _build(ball_with_neck).surfaces[kinds.index(SurfaceKind.SPHERE)]
    assert is_sphere_at(sphere, (0, 0, 0), 1e-12)
    assert sphere.radius == pytest.approx(10, abs=1e-12)


def test_a_rod_has_the_textbook_moments_of_inertia(rod):
    solid = _build(rod)
    v = 250 * math.pi
    assert solid.volume == pytest.approx(v, rel=1e-12)
    assert solid.area == pytest.approx(150 * math.pi, rel=1e-12)
    assert solid.inertia == pytest.approx(np.diag([v * (75 + 100) / 12] * 2 + [v * 12.5]), rel=1e-10, abs=1e-9)


def test_chamfers_and_fillets_become_cones_and_tori():
    c = math.sqrt(0.5)
    feature = Turned(profile=(Vertex(r=4, z=0), Vertex(r=9, z=0), Vertex(r=10, z=1), Vertex(r=10, z=2),
                              Vertex(r=8, z=4, mid=(8 + 2 * c, 2 + 2 * c)), Vertex(r=4, z=4)))  # fmt: skip
    kinds = {s.kind for s in _build(feature).surfaces}
    assert kinds == {SurfaceKind.CYLINDER, SurfaceKind.CONE, SurfaceKind.TORUS, SurfaceKind.PLANE}
    assert all(is_revolved_about(s, (0, 0, 0), (0, 0, 1), 1e-12) for s in _build(feature).surfaces)


def test_a_cap_screw_loses_just_its_hexagon():
    profile = tuple(Vertex(r=r, z=z) for r, z in ((0, -20), (2, -20), (2, 0), (3.5, 0), (3.5, 4), (0, 4)))
    solid = _build(Turned(profile=profile, hex_socket=(3, 4, 2)))
    assert solid.volume == pytest.approx(math.pi * (80 + 49) - math.sqrt(3) / 2 * 9 * 2, rel=1e-10)


def test_a_counterbored_hole_loses_bore_and_head(rod):
    hole = Hole(top=10, diameter=4, head_diameter=6, head_depth=3)
    assert _build(replace(rod, holes=(hole,))).volume == pytest.approx(math.pi * (250 - 4 * 7 - 9 * 3), rel=1e-10)


def test_a_countersunk_blind_hole_loses_a_cone_and_a_cylinder(rod):
    hole = Hole(top=10, diameter=4, depth=6, head_diameter=6, countersink=True)
    cone = math.pi / 3 * (9 + 6 + 4)
    assert _build(replace(rod, holes=(hole,))).volume == pytest.approx(
        250 * math.pi - cone - math.pi * 4 * 5, rel=1e-10
    )


def test_a_hole_drilled_upwards_starts_at_its_own_plane(rod):
    up = _build(replace(rod, holes=(Hole(top=0, diameter=4, depth=3, upwards=True),)))
    down = _build(replace(rod, holes=(Hole(top=10, diameter=4, depth=3),)))
    assert up.volume == pytest.approx(down.volume, rel=1e-12)
    assert up.centre[2] - 5 == pytest.approx(5 - down.centre[2], rel=1e-9)
    assert up.centre[2] > 5


def test_a_circle_of_holes_begins_at_its_first_angle(rod):
    solid = _build(replace(rod, holes=(Hole(top=10, diameter=2, n=3, pitch_radius=3, first=math.pi / 6),)))
    bores = [s for s in solid.surfaces if s.kind is SurfaceKind.CYLINDER and s.radius == pytest.approx(1)]
    angles = sorted(math.degrees(math.atan2(s.point[1], s.point[0])) for s in bores)
    assert angles == pytest.approx([-90, 30, 150])
    assert solid.volume == pytest.approx(math.pi * (250 - 30), rel=1e-10)


def test_a_cross_hole_that_starts_on_the_skin_takes_its_whole_round(rod):
    # Two crossing cylinders: the drill ends on the axis, where its flat bottom is 2 * sqrt(25 - 1.5^2) from nothing.
    hole = CrossHole(origin=(5, 0, 5), direction=(-1, 0, 0), diameter=3, depth=5)
    lost = 250 * math.pi - _build(replace(rod, cross_holes=(hole,))).volume
    y = np.linspace(-1.5, 1.5, 200001)
    expected = np.trapezoid(2 * np.sqrt(2.25 - y**2) * np.sqrt(25 - y**2), y)
    assert lost == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(("change", "says"), [
    ({"holes": (Hole(top=10, diameter=10),)}, r"hole 0 .* leaves a wall of 0 mm"),
    ({"holes": (Hole(top=10, diameter=11, depth=4),)}, r"leaves a wall of -0.5 mm"),
    ({"holes": (Hole(top=10, diameter=3, x=4),)}, r"leaves a wall of -0.5 mm"),
    ({"holes": (Hole(top=10, diameter=3, head_diameter=12, head_depth=2),)},
     r"head of hole 0 .* leaves a wall of -1 mm"),
    ({"holes": (Hole(top=10, diameter=-3),)}, "must be positive"),
    ({"holes": (Hole(top=10, diameter=3, depth=-1),)}, "must be positive"),
    ({"holes": (Hole(top=10, diameter=3, depth=4, head_diameter=5, head_depth=4),)}, "must lie between 0 and 4 mm"),
    ({"holes": (Hole(top=10, diameter=3, head_diameter=5, head_depth=10),)}, "must lie between 0 and 10 mm"),
    ({"holes": (Hole(top=10, diameter=3, x=math.nan),)}, "not numbers"),
    ({"holes": (Hole(top=10, diameter=3, head_diameter=2, head_depth=1),)}, "must be wider than the hole"),
    ({"holes": (Hole(top=0, diameter=3),)}, "away from the part"),
    ({"holes": (Hole(top=10, diameter=2, n=3),)}, "must be positive"),
    ({"holes": (Hole(top=10, diameter=4), Hole(top=8, diameter=3, depth=3))}, "hole 1 .* cuts nothing"),
    ({"holes": (Hole(top=8, diameter=3, depth=3),)}, "closed cavity"),
    ({"cross_holes": (CrossHole(origin=(9, 0, 0), direction=(0, 0, 1), diameter=2, depth=9),)}, "cuts nothing"),
    ({"cross_holes": (CrossHole(origin=(9, 0, 5), direction=(-1, 0, 0), diameter=30, depth=9),)},
     "open along its whole depth"),
    ({"cross_holes": (CrossHole(origin=(6, 0, 5), direction=(0, 0, 0), diameter=3, depth=9),)}, "no direction"),
    ({"hex_socket": (3, 10, -1)}, "must be positive"),
])  # fmt: skip
def test_a_hole_that_makes_no_part_is_refused_by_name(rod, change, says):
    with pytest.raises(BuildError, match=says) as caught:
        _build(replace(rod, **change))
    assert caught.value.where == "hit: frame: part"


def test_a_cross_hole_as_wide_as_the_neck_that_it_crosses_is_refused():
    profile = ((0, 0), (5, 0), (5, 4), (2, 4), (2, 8), (5, 8), (5, 12), (0, 12))
    hole = CrossHole(origin=(6, 0, 6), direction=(-1, 0, 0), diameter=3.9, depth=12)
    feature = Turned(profile=tuple(Vertex(r=r, z=z) for r, z in profile), cross_holes=(hole,))
    assert _build(feature).volume > 0
    with pytest.raises(BuildError, match=r"hit: frame: part: cross hole 0 .* open along its whole depth"):
        _build(replace(feature, cross_holes=(replace(hole, diameter=4.0),)))


def test_a_hole_may_open_into_a_ball(ball_with_neck):
    drilled = _build(replace(ball_with_neck, holes=(Hole(top=10, diameter=4, depth=10),)))
    # A bore of radius 2 through a ball: its top is the ball's, its bottom flat at the centre.
    lost = _build(ball_with_neck).volume - drilled.volume
    h = 10 - math.sqrt(96)
    assert lost == pytest.approx(math.pi * 4 * (10 - h) + math.pi * h**2 * (30 - h) / 3, rel=1e-9)

"""Trees and distances: against python-fcl and closed forms; exempt faces against the tilt limit of a ball joint."""

from __future__ import annotations

import math

import fcl
import numpy as np
import pytest
import trimesh

from linkwright.analysis.contact.crossings import find_crossings
from linkwright.analysis.contact.distance import TOLERANCE, compute_distance, scan_poses
from linkwright.analysis.contact.tree import ContactTree, build_tree, group_bits
from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.poses import rotation_about


def _bar():
    blank = trimesh.creation.box((60.0, 12.0, 6.0))
    for x in (-22.0, 0.0, 22.0):
        blank = blank.difference(trimesh.creation.cylinder(3.0, 20.0, sections=60).apply_translation((x, 0.0, 0.0)))
    return blank


def _plate():
    blank = trimesh.creation.cylinder(25.0, 5.0, sections=120)
    for k in range(6):
        at = (17.0 * math.cos(k * math.pi / 3), 17.0 * math.sin(k * math.pi / 3), 0.0)
        blank = blank.difference(trimesh.creation.cylinder(2.0, 20.0, sections=40).apply_translation(at))
    return blank.union(trimesh.creation.icosphere(3, 6.0).apply_translation((8.0, 0.0, 4.0)))


@pytest.fixture(scope="module")
def bar():
    return _bar()


@pytest.fixture(scope="module")
def plate():
    return _plate()


def _random_poses(rng, n, spread):
    Ts = np.tile(np.eye(4), (n, 1, 1))
    for T in Ts:
        axis = rng.normal(size=3)
        T[:3, :3] = rotation_about(axis, rng.uniform(0.0, math.pi))
        T[:3, 3] = rng.normal(size=3) * spread
    return Ts


def _fcl_distances(a, b, Ts):
    def model(mesh):
        bvh = fcl.BVHModel()
        bvh.beginModel(len(mesh.vertices), len(mesh.faces))
        bvh.addSubModel(mesh.vertices, mesh.faces)
        bvh.endModel()
        return bvh

    one, two, out = fcl.CollisionObject(model(a)), model(b), []
    for T in Ts:
        other = fcl.CollisionObject(two, fcl.Transform(T[:3, :3], T[:3, 3]))
        out.append(max(0.0, fcl.distance(one, other, fcl.DistanceRequest(), fcl.DistanceResult())))
    return np.array(out)


def test_distance_equals_fcl_at_random_poses_of_parts_with_holes(rng, bar, plate):
    Ts = _random_poses(rng, 120, 25.0)
    expected = _fcl_distances(plate, bar, Ts)
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    values = np.array([compute_distance(a, b, T).value for T in Ts])
    assert 10 < (expected == 0.0).sum() < 110
    np.testing.assert_allclose(values, expected, atol=1e-8)
    np.testing.assert_array_equal(values == 0.0, expected == 0.0)


def test_distance_does_not_depend_on_cutting_leaf_size_or_order(rng, bar, plate):
    Ts = _random_poses(rng, 10, 40.0)
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    for max_edge, leaf_size in ((np.inf, 1), (2.0, 7), (9.0, 64)):
        c, d = (build_tree(m.triangles, max_edge=max_edge, leaf_size=leaf_size) for m in (plate, bar))
        for T in Ts:
            value = compute_distance(a, b, T).value
            assert compute_distance(c, d, T).value == pytest.approx(value, abs=2 * TOLERANCE)
            assert compute_distance(d, c, np.linalg.inv(T)).value == pytest.approx(value, abs=1e-8)


def test_witness_points_lie_on_the_surfaces_at_the_distance(rng, bar, plate):
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    for T in _random_poses(rng, 20, 60.0):
        found = compute_distance(a, b, T)
        assert np.linalg.norm(found.point_a - found.point_b) == pytest.approx(found.value, abs=1e-9)
        in_b = T[:3, :3].T @ (found.point_b - T[:3, 3])
        assert trimesh.proximity.closest_point_naive(plate, [found.point_a])[1][0] == pytest.approx(0.0, abs=1e-9)
        assert trimesh.proximity.closest_point_naive(bar, [in_b])[1][0] == pytest.approx(0.0, abs=1e-9)


def test_cutoff_just_above_the_distance_finds_it_and_just_below_does_not(rng, bar, plate):
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    for T in _random_poses(rng, 20, 60.0):
        value = compute_distance(a, b, T).value
        if value == 0.0:
            continue
        assert compute_distance(a, b, T, cutoff=value + 1e-6).value == pytest.approx(value, abs=1e-9)
        below = compute_distance(a, b, T, cutoff=value - 1e-6)
        assert below.value == value - 1e-6
        assert below.point_a is None


def test_scan_gives_the_least_of_all_poses_and_every_distance_below_need(rng, bar, plate):
    Ts = _random_poses(rng, 150, 45.0)
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    each = np.array([compute_distance(a, b, T).value for T in Ts])
    apart = Ts[each > 0.0]
    each = each[each > 0.0]
    need = float(np.quantile(each, 0.3))
    for share in (0.0, 0.05):
        scan = scan_poses(a, b, apart, need=need, share=share)
        assert scan.value == pytest.approx(each.min(), abs=1e-8)
        assert each[scan.pose] == pytest.approx(each.min(), abs=1e-8)
        np.testing.assert_array_equal(scan.values < need, each < need)
        np.testing.assert_allclose(scan.values[each < need], each[each < need], atol=1e-8)
    rough = scan_poses(a, b, apart, need=0.0, share=0.2)
    assert each.min() - 1e-9 <= rough.value <= each.min() / 0.8


def test_warm_witness_changes_nothing_but_the_way_there(rng, bar, plate):
    a, b = build_tree(plate.triangles), build_tree(bar.triangles)
    T = _random_poses(rng, 1, 60.0)[0]
    cold = compute_distance(a, b, T)
    nudge = T.copy()
    nudge[:3, 3] += 0.3
    assert compute_distance(a, b, nudge, warm=cold.witness).value == pytest.approx(
        compute_distance(a, b, nudge).value, abs=1e-9
    )


def test_parallel_plates_are_at_their_gap(bar):
    tree = build_tree(bar.triangles)
    T = np.eye(4)
    T[2, 3] = 6.0 + 0.37
    assert compute_distance(tree, tree, T).value == pytest.approx(0.37, abs=1e-9)


def test_pieces_tile_their_triangles_and_boxes_hold_them(plate):
    tree = build_tree(plate.triangles, max_edge=3.0)
    pieces = tree.pieces.reshape(-1, 3, 3)
    areas = 0.5 * np.linalg.norm(np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0]), axis=1)
    np.testing.assert_allclose(np.bincount(tree.sources, areas, len(plate.faces)), plate.area_faces, atol=1e-9)
    assert max(np.linalg.norm(pieces[:, k] - pieces[:, k - 1], axis=1).max() for k in range(3)) <= 3.0
    for node, (_, first, count) in zip(tree.nodes, tree.links, strict=True):
        local = (tree.pieces[first : first + count].reshape(-1, 3) - node[:3]) @ node[7:].reshape(3, 3).T
        assert (np.abs(local) <= node[4:7] + 1e-9).all()
        assert np.linalg.norm(local, axis=1).max() <= node[3] + 1e-9


def test_tree_survives_its_bytes(bar):
    tree = build_tree(bar.triangles, np.arange(len(bar.faces)) % 5)
    again = ContactTree.from_bytes(tree.to_bytes())
    for name in ("nodes", "links", "pieces", "groups", "sources"):
        np.testing.assert_array_equal(getattr(tree, name), getattr(again, name))


def test_a_surface_without_triangles_or_with_a_hole_in_its_numbers_is_refused():
    with pytest.raises(BuildError, match="no triangles"):
        build_tree(np.zeros((0, 3, 3)))
    with pytest.raises(BuildError, match="not finite"):
        build_tree(np.full((1, 3, 3), np.nan))


def test_node_bits_are_those_that_all_pieces_share(plate):
    tree = build_tree(plate.triangles, np.arange(len(plate.faces)) % 3)
    of_node, of_piece = group_bits(tree, np.array([1, 3, 5], dtype=np.uint8))
    for bits, (_, first, count) in zip(of_node, tree.links, strict=True):
        assert bits == np.bitwise_and.reduce(of_piece[first : first + count])
    assert of_node[0] == 1


# A ball of radius 10 with a neck of radius 3 in a socket of radius 10.05 whose rim has radius 9.2 at height 6.
_RIM = math.hypot(9.2, 6.0)
TILT_LIMIT = math.degrees(math.atan2(9.2, 6.0) - math.asin(3.0 / _RIM))


def _revolve(profile):
    return trimesh.creation.revolve(np.array(profile), sections=360)


@pytest.fixture(scope="module")
def ball_joint():
    """Trees of ball bar and socket, and for each whether its group 1 is the mating sphere."""
    turn = np.linspace(-math.pi / 2, math.acos(3.0 / 10.0), 120)
    ball = _revolve([(10.0 * math.cos(t), 10.0 * math.sin(t)) for t in turn] + [(3.0, 40.0), (0.0, 40.0)])
    turn = np.linspace(math.asin(4.0 / 10.05), -math.pi / 2, 120)
    seat = [(10.05 * math.cos(t), 10.05 * math.sin(t)) for t in turn]
    socket = _revolve([(0.0, -14.0), (16.0, -14.0), (16.0, 6.0), (9.2, 6.0), *seat])
    trees = []
    for mesh, radius in ((ball, 10.0), (socket, 10.05)):
        on_sphere = (np.abs(np.linalg.norm(mesh.triangles, axis=2) - radius) < 1e-6).all(axis=1)
        assert 1000 < on_sphere.sum() < len(mesh.faces)
        trees.append(build_tree(mesh.triangles, on_sphere.astype(np.int32)))
    return trees


def _first_tilt(ball, socket, need, exempt_ball, exempt_socket):
    """The tilt from which on the two are nearer than need [deg]: 0 at once, 60 never."""

    def is_near(tilt):
        T = np.eye(4)
        T[:3, :3] = rotation_about(np.array([1.0, 0.0, 0.0]), math.radians(tilt))
        return compute_distance(socket, ball, T, cutoff=need, exempt_a=exempt_socket, exempt_b=exempt_ball).value < need

    low, high = 0.0, 60.0
    if is_near(low):
        return low
    while is_near(high) and high - low > 0.005:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_near(middle) else (middle, high)
    return high


NONE_MATE, SPHERE_MATES, ALL_MATE = (np.array(bits, dtype=np.uint8) for bits in ([0, 0], [0, 1], [1, 1]))


def test_neck_meets_rim_at_the_closed_form_tilt_if_the_ball_alone_is_exempt(ball_joint):
    assert pytest.approx(41.04, abs=0.005) == TILT_LIMIT
    assert _first_tilt(*ball_joint, 1e-6, SPHERE_MATES, ALL_MATE) == pytest.approx(TILT_LIMIT, abs=0.02)
    assert _first_tilt(*ball_joint, 1e-6, SPHERE_MATES, SPHERE_MATES) == pytest.approx(TILT_LIMIT, abs=0.02)
    # The neck is near the rim earlier by the angle under which the rim, seen from the centre, is 0.1 mm off it.
    early = math.degrees(math.asin(3.1 / _RIM) - math.asin(3.0 / _RIM))
    assert _first_tilt(*ball_joint, 0.1, SPHERE_MATES, ALL_MATE) == pytest.approx(TILT_LIMIT - early, abs=0.02)


def test_wrong_exemptions_raise_false_alarms_or_miss_the_contact(ball_joint):
    assert _first_tilt(*ball_joint, 0.1, NONE_MATE, NONE_MATE) == 0.0
    assert _first_tilt(*ball_joint, 0.1, SPHERE_MATES, NONE_MATE) == 0.0
    assert _first_tilt(*ball_joint, 0.1, SPHERE_MATES, 2 * SPHERE_MATES) == 0.0, "different joints' bits do not pair"
    assert _first_tilt(*ball_joint, 0.1, ALL_MATE, ALL_MATE) == 60.0


def test_crossings_name_the_faces_that_cross_and_only_those():
    box = trimesh.creation.box((2.0, 2.0, 2.0))
    side = np.argmax(np.abs(box.face_normals), axis=1) * 2 + (box.face_normals.max(axis=1) > 0.5)
    tree = build_tree(box.triangles, side)
    T = np.eye(4)
    T[0, 3] = 1.5
    T[1, 3] = T[2, 3] = 0.1
    crossing = {tuple(pair) for pair in find_crossings(tree, tree, T).tolist()}
    # B's -x side enters A through A's +y and +z sides; A's +x side meets B's -y and -z sides; and y against z.
    assert crossing == {(3, 0), (5, 0), (1, 2), (1, 4), (3, 4), (5, 2)}
    T[0, 3] = 2.5
    assert len(find_crossings(tree, tree, T)) == 0

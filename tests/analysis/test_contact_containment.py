"""Inside and outside: rays against winding numbers and closed forms, at the awkward points on purpose."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from linkwright.analysis.contact.containment import compute_anchor, compute_winding_numbers, find_inside, is_inside
from linkwright.analysis.contact.tree import build_tree


def test_points_inside_a_box_are_known_even_in_line_with_its_edges_and_corners():
    tree = build_tree(trimesh.creation.box((20.0, 20.0, 20.0)).triangles)
    grid = np.stack(np.meshgrid(*[np.arange(-12.0, 13.0, 2.0)] * 3), axis=-1).reshape(-1, 3)
    off_surface = np.abs(np.abs(grid).max(axis=1) - 10.0) > 1e-9
    inside = is_inside(tree, grid[off_surface])
    np.testing.assert_array_equal(inside, np.abs(grid[off_surface]).max(axis=1) < 10.0)
    assert 0 < inside.sum() < len(inside)


def test_rays_agree_with_winding_numbers_in_a_part_with_holes(rng):
    plate = trimesh.creation.cylinder(25.0, 5.0, sections=90)
    for x in (-12.0, 12.0):
        plate = plate.difference(trimesh.creation.cylinder(4.0, 20.0, sections=40).apply_translation((x, 0.0, 0.0)))
    tree = build_tree(plate.triangles)
    points = rng.uniform(plate.bounds[0] - 2.0, plate.bounds[1] + 2.0, (800, 3))
    winding = compute_winding_numbers(tree, points)
    np.testing.assert_allclose(winding, np.round(winding), atol=1e-9)
    np.testing.assert_array_equal(is_inside(tree, points), winding > 0.5)
    assert not is_inside(tree, np.array([[12.0, 0.0, 0.0]]))[0], "a hole is not inside"


def test_a_cavity_is_outside_and_overlapping_shells_are_inside():
    outer, inner = trimesh.creation.icosphere(3, 10.0), trimesh.creation.icosphere(3, 5.0)
    hollow = build_tree(np.concatenate([outer.triangles, inner.triangles[:, ::-1]]))
    np.testing.assert_array_equal(is_inside(hollow, np.array([[0.0, 0.0, 0.0], [7.0, 0.0, 0.0]])), [False, True])
    double = build_tree(np.concatenate([outer.triangles, inner.triangles]))
    np.testing.assert_allclose(compute_winding_numbers(double, np.zeros((1, 3))), 2.0, atol=1e-9)
    assert is_inside(double, np.zeros((1, 3)))[0]


@pytest.mark.parametrize(
    ("mesh", "deepest"),
    [
        (trimesh.creation.annulus(4.0, 5.0, 10.0), 0.5),
        (trimesh.creation.box((100.0, 20.0, 1.0)), 0.5),
        (trimesh.creation.icosphere(3, 8.0), 8.0),
        (trimesh.creation.cylinder(2.0, 60.0), 2.0),
    ],
    ids=["bushing", "sheet", "ball", "pin"],
)
def test_anchor_lies_at_least_half_as_deep_inside_as_possible(mesh, deepest):
    point, depth = compute_anchor(build_tree(mesh.triangles, max_edge=np.inf))
    assert trimesh.proximity.closest_point_naive(mesh, [point])[1][0] == pytest.approx(depth, abs=1e-9)
    assert compute_winding_numbers(build_tree(mesh.triangles), point[None])[0] == pytest.approx(1.0, abs=1e-9)
    assert 0.5 * deepest < depth <= deepest


def test_a_surface_that_looks_inwards_has_no_anchor():
    mesh = trimesh.creation.box((4.0, 4.0, 4.0))
    assert compute_anchor(build_tree(mesh.triangles[:, ::-1]))[1] < 0.0


def test_find_inside_names_the_point_at_each_pose():
    tree = build_tree(trimesh.creation.box((10.0, 10.0, 10.0)).triangles)
    points = np.array([[100.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.0, 0.0]])
    Ts = np.tile(np.eye(4), (4, 1, 1))
    Ts[1, 0, 3], Ts[2, 0, 3], Ts[3, 0, 3] = 30.0, -99.0, -5.3
    np.testing.assert_array_equal(find_inside(tree, points, Ts), [1, -1, 0, 2])

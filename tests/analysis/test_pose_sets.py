"""Rings, grids and rays hold what their names say, and hand out the poses they count."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.analysis.pose_sets import (
    PoseSet,
    count_rings,
    count_tilts,
    grid_positions,
    pen_turns,
    plate_turns,
    ray_positions,
    ring_tilts,
    sphere_directions,
)
from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.poses import pose_from_task, rotation_about

DEG = math.pi / 180.0


def rotations(turns):
    return pose_from_task(np.concatenate([np.zeros_like(turns), turns], axis=-1))[:, :3, :3]


def test_rings_hold_as_many_tilts_as_they_count():
    for bound in (30.0 * DEG, 45.0 * DEG, 90.0 * DEG):
        for n in range(1, 9):
            tilts = ring_tilts(bound, n)
            assert len(tilts) == count_tilts(bound, n)
            assert tilts[:, 0].max() == pytest.approx(bound)
            assert tilts[0] == pytest.approx([0.0, 0.0])


def test_the_count_keeps_the_rounding_of_plain_doubles():
    """Exact arithmetic gives 35 tilts at 45 degrees and 3 rings, 169 at 30 degrees and 7: the floor loses one."""
    assert (count_tilts(45.0 * DEG, 3), count_tilts(30.0 * DEG, 7)) == (34, 168)


def test_the_least_number_of_rings_is_found():
    for wanted in (1, 6, 7, 600, 617, 618):
        n = count_rings(45.0 * DEG, wanted)
        assert count_tilts(45.0 * DEG, n) >= wanted
        assert n == 1 or count_tilts(45.0 * DEG, n - 1) < wanted


def test_a_pen_points_where_its_tilt_says_and_its_x_stays_level():
    tilts = ring_tilts(45.0 * DEG, 5)
    Q = rotations(pen_turns(tilts))
    t1, t2 = tilts.T
    want = [
        rotation_about(np.array([math.cos(b), 0.0, math.sin(b)]), a) @ [0.0, 1.0, 0.0]
        for a, b in zip(t1, t2, strict=True)
    ]
    assert np.abs(Q[..., 1] - want).max() < 1e-14
    assert np.abs(Q[:, 2, 0]).max() < 1e-15


def test_a_plate_is_turned_about_an_axis_in_its_plane_by_the_tilt():
    tilts = ring_tilts(60.0 * DEG, 4)
    Q = rotations(plate_turns(tilts))
    assert np.abs(Q[:, 2, 2] - np.cos(tilts[:, 0])).max() < 1e-14
    axes = np.stack([np.cos(tilts[:, 1]), np.sin(tilts[:, 1]), np.zeros(len(tilts))], axis=-1)
    assert np.abs(np.einsum("nij,nj->ni", Q, axes) - axes).max() < 1e-14


@pytest.mark.parametrize(("make", "k"), [(pen_turns, 1), (plate_turns, 2)])
def test_a_roll_leaves_the_tool_where_it_points_and_turns_by_its_angle(make, k):
    tilts, rolls = ring_tilts(30.0 * DEG, 3), np.array([-20.0, 0.0, 35.0]) * DEG
    level, rolled = rotations(make(tilts)), rotations(make(tilts, rolls)).reshape(len(tilts), 3, 3, 3)
    assert np.abs(rolled[..., k] - level[:, None, :, k]).max() < 1e-14
    relative = np.einsum("nji,nmjk->nmik", level, rolled)
    cosines = (np.trace(relative, axis1=2, axis2=3) - 1.0) / 2.0
    assert np.abs(cosines - np.cos(rolls)).max() < 1e-14


def test_a_grid_has_its_ends_on_the_box_and_a_single_place_in_its_middle():
    grid = grid_positions((0.0, -5.0, 10.0), (8.0, 5.0, 20.0), (17, 11, 1))
    assert len(grid) == 17 * 11
    assert grid.min(axis=0) == pytest.approx([0.0, -5.0, 15.0])
    assert grid.max(axis=0) == pytest.approx([8.0, 5.0, 15.0])
    assert np.unique(np.diff(np.unique(grid[:, 0]))) == pytest.approx(0.5)


def test_rays_go_outwards_in_equal_steps_in_all_directions():
    directions = sphere_directions(6)
    assert np.abs(np.linalg.norm(directions, axis=1) - 1.0).max() < 1e-15
    assert np.abs(directions.mean(axis=0)).max() < 0.05
    # No point of the sphere is far from a direction: the rings lie 30 degrees apart.
    rng = np.random.default_rng(20041)
    points = rng.normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    assert np.degrees(np.arccos((points @ directions.T).max(axis=1))).max() < 30.0
    rays = ray_positions((1.0, 2.0, 3.0), directions, 2.0, 5).reshape(len(directions), 5, 3)
    away = np.linalg.norm(rays - np.array([1.0, 2.0, 3.0]), axis=-1)
    assert np.abs(away - [2.0, 4.0, 6.0, 8.0, 10.0]).max() < 1e-12


def test_blocks_hold_every_pose_once_and_in_the_order_of_its_number(rng):
    poses = PoseSet(positions=rng.normal(size=(23, 3)), turns=rng.normal(size=(7, 2)))
    whole = poses.poses()
    assert whole.shape == (len(poses), 5)
    for n in (1, 7, 20, 1000):
        blocks = [poses.poses(first, last) for first, last in poses.blocks(n)]
        assert (np.concatenate(blocks) == whole).all()
        assert max(len(b) for b in blocks) <= max(n, 7)
    assert (np.stack([poses.pose(k) for k in range(len(poses))]) == whole).all()


def test_an_empty_set_is_refused():
    with pytest.raises(VacuousCheckError, match="positions"):
        PoseSet(positions=np.zeros((0, 3)), turns=np.zeros((1, 2)))
    with pytest.raises(VacuousCheckError, match="turns"):
        PoseSet(positions=np.zeros((1, 3)), turns=np.zeros((0, 2)))
    with pytest.raises(VacuousCheckError, match="rings"):
        ring_tilts(0.0, 3)
    with pytest.raises(VacuousCheckError, match="rings"):
        ring_tilts(1.0, 0)

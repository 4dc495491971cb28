"""The poses that checks visit."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from linkwright.analysis.sampling import sample_box
from linkwright.designs.language.errors import VacuousCheckError

LOWER, UPPER = np.array([-3.0, 0.1, 5.0]), np.array([-1.0, 0.7, 5.5])


def _on_bound(poses):
    return (poses == LOWER) | (poses == UPPER)


@pytest.mark.parametrize("n", [1, 2, 3, 17, 1000])
def test_sample_has_exactly_n_poses_all_in_the_box(n):
    poses = sample_box(LOWER, UPPER, n, 1)
    assert poses.shape == (n, 3)
    assert ((poses >= LOWER) & (poses <= UPPER)).all()


def test_half_of_the_poses_is_inside_and_half_on_the_border_with_every_corner():
    poses = sample_box(LOWER, UPPER, 1000, 1)
    n_bounds = _on_bound(poses).sum(axis=1)
    assert (n_bounds == 0).sum() == 500
    for k in (1, 2, 3):
        assert (n_bounds == k).sum() > 100
    found = {tuple(p) for p in poses}
    assert all(corner in found for corner in itertools.product(*zip(LOWER, UPPER, strict=True)))
    assert np.abs(poses[:500].mean(axis=0) - (LOWER + UPPER) / 2).max() < 0.1


def test_the_same_seed_gives_the_same_poses_and_another_seed_others():
    np.testing.assert_array_equal(sample_box(LOWER, UPPER, 50, 7), sample_box(LOWER, UPPER, 50, 7))
    assert (sample_box(LOWER, UPPER, 50, 7) != sample_box(LOWER, UPPER, 50, 8)).any()


def test_a_coordinate_whose_bounds_agree_stays_there():
    poses = sample_box(np.array([0.0, 0.3]), np.array([1.0, 0.3]), 100, 1)
    assert (poses[:, 1] == 0.3).all()


@pytest.mark.parametrize(
    ("lower", "upper", "n", "message"),
    [
        ([0.0], [1.0], 0, "0 poses"),
        ([0.0, 2.0], [1.0, 1.0], 5, "coordinate 1"),
        ([], [], 5, "shapes"),
        ([0.0], [np.nan], 5, "empty"),
        ([0.0, 0.0], [1.0], 5, "shapes"),
    ],
)
def test_a_sample_of_nothing_is_refused(lower, upper, n, message):
    with pytest.raises(VacuousCheckError, match=message):
        sample_box(np.array(lower), np.array(upper), n, 1)

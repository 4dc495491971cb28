"""PATHOS-II as it is shipped: its workspace, its one assembly, and what it refuses."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from linkwright.designs.language.errors import ParameterError
from linkwright.designs.pathos2.mechanism import Pathos2
from linkwright.designs.pathos2.parameters import PathosLimits, PathosParameters
from linkwright.designs.pathos2.workspace import PATHOS2_WORKSPACE

DEG = math.pi / 180.0


@pytest.fixture(scope="module")
def pathos():
    return Pathos2({})


def test_every_corner_and_face_of_the_declared_workspace_is_reachable(pathos, rng):
    lower, upper = np.array(PATHOS2_WORKSPACE.lower), np.array(PATHOS2_WORKSPACE.upper)
    grid = np.array(list(itertools.product(*zip(lower, (lower + upper) / 2.0, upper, strict=True))))
    inside = np.concatenate([grid, rng.uniform(lower, upper, (5000, 7)), pathos.home[None]])
    inverse = pathos.solve_inverse(inside)
    assert inverse.is_reachable.all(), inverse.reason(int(np.argmin(inverse.is_reachable)))
    corner = np.where(np.arange(7) < 3, upper + 40.0, upper)
    assert not pathos.solve_inverse(corner[None]).is_reachable[0]


@pytest.mark.parametrize(
    "parameters",
    [
        PathosParameters(),
        PathosParameters(home_turn=15.0 * DEG),
        PathosParameters(globular_tilt=20.0 * DEG),
        PathosParameters(base_distance=470.0, middle_link_length=145.0, plate_radius=25.0),
    ],
)
def test_forward_finds_one_assembly_for_every_reachable_set_of_motor_angles(parameters, rng):
    pathos = Pathos2({"parameters": parameters})
    half = np.array([80.0, 80.0, 80.0, 0.5, 0.5, 0.9])
    drawn = pathos.home + np.column_stack([rng.uniform(-half, half, (60000, 6)), rng.uniform(-20.0, 5.0, 60000)])
    poses = drawn[pathos.solve_inverse(drawn).is_reachable][:1000]
    assert len(poses) > 500
    forward = pathos.solve_forward(pathos.solve_inverse(poses).joints[:, :7])
    assert forward.is_solved.all()
    assert np.all(forward.n_candidates == 1)
    assert np.abs(forward.poses - poses).max() < 1e-9


def test_beyond_the_parallel_singularity_a_pose_is_refused_by_name(pathos):
    """At Rz = 60 degrees the six forces cannot turn the platform."""
    pose = np.array([0.0, 0.0, 225.0, 0.0, 0.0, 60.0 * DEG, 70.0])
    inverse = pathos.solve_inverse(pose[None])
    assert not inverse.is_reachable[0]
    assert inverse.reason(0) == "parallel singularity"


def test_limits_in_the_wrong_order_are_refused_by_name():
    with pytest.raises(ParameterError, match="theta_3_max_deg"):
        Pathos2({"joint_limits": PathosLimits(theta_3_max=5.0 * DEG)})
    with pytest.raises(ParameterError, match="gap_max_mm"):
        Pathos2({"joint_limits": PathosLimits(gap_max=90.0)})


def test_the_limits_cost_next_to_nothing_of_a_sphere_of_100_mm_at_fixed_orientation(pathos, rng):
    """The reach alone holds 99.7 % of it, and 81 % of a sphere of 120 mm."""
    directions = rng.normal(size=(20000, 3))
    directions *= (rng.uniform(size=20000) ** (1.0 / 3.0) / np.linalg.norm(directions, axis=1))[:, None]
    shares = {}
    for radius in (50.0, 60.0):
        poses = np.tile(pathos.home, (20000, 1))
        poses[:, :3] += radius * directions
        inverse = pathos.solve_inverse(poses)
        legs = [k for k, name in enumerate(inverse.requirements) if name.startswith("leg") and "limit" not in name]
        shares[radius] = np.mean(np.all(inverse.margins[:, legs] >= 0.0, axis=-1)), np.mean(inverse.is_reachable)
    assert shares[50.0][0] == pytest.approx(0.997, abs=0.002)
    assert shares[50.0][0] - shares[50.0][1] < 0.005
    assert shares[60.0][0] == pytest.approx(0.81, abs=0.01)

"""Zhang, Kong, Sun, Du: Design and Analysis of a Novel Haptic Device. Each erratum with the test that shows it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.designs.chains.tripod import DELTAS, close_loops, plate_pose
from linkwright.designs.hit.mechanism import Hit
from linkwright.designs.hit.parameters import HIT_REFERENCE, HitParameters
from linkwright.designs.language.poses import pose_from_task, rotation_about
from linkwright.designs.language.vectors import rot_fixed_xyz

DEG = math.pi / 180.0
X, Y, Z = np.eye(3)
POSE = np.array([30.0, -20.0, 260.0, 10.0 * DEG, -15.0 * DEG, 20.0 * DEG])


@pytest.fixture(scope="module")
def hit():
    return Hit({"parameters": HIT_REFERENCE})


def _step(R=None, p=(0.0, 0.0, 0.0)):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.eye(3) if R is None else R, p
    return T


def _wide_poses(hit, rng, n):
    lower = [-260.0, -230.0, 100.0, -0.7, -0.7, -1.0]
    poses = rng.uniform(lower, [260.0, 230.0, 360.0, 0.7, 0.7, 1.0], (40 * n, 6))
    return poses[hit.solve_inverse(poses).is_reachable][:n]


def test_equation_3_is_the_product_of_three_turns_and_not_as_printed():
    phi, theta, psi = 0.3, -0.5, 0.9
    Q = rot_fixed_xyz(phi, theta, psi)
    want = rotation_about(Z, psi) @ rotation_about(Y, theta) @ rotation_about(X, phi)
    got = np.stack([Q.x.array(), Q.y.array(), Q.z.array()], axis=-1)
    assert np.abs(got - want).max() < 1e-15
    # Printed in row 1, column 2: S_theta where S_psi belongs.
    printed = math.cos(psi) * math.sin(theta) * math.sin(phi) - math.sin(theta) * math.cos(phi)
    assert abs(printed - want[0, 1]) > 0.1


def test_the_reference_pose_gives_the_reference_angles(hit):
    inverse = hit.solve_inverse(np.array([[0.0, 0.0, 250.0, 0.0, 0.0, 0.0], POSE]))
    assert inverse.is_reachable.all()
    names = [j.name for j in hit.joints]
    degrees = {name: np.degrees(inverse.joints[:, k]) for k, name in enumerate(names)}
    assert degrees["leg_1_theta_1"][0] == pytest.approx(135.572996, abs=5e-7)
    assert degrees["leg_1_theta_2"][0] == pytest.approx(44.427004, abs=5e-7)
    for leg, alpha, t1, t2 in (
        (1, 3.935219, 119.912982, 52.582441),
        (2, -8.680571, 124.935201, 42.742895),
        (3, -2.481656, 115.027676, 21.135649),
    ):
        assert degrees[f"leg_{leg}_pin"][1] == pytest.approx(alpha, abs=5e-7)
        assert degrees[f"leg_{leg}_theta_1"][1] == pytest.approx(t1, abs=5e-7)
        assert degrees[f"leg_{leg}_theta_2"][1] == pytest.approx(t2, abs=5e-7)


def _chain_ball(p, delta, alpha, first, second):
    T = _step(rotation_about(Z, delta)) @ _step(p=(p.base_radius, 0, 0)) @ _step(rotation_about(Y, alpha))
    T = T @ _step(p=(0, 0, p.chain_height)) @ _step(rotation_about(X, first)) @ _step(p=(0, 0, p.lower_link_length))
    return (T @ _step(rotation_about(X, second)) @ _step(p=(0, 0, p.upper_link_length)))[:3, 3]


def test_equation_4_reaches_the_ball_with_the_quarter_turn_on_the_first_joint(hit):
    joints = hit.solve_inverse(POSE[None]).joints[0]
    values = {j.name: joints[k] for k, j in enumerate(hit.joints)}
    T = pose_from_task(POSE)
    for i, delta in enumerate(DELTAS):
        want = T[:3, :3] @ rotation_about(Z, delta) @ (hit.parameters.platform_radius * X) + T[:3, 3]
        alpha, t1, t2 = (values[f"leg_{i + 1}_{n}"] for n in ("pin", "theta_1", "theta_2"))
        used = _chain_ball(hit.parameters, delta, alpha, t1 - math.pi / 2, t2 - t1)
        assert np.linalg.norm(used - want) < 1e-9
        printed = _chain_ball(hit.parameters, delta, alpha, t1, t2 - t1 - math.pi / 2)
        assert np.linalg.norm(printed - want) > 100.0


def test_printed_equations_9_and_10_are_not_angles_of_the_leg(hit):
    """|FD|^2 has a plus sign, and the cosine law needs its arccos with L2 and L3."""
    p, joints = hit.parameters, hit.solve_inverse(POSE[None]).joints[0]
    t1, t2 = joints[0], joints[1]
    y = p.lower_link_length * math.cos(t1) + p.upper_link_length * math.cos(t2)
    w = p.lower_link_length * math.sin(t1) + p.upper_link_length * math.sin(t2)
    d = math.hypot(w, y)
    assert math.acos(d / (2.0 * p.lower_link_length)) == pytest.approx((t1 - t2) / 2.0, abs=1e-12)
    assert abs(w * w - y * y - d * d) > 1.0


def test_equation_14_as_printed_turns_the_platform_upside_down():
    T = pose_from_task(POSE)
    F = np.stack([T[:3, :3] @ rotation_about(Z, d) @ (110.0 * X) + T[:3, 3] for d in DELTAS])[None]
    R, origin = plate_pose(F)
    assert np.abs(R[0] - T[:3, :3]).max() < 1e-12
    assert np.abs(origin[0] - T[:3, 3]).max() < 1e-12
    n = R[0][:, 0]
    printed = np.cross(n, (F[0, 2] - F[0, 1]) / np.linalg.norm(F[0, 2] - F[0, 1]))
    assert printed @ T[:3, 2] < -0.99


def test_the_jacobian_at_home_has_the_reference_rows(hit):
    J = hit.compute_jacobian(np.array([[0.0, 0.0, 250.0, 0.0, 0.0, 0.0]]))[0] * np.array([1e3] * 3 + [1.0] * 3)
    assert np.abs(J[0] - [0, -4.7619, -4.6676, 0, 0.5134, -0.5238]).max() < 5e-5
    assert np.abs(J[1] - [0, -4.7619, 4.6676, 0, -0.5134, -0.5238]).max() < 5e-5


def test_equation_16_takes_rows_of_the_inverse_not_columns(hit, rng):
    """Influence coefficients: serial chain C-D-E-F per leg; second row, and second plus third, of its inverse."""
    for pose in _wide_poses(hit, rng, 20):
        J = hit.compute_jacobian(pose[None])[0]
        Ts = hit.place_bodies(pose[None])[0]
        index = {b.name: k for k, b in enumerate(hit.bodies)}
        for i, delta in enumerate(DELTAS):
            frame, lower = Ts[index[f"leg_{i + 1}_frame"]], Ts[index[f"leg_{i + 1}_lower_left"]]
            ball = pose_from_task(pose)
            F = ball[:3, :3] @ rotation_about(Z, delta) @ (hit.parameters.platform_radius * X) + ball[:3, 3]
            E = F - hit.parameters.upper_link_length * Ts[index[f"leg_{i + 1}_upper_left"]][:3, 0]
            D = E - hit.parameters.lower_link_length * lower[:3, 0]
            screws = [(frame[:3, 1], frame[:3, 3]), (frame[:3, 0], D), (frame[:3, 0], E), (X, F), (Y, F), (Z, F)]
            serial = np.stack([np.concatenate([np.cross(s, pose[:3] - o), s]) for s, o in screws], axis=1)
            G = np.linalg.inv(serial)
            rows = np.stack([G[1], G[1] + G[2]])
            scale = np.abs(J[2 * i : 2 * i + 2]).max()
            assert np.abs(rows - J[2 * i : 2 * i + 2]).max() < 1e-9 * max(scale, 1.0)
            columns = np.stack([G[:, 1], G[:, 1] + G[:, 2]])
            assert np.abs(columns - J[2 * i : 2 * i + 2]).max() > 1e-3


def test_a_cold_start_from_zero_lean_misses_some_poses_and_the_solver_none(hit, rng):
    poses = _wide_poses(hit, rng, 1500)
    joints = hit.solve_inverse(poses).joints
    y = np.stack([150.0 * (np.cos(joints[:, 2 * i]) + np.cos(joints[:, 2 * i + 1])) for i in range(3)], -1)
    w = np.stack([150.0 * (np.sin(joints[:, 2 * i]) + np.sin(joints[:, 2 * i + 1])) for i in range(3)], -1)
    alphas, _, _ = close_loops(y, w + hit.parameters.chain_height, 110.0, 110.0, np.zeros((len(poses), 3)))
    true = np.stack([joints[:, [j.name for j in hit.joints].index(f"leg_{i}_pin")] for i in (1, 2, 3)], -1)
    missed = np.mean(np.abs(alphas - true).max(axis=1) > 1e-6)
    assert 0.001 < missed < 0.15
    forward = hit.solve_forward(joints[:, :6])
    assert forward.is_solved.all()
    assert np.abs(forward.poses - poses).max() < 1e-9


def test_equal_radii_make_the_workspace_sixfold_symmetric(rng):
    """R = r: turning a position by 60 degrees at zero orientation keeps it feasible or not; R != r breaks that."""
    for p, symmetric in ((HIT_REFERENCE, True), (HitParameters(base_radius=130.0, platform_radius=90.0), False)):
        hit = Hit({"parameters": p})
        poses = np.zeros((4000, 6))
        poses[:, :3] = rng.uniform([-260, -260, 110], [260, 260, 360], (4000, 3))
        turned = poses.copy()
        turned[:, :3] = poses[:, :3] @ rotation_about(Z, math.pi / 3.0).T
        here, there = hit.solve_inverse(poses).is_reachable, hit.solve_inverse(turned).is_reachable
        assert 200 < here.sum() < 3800
        assert bool(np.array_equal(here, there)) is symmetric


def test_the_cone_angle_at_zero_orientation_is_the_lean_of_the_leg(hit):
    pose = np.array([[60.0, 30.0, 240.0, 0.0, 0.0, 0.0]])
    values = {j.name: v for j, v in zip(hit.joints, hit.solve_inverse(pose).joints[0], strict=True)}
    for leg in (1, 2, 3):
        assert values[f"leg_{leg}_ball"] == pytest.approx(abs(values[f"leg_{leg}_pin"]), abs=1e-7)


def test_every_branch_closes_its_loops_and_the_working_one_is_named(hit):
    assert hit.branches[0] == "up-out"
    low = POSE - np.array([0.0, 0.0, 60.0, 0.0, 0.0, 0.0])  # the folded-down legs reach no higher
    seen = []
    for branch in (*hit.branches, "up-out/up-in/down-out"):
        joints = hit.solve_inverse(low[None], branch).joints[0]
        values = {j.name: v for j, v in zip(hit.joints, joints, strict=True)}
        T = pose_from_task(low)
        for i, delta in enumerate(DELTAS):
            want = T[:3, :3] @ rotation_about(Z, delta) @ (110.0 * X) + T[:3, 3]
            alpha, t1, t2 = (values[f"leg_{i + 1}_{n}"] for n in ("pin", "theta_1", "theta_2"))
            assert np.linalg.norm(_chain_ball(hit.parameters, delta, alpha, t1 - math.pi / 2, t2 - t1) - want) < 1e-9
        seen.append(tuple(np.round(joints[:6], 6)))
    assert len(set(seen)) == 5


def test_a_kite_with_unequal_links_solves_both_ways(rng):
    hit = Hit({"parameters": HitParameters(lower_link_length=140.0, upper_link_length=160.0)})
    poses = _wide_poses(hit, rng, 300)
    forward = hit.solve_forward(hit.solve_inverse(poses).joints[:, :6])
    assert forward.is_solved.mean() > 0.99
    assert np.abs(forward.poses - poses)[forward.is_solved].max() < 1e-9

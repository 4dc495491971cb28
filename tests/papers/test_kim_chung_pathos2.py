"""Kim, Chung: Design and Analysis of a New 7-DOF Parallel Type Haptic Device, PATHOS-II: kinematics and errata."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from linkwright.designs.language.errors import UnknownNameError
from linkwright.designs.language.joints import JointKind
from linkwright.designs.language.poses import pose_from_task, rotation_about
from linkwright.designs.language.vectors import vec_from_array
from linkwright.designs.language.vocabulary import Requirements
from linkwright.designs.pathos2.closure import platform_from_globes
from linkwright.designs.pathos2.mechanism import Pathos2
from linkwright.designs.pathos2.parameters import PathosParameters

DEG = math.pi / 180.0
X, Y, Z = np.eye(3)
TURNS = tuple(120.0 * DEG * k for k in (0, 1, 2, 0, 1, 2))


@pytest.fixture(scope="module")
def pathos():
    return Pathos2({})


@pytest.fixture
def poses(pathos, rng):
    """Reachable poses from all of the working region, grip between 50 and 75 mm."""
    half = np.array([80.0, 80.0, 80.0, 0.5, 0.5, 0.7])
    drawn = pathos.home + np.column_stack([rng.uniform(-half, half, (40000, 6)), rng.uniform(-20.0, 5.0, 40000)])
    kept = drawn[pathos.solve_inverse(drawn).is_reachable]
    assert len(kept) > 500
    return kept[:500]


def _values(pathos, pose):
    joints = pathos.solve_inverse(np.asarray(pose)[None])
    assert joints.is_reachable[0], joints.reason(0)
    return {j.name: v for j, v in zip(pathos.joints, joints.joints[0], strict=True)}


def _shift(axis, length):
    T = np.eye(4)
    T[:3, 3] = length * axis
    return T


def _turn(axis, angle):
    T = np.eye(4)
    T[:3, :3] = rotation_about(axis, angle)
    return T


def _product(*steps):
    T = np.eye(4)
    for step in steps:
        T = T @ step
    return T


def _base(p, i, shift_up=None):
    """First brace of eq. (1)."""
    low = i < 3
    return _product(
        _shift(Z, 0.0 if low else p.base_distance),
        _turn(X, 0.0 if low else math.pi),
        _turn(Z, TURNS[i]),
        _shift(Z, p.base_radius * math.tan(p.motor_tilt) if shift_up is None else shift_up),
        _turn(Y, p.motor_tilt),
        _shift(X, p.base_radius / math.cos(p.motor_tilt)),
    )


def _platform(p, h_0, i):
    """Last brace of eq. (1)."""
    return _product(
        _turn(X, 0.0 if i < 3 else math.pi),
        _shift(Z, -h_0),
        _turn(Z, TURNS[i]),
        _shift(X, p.plate_radius),
        _turn(Y, p.globular_tilt),
    )


def _chain(p, h_0, i, q, last_axis=Z):
    """Eq. (1), with the globular joint's last axis as asked for."""
    return _product(
        _base(p, i),
        _turn(Z, q[0]),
        _shift(Z, p.lower_link_length),
        _turn(Y, q[1]),
        _shift(Z, p.middle_link_length),
        _turn(X, q[2]),
        _shift(Z, p.upper_link_length),
        _turn(Z, q[3]),
        _turn(Y, q[4]),
        _turn(last_axis, q[5]),
        np.linalg.inv(_platform(p, h_0, i)),
    )


def _angles(values, i, n=6):
    return [values[f"leg_{i + 1}_theta_{k}"] for k in range(1, n + 1)]


def test_the_home_pose_gives_the_reference_angles_and_points(pathos):
    values = _values(pathos, pathos.home)
    for i in range(6):
        mirror = 1.0 if i < 3 else -1.0
        want = (-27.50 * mirror, -80.50, 91.17 * mirror)
        assert np.degrees(_angles(values, i, 3)) == pytest.approx(want, abs=5e-3)
        assert math.degrees(values[f"leg_{i + 1}_theta_5"]) == pytest.approx(77.0, abs=0.5)
    assert values["grip"] == pytest.approx(140.0, abs=1e-12)
    Ts = pathos.place_bodies(pathos.home[None])[0]
    index = {b.name: k for k, b in enumerate(pathos.bodies)}
    points = [Ts[index[f"leg_1_{n}"], :3, 3] for n in ("lower_link", "middle_link", "upper_link", "ring")]
    want = [(100.0, 0.0, 0.0), (135.0, 0.0, 60.6), (40.5, 63.8, 141.9), (17.3, 10.0, 155.0)]
    assert np.abs(np.array(points) - want).max() < 0.06
    facing = [Ts[index[f"leg_4_{n}"], :3, 3] for n in ("lower_link", "middle_link", "upper_link", "ring")]
    assert np.abs(np.array(facing) * (1, 1, -1) + (0, 0, 450.0) - points).max() < 1e-9


def test_equation_1_closes_with_a_last_turn_about_z_and_not_as_printed(pathos, poses):
    for pose in poses[:100]:
        values = _values(pathos, pose)
        for i in range(6):
            q = _angles(values, i)
            assert np.abs(_chain(pathos.parameters, pose[6], i, q) - pose_from_task(pose)).max() < 1e-10
            printed = _chain(pathos.parameters, pose[6], i, q, last_axis=X)
            assert np.abs(printed[:3, :3] - pose_from_task(pose)[:3, :3]).max() > 1e-3


def test_the_globular_joint_with_a_tilted_axis_closes_too(rng):
    pathos = Pathos2({"parameters": PathosParameters(globular_tilt=20.0 * DEG)})
    values = _values(pathos, pathos.home)
    for i in range(6):
        T = _chain(pathos.parameters, pathos.home[6], i, _angles(values, i))
        assert np.abs(T - pose_from_task(pathos.home)).max() < 1e-10


def _dyad_point(p, q):
    T = _product(_turn(Z, q[0]), _shift(Z, p.lower_link_length), _turn(Y, q[1]), _shift(Z, p.middle_link_length))
    return (T @ _turn(X, q[2]) @ _shift(Z, p.upper_link_length))[:3, 3]


def _dyad_angles(p, a, c_1x, c_1y):
    """Eqs. (9), (11), (13)."""
    l_2, l_3 = p.middle_link_length, p.upper_link_length
    c_2z = (l_2**2 - l_3**2 + a[0] ** 2 + a[1] ** 2 + (a[2] - p.lower_link_length) ** 2) / (2.0 * l_2)
    return (
        math.atan2(c_1x * a[1] - c_1y * a[0], c_1x * a[0] + c_1y * a[1]),
        math.atan2(math.copysign(1.0, c_2z) * c_1x, math.copysign(1.0, c_2z) * (a[2] - p.lower_link_length)),
        math.atan2(-c_1y, c_2z - l_2),
    ), math.sqrt(l_3**2 - (c_2z - l_2) ** 2)


def test_equation_14_needs_c_1y_in_the_root_and_has_two_elbow_positions_not_four(pathos, poses):
    p = pathos.parameters
    for pose in poses[:100]:
        values = _values(pathos, pose)
        a = _dyad_point(p, _angles(values, 0, 3))
        _, size = _dyad_angles(p, a, 1.0, 1.0)
        elbows = []
        for s_x, s_y in itertools.product((1.0, -1.0), repeat=2):
            q, _ = _dyad_angles(p, a, s_x * math.sqrt(a[0] ** 2 + a[1] ** 2 - size**2), s_y * size)
            assert np.abs(_dyad_point(p, q) - a).max() < 1e-9
            T = _product(_turn(Z, q[0]), _shift(Z, p.lower_link_length), _turn(Y, q[1]))
            elbows.append((T @ _shift(Z, p.middle_link_length))[:3, 3])
        assert np.abs(elbows[0] - elbows[3]).max() < 1e-9
        assert np.abs(elbows[1] - elbows[2]).max() < 1e-9
        assert np.abs(elbows[0] - elbows[1]).max() > 1.0
        printed, _ = _dyad_angles(p, a, -np.linalg.norm(a), -size)
        assert np.abs(_dyad_point(p, printed) - a).max() > 1.0


def test_equation_4_turns_the_second_vector_by_theta_2_and_not_by_theta_3(pathos):
    p, q = pathos.parameters, _angles(_values(pathos, pathos.home), 0, 3)
    c_2 = p.middle_link_length * Z + rotation_about(X, q[2]) @ (p.upper_link_length * Z)
    for turn, closes in ((q[1], True), (q[2], False)):
        c_1 = p.lower_link_length * Z + rotation_about(Y, turn) @ c_2
        miss = np.abs(rotation_about(Z, q[0]) @ c_1 - _dyad_point(p, q)).max()
        assert bool(miss < 1e-9) is closes


def test_table_1_as_printed_lifts_the_motors_off_the_base_plate(pathos):
    p = pathos.parameters
    printed = _base(p, 0, shift_up=p.base_radius / math.sin(p.motor_tilt))[:3, 3]
    assert printed[2] == pytest.approx(142.3, abs=0.05)
    for i in range(6):
        foot = _base(p, i)[:3, 3]
        assert np.hypot(foot[0], foot[1]) == pytest.approx(p.base_radius, abs=1e-9)
        assert foot[2] == pytest.approx(0.0 if i < 3 else p.base_distance, abs=1e-9)
    assert (p.shift_along, p.shift_up) == pytest.approx((115.47, 57.74), abs=5e-3)


def test_both_branches_and_mixed_ones_close_and_unknown_ones_are_named(pathos):
    index = [j.name for j in pathos.joints]
    for branch in (*pathos.branches, "clockwise/" * 3 + "/".join(["counter-clockwise"] * 3)):
        joints = pathos.solve_inverse(pathos.home[None], branch).joints[0]
        values = dict(zip(index, joints, strict=True))
        for i in range(6):
            T = _chain(pathos.parameters, pathos.home[6], i, _angles(values, i))
            assert np.abs(T - pose_from_task(pathos.home)).max() < 1e-10
    with pytest.raises(UnknownNameError):
        pathos.solve_inverse(pathos.home[None], "up")


# Forward kinematics with nine sensors


def _sensors(pathos, poses):
    names = [j.name for j in pathos.joints]
    columns = [names.index(f"leg_{leg}_theta_{k}") for leg in (1, 5, 6) for k in (1, 2, 3)]
    return pathos.solve_inverse(poses).joints[:, columns]


def _globes(poses, p):
    """P_3, P_2, P_1: joints 1, 5, 6."""
    T = pose_from_task(poses[:, :6])
    return [(T @ np.stack([_platform(p, h, i) for h in poses[:, 6]]))[:, :3, 3] for i in (0, 4, 5)]


def test_nine_sensors_give_the_pose_and_the_grip(pathos, poses):
    forward = pathos.solve_forward_from_sensors(_sensors(pathos, poses))
    assert forward.is_solved.all()
    got, want = pose_from_task(forward.poses[:, :6]), pose_from_task(poses[:, :6])
    assert np.abs(got[:, :3, 3] - want[:, :3, 3]).max() < 1e-11
    assert np.abs(got[:, :3, :3] - want[:, :3, :3]).max() < 1e-12
    assert np.abs(forward.poses[:, 6] - poses[:, 6]).max() < 1e-11
    assert forward.residual.max() < 1e-11


def test_both_forward_solutions_agree(pathos, poses):
    motors = pathos.solve_forward(pathos.solve_inverse(poses).joints[:, :7])
    sensors = pathos.solve_forward_from_sensors(_sensors(pathos, poses))
    assert motors.is_solved.all()
    assert np.abs(motors.poses - sensors.poses).max() < 1e-9


def test_equation_19_gives_the_whole_distance_of_the_top_plates(pathos, poses):
    r = pathos.parameters.plate_radius
    P_3, P_2, P_1 = _globes(poses, pathos.parameters)
    for P in (P_1, P_2):
        h = np.sqrt(np.sum((P - P_3) ** 2, axis=-1) - 3.0 * r * r)
        assert np.abs(h - 2.0 * poses[:, 6]).max() < 1e-9


def test_equation_20_has_rank_2_so_that_it_cannot_be_solved(pathos, poses):
    for P_3, P_2, P_1 in zip(*_globes(poses, pathos.parameters), strict=True):
        rows = 2.0 * np.array([P_2 - P_1, P_3 - P_2, P_1 - P_3])
        values = np.linalg.svd(rows, compute_uv=False)
        assert values[2] < 1e-14 * values[0]
        assert values[1] > 1e-2 * values[0]


def test_the_true_point_satisfies_equation_20(pathos, poses):
    r, h = pathos.parameters.plate_radius, 2.0 * poses[:, 6]
    P_3, P_2, P_1 = _globes(poses, pathos.parameters)
    T = pose_from_task(poses[:, :6])
    P = (T @ np.stack([_platform(pathos.parameters, h_0, 3) for h_0 in poses[:, 6]]))[:, :3, 3]
    s_1, s_2, s_3 = (np.sum(q * q, axis=-1) for q in (P_1, P_2, P_3))
    apart = 3.0 * r * r - h * h
    lines = ((P_2 - P_1, s_2 - s_1), (P_3 - P_2, apart + s_3 - s_2), (P_1 - P_3, s_1 - s_3 - apart))
    for difference, right in lines:
        assert np.abs(2.0 * np.sum(difference * P, axis=-1) - right).max() < 1e-9


def test_exchanging_P1_and_P2_as_the_text_does_mirrors_the_platform(pathos, poses):
    globes = [vec_from_array(P) for P in _globes(poses, pathos.parameters)]
    for order, right in (((0, 1, 2), True), ((0, 2, 1), False)):
        R, _, _ = platform_from_globes(pathos.parameters, *(globes[k] for k in order), Requirements())
        want = pose_from_task(poses[:, :6])[:, :3, :3]
        off = np.abs(np.stack([R.x.array(), R.y.array(), R.z.array()], axis=-1) - want).max(axis=(1, 2))
        assert np.all(off < 1e-10) if right else np.all(off > 0.5)


def test_two_measurements_are_left_to_tell_a_faulty_sensor(pathos, poses):
    sensors = _sensors(pathos, poses[:50])
    for k in range(9):
        wrong = sensors.copy()
        wrong[:, k] += 5.0 * DEG
        assert np.median(pathos.solve_forward_from_sensors(wrong).residual) > 0.1
    wrong[0] = np.nan
    forward = pathos.solve_forward_from_sensors(wrong)
    assert not forward.is_solved[0]
    assert np.isfinite(forward.poses).all()


def test_orientation_is_what_the_sensors_noise_spoils_most(pathos, rng):
    """0.01 degrees rms a joint: 0.07 mm, 0.074 degrees, 0.012 mm of h_0 (rms)."""
    half = np.array([50.0, 50.0, 50.0, 0.4, 0.4, 0.4, 0.0])
    drawn = pathos.home - 5.0 * np.eye(7)[6] + rng.uniform(-half, half, (30000, 7))
    poses = drawn[pathos.solve_inverse(drawn).is_reachable][:4000]
    sensors = _sensors(pathos, poses)
    forward = pathos.solve_forward_from_sensors(sensors + rng.normal(0.0, 0.01 * DEG, sensors.shape))
    got, want = pose_from_task(forward.poses[:, :6]), pose_from_task(poses[:, :6])
    shift = np.linalg.norm(got[:, :3, 3] - want[:, :3, 3], axis=-1)
    relative = np.swapaxes(got[:, :3, :3], 1, 2) @ want[:, :3, :3]
    turn = np.linalg.norm(relative - np.eye(3), axis=(1, 2)) / math.sqrt(2.0)
    rms = [math.sqrt(np.mean(e * e)) for e in (shift, np.degrees(turn), forward.poses[:, 6] - poses[:, 6])]
    assert rms == pytest.approx([0.07, 0.074, 0.012], rel=0.2)


# Mobility


def _constraints(pathos, pose, locked):
    Ts = pathos.place_bodies(pose[None])[0]
    index = {b.name: k for k, b in enumerate(pathos.bodies)}
    rows = []
    for joint in pathos.joints:
        a, b = index[joint.parent], index[joint.child]
        at = (Ts[a, :3, :3] @ joint.p_parent + Ts[a, :3, 3]) / 100.0
        across = np.linalg.svd((Ts[a, :3, :3] @ joint.axis_parent)[None])[2][1:]
        move = np.hstack([np.eye(3), np.array([[0, at[2], -at[1]], [-at[2], 0, at[0]], [at[1], -at[0], 0]])])
        turn = np.hstack([np.zeros((3, 3)), np.eye(3)])
        if joint.kind is JointKind.REVOLUTE:
            blocks = [move, across @ turn]
        else:
            blocks = [move if locked else across @ move, turn]
        row = np.zeros((sum(len(block) for block in blocks), 6 * len(Ts)))
        row[:, 6 * b : 6 * b + 6] = np.vstack(blocks)
        row[:, 6 * a : 6 * a + 6] = -np.vstack(blocks)
        rows.append(row)
    return np.vstack(rows)[:, 6:]


@pytest.mark.parametrize(("locked", "freedoms"), [(False, 7), (True, 6)])
def test_mobility_is_7_with_the_grip_and_6_without_by_constraint_rank(pathos, poses, locked, freedoms):
    for pose in poses[:2]:
        rows = _constraints(pathos, pose, locked)
        values = np.linalg.svd(rows, compute_uv=False)
        assert rows.shape[1] - int(np.sum(values > 1e-9 * values[0])) == freedoms


def test_the_mobility_formula_sums_over_all_joints_and_not_over_two(pathos):
    """Printed with i = 1 .. 2; a globular joint counts as one of three freedoms: ring and fork are inside it."""
    links = sum(b.kind not in ("ring", "fork") for b in pathos.bodies)
    joints = sum(not j.name.endswith(("theta_5", "theta_6")) for j in pathos.joints)
    assert (links, joints) == (21, 25)
    assert 6 * (links - joints - 1) + len(pathos.joints) == 7
    assert 6 * (links - 1 - (joints - 1) - 1) + len(pathos.joints) - 1 == 6
    assert 6 * (len(pathos.bodies) - len(pathos.joints) - 1) + len(pathos.joints) == 7


# Jacobians

#: Rows v, omega; columns six motors and h_0 [cm/rad, 1/rad; the last one 1/cm].
REFERENCE_JACOBIAN = np.array(
    [
        [-1.866, 4.684, -2.818, 1.866, 2.818, -4.684, 0.0],
        [-4.331, 0.550, 3.782, 4.331, -3.782, -0.550, 0.0],
        [10.508, 10.508, 10.508, 10.508, 10.508, 10.508, 0.0],
        [-0.663, 0.111, 0.551, -0.663, 0.551, 0.111, 0.0],
        [0.254, -0.701, 0.447, 0.254, 0.447, -0.701, 0.0],
        [-1.973, -1.973, -1.973, 1.973, 1.973, 1.973, -0.188],
    ]
)


def test_the_jacobians_at_home_have_the_reference_elements(pathos):
    J = pathos.compute_motor_jacobian(pathos.home[None])[0]
    assert np.abs(J / np.array([10.0] * 3 + [1.0] * 3)[:, None] - REFERENCE_JACOBIAN[:, :6]).max() < 6e-4
    # The seventh joint measures the distance 2 h_0; per change of h_0 its column counts twice.
    full = np.linalg.inv(pathos.compute_jacobian(pathos.home[None])[0])
    assert np.abs(full[:6, 6] * 2.0 * 10.0 - REFERENCE_JACOBIAN[:, 6]).max() < 6e-4
    assert full[6] == pytest.approx([0.0] * 6 + [0.5], abs=1e-15)


def test_a_motor_pushes_along_its_upper_link(pathos, poses):
    """The cross product of the planes of R2 and R3 with the globular joint is the upper link's direction."""
    index = {b.name: k for k, b in enumerate(pathos.bodies)}
    for Ts in pathos.place_bodies(poses[:50]):
        for i in range(6):
            middle, upper, ring = (Ts[index[f"leg_{i + 1}_{n}"]] for n in ("middle_link", "upper_link", "ring"))
            S = ring[:3, 3]
            n = np.cross(np.cross(middle[:3, 1], S - middle[:3, 3]), np.cross(upper[:3, 0], S - upper[:3, 3]))
            assert np.linalg.norm(np.cross(n, upper[:3, 2])) < 1e-9 * np.linalg.norm(n)


def test_torques_hold_a_force_of_5_newton_as_in_the_reference(pathos):
    """Tau = J^T F: largest motor torque 0.23, 0.22, 0.53 N m for 5 N along x, y, z."""
    J = pathos.compute_motor_jacobian(pathos.home[None])[0]
    torque = np.abs(J[:3].T * 5.0).max(axis=0) / 1000.0
    assert torque == pytest.approx([0.23, 0.22, 0.53], abs=5e-3)

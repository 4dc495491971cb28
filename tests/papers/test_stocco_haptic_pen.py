"""Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen. The pen: Tables VII to X, sections V and VI."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from linkwright.designs.haptic_pen.mechanism import HapticPen
from linkwright.designs.haptic_pen.parameters import (
    STOCCO_HAND_FORCE,
    STOCCO_TABLE_7,
    STOCCO_TABLE_8,
    STOCCO_TABLE_8_GII,
    STOCCO_TABLE_9,
    STOCCO_TABLE_10,
    HapticPenForward,
)
from linkwright.designs.language.errors import UnknownNameError

DEG = math.pi / 180.0
#: The paper's J counts in centimetres: of rates of motors by cm/s, and of turns.
CM = np.array([10.0, 10.0, 10.0, 1.0, 1.0])


@pytest.fixture(scope="module")
def pen():
    return HapticPen({"parameters": STOCCO_TABLE_7})


def _rings(bound, n_rings):
    """Tilts (theta_1, theta_2) of eqs. (14) to (16) in plain double precision, rings in order."""
    tilts = [(0.0, 0.0)]
    for n in range(1, n_rings + 1):
        m = math.floor(2.0 * math.pi * n_rings / bound * math.sin(n * bound / n_rings))
        tilts += [(n * bound / n_rings, 2.0 * math.pi * k / m) for k in range(m)]
    return np.array(tilts)


def _pen_directions(tilts):
    t1, t2 = tilts.T
    return np.stack([-np.sin(t1) * np.sin(t2), np.cos(t1), np.sin(t1) * np.cos(t2)], axis=-1)


def _turns(tilts):
    j = _pen_directions(tilts)
    return np.stack([np.arcsin(j[:, 2]), np.arctan2(-j[:, 0], j[:, 1])], axis=-1)


def _poses(positions, tilts):
    turns = _turns(tilts)
    return np.concatenate([np.repeat(positions, len(turns), axis=0), np.tile(turns, (len(positions), 1))], axis=1)


def _grid(k0):
    """A quarter of the workspace, coarser than Table VI; it holds the poses where the indices are decided."""
    return np.array(
        [(x, y, k0 + z) for x in range(0, 81, 20) for y in range(0, 51, 10) for z in range(-50, 51, 10)], dtype=float
    )


def _outer_tilts():
    tilts = _rings(45.0 * DEG, 14)
    return tilts[(tilts[:, 0] == 0.0) | (tilts[:, 0] > 36.0 * DEG)]


def _index(A):
    squares = np.linalg.eigvalsh(np.swapaxes(A, 1, 2) @ A)
    return math.sqrt(squares[:, 0].min() / squares[:, -1].max())


def _scaled(pen, poses, waist_scale):
    J = pen.compute_force_jacobian(poses) * CM
    return np.diag([waist_scale, 1.0, 1.0] * 2) @ J @ np.diag(1.0 / np.array(STOCCO_HAND_FORCE))


def test_the_home_pose_has_the_reference_angles(pen):
    inverse = pen.solve_inverse(pen.home[None])
    assert inverse.is_reachable.all()
    want = [2.29, 147.24, 32.76, -2.29, 147.24, 32.76]
    assert np.degrees(inverse.joints[0, :6]) == pytest.approx(want, abs=5e-3)


def test_the_jacobian_at_home_has_the_reference_rows_and_singular_values(pen):
    J = pen.compute_force_jacobian(pen.home[None])[0] * CM
    assert J[0] == pytest.approx([0.0, -0.039936, -0.001597, -0.011182, 0.0], abs=5e-7)
    assert J[1] == pytest.approx([-0.043964, 0.001665, -0.041625, -0.291377, 0.307748], abs=5e-7)
    values = np.linalg.svd(_scaled(pen, pen.home[None], 1.6)[0], compute_uv=False)
    assert values == pytest.approx([0.16203, 0.15782, 0.090424, 0.087928, 0.055553], abs=1e-6)


def test_a_tilted_pose_has_the_reference_singular_values(pen):
    poses = _poses(np.array([[80.0, 50.0, 300.0]]), np.array([[45.0 * DEG, 340.0 * DEG]]))
    values = np.linalg.svd(_scaled(pen, poses, 1.6)[0], compute_uv=False)
    assert values == pytest.approx([0.18903, 0.133402, 0.094747, 0.071618, 0.053761], abs=1e-6)


def test_the_extreme_poses_of_table_7_are_where_the_reference_found_them(pen):
    tilts = _rings(45.0 * DEG, 14)
    worst = _scaled(pen, _poses(np.array([[80.0, 50.0, 300.0]]), tilts[610:611]), 1.6)
    best = _scaled(pen, _poses(np.array([[40.0, 10.0, 200.0]]), tilts[578:579]), 1.6)
    low, high = np.linalg.svd(worst, compute_uv=False).min(), np.linalg.svd(best, compute_uv=False).max()
    assert low == pytest.approx(0.053567, abs=5e-7)
    assert high == pytest.approx(0.228439, abs=5e-7)
    assert low / high == pytest.approx(0.234, abs=5e-4)


@pytest.mark.parametrize("row", range(4))
def test_tables_8_and_9_follow_from_the_poses_that_decide_them(row):
    """Force index with Q_1 of Table VIII; velocity index with S_T not inverted and R_w/R_s on the waists."""
    p, (ratio, velocity) = STOCCO_TABLE_8[row], STOCCO_TABLE_9[row]
    pen, poses = HapticPen({"parameters": p}), _poses(_grid(p.home_distance), _outer_tilts())
    assert _index(_scaled(pen, poses, p.waist_scale)) == pytest.approx(STOCCO_TABLE_8_GII[row], abs=5.1e-4)
    rates = pen.compute_force_jacobian(poses) * CM @ np.diag([1.0, 1.0, 1.0, 0.06, 0.06])
    assert _index(np.diag([ratio, 1.0, 1.0] * 2) @ rates) == pytest.approx(velocity, abs=5.1e-4)
    # Eq. (26) as printed puts R_w on the shoulders: that is another index.
    assert _index(np.diag([1.0, ratio, ratio] * 2) @ rates) < 0.8 * velocity


def test_table_7_needs_the_frame_at_zero_roll_and_half_lengths(pen):
    """A frame by the plain tilt, or l_1 and l_6 as full lengths, gives another index than 0.234."""
    tilts = _outer_tilts()
    poses = _poses(_grid(250.0), tilts)
    J, j_e = pen.compute_force_jacobian(poses), _pen_directions(tilts)
    x = np.cross(j_e, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    R = np.stack([x, j_e, np.cross(x, j_e)], axis=-1)
    t2 = tilts[:, 1]
    axis = np.stack([np.cos(t2), 0.0 * t2, np.sin(t2)], axis=-1)
    # The tilted x axis: Rodrigues on (1, 0, 0).
    c, s = np.cos(tilts[:, :1]), np.sin(tilts[:, :1])
    tilted = c * np.eye(3)[0] + s * np.cross(axis, np.eye(3)[0]) + (1.0 - c) * axis[:, :1] * axis
    P = np.stack([tilted, j_e, np.cross(tilted, j_e)], axis=-1)
    turn = np.tile(np.swapaxes(R, 1, 2) @ P, (len(_grid(250.0)), 1, 1))
    both = np.concatenate([J[..., :3] @ turn, J[..., 3:] @ turn[:, [0, 2]][:, :, [0, 2]]], axis=-1) * CM
    plain = np.diag([1.6, 1.0, 1.0] * 2) @ both @ np.diag(1.0 / np.array(STOCCO_HAND_FORCE))
    assert _index(plain) == pytest.approx(0.2394, abs=5e-4)
    for field, length, wrong in (("shoulder_half_spacing", 12.0, 0.22895), ("pen_half_length", 35.0, None)):
        other = HapticPen({"parameters": replace(STOCCO_TABLE_7, **{field: length})})
        got = _index(_scaled(other, poses, 1.6))
        assert abs(got - 0.234) > 4e-3
        if wrong is not None:
            assert got == pytest.approx(wrong, abs=5e-4)


def test_equation_16_counts_samples_with_plain_doubles_and_its_example_holds_a_misprint():
    assert [len(_rings(45.0 * DEG, n)) for n in (1, 2, 3, 4, 14)] == [6, 18, 34, 58, 617]  # printed: 6, 8, 34, 58
    assert [len(_rings(30.0 * DEG, n)) for n in (6, 7)] == [126, 168]
    assert 17 * 11 * 21 * 617 == 2_422_959


def test_the_whole_workspace_of_table_6_is_reachable(pen):
    positions = np.array([(x, y, 250 + z) for x in (0, 40, 80) for y in (0, 25, 50) for z in (-50, 0, 50)], dtype=float)
    inverse = pen.solve_inverse(_poses(positions, _rings(45.0 * DEG, 14)))
    assert inverse.is_reachable.all()


@pytest.mark.parametrize("p", [*STOCCO_TABLE_8, STOCCO_TABLE_10])
def test_every_optimum_keeps_the_forearms_out_of_line(p):
    """l_3 > l_1 + l_2 (with l_1 half the spacing) makes the singularities of Fig. 12 b to d impossible."""
    assert p.forearm_length > p.shoulder_half_spacing + p.upper_arm_length
    # Text: impossible in Fig. 12a if l_1 > l_2, which no optimum satisfies.
    assert p.shoulder_half_spacing < p.upper_arm_length


def test_the_spatial_resolution_of_table_10_comes_from_one_arm_and_a_pen_of_164_mm():
    """142, 314 and 175 um, 0.122 and 0.099 degrees for a count of 1/4000 turn; 7 cm of half pen would not do."""
    pen, count = HapticPen({"parameters": STOCCO_TABLE_10}), 2.0 * math.pi / 4000.0
    # An arm alone: its three rows by the velocity of its tip are those by v at zero offset.
    J_tip = pen.compute_force_jacobian(pen.home[None])[0, :3, :3]
    step = np.abs(np.linalg.inv(J_tip)).max(axis=1) * count * 1000.0
    assert step == pytest.approx([142.0, 314.0, 175.0], abs=0.5)
    half = STOCCO_TABLE_10.pen_half_length * 1000.0
    assert np.degrees([step[2] / half, step[0] / half]) == pytest.approx([0.122, 0.099], abs=5e-4)
    assert abs(math.degrees(step[2] / 70_000.0) - 0.122) > 0.015


def test_no_motor_sees_the_pen_roll(pen, rng):
    """Both wrists lie on the pen's axis and turn freely there: a roll of the pen moves neither, and no motor."""
    poses = np.concatenate([pen.home[:3] + rng.uniform(-50, 50, (50, 3)), rng.uniform(-0.5, 0.5, (50, 2))], axis=1)
    Ts, names = pen.place_bodies(poses), [b.name for b in pen.bodies]
    for arm, half in (("arm_a", 70.0), ("arm_b", -70.0)):
        wrist = Ts[:, names.index(f"{arm}_hub")]
        assert np.abs(Ts[:, -1, :3, 3] + half * Ts[:, -1, :3, 1] - wrist[:, :3, 3]).max() < 1e-9
        assert not next(j for j in pen.joints if j.name == f"{arm}_turn").is_active


def test_six_motors_for_five_coordinates_refuse_what_does_not_close_unless_told_how_much(pen):
    joints = pen.solve_inverse(pen.home[None]).joints[:, :6]
    noisy = joints + np.array([-1.0, 1.0, 1.0, 1.0, -1.0, 1.0]) * 2.0 * math.pi / 4000.0
    assert pen.solve_forward(joints).is_solved.all()
    assert not pen.solve_forward(noisy).is_solved.any()
    patient = HapticPen({"parameters": STOCCO_TABLE_7, "forward": HapticPenForward(closure_tolerance=1.0)})
    forward = patient.solve_forward(noisy)
    assert forward.is_solved.all()
    assert 0.1 < forward.residual[0] < 1.0
    assert np.abs(forward.poses - pen.home)[0, :3].max() < 0.5


def test_every_branch_reaches_the_tip_and_they_differ(pen):
    pose, seen = np.array([[20.0, 10.0, 230.0, 0.1, -0.2]]), []
    tips = pen.place_bodies(pose)[0][[b.name for b in pen.bodies].index("arm_a_hub")][:3, 3] - [0.0, 80.0, 0.0]
    radius = math.hypot(tips[1], tips[2])
    for branch in (*pen.branches, "out/in"):
        joints = pen.solve_inverse(pose, branch).joints[0]
        for side, q in ((-1.0, joints[1]), (1.0, joints[2])):
            elbow = np.array([side * 24.0 + 170.0 * math.cos(q), 170.0 * math.sin(q)])
            assert math.hypot(tips[0] - elbow[0], radius - elbow[1]) == pytest.approx(230.0, abs=1e-9)
        seen.append(tuple(np.round(joints[:6], 6)))
    assert len(set(seen)) == 5
    with pytest.raises(UnknownNameError):
        pen.solve_inverse(pose, "out/in/out")

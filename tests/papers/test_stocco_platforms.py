"""Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen. The 6-DOF comparison: Tables II to V."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from linkwright.designs.inoue.mechanism import Inoue
from linkwright.designs.inoue.parameters import STOCCO_TABLE_5, STOCCO_TABLE_5_GII
from linkwright.designs.language.poses import rotation_about, task_from_pose
from linkwright.designs.stewart.mechanism import Stewart
from linkwright.designs.stewart.parameters import STOCCO_TABLE_4, STOCCO_TABLE_4_GII, WIDE_LIMITS
from linkwright.designs.twin_pantograph.mechanism import TwinPantograph
from linkwright.designs.twin_pantograph.parameters import STOCCO_HAND_FORCE, STOCCO_TABLE_3, STOCCO_TABLE_3_GII

DEG = math.pi / 180.0
X, Y, Z = np.eye(3)
#: J in centimetres: of motor angles, and of leg lengths, by cm and by turns.
TURNING = np.array([10.0] * 3 + [1.0] * 3)
SLIDING = np.array([1.0] * 3 + [0.1] * 3)
TWIN_SCALES = (1.9, 1.0, 1.0, 1.0, 1.0, 0.03)
STEWART_SCALES = (1.0, 1.0, 0.5, 0.9, 0.9, 0.5)
INOUE_SCALES = (1.0, 1.0, 0.75, 0.75, 0.75, 0.75)


@pytest.fixture(scope="module")
def twin():
    return TwinPantograph({"parameters": STOCCO_TABLE_3})


def _stewart(**changes):
    return Stewart({"parameters": replace(STOCCO_TABLE_4, **changes), "joint_limits": WIDE_LIMITS})


def _inoue(**changes):
    return Inoue({"parameters": replace(STOCCO_TABLE_5, **changes)})


def _frames(tilts, rolls):
    """The paper's end-effector frames: Rz Rx puts the pen along the tilted j, Ry rolls it; shape (n, 3, 3)."""
    t1, t2 = np.asarray(tilts).T
    a, b = np.arcsin(np.sin(t1) * np.cos(t2)), np.arctan2(np.sin(t1) * np.sin(t2), np.cos(t1))
    tilted = rotation_about(Z, b) @ rotation_about(X, a)
    return (tilted[:, None] @ rotation_about(Y, np.asarray(rolls))[None]).reshape(-1, 3, 3)


def _decisive_frames():
    """The tilt of 30 degrees in all 41 directions of the outermost of 7 rings, rolled; and no tilt."""
    count = math.floor(2.0 * math.pi * 7 / (30.0 * DEG) * math.sin(30.0 * DEG))
    ring = [(30.0 * DEG, 2.0 * math.pi * m / count) for m in range(count)]
    rolls = np.array([-30.0, -15.0, 0.0, 15.0, 30.0]) * DEG
    return np.concatenate([_frames([(0.0, 0.0)], rolls), _frames(ring, rolls)])


def _placed(positions, frames):
    Ts = np.zeros((len(positions), len(frames), 4, 4))
    Ts[..., :3, :3], Ts[..., :3, 3], Ts[..., 3, 3] = frames, np.asarray(positions)[:, None], 1.0
    return Ts.reshape(-1, 4, 4)


def _scaled(mechanism, Ts, scales):
    J, R = mechanism.compute_jacobian(task_from_pose(Ts)), Ts[:, :3, :3]
    own = np.concatenate([J[..., :3] @ R, J[..., 3:] @ R], axis=-1)
    own = own * (SLIDING if mechanism.name == "stewart" else TURNING)
    return np.diag(scales) @ own @ np.diag(1.0 / np.array(STOCCO_HAND_FORCE))


def _index(mechanism, Ts, scales):
    A = _scaled(mechanism, Ts, scales)
    squares = np.linalg.eigvalsh(np.swapaxes(A, 1, 2) @ A)
    return math.sqrt(max(squares[:, 0].min(), 0.0) / squares[:, -1].max())


def _values(mechanism, position, frame, scales):
    return np.linalg.svd(_scaled(mechanism, _placed([position], frame), scales)[0], compute_uv=False)


def _half_grid():
    """Table II for the parallel platforms, thinned: it holds the poses that decide the indices."""
    return np.array(
        [(x, y, 250 + z) for x in (0, 40, 80) for y in (-50, 0, 50) for z in (-50, -25, 0, 25, 50)], dtype=float
    )


LEVEL, HOME = _frames([(0.0, 0.0)], [0.0]), (0.0, 0.0, 250.0)


def test_the_twin_has_the_reference_singular_values(twin):
    want = [0.090529, 0.076103, 0.07345, 0.069642, 0.060035, 0.058673]
    assert _values(twin, HOME, LEVEL, TWIN_SCALES) == pytest.approx(want, abs=6e-7)
    frame = _frames([(30.0 * DEG, 315.0 * DEG)], [30.0 * DEG])
    want = [0.105013, 0.086783, 0.072345, 0.060689, 0.057637, 0.038000]
    assert _values(twin, (-80.0, 50.0, 300.0), frame, TWIN_SCALES) == pytest.approx(want, abs=6e-7)


def test_table_3_follows_from_its_two_extreme_poses(twin):
    rolled = [30.0 * DEG]
    low_frame, high_frame = (_frames([(30.0 * DEG, 2.0 * math.pi * m / 41)], rolled) for m in (36, 22))
    low = _values(twin, (-80.0, 50.0, 300.0), low_frame, TWIN_SCALES).min()
    high = _values(twin, (20.0, -30.0, 200.0), high_frame, TWIN_SCALES).max()
    assert (low, high) == pytest.approx((0.038008, 0.116342), abs=6e-7)
    assert low / high == pytest.approx(STOCCO_TABLE_3_GII, abs=5e-4)
    positions = [(x, y, 250.0 + z) for x in (-80, -20, 0, 20, 80) for y in (-50, -30, 0, 50) for z in (-50, 0, 50)]
    Ts = _placed(positions, _decisive_frames())
    assert _index(twin, Ts, TWIN_SCALES) == pytest.approx(0.326693, abs=1e-6)
    # Q_2 = 0.035 is a tie with the printed 0.03: better by 4 parts in a million.
    other = _index(twin, Ts, (*TWIN_SCALES[:5], 0.035))
    assert 0.0 < other / _index(twin, Ts, TWIN_SCALES) - 1.0 < 1e-5


def test_table_2_counts_the_samples_of_the_twin_but_not_of_the_platforms():
    """Printed for the platforms: 2,653,020, which no grid of 11 steps on two axes divides. Table II gives 2,378,376."""
    assert 17 * 11 * 11 * 168 * 13 == 4_492_488
    assert 9 * 11 * 11 * 168 * 13 == 2_378_376
    assert 2_653_020 % 11 != 0


def test_the_roll_motor_reads_a_roll_at_a_still_tip_but_for_the_swing_of_its_hub(twin):
    """At home a pure roll moves no other motor; q7 follows it, over the squared sine between pen and forearm."""
    J = twin.compute_jacobian(twin.home[None])[0]
    assert np.abs(J[:5, 4]).max() < 1e-15
    assert J[5, 4] == pytest.approx(1.0, abs=1e-2)


def test_without_the_redundant_waist_the_pen_must_not_lie_in_the_plane_of_arm_b(twin):
    """Section V and its footnote: with q4 passive that pose is singular; near it the pose is refused."""
    smallest = []
    for sine in (0.5, 0.1, 0.02):
        poses = np.tile(twin.home, (4001, 1))
        poses[:, 3] = np.linspace(0.0, 1.5, 4001)
        Ts = twin.place_bodies(poses)
        names = [b.name for b in twin.bodies]
        normal = -Ts[:, names.index("arm_b_waist"), :3, 1]
        out = -np.einsum("ni,ni->n", normal, Ts[:, -1, :3, 1])
        k = int(np.argmin(np.abs(out - sine)))
        assert out[k] == pytest.approx(sine, abs=2e-3)
        J = twin.compute_jacobian(poses[k : k + 1])[0] * np.array([30.0] * 3 + [1.0] * 3)
        smallest.append(np.linalg.svd(J, compute_uv=False).min() / out[k])
        inverse = twin.solve_inverse(poses[k : k + 1])
        margin = inverse.margins[0, inverse.requirements.index("pen in the plane of arm_b")]
        assert (margin < 0.0) == (sine < 0.05)
    assert max(smallest) / min(smallest) < 2.5


def test_stewart_and_inoue_have_the_reference_singular_values():
    want = [1.900028, 1.892966, 1.223726, 0.658413, 0.379391, 0.366168]
    assert _values(_stewart(), HOME, LEVEL, STEWART_SCALES) == pytest.approx(want, abs=6e-7)
    want = [0.099522, 0.092469, 0.071062, 0.057556, 0.056445, 0.052064]
    assert _values(_inoue(), HOME, LEVEL, INOUE_SCALES) == pytest.approx(want, abs=6e-7)


def test_table_4_follows_only_from_half_spacings_and_the_single_arm_first():
    Ts = _placed(_half_grid(), _decisive_frames())
    got = _index(_stewart(), Ts, STEWART_SCALES)
    assert got == pytest.approx(0.0957, abs=5e-5)
    assert got == pytest.approx(STOCCO_TABLE_4_GII, abs=5e-4)
    assert _index(_stewart(pair_half_spacing=50.0), Ts, STEWART_SCALES) == pytest.approx(0.050, abs=5e-4)
    swapped = _stewart(platform_single_radius=40.0, platform_pair_radius=30.0)
    assert _index(swapped, Ts, STEWART_SCALES) == pytest.approx(0.073, abs=1e-3)
    assert _index(_stewart(), Ts, (1.0, 1.0, 0.9, 0.5, 0.5, 0.9)) == pytest.approx(0.056, abs=5e-4)


def test_table_4_is_no_optimum_unless_base_sides_may_not_overlap():
    """Not in the text: a design with crossing base lines, inside the table's ranges, has twice the index."""
    crossing = _stewart(
        pair_half_spacing=160.0,
        base_single_radius=40.0,
        base_pair_radius=20.0,
        platform_single_radius=30.0,
        platform_pair_radius=20.0,
        base_angle=130.0 * DEG,
        platform_angle=165.0 * DEG,
    )
    Ts = _placed(_half_grid(), _decisive_frames())
    assert _index(crossing, Ts, (1.0, 1.0, 1.3, 1.5, 1.5, 1.3)) == pytest.approx(0.196, abs=5e-4)

    def overlaps(p):
        s, c, l_4, l_5 = math.sin(p.base_angle), math.cos(p.base_angle), p.base_single_radius, p.base_pair_radius
        return p.pair_half_spacing > min((l_5 - l_4 * c) / s, (l_4 - l_5 * c) / s, -l_5 * s / c)

    assert overlaps(crossing.parameters)
    assert not overlaps(STOCCO_TABLE_4)


def test_table_5_comes_out_lower_than_printed():
    """Printed: 0.215, for an optimum that is ours too. Used and stated: 0.2133."""
    Ts = _placed(_half_grid(), _decisive_frames())
    got = _index(_inoue(), Ts, INOUE_SCALES)
    assert got == pytest.approx(0.2133, abs=5e-5)
    assert STOCCO_TABLE_5_GII - got > 1e-3
    swapped = _inoue(platform_single_radius=40.0, platform_pair_radius=20.0)
    assert _index(swapped, Ts, INOUE_SCALES) == pytest.approx(0.107, abs=5e-4)
    assert _index(_inoue(shoulder_half_spacing=10.0), Ts, INOUE_SCALES) == pytest.approx(0.205, abs=5e-4)


def test_the_offset_ball_keeps_the_lines_of_the_legs(rng):
    """q^2 = |ball - gimbal|^2 - x_T^2, so the rows of J stay on the same lines, longer by a few parts in a thousand."""
    literal, offset = _stewart(), _stewart(ball_offset=18.0)
    poses = literal.home + rng.uniform(-1.0, 1.0, (200, 6)) * [60.0, 40.0, 40.0, 0.3, 0.3, 0.3]
    a, b = (m.solve_inverse(poses).joints[:, :6] for m in (literal, offset))
    assert np.abs(np.sqrt(a**2 - 18.0**2) - b).max() < 1e-9
    J, K = literal.compute_jacobian(poses), offset.compute_jacobian(poses)
    assert np.abs(J * (a / b)[..., None] - K).max() < 1e-10
    assert (a / b).max() < 1.006


@pytest.mark.parametrize("make", [_stewart, _inoue])
def test_motors_alone_name_the_pose_over_the_papers_workspace(make, rng):
    """Table IV and V literally: forward kinematics finds one pose, the right one, for every pose of W."""
    mechanism = make()
    poses = mechanism.home + rng.uniform(-1.0, 1.0, (300, 6)) * [80.0, 50.0, 50.0, 18 * DEG, 30 * DEG, 18 * DEG]
    inverse = mechanism.solve_inverse(poses)
    poses = poses[inverse.is_reachable]
    assert len(poses) > 280
    forward = mechanism.solve_forward(inverse.joints[inverse.is_reachable, :6])
    assert forward.is_solved.all()
    assert np.abs(forward.poses - poses).max() < 1e-9

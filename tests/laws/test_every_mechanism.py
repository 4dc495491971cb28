"""What is true of every mechanism, whatever it is: round trips, derivatives, closed loops, mobility."""

from __future__ import annotations

import numpy as np

from linkwright.designs.language.joints import JointKind
from linkwright.designs.language.poses import pose_from_task


def test_forward_after_inverse_returns_the_pose_everywhere(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 2000)
    active = mechanism.solve_inverse(poses).joints[:, : mechanism.n_active]
    forward = mechanism.solve_forward(active)
    assert forward.is_solved.all(), [forward.reason(i) for i in np.flatnonzero(~forward.is_solved)[:3]]
    got, want = pose_from_task(forward.poses), pose_from_task(poses)
    assert np.abs(got[:, :3, 3] - want[:, :3, 3]).max() <= 1e-9
    assert np.abs(got[:, :3, :3] - want[:, :3, :3]).max() <= 1e-10


def test_a_warm_started_forward_returns_the_pose_too(each_design, feasible_poses, rng):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 300)
    active = mechanism.solve_inverse(poses).joints[:, : mechanism.n_active]
    near = poses + rng.normal(0.0, 1.0, poses.shape) * np.where([c.unit == "mm" for c in mechanism.task], 2.0, 0.02)
    forward = mechanism.solve_forward(active, near=near)
    assert forward.is_solved.all()
    assert np.abs(forward.poses - poses).max() <= 1e-9


def test_motor_angles_of_no_pose_are_refused_and_finite(each_design, rng):
    mechanism = each_design.mechanism
    active = rng.uniform(-3.0, 3.0, (200, mechanism.n_active))
    active[0] = np.nan
    forward = mechanism.solve_forward(active)
    assert not forward.is_solved[0]
    assert np.isfinite(forward.poses).all()
    solved = np.flatnonzero(forward.is_solved)
    back = mechanism.solve_inverse(forward.poses[solved]).joints[:, : mechanism.n_active]
    assert np.abs(back - active[solved]).max(initial=0.0) < 1e-6


def test_poses_out_of_reach_are_reported_with_a_reason_and_without_nan(each_design):
    mechanism = each_design.mechanism
    far = np.tile(mechanism.home, (3, 1))
    far[0, 0] += 1e4
    far[1, 0] = np.nan
    far[2, 0] = np.inf
    inverse = mechanism.solve_inverse(far)
    assert not inverse.is_reachable.any()
    assert np.isfinite(inverse.joints).all()
    assert all(inverse.reason(i) for i in range(3))


def _twisted(poses, axis, step):
    """Poses moved by a small twist along one of its six axes; rotations by the exact product."""
    from linkwright.designs.language.poses import rotation_about, task_from_pose

    Ts = pose_from_task(poses)
    if axis < 3:
        Ts[:, axis, 3] += step
    else:
        Ts[:, :3, :3] = rotation_about(np.eye(3)[axis - 3], step) @ Ts[:, :3, :3]
    return task_from_pose(Ts)


def test_the_jacobian_equals_finite_differences(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 1500)
    joints = mechanism.solve_inverse(poses).joints
    bends = [
        np.abs(np.sin(joints[:, k]))
        for k, j in enumerate(mechanism.joints)
        if "elbow_left" in j.name or "elbow_right" in j.name
    ]
    poses = poses[np.min(bends, axis=0) > 0.4]
    assert len(poses) > 300
    J = mechanism.compute_jacobian(poses)
    for axis in range(J.shape[-1]):
        h = 1e-2 if axis < 3 else 1e-4
        moved = [
            mechanism.solve_inverse(_twisted(poses, axis, k * h)).joints[:, : mechanism.n_active]
            for k in (-2, -1, 1, 2)
        ]
        slope = (moved[0] - 8.0 * moved[1] + 8.0 * moved[2] - moved[3]) / (12.0 * h)
        # Turns count per radian, shifts per metre, as in the references.
        scale = 1e3 if axis < 3 else 1.0
        assert np.abs(slope - J[:, :, axis]).max() * scale <= 1e-6


def test_placed_bodies_meet_at_every_joint(each_design, feasible_poses):
    mechanism = each_design.mechanism
    Ts = mechanism.place_bodies(feasible_poses(each_design, 100))
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    for joint in mechanism.joints:
        parent, child = Ts[:, index[joint.parent]], Ts[:, index[joint.child]]
        at = parent[:, :3, :3] @ joint.p_parent + parent[:, :3, 3]
        to = child[:, :3, :3] @ joint.p_child + child[:, :3, 3]
        assert np.abs(at - to).max() <= 1e-9, joint.name
        if joint.kind is JointKind.REVOLUTE:
            assert np.abs(parent[:, :3, :3] @ joint.axis_parent - child[:, :3, :3] @ joint.axis_child).max() <= 1e-12


def test_joint_values_are_the_turns_between_placed_bodies(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = np.concatenate([mechanism.home[None], feasible_poses(each_design, 100)])
    Ts, values = mechanism.place_bodies(poses), mechanism.solve_inverse(poses).joints
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    for k, joint in enumerate(mechanism.joints):
        R_p, R_c = Ts[:, index[joint.parent], :3, :3], Ts[:, index[joint.child], :3, :3]
        if joint.kind is JointKind.SPHERICAL:
            angle = np.arccos(np.clip(np.sum((R_p @ joint.axis_parent) * (R_c @ joint.axis_child), -1), -1.0, 1.0))
            assert np.abs(angle - values[:, k]).max() <= 1e-7, joint.name
            continue
        relative = np.swapaxes(R_p, 1, 2) @ R_c
        moved = relative @ np.swapaxes(relative[:1], 1, 2)  # the turn since home, in the parent's axes
        axis = np.asarray(joint.axis_parent)
        skew = np.stack(
            [moved[:, 2, 1] - moved[:, 1, 2], moved[:, 0, 2] - moved[:, 2, 0], moved[:, 1, 0] - moved[:, 0, 1]], -1
        )
        turn = np.arctan2(skew @ axis / 2.0, (np.trace(moved, axis1=1, axis2=2) - 1.0) / 2.0)
        want = np.mod(values[:, k] - values[0, k] + np.pi, 2.0 * np.pi) - np.pi
        assert np.abs(turn - want).max() <= 1e-9, joint.name


def _constraint_rows(mechanism, pose):
    """Velocity constraints of all joints on the twists of all bodies, about the base's origin."""
    Ts = mechanism.place_bodies(pose[None])[0]
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    rows = []
    for joint in mechanism.joints:
        a, b = index[joint.parent], index[joint.child]
        at = (Ts[a, :3, :3] @ joint.p_parent + Ts[a, :3, 3]) / 100.0
        axis = Ts[a, :3, :3] @ joint.axis_parent
        cross = np.array([[0, -at[2], at[1]], [at[2], 0, -at[0]], [-at[1], at[0], 0]])
        blocks = [np.hstack([np.eye(3), -cross])]
        if joint.kind is JointKind.REVOLUTE:
            two = np.linalg.svd(axis[None])[2][1:]
            blocks.append(np.hstack([np.zeros((2, 3)), two]))
        for block in blocks:
            row = np.zeros((len(block), 6 * len(Ts)))
            row[:, 6 * b : 6 * b + 6], row[:, 6 * a : 6 * a + 6] = block, -block
            rows.append(row)
    return np.vstack(rows)[:, 6:]  # the base stands still


def test_joints_and_bodies_leave_as_many_freedoms_as_there_are_motors(each_design):
    mechanism = each_design.mechanism
    rows = _constraint_rows(mechanism, mechanism.home + 0.013)
    values = np.linalg.svd(rows, compute_uv=False)
    freedoms = rows.shape[1] - int(np.sum(values > 1e-9 * values[0]))
    assert freedoms == len(mechanism.task)


def test_power_of_the_motors_equals_power_of_the_hand(each_design, feasible_poses, rng):
    """Motor torques that hold a wrench, times motor rates, equal wrench times twist; rates from placed bodies."""
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 50)
    J = mechanism.compute_jacobian(poses)
    twist, wrench = rng.normal(size=(50, J.shape[-1])), rng.normal(size=(50, J.shape[-1]))
    torque = np.linalg.solve(np.swapaxes(J, 1, 2), wrench[..., None])[..., 0]
    h = 1e-5
    moved = []
    for sign in (-1.0, 1.0):
        q = poses
        for axis in range(J.shape[-1]):
            q = np.concatenate([_twisted(q[i : i + 1], axis, sign * h * twist[i, axis]) for i in range(len(q))])
        moved.append(mechanism.solve_inverse(q).joints[:, : mechanism.n_active])
    rates = (moved[1] - moved[0]) / (2.0 * h)
    assert np.allclose(np.sum(torque * rates, -1), np.sum(wrench * twist, -1), rtol=1e-4, atol=1e-4)

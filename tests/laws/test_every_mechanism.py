"""What is true of every mechanism, whatever it is: round trips, derivatives, closed loops, mobility."""

from __future__ import annotations

import itertools

import numpy as np

from linkwright.designs.language.joints import JointKind


def test_forward_after_inverse_returns_the_pose_everywhere(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 2000)
    active = mechanism.solve_inverse(poses).joints[:, : mechanism.n_active]
    forward = mechanism.solve_forward(active)
    assert forward.is_solved.all(), [forward.reason(i) for i in np.flatnonzero(~forward.is_solved)[:3]]
    got, want = (mechanism.place_bodies(q)[:, -1] for q in (forward.poses, poses))  # the body in the hand
    assert np.abs(got[:, :3, 3] - want[:, :3, 3]).max() <= 1e-9
    assert np.abs(got[:, :3, :3] - want[:, :3, :3]).max() <= 1e-10
    beyond = slice(6, None) if len(mechanism.task) > 6 else slice(0, None) if len(mechanism.task) < 6 else slice(6, 6)
    assert np.abs(forward.poses[:, beyond] - poses[:, beyond]).max(initial=0.0) <= 1e-9


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


def test_the_jacobian_equals_finite_differences(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 1500)
    # Turns count per radian, shifts per metre, as in the references.
    scales = np.where([c.unit == "mm" for c in mechanism.task], 1e3, 1.0)
    # Away from the serial singularities, where a motor's rates grow without bound.
    home = np.linalg.norm(mechanism.compute_jacobian(mechanism.home[None])[0] * scales, axis=-1)
    rates = np.linalg.norm(mechanism.compute_jacobian(poses) * scales, axis=-1)
    poses = poses[np.all(rates < 2.0 * home, axis=-1)]
    assert len(poses) > 300
    J = mechanism.compute_jacobian(poses)
    for axis, (unit, scale) in enumerate(zip(np.eye(J.shape[-1]), scales, strict=True)):
        h = 1e-2 if scale > 1.0 else 1e-4
        moved = [
            mechanism.solve_inverse(mechanism.move_pose(poses, np.tile(k * h * unit, (len(poses), 1)))).joints
            for k in (-2, -1, 1, 2)
        ]
        slope = ((moved[0] - 8.0 * moved[1] + 8.0 * moved[2] - moved[3]) / (12.0 * h))[:, : mechanism.n_active]
        assert np.abs(slope - J[:, :, axis]).max() * scale <= 1e-6


def test_placed_bodies_meet_at_every_joint(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 100)
    Ts, values = mechanism.place_bodies(poses), mechanism.solve_inverse(poses).joints
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    for k, joint in enumerate(mechanism.joints):
        parent, child = Ts[:, index[joint.parent]], Ts[:, index[joint.child]]
        at = parent[:, :3, :3] @ joint.p_parent + parent[:, :3, 3]
        to = child[:, :3, :3] @ joint.p_child + child[:, :3, 3]
        if joint.kind is JointKind.PRISMATIC:  # its value is the way from the parent's point to the child's
            at = at + values[:, k, None] * (parent[:, :3, :3] @ joint.axis_parent)
        assert np.abs(at - to).max() <= 1e-9, joint.name
        if joint.kind in (JointKind.REVOLUTE, JointKind.PRISMATIC):
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
        want = 0.0 if joint.kind is JointKind.PRISMATIC else values[:, k] - values[0, k]
        assert np.abs(np.mod(turn - want + np.pi, 2.0 * np.pi) - np.pi).max() <= 1e-9, joint.name


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
        point, spin = np.hstack([np.eye(3), -cross]), np.hstack([np.zeros((3, 3)), np.eye(3)])
        two = np.linalg.svd(axis[None])[2][1:]
        blocks = {
            JointKind.SPHERICAL: [point],
            JointKind.REVOLUTE: [point, two @ spin],
            JointKind.PRISMATIC: [two @ point, spin],
        }[joint.kind]
        for block in blocks:
            row = np.zeros((len(block), 6 * len(Ts)))
            row[:, 6 * b : 6 * b + 6], row[:, 6 * a : 6 * a + 6] = block, -block
            rows.append(row)
    return np.vstack(rows)[:, 6:]  # the base stands still


def test_joints_and_bodies_leave_the_freedoms_of_the_task_and_the_idle_ones(each_design):
    mechanism = each_design.mechanism
    rows = _constraint_rows(mechanism, mechanism.home + 0.013)
    values = np.linalg.svd(rows, compute_uv=False)
    freedoms = rows.shape[1] - int(np.sum(values > 1e-9 * values[0]))
    assert freedoms == len(mechanism.task) + mechanism.n_idle_freedoms


def test_power_of_the_motors_equals_power_of_the_hand(each_design, feasible_poses, rng):
    """Motor torques that hold a wrench, times motor rates, equal wrench times twist; rates from placed bodies."""
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 50)
    J = mechanism.compute_jacobian(poses)
    twist, wrench = rng.normal(size=(50, J.shape[-1])), rng.normal(size=(50, J.shape[-1]))
    torque = np.einsum("nij,nj->ni", np.linalg.pinv(np.swapaxes(J, 1, 2)), wrench)  # the smallest that holds it
    h = 1e-5
    moved = [
        mechanism.solve_inverse(mechanism.move_pose(poses, sign * h * twist)).joints[:, : mechanism.n_active]
        for sign in (-1.0, 1.0)
    ]
    rates = (moved[1] - moved[0]) / (2.0 * h)
    assert np.allclose(np.sum(torque * rates, -1), np.sum(wrench * twist, -1), rtol=1e-4, atol=1e-4)


def test_every_corner_of_the_declared_workspace_is_reachable(each_design, rng):
    mechanism = each_design.mechanism
    lower, upper = each_design.box()
    corners = np.array(list(itertools.product(*zip(lower, upper, strict=True))))
    inside = rng.uniform(lower, upper, (5000, len(lower)))
    inverse = mechanism.solve_inverse(np.concatenate([corners, inside]))
    assert inverse.is_reachable.all(), [inverse.reason(i) for i in np.flatnonzero(~inverse.is_reachable)[:3]]
    assert mechanism.solve_inverse(mechanism.home[None]).is_reachable.all()

"""Bodies, joint values, freedoms, Jacobian and forward kinematics against MuJoCo, told only bodies and joints."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import pytest

from linkwright.designs.language.joints import JointKind
from linkwright.designs.language.poses import rotation_about
from linkwright.designs.language.units import DEG

#: A radian counts as much as its arc at this lever [mm], about the size of the mechanisms.
LEVER = 100.0

#: A tenth of a millimetre, and what must be left of it wherever the linkage lets it show [mm].
MOVED, FOUND = 0.1, 0.01


class Said(NamedTuple):
    """What a mechanism says at a pose: joint values [rad or mm], Ts_base_body [mm], Jacobian."""

    pose: np.ndarray
    joints: np.ndarray
    bodies: np.ndarray
    jacobian: np.ndarray


class Disagreement(NamedTuple):
    """Largest differences at a pose [mm]: of the bodies, in the loops, of the joint values; turns at the lever."""

    bodies: float
    gaps: float
    values: float


def compare(engine, said, values=None):
    """The engine at the joint values that the mechanism says (or at given ones) against all that it says there."""
    engine.set_joints(said.joints if values is None else values)
    return Disagreement(
        body_difference(engine, said),
        np.abs(engine.residuals()).max(),
        max(value_difference(engine, joint, x) for joint, x in zip(engine.joints, said.joints, strict=True)),
    )


def body_difference(engine, said):
    difference = np.abs(engine.place_bodies() - said.bodies)
    return max(difference[:, :3, 3].max(), difference[:, :3, :3].max() * LEVER)


def value_difference(engine, joint, value):
    difference = engine.read_joint(joint) - value
    if joint.kind is JointKind.PRISMATIC:
        return abs(difference)
    return abs(np.mod(difference + np.pi, 2.0 * np.pi) - np.pi) * LEVER


def null_space(matrix):
    """An orthonormal basis of the motions that a matrix forbids none of; the rank must be beyond doubt."""
    _, s, rows = np.linalg.svd(matrix)
    rank = int(np.sum(s > 1e-4 * s[0]))
    assert np.all(s[rank:] < 1e-11 * s[0]), s / s[0]
    return rows[rank:].T


def hand_bodies(engine, motions):
    """Bodies whose twists tell the engine's motions apart: the last one and, if need be, those before it."""
    scale = np.repeat([1.0, LEVER], 3)[:, None]
    names, rows = [], np.zeros((0, motions.shape[1]))
    for name in reversed(engine.names):
        names.append(name)
        rows = np.vstack([rows, scale * (engine.body_jacobian(name) @ motions)])
        if np.linalg.matrix_rank(rows, tol=1e-4 * np.linalg.norm(rows)) == motions.shape[1]:
            break
    return names


def body_twists(mechanism, pose, names):
    """[v of the origin; omega] of bodies per velocity of the task, shape (6 n_bodies, n_velocity), by differences."""
    index = [[body.name for body in mechanism.bodies].index(name) for name in names]
    columns = []
    for unit, step in zip(np.eye(len(pose)), [1e-2 if c.unit == "mm" else 1e-4 for c in mechanism.task], strict=True):
        ahead, behind = (
            mechanism.place_bodies(mechanism.move_pose(pose[None], sign * step * unit[None]))[0, index]
            for sign in (1.0, -1.0)
        )
        turn = ahead[:, :3, :3] @ np.swapaxes(behind[:, :3, :3], 1, 2)
        spin = np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]])
        twist = np.concatenate([ahead[:, :3, 3] - behind[:, :3, 3], spin.T / 2.0], axis=-1) / (2.0 * step)
        columns.append(twist.ravel())
    return np.stack(columns, axis=-1)


def motor_rates(engine, mechanism, said):
    """The engine's d(active joints)/d(velocity of the task): the motion in its loops that moves the hand like that."""
    engine.set_joints(said.joints)
    motions = null_space(engine.loop_jacobian())
    names = hand_bodies(engine, motions)
    twists = body_twists(mechanism, said.pose, names)
    possible = np.vstack([engine.body_jacobian(name) for name in names]) @ motions
    scale = np.tile(np.repeat([1.0, LEVER], 3), len(names))[:, None]
    share = np.linalg.lstsq(scale * possible, scale * twists, rcond=None)[0]
    assert relative_difference(scale * (possible @ share), scale * twists) <= 1e-6, "the hand cannot move like that"
    return motions[engine.held] @ share


def relative_difference(got, want):
    """Largest difference of a column, as a share of the column's size."""
    return float(np.max(np.abs(got - want).max(axis=0) / np.abs(want).max(axis=0)))


def held_columns(engine):
    """The motors' columns, and for each idle freedom the column that it moves most."""
    held = list(engine.held)
    idle = null_space(np.vstack([engine.loop_jacobian() / LEVER, np.eye(engine.model.nv)[held]]))
    for _ in range(idle.shape[1]):
        held.append(int(np.argmax(np.linalg.norm(idle, axis=1))))
        idle = idle @ null_space(idle[held[-1:]])
    return np.array(held)


def return_forward(engine, said, rng, false_motor=0.0):
    """Motors held (one false by so much), all else shaken, loops closed by the engine: what stays open or off [mm]."""
    engine.set_joints(said.joints)
    free = np.setdiff1d(np.arange(engine.model.nv), held_columns(engine))
    shake = np.zeros(engine.model.nv)
    shake[free] = rng.normal(0.0, 0.02, len(free))
    shake[engine.held[0]] = false_motor
    engine.move(shake)
    assert body_difference(engine, said) > 0.1
    engine.close_loops(free)
    return max(np.abs(engine.residuals()).max(), body_difference(engine, said))


@pytest.fixture
def engine(engine_module, each_design):
    return engine_module.Engine(each_design.mechanism)


@pytest.fixture
def sayings(each_design, feasible_poses):
    """At reachable poses far about the workspace; home is not among them, as the engine has seen it."""
    mechanism, poses = each_design.mechanism, feasible_poses(each_design, 8)
    joints, bodies = mechanism.solve_inverse(poses).joints, mechanism.place_bodies(poses)
    return [Said(*row) for row in zip(poses, joints, bodies, mechanism.compute_jacobian(poses), strict=True)]


def test_the_engine_places_every_body_and_reads_every_joint_alike(engine, sayings):
    for said in sayings:
        assert max(compare(engine, said)) <= 1e-9


def test_the_engine_counts_the_freedoms_of_task_and_idle_bodies(engine, each_design, sayings):
    for said in sayings:
        engine.set_joints(said.joints)
        n_freedoms = null_space(engine.loop_jacobian()).shape[1]
        assert n_freedoms == len(each_design.mechanism.task) + each_design.mechanism.n_idle_freedoms


def test_the_engines_loops_give_the_jacobian(engine, each_design, sayings):
    for said in sayings:
        assert relative_difference(motor_rates(engine, each_design.mechanism, said), said.jacobian) <= 1e-6


def test_the_engine_finds_back_to_the_pose_from_its_motors(engine, sayings, rng):
    for said in sayings:
        assert return_forward(engine, said, rng) <= 1e-9


def _false_engines(engine_module, mechanism, kind_of_change):
    """An engine for each end of each joint, told of a change there."""
    joints = mechanism.joints
    for k, joint in enumerate(joints):
        for end in ("parent", "child"):
            false = dataclasses.replace(joint, **kind_of_change(joint, end))
            told = (*joints[:k], false, *joints[k + 1 :])
            yield f"{joint.name} at its {end}", engine_module.Engine(mechanism, told)


def test_any_joint_point_moved_by_a_tenth_of_a_millimetre_is_found(engine_module, each_design, sayings, rng):
    def moved(joint, end):
        away = rng.normal(size=3)
        return {f"p_{end}": tuple(getattr(joint, f"p_{end}") + MOVED * away / np.linalg.norm(away))}

    for where, false in _false_engines(engine_module, each_design.mechanism, moved):
        found = compare(false, sayings[0])
        assert max(found.bodies, found.gaps) > FOUND, where


def test_any_joint_axis_tilted_by_a_tenth_of_a_degree_is_found(engine_module, each_design, sayings, rng):
    def tilted(joint, end):
        axis = np.array(getattr(joint, f"axis_{end}"))
        return {f"axis_{end}": tuple(rotation_about(np.cross(axis, rng.normal(size=3)), 0.1 * DEG) @ axis)}

    for where, false in _false_engines(engine_module, each_design.mechanism, tilted):
        # The angle between a ball's bar and its socket is blind to a tilt across both: another pose sees it.
        assert any(max(compare(false, said)) > FOUND for said in sayings), where


def test_any_joint_taken_out_of_a_loop_is_found_in_the_freedoms(engine, each_design, sayings):
    mechanism = each_design.mechanism
    for joint in engine.loops:
        engine.set_joints(sayings[0].joints)
        engine.release(joint)
        n_freedoms = null_space(engine.loop_jacobian()).shape[1] if engine.data.ne else engine.model.nv
        assert n_freedoms > len(mechanism.task) + mechanism.n_idle_freedoms, joint.name


def test_any_false_joint_value_is_found(engine, sayings):
    by_name = {joint.name: k for k, joint in enumerate(engine.joints)}
    for joint in engine.tree:
        if joint.kind is not JointKind.SPHERICAL:
            false = sayings[0].joints.copy()
            false[by_name[joint.name]] += MOVED if joint.kind is JointKind.PRISMATIC else MOVED / LEVER
            found = compare(engine, sayings[0], false)
            assert max(found.bodies, found.gaps) > FOUND, joint.name


def test_a_jacobian_false_by_a_hundred_thousandth_is_found(engine, each_design, sayings):
    rates, J = motor_rates(engine, each_design.mechanism, sayings[0]), sayings[0].jacobian
    for row, column in zip(*np.nonzero(np.abs(J) > 0.2 * np.abs(J).max(axis=0)), strict=True):
        false = J.copy()
        false[row, column] *= 1.0 + 1e-5
        assert relative_difference(rates, false) > 1e-6


def test_a_motor_false_by_a_microradian_is_found_forward(engine, sayings, rng):
    assert return_forward(engine, sayings[0], rng, false_motor=1e-6) > 1e-8

"""A mechanism retold to MuJoCo: its bodies, the points and axes of its joints, and nothing of its kinematics.

A spanning tree of the joints becomes the engine's tree of bodies; every joint left over becomes an equality constraint.
A `Joint` does not say how far its child is turned at value zero, so one angle per joint of the tree is read off the
placed bodies at home; at every other pose the engine stands alone. Lengths are mm there too.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence

import mujoco
import numpy as np

from linkwright.designs.language.joints import Joint, JointKind, Point
from linkwright.designs.language.mechanism import Array, Mechanism
from linkwright.designs.language.poses import rotation_about

#: Distance [mm] of the second point that a pin holds: 1e-9 mm there is 1e-11 rad.
_SECOND_POINT = 100.0

#: Which joints the tree takes first: a slide has no constraint here, a motor needs a coordinate, a ball has no value.
_TYPES = {
    JointKind.PRISMATIC: mujoco.mjtJoint.mjJNT_SLIDE,
    JointKind.REVOLUTE: mujoco.mjtJoint.mjJNT_HINGE,
    JointKind.SPHERICAL: mujoco.mjtJoint.mjJNT_BALL,
}
_MAX_STEPS = 50


def swap_ends(joint: Joint) -> Joint:
    """The same joint told from its child: its value stays, as both axes turn round."""
    return dataclasses.replace(
        joint,
        parent=joint.child,
        child=joint.parent,
        p_parent=joint.p_child,
        p_child=joint.p_parent,
        axis_parent=_against(joint.axis_child),
        axis_child=_against(joint.axis_parent),
    )


def _against(axis: Point) -> Point:
    x, y, z = axis
    return -x, -y, -z


def split_joints(joints: Sequence[Joint], base: str) -> tuple[list[Joint], list[Joint]]:
    """Joints of a spanning tree, from the base outwards, and those that close loops."""
    rank = list(_TYPES)
    group = {name: name for joint in joints for name in (joint.parent, joint.child)}
    chosen: list[Joint] = []
    left: list[Joint] = []
    for joint in sorted(joints, key=lambda j: (rank.index(j.kind), not j.is_active)):
        a, b = group[joint.parent], group[joint.child]
        (left if a == b else chosen).append(joint)
        group = {name: a if root == b else root for name, root in group.items()}
    tree, reached = [], [base]
    for name in reached:
        for joint in [j for j in chosen if name in (j.parent, j.child)]:
            chosen.remove(joint)
            tree.append(joint if joint.parent == name else swap_ends(joint))
            reached.append(tree[-1].child)
    assert not chosen, f"not joined to the base: {[j.name for j in chosen]}"
    return tree, left


def turn_of(joint: Joint, R_parent_child: Array) -> float:
    """Turn [rad] about the joint's axis, counted from a direction that depends on the axes alone."""
    moved = _axes_about(joint.axis_parent).T @ R_parent_child @ _axes_about(joint.axis_child)
    return float(np.arctan2(moved[1, 0] - moved[0, 1], moved[0, 0] + moved[1, 1]))


@functools.cache
def _axes_about(axis: Point) -> Array:
    """A rotation whose z is the axis."""
    z = np.asarray(axis) / np.linalg.norm(axis)
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    axes = np.stack([x, np.cross(z, x), z], axis=-1)
    axes.flags.writeable = False
    return axes


@functools.lru_cache(maxsize=1)
def _home_of(mechanism: Mechanism) -> tuple[Array, Array]:
    """Bodies (n_bodies, 4, 4) [mm] and joint values (n_joints,) [rad or mm] at home."""
    home = mechanism.home[None]
    return mechanism.place_bodies(home)[0], mechanism.solve_inverse(home).joints[0]


class Engine:
    """The MuJoCo model of a mechanism and its present state.

    Args:
        mechanism: whose bodies at home give the turn at value zero of the joints.
        joints: told to the engine instead of the mechanism's own.

    Attributes:
        tree, loops: joints with coordinates and joints that are constraints.
        held: columns of the velocity that belong to active joints, in the mechanism's order.
    """

    def __init__(self, mechanism: Mechanism, joints: Sequence[Joint] | None = None) -> None:
        self.joints = tuple(joints or mechanism.joints)
        self.names = [body.name for body in mechanism.bodies]
        self.tree, self.loops = split_joints(self.joints, self.names[0])
        self.zero: dict[str, float] = {}
        self.model = self._build(*_home_of(mechanism))
        self.data = mujoco.MjData(self.model)
        self.held = np.array([self._column(j.name) for j in self.joints if j.is_active])

    def _build(self, home: Array, values: Array) -> mujoco.MjModel:
        spec = mujoco.MjSpec()
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        R = {name: T[:3, :3] for name, T in zip(self.names, home, strict=True)}
        value = {joint.name: x for joint, x in zip(self.joints, values, strict=True)}
        for joint in (*self.tree, *self.loops):
            turn = turn_of(joint, R[joint.parent].T @ R[joint.child])
            self.zero[joint.name] = turn - (value[joint.name] if joint.kind is JointKind.REVOLUTE else 0.0)
        made = {self.names[0]: spec.worldbody}
        for joint in self.tree:
            made[joint.child] = self._add_body(made[joint.parent], joint, R[joint.parent].T @ R[joint.child])
        for joint in self.loops:
            _add_closure(spec, made, joint)
        return spec.compile()

    def _add_body(self, parent: mujoco.MjsBody, joint: Joint, R_home: Array) -> mujoco.MjsBody:
        """The child of a tree's joint, drawn at value zero; behind a ball, which has no value, turned as at home."""
        to_parent, to_child = _axes_about(joint.axis_parent), _axes_about(joint.axis_child)
        turned = rotation_about(np.array([0.0, 0.0, 1.0]), self.zero[joint.name])
        R_zero = R_home if joint.kind is JointKind.SPHERICAL else to_parent @ turned @ to_child.T
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, R_zero.ravel())
        body = parent.add_body(name=joint.child, pos=np.array(joint.p_parent) - R_zero @ joint.p_child, quat=quat)
        body.mass, body.inertia, body.explicitinertial = 1.0, np.ones(3), True  # MuJoCo wants some; nothing here moves
        body.add_joint(name=joint.name, type=_TYPES[joint.kind], pos=joint.p_child, axis=joint.axis_child)
        return body

    def _column(self, name: str) -> int:
        return int(self.model.jnt_dofadr[self.model.joint(name).id])

    def columns_of(self, kind: JointKind) -> Array:
        """Columns of the velocity that belong to the tree's joints of a kind."""
        width = 3 if kind is JointKind.SPHERICAL else 1
        starts = [self._column(joint.name) for joint in self.tree if joint.kind is kind]
        return np.array([start + k for start in starts for k in range(width)], dtype=int)

    def set_joints(self, values: Array) -> None:
        """Joint values (n_joints,) [rad or mm] in the mechanism's order; what balls lack in values the loops decide."""
        mujoco.mj_resetData(self.model, self.data)
        value = {joint.name: x for joint, x in zip(self.joints, values, strict=True)}
        for joint in self.tree:
            if joint.kind is not JointKind.SPHERICAL:
                self.data.joint(joint.name).qpos = value[joint.name]
        self.close_loops(self.columns_of(JointKind.SPHERICAL))

    def move(self, velocity: Array) -> None:
        """Go on for a unit of time at a velocity (n_columns,)."""
        mujoco.mj_integratePos(self.model, self.data.qpos, velocity, 1.0)
        mujoco.mj_fwdPosition(self.model, self.data)

    def close_loops(self, free: Array) -> None:
        """Newton's method on the loops' residuals, moving the free columns only."""
        mujoco.mj_fwdPosition(self.model, self.data)
        for _ in range(_MAX_STEPS if len(free) else 0):
            velocity = np.zeros(self.model.nv)
            velocity[free] = np.linalg.lstsq(self.loop_jacobian()[:, free], -self.residuals(), rcond=1e-10)[0]
            self.move(velocity)
            if np.abs(velocity).max() < 1e-13:
                break

    def release(self, joint: Joint) -> None:
        """Take a joint out of the loops, until the joints are set again."""
        for k in range(self.model.neq):
            if self.model.equality(k).name.rpartition("/")[0] == joint.name:
                self.data.eq_active[k] = 0
        self.move(np.zeros(self.model.nv))

    def residuals(self) -> Array:
        """Gaps of the loops [mm]: three components for a ball, and for each of two points of a pin."""
        return np.array(self.data.efc_pos[: self.data.ne])

    def loop_jacobian(self) -> Array:
        """d(residuals)/d(velocity), shape (n_residuals, n_columns)."""
        return np.array(self.data.efc_J).reshape(-1, self.model.nv)[: self.data.ne]

    def place_bodies(self) -> Array:
        """Ts_base_body in the mechanism's order, shape (n_bodies, 4, 4) [mm]."""
        Ts = np.tile(np.eye(4), (len(self.names), 1, 1))
        for T, name in zip(Ts[1:], self.names[1:], strict=True):
            T[:3, :3], T[:3, 3] = self.data.body(name).xmat.reshape(3, 3), self.data.body(name).xpos
        return Ts

    def body_jacobian(self, name: str) -> Array:
        """Velocity of the tree to [v of the body's origin; omega] in base axes, shape (6, n_columns)."""
        J = np.zeros((6, self.model.nv))
        mujoco.mj_jacBody(self.model, self.data, J[:3], J[3:], self.model.body(name).id)
        return J

    def read_joint(self, joint: Joint) -> float:
        """What a joint's value [rad or mm] is between the engine's bodies."""
        parent, child = self.data.body(self._in_engine(joint.parent)), self.data.body(self._in_engine(joint.child))
        R_parent, R_child = parent.xmat.reshape(3, 3), child.xmat.reshape(3, 3)
        if joint.kind is JointKind.PRISMATIC:
            way = child.xpos + R_child @ joint.p_child - parent.xpos - R_parent @ joint.p_parent
            return float(way @ R_parent @ joint.axis_parent)
        if joint.kind is JointKind.SPHERICAL:
            bar, socket = R_child @ joint.axis_child, R_parent @ joint.axis_parent
            return float(np.arctan2(np.linalg.norm(np.cross(bar, socket)), np.dot(bar, socket)))
        return turn_of(joint, R_parent.T @ R_child) - self.zero[joint.name]

    def _in_engine(self, name: str) -> str:
        """The base is the engine's world."""
        return "world" if name == self.names[0] else name


def _add_closure(spec: mujoco.MjSpec, made: dict[str, mujoco.MjsBody], joint: Joint) -> None:
    """Points that a joint keeps together: one for a ball, two along the axis of a pin."""
    assert joint.kind is not JointKind.PRISMATIC, f"{joint.name}: a slide that closes a loop is not told to the engine"
    for k in range(1 if joint.kind is JointKind.SPHERICAL else 2):
        ends = []
        for side in ("parent", "child"):
            axis, at = np.array(getattr(joint, f"axis_{side}")), np.array(getattr(joint, f"p_{side}"))
            site = f"{joint.name}_{side}_{k}"
            made[getattr(joint, side)].add_site(name=site, pos=at + k * _SECOND_POINT * axis)
            ends.append(site)
        spec.add_equality(
            name=f"{joint.name}/{k}",
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            name1=ends[0],
            name2=ends[1],
        )

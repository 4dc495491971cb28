"""A mechanism written as formulas: state at a pose, and what follows from it; the arrays are made here, once for all.

A mechanism of this kind says, in the vocabulary, what its state is at a pose and how joint values, rate rows and body
frames follow from it. Batches, masks, limits and reasons come from here; other readings of the same formulas
(compiled kernels, enclosures, C) can be added without touching a mechanism.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np

from .mechanism import Array, InverseSolution, Mechanism
from .poses import pose_from_parts, pose_from_task, rotation_from_vector, task_from_pose
from .vectors import Rot, Vec
from .vocabulary import Number, Require, Requirements

#: Slack of joint limits [rad, mm]: a pose exactly on a limit keeps it.
LIMIT_SLACK = 1e-9


class FormulaMechanism(Mechanism):
    """A mechanism whose inverse kinematics, Jacobian and body poses are formulas of its pose."""

    @abstractmethod
    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> Any:
        """All that the formulas below need, at a pose (one number per task coordinate) in a branch of `read_branch`."""

    @abstractmethod
    def joint_values(self, state: Any) -> Sequence[Number]:
        """Values of all joints in the mechanism's order [rad or mm]."""

    @abstractmethod
    def rate_rows(self, state: Any) -> Sequence[Sequence[Number]]:
        """Rows d(active joint)/d(velocity), a number per column of the velocity."""

    @abstractmethod
    def body_frames(self, state: Any) -> Sequence[tuple[Rot, Vec]]:
        """Axes and origin of every body in the base, in the mechanism's order."""

    @abstractmethod
    def read_branch(self, branch: str | None) -> Any:
        """What `solve_state` takes for a named branch; None is the working one.

        Raises:
            UnknownNameError: lists the branches.
        """

    def move_pose(self, poses: Array, velocity: Array) -> Array:
        """Poses (n, n_task) after a unit of time at the velocities that the Jacobian's columns stand for.

        For a platform in space these are twists [v; omega] in base axes; otherwise plain rates of the coordinates.
        """
        if len(self.task) != 6:
            return poses + velocity
        Ts = pose_from_task(poses)
        Ts[..., :3, :3] = rotation_from_vector(velocity[..., 3:]) @ Ts[..., :3, :3]
        Ts[..., :3, 3] += velocity[..., :3]
        return task_from_pose(Ts)

    def _evaluate(self, poses: Array, branch: str | None, require: Require) -> Any:
        # Out of reach the formulas may divide by zero or meet infinities; the margins carry the message.
        with np.errstate(all="ignore"):
            return self.solve_state(tuple(np.moveaxis(poses, -1, 0)), self.read_branch(branch), require)

    def solve_inverse(self, poses: Array, branch: str | None = None) -> InverseSolution:
        """Joint values for poses (n, n_task); joint limits are required in the working branch only.

        Branches other than the working one are assemblies that the solids do not allow, so their joints have no limits.
        """
        poses = np.asarray(poses, dtype=float)
        shape, need = poses.shape[:-1], Requirements()
        state = self._evaluate(poses, branch, need)
        with np.errstate(all="ignore"):
            joints = _stacked(self.joint_values(state), shape)
        names, margins = need.names, need.stacked(shape)
        if self.read_branch(branch) == self.read_branch(None):
            lower, upper = (np.array([getattr(j, end) for j in self.joints]) for end in ("lower", "upper"))
            names = names + [f"{j.name} below its limit" for j in self.joints]
            names = names + [f"{j.name} above its limit" for j in self.joints]
            margins = np.concatenate([margins, joints - lower + LIMIT_SLACK, upper - joints + LIMIT_SLACK], axis=-1)
        finite = np.isfinite(margins) & np.all(np.isfinite(poses), axis=-1)[..., None]
        return InverseSolution(
            joints=np.where(np.isfinite(joints), joints, 0.0),
            margins=np.where(finite, margins, -np.inf),
            requirements=tuple(names),
            is_reachable=np.all(finite & (margins >= 0.0), axis=-1),
        )

    def compute_jacobian(self, poses: Array) -> Array:
        """Velocity to active joint rates, shape (n, n_active, n_velocity)."""
        poses = np.asarray(poses, dtype=float)
        state = self._evaluate(poses, None, Requirements())
        # On a serial singularity a rate is infinite: a true answer, not a mishap to warn of.
        with np.errstate(all="ignore"):
            rows = self.rate_rows(state)
        return np.stack([_stacked(row, poses.shape[:-1]) for row in rows], axis=-2)

    def place_bodies(self, poses: Array) -> Array:
        """Ts_base_body, shape (n, n_bodies, 4, 4) [mm]."""
        poses = np.asarray(poses, dtype=float)
        frames = self.body_frames(self._evaluate(poses, None, Requirements()))
        Ts = [np.broadcast_to(pose_from_parts(R, p), (*poses.shape[:-1], 4, 4)) for R, p in frames]
        return np.stack(Ts, axis=-3)


def _stacked(columns: Sequence[Number], shape: tuple[int, ...]) -> Array:
    return np.stack([np.broadcast_to(np.asarray(c, dtype=float), shape) for c in columns], axis=-1)

"""Forward kinematics by search: many starts, every legal answer kept, no answer where there is more than one.

Used by every mechanism without a closed form; derived from its own inverse kinematics and Jacobian, so that it cannot
disagree with them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from .mechanism import Array, ForwardSolution

if TYPE_CHECKING:
    from .formulas import FormulaMechanism

#: Two answers closer than this in every coordinate [mm, rad] are the same.
_SAME = 1e-5
_MAX_STEPS = 40


class Candidates:
    """Collects legal poses for a batch of joint values and says in the end which are answers.

    Args:
        n: size of the batch.
        home: pose that stands where there is no answer, shape (n_task,).
        near: expected poses (n, n_task), or None. With them the nearest legal pose is the answer, else the only one.
    """

    def __init__(self, n: int, home: Array, near: Array | None) -> None:
        self.near = None if near is None else np.broadcast_to(np.asarray(near, dtype=float), (n, len(home)))
        self.poses = np.tile(home, (n, 1))
        self.residual = np.full(n, np.inf)
        self._kept: list[list[Array]] = [[] for _ in range(n)]
        self._distance = np.full(n, np.inf)

    def offer(self, poses: Array, legal: Array, residual: Array) -> None:
        """Take up the legal ones of a batch of poses (n, n_task)."""
        for k in np.flatnonzero(legal):
            if any(np.max(np.abs(poses[k] - other)) < _SAME for other in self._kept[k]):
                continue
            self._kept[k].append(poses[k].copy())
            distance = 0.0 if self.near is None else float(np.linalg.norm(poses[k] - self.near[k]))
            if distance < self._distance[k]:
                self._distance[k], self.poses[k], self.residual[k] = distance, poses[k], residual[k]

    def solution(self) -> ForwardSolution:
        """The answers, and where there are none or too many."""
        found = np.array([len(kept) for kept in self._kept], dtype=int)
        solved = found == 1 if self.near is None else found >= 1
        return ForwardSolution(poses=self.poses, is_solved=solved, n_candidates=found, residual=self.residual)

    def all_poses(self, k: int) -> Array:
        """Every legal pose found for set k, shape (n_candidates, n_task)."""
        return np.array(self._kept[k]).reshape(-1, self.poses.shape[1])


def search_forward(
    mechanism: FormulaMechanism,
    active: Array,
    starts: Iterable[Array],
    near: Array | None,
    *,
    is_working: Callable[[Array], Array] | None = None,
    step_cap: float = 0.3,
    tolerance: float = 1e-10,
) -> ForwardSolution:
    """Newton on the inverse kinematics from many starts.

    Args:
        mechanism: gives the inverse, the Jacobian and `move_pose`.
        active: wanted values (n, n_active) [rad or mm].
        starts: poses (n_task,) to start from; `near` comes first if there is one.
        is_working: tells for poses (n, n_task) whether they belong to the working assembly mode.
        step_cap: largest change of an active joint in one step [rad; times 100 in mm for prismatic joints].
        tolerance: largest difference of active joints that counts as reached [rad or mm].
    """
    active = np.atleast_2d(np.asarray(active, dtype=float))
    candidates = Candidates(len(active), mechanism.home, near)
    finite = np.all(np.isfinite(active), axis=-1)
    goal = np.where(finite[:, None], active, 0.0)
    cap = np.array([step_cap * (100.0 if j.unit == "mm" else 1.0) for j in mechanism.joints[: mechanism.n_active]])
    guesses = [np.broadcast_to(start, (len(active), len(mechanism.home))) for start in starts]
    for guess in [candidates.near, *guesses] if candidates.near is not None else guesses:
        poses, error = _newton(mechanism, goal, np.array(guess, dtype=float), cap)
        legal = finite & (error < tolerance) & mechanism.solve_inverse(poses).is_reachable
        if is_working is not None:
            legal &= is_working(poses)
        candidates.offer(poses, legal, error)
    return candidates.solution()


def _newton(mechanism: FormulaMechanism, goal: Array, poses: Array, cap: Array) -> tuple[Array, Array]:
    error = np.full(len(goal), np.inf)
    n = goal.shape[1]
    for _ in range(_MAX_STEPS):
        miss = goal - mechanism.solve_inverse(poses).joints[:, :n]
        angular = np.array([j.unit == "deg" for j in mechanism.joints[:n]])
        miss = np.where(angular, np.mod(miss + np.pi, 2.0 * np.pi) - np.pi, miss)
        error = np.max(np.abs(miss), axis=-1)
        if np.max(error, initial=0.0) < 1e-14:
            break
        miss *= np.minimum(1.0, np.min(cap / np.maximum(np.abs(miss), 1e-300), axis=-1))[:, None]
        J = mechanism.compute_jacobian(poses)
        J = np.where(np.isfinite(J), J, 0.0)
        velocity = np.einsum("nij,nj->ni", np.linalg.pinv(J), miss)
        moved = mechanism.move_pose(poses, velocity)
        poses = np.where(np.isfinite(moved), moved, poses)
    return poses, error

"""The Global Isotropy Index: the least singular value over a whole set of poses, over the greatest, by compiled kernel.

Source: Stocco, Salcudean, Sassani, eq. (11). Printed: two equal sigmas. Used: minimum over maximum, over all poses.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.program import Program
from linkwright.designs.codegen.singular import singular_values
from linkwright.designs.codegen.trace import trace_formula
from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.formulas import LIMIT_SLACK, FormulaMechanism
from linkwright.designs.language.vectors import Vec, rot_fixed_xyz
from linkwright.designs.language.vocabulary import Number, Require, fmin

from ..pose_sets import PoseSet
from .scaling import N_MOVES, Scaling, hand_columns

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: Poses a call of the kernel: poses and results stay in the processor's cache.
_BLOCK = 4096
_TURNS = ("rx", "ry", "rz")


@dataclass(frozen=True, slots=True, kw_only=True)
class GlobalIsotropy:
    """The index of a set of poses, and the two poses that decide it.

    Attributes:
        least, greatest: singular values of the scaled Jacobian over all reachable poses.
        pose_of_least, pose_of_greatest: where, shape (n_task,) [mm, rad].
        n_poses, n_unreachable: how many were visited, and how many of them are out of reach.
    """

    least: float
    greatest: float
    pose_of_least: Array
    pose_of_greatest: Array
    n_poses: int
    n_unreachable: int

    @property
    def index_of_reachable(self) -> float:
        """The index of those poses that can be reached."""
        return self.least / self.greatest if self.greatest > 0.0 else 0.0

    @property
    def index(self) -> float:
        """The index; 0 if any pose is out of reach (a design must serve its whole workspace)."""
        return 0.0 if self.n_unreachable else self.index_of_reachable


def trace_isotropy(
    mechanism: FormulaMechanism,
    scaling: Scaling,
    *,
    has_hand_axes: bool = True,
    has_limits: bool = False,
    branch: str | None = None,
) -> Program:
    """The program with output "sigma": least and greatest singular value of S_J G S_T^-1 (velocity form: S_J G S_T).

    Args:
        mechanism: whose formulas are traced; legal where these are.
        scaling: of motors and hand.
        has_hand_axes: G counts velocities in the hand's own axes (as Stocco et al. do), else in the base's.
        has_limits: the joint limits are asked as well.
        branch: working mode.
    """

    def formula(pose: Sequence[Number], _: Sequence[Number], require: Require) -> dict[str, Any]:
        state = mechanism.solve_state(tuple(pose), mechanism.read_branch(branch), require)
        if has_limits:
            for joint, value in zip(mechanism.joints, mechanism.joint_values(state), strict=True):
                require(fmin(value - joint.lower, joint.upper - value) + LIMIT_SLACK, f"{joint.name} within its limits")
        rows = [tuple(row)[: hand_columns(mechanism)] for row in mechanism.rate_rows(state)]
        if has_hand_axes:
            rows = _in_hand_axes(mechanism, pose, rows)
        rows = [row for row in rows if not _is_zero(row)]
        lines, columns = scaling.rows(len(rows)), scaling.columns(len(rows[0]))
        scaled = [[x * (a * b) for x, b in zip(row, columns, strict=True)] for row, a in zip(rows, lines, strict=True)]
        return {"sigma": list(singular_values(scaled))}

    return trace_formula(f"{mechanism.name}_isotropy", [c.name for c in mechanism.task], (), formula)


def _is_zero(row: Sequence[Number]) -> bool:
    """A motor that does not move the hand in any pose."""
    return all(isinstance(x, int | float) and x == 0.0 for x in row)


def _in_hand_axes(
    mechanism: FormulaMechanism, pose: Sequence[Number], rows: Sequence[tuple[Number, ...]]
) -> list[tuple[Number, ...]]:
    """Rows by velocities in the hand's axes; a task in a plane keeps its own.

    A task with only two of the turns rx, ry, rz has these as columns; its motors do not feel the third, so their moment
    about the hand's axis of that name is zero, and those about the other two axes follow.
    """
    names = [c.name for c in mechanism.task]
    turns = {name: pose[names.index(name)] if name in names else 0.0 for name in _TURNS}
    missing = [k for k, name in enumerate(_TURNS) if name not in names]
    if names[:N_MOVES] != ["x", "y", "z"] or len(missing) > 1:
        return list(rows)
    Q = rot_fixed_xyz(turns["rx"], turns["ry"], turns["rz"])
    if not missing:
        return [(*Q.inverse_apply(Vec(*row[:3])), *Q.inverse_apply(Vec(*row[3:6]))) for row in rows]
    tilted = rot_fixed_xyz(0.0, turns["ry"], turns["rz"])
    level = rot_fixed_xyz(0.0, 0.0, turns["rz"])
    about = [(tilted.x, level.y, Vec(0.0, 0.0, 1.0))[k] for k in range(3) if k not in missing]
    own = [Q[k] for k in range(3) if k not in missing]
    (a, b), (c, d) = [[axis.dot(e) for e in own] for axis in about]
    part = 1.0 / (a * d - b * c)
    return [
        (*Q.inverse_apply(Vec(*row[:3])), (d * row[3] - b * row[4]) * part, (a * row[4] - c * row[3]) * part)
        for row in rows
    ]


def compute_global_isotropy(
    kernel: Kernel, poses: PoseSet, *, n_threads: int | None = None, progress: Progress | None = None
) -> GlobalIsotropy:
    """The index of a set of poses.

    Args:
        kernel: of a program of `trace_isotropy`.
        poses: which poses to visit.
        n_threads: None for as many as there are cores.
        progress: told how many poses are done.

    Raises:
        VacuousCheckError: no pose is reachable, so there is no singular value to speak of.
    """
    n_threads = n_threads or os.cpu_count() or 1
    ranges = list(poses.blocks(_BLOCK))
    share = -(-len(ranges) // n_threads)
    done = [0] * n_threads

    def visit(k: int) -> list[_Extremes]:
        mine = ranges[k * share : (k + 1) * share]
        buffer = kernel.buffer(max((b - a for a, b in mine), default=0) * len(poses.turns))
        found = []
        for first, last in mine:
            block = poses.poses(first, last)
            result = kernel(block, n_threads=1, into=buffer[: len(block)])
            found.append(_extremes(result.outputs["sigma"], result.is_legal, first * len(poses.turns)))
            done[k] += len(block)
            if k == 0 and progress is not None:
                progress(sum(done), len(poses), "singular values")
        return found

    with ThreadPoolExecutor(n_threads) as pool:
        found = [extreme for part in pool.map(visit, range(n_threads)) for extreme in part]
    low, high = min(found, key=lambda e: e.least), max(found, key=lambda e: e.greatest)
    if not np.isfinite(low.least):
        raise VacuousCheckError(f"{kernel.program.name}: none of {len(poses)} poses can be reached, so nothing is said")
    return GlobalIsotropy(
        least=low.least,
        greatest=high.greatest,
        pose_of_least=poses.pose(low.at_least),
        pose_of_greatest=poses.pose(high.at_greatest),
        n_poses=len(poses),
        n_unreachable=sum(e.n_illegal for e in found),
    )


@dataclass(frozen=True, slots=True)
class _Extremes:
    """Of one block: the ends of the singular values, the numbers of their poses, and how many poses do not count."""

    least: float
    at_least: int
    greatest: float
    at_greatest: int
    n_illegal: int


def _extremes(sigma: Array, is_legal: Array, first: int) -> _Extremes:
    low = np.where(is_legal, sigma[:, 0], np.inf)
    high = np.where(is_legal, sigma[:, 1], -np.inf)
    i, j = int(np.argmin(low)), int(np.argmax(high))
    return _Extremes(float(low[i]), first + i, float(high[j]), first + j, len(low) - int(np.count_nonzero(is_legal)))

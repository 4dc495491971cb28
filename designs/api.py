"""Linkwright from Python: load a mechanism, solve it both ways, differentiate it, place its bodies.

    from linkwright.designs import api

    hit = api.load("hit", ["parameters.base_radius_mm=130"])
    answer = api.solve_inverse(hit, hit.home)
    angles = answer.active                      # [rad], shape (6,)

Units are those inside: millimetre and radian. Every function takes one pose, shape (n_task,), or any array of poses,
shape (..., n_task), and what it returns has the same leading shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from .file.reader import load_design
from .language.errors import ParameterError
from .language.mechanism import Array, ForwardSolution, InverseSolution, Mechanism
from .outside import add_mechanisms

__all__ = [
    "ForwardResult",
    "InverseResult",
    "add_mechanisms",
    "compute_jacobian",
    "load",
    "load_design",
    "place_bodies",
    "solve_forward",
    "solve_inverse",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class InverseResult:
    """Joint values of one pose (leading shape empty) or of many.

    Attributes:
        joints: all joints in the mechanism's order, active first, shape (..., n_joints) [rad or mm]. Finite always,
            but meaningless where `is_reachable` is False.
        n_active: how many of them are driven.
        margins: distance to each requirement, shape (..., n_requirements); legal where >= 0.
        requirements: their names.
        is_reachable: shape (...); for one pose it is a plain truth value.
    """

    joints: Array
    n_active: int
    margins: Array
    requirements: tuple[str, ...]
    is_reachable: Array

    @property
    def active(self) -> Array:
        """The driven joints alone, shape (..., n_active) [rad or mm]."""
        return self.joints[..., : self.n_active]

    def reason(self, *index: int) -> str:
        """Why the pose (at this index, of many) cannot be reached; empty if it can."""
        margins = self.margins[index][None]
        return InverseSolution(
            joints=self.joints[index][None],
            margins=margins,
            requirements=self.requirements,
            is_reachable=np.all(margins >= 0.0, axis=-1),
        ).reason(0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ForwardResult:
    """The pose of one set of driven joint values (leading shape empty) or of many.

    Attributes:
        poses: task coordinates, shape (..., n_task) [mm, rad]; the home pose where `is_solved` is False.
        is_solved: exactly one legal pose was found, or one near the expected one, shape (...).
        n_candidates: how many distinct legal poses were found, shape (...).
        residual: closure error of the answer, shape (...) [rad or mm of the driven joints, as the mechanism says].
    """

    poses: Array
    is_solved: Array
    n_candidates: Array
    residual: Array

    def reason(self, *index: int) -> str:
        """Why the set (at this index, of many) has no answer; empty if it has one."""
        return ForwardSolution(
            poses=self.poses[index][None],
            is_solved=np.atleast_1d(self.is_solved[index]),
            n_candidates=np.atleast_1d(self.n_candidates[index]),
            residual=np.atleast_1d(self.residual[index]),
        ).reason(0)


def load(design: str | Path, overrides: Sequence[str] = ()) -> Mechanism:
    """The mechanism of a design file or of a catalogue name; `load_design` gives the workspace and the rest as well.

    Args:
        design: path of a design file, or a name of the catalogue.
        overrides: texts "key=value" as for `--set` on the command line, in the units of the file.

    Raises:
        DesignFileError: names file, line, key, value and what is allowed.
    """
    return load_design(str(design), overrides).mechanism


def solve_inverse(mechanism: Mechanism, poses: ArrayLike, branch: str | None = None) -> InverseResult:
    """Joint values for poses (..., n_task) [mm, rad], in a named branch (default: the working one).

    Raises:
        ParameterError: the last axis does not hold one number per task coordinate.
        UnknownNameError: lists the branches.
    """
    rows, shape = _rows_of(mechanism, poses)
    solution = mechanism.solve_inverse(rows, branch)
    return InverseResult(
        joints=_shaped(solution.joints, shape),
        n_active=mechanism.n_active,
        margins=_shaped(solution.margins, shape),
        requirements=solution.requirements,
        is_reachable=_shaped(solution.is_reachable, shape),
    )


def solve_forward(mechanism: Mechanism, active: ArrayLike, near: ArrayLike | None = None) -> ForwardResult:
    """Poses for driven joint values (..., n_active) [rad or mm].

    Args:
        mechanism: from `load`.
        active: values of the driven joints.
        near: an expected pose (n_task,), or one each (..., n_task): decides where several poses are legal.

    Raises:
        ParameterError: the last axis does not hold one number per driven joint (per coordinate in `near`).
    """
    names = [f"{joint.name} [{_unit_inside(joint.unit)}]" for joint in mechanism.joints[: mechanism.n_active]]
    rows, shape = _rows(mechanism, active, "active", names)
    guess = None if near is None else np.broadcast_to(_checked_poses(mechanism, near, "near"), (*shape, _n(mechanism)))
    solution = mechanism.solve_forward(rows, None if guess is None else guess.reshape(-1, _n(mechanism)))
    return ForwardResult(
        poses=_shaped(solution.poses, shape),
        is_solved=_shaped(solution.is_solved, shape),
        n_candidates=_shaped(solution.n_candidates, shape),
        residual=_shaped(solution.residual, shape),
    )


def compute_jacobian(mechanism: Mechanism, poses: ArrayLike) -> Array:
    """Velocity to driven joint rates at poses (..., n_task), shape (..., n_active, n_velocity).

    For a platform in space the velocity is the twist [v; omega] in base axes [mm/s, rad/s], else the plain rates of
    the task's coordinates.
    """
    rows, shape = _rows_of(mechanism, poses)
    return _shaped(mechanism.compute_jacobian(rows), shape)


def place_bodies(mechanism: Mechanism, poses: ArrayLike) -> Array:
    """Ts_base_body at poses (..., n_task), shape (..., n_bodies, 4, 4) [mm], in the order of `mechanism.bodies`."""
    rows, shape = _rows_of(mechanism, poses)
    return _shaped(mechanism.place_bodies(rows), shape)


def _n(mechanism: Mechanism) -> int:
    return len(mechanism.task)


def _unit_inside(unit: str) -> str:
    return "rad" if unit == "deg" else unit


def _rows_of(mechanism: Mechanism, poses: ArrayLike) -> tuple[Array, tuple[int, ...]]:
    values = _checked_poses(mechanism, poses, "poses")
    return values.reshape(-1, _n(mechanism)), values.shape[:-1]


def _checked_poses(mechanism: Mechanism, poses: ArrayLike, field: str) -> Array:
    return _checked(mechanism, poses, field, [f"{c.name} [{_unit_inside(c.unit)}]" for c in mechanism.task])


def _rows(mechanism: Mechanism, values: ArrayLike, field: str, names: Sequence[str]) -> tuple[Array, tuple[int, ...]]:
    array = _checked(mechanism, values, field, names)
    return array.reshape(-1, len(names)), array.shape[:-1]


def _checked(mechanism: Mechanism, values: ArrayLike, field: str, names: Sequence[str]) -> Array:
    array = np.asarray(values, dtype=float)
    if array.ndim == 0 or array.shape[-1] != len(names):
        wanted = f"the last axis of {mechanism.name} must hold {len(names)} numbers: {', '.join(names)}"
        raise ParameterError(f"shape of {field}", array.shape, wanted)
    return array


def _shaped(rows: Array, shape: tuple[int, ...]) -> Array:
    return rows.reshape((*shape, *rows.shape[1:]))

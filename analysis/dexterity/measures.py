"""Dexterity at poses: condition numbers, manipulability, isotropy, and how far both kinds of singularity are.

All follow from the Jacobian alone. Written as G = D^-1 W with rows of W of length one, W holds the lines along which
the motors push the hand and D the levers at which they do. Where W loses rank the hand is free although all motors are
held (parallel singularity); where a lever is zero a motor cannot move the hand (serial singularity, a toggle).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from linkwright.designs.language.mechanism import Mechanism

from .scaling import N_MOVES, compute_hand_jacobian, with_length

Array = np.ndarray

_TINY = 1e-300


@dataclass(frozen=True, slots=True, kw_only=True)
class Measures:
    """What the Jacobian says at n poses; arrays of shape (n,), infinite where a matrix is singular.

    Attributes:
        condition: of J, with turns times the stated length.
        condition_position, condition_rotation: of J_p and J_o, the rows of J for v and for omega; no length enters.
            All ones for a task without turns, or with one.
        isotropy: 1 / condition.
        manipulability: product of J's singular values, turns times the length [mm per radian of motor, to the power of
            the degrees of freedom].
        slowest, fastest: least and greatest hand speed for motor rates of length one [mm/rad].
        parallel_margin: least singular value of W; 0 at a parallel singularity, 1 for lines all square to each other.
        determinant: of W, signed if there are as many motors as coordinates, else the root of det W^T W. Its sign is
            the assembly mode; it changes where the parallel singularity is crossed.
        serial_margin: least lever [mm/rad, of a slide mm/mm]; 0 at a toggle.
    """

    condition: Array
    condition_position: Array
    condition_rotation: Array
    isotropy: Array
    manipulability: Array
    slowest: Array
    fastest: Array
    parallel_margin: Array
    determinant: Array
    serial_margin: Array


#: Names of the measures, in order.
MEASURES = tuple(f.name for f in fields(Measures))


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid:
    """Where motor rates of length one take the hand.

    Attributes:
        semi_axes: longest first [mm/rad for moves, rad/rad for turns]; force has the reciprocals.
        directions: unit vectors in the columns, in base axes (turns of a task by single turns: in its coordinates).
    """

    semi_axes: Array
    directions: Array


def measure_poses(mechanism: Mechanism, poses: Array, length: float) -> Measures:
    """Measures at poses (n, n_task), turns made lengths by `length` [mm]."""
    return measure_jacobians(compute_hand_jacobian(mechanism, poses), length)


def measure_jacobians(G: Array, length: float) -> Measures:
    """Measures of hand-to-motor Jacobians, shape (n, n_active, n_hand) [motor rate per mm/s, rad/s]."""
    G = with_length(np.asarray(G, dtype=float), length)
    _, S, Vt = np.linalg.svd(G, full_matrices=False)
    # J = V S^-1 U^T; U is square to itself, so rows of V S^-1 have the singular values of rows of J.
    with np.errstate(over="ignore"):
        rows = np.swapaxes(Vt, -1, -2) / np.maximum(S, _TINY)[:, None, :]
        speeds = 1.0 / np.maximum(S, _TINY)
        condition = S[:, 0] / np.maximum(S[:, -1], _TINY)
        manipulability = np.prod(speeds, axis=-1)
    W, levers = unit_lines(G)
    return Measures(
        condition=condition,
        condition_position=_conditions(rows[:, :N_MOVES]),
        condition_rotation=_conditions(rows[:, N_MOVES:]),
        isotropy=1.0 / condition,
        manipulability=manipulability,
        slowest=speeds[:, 0],
        fastest=speeds[:, -1],
        parallel_margin=np.linalg.svd(W, compute_uv=False)[:, -1],
        determinant=compute_determinants(W),
        serial_margin=np.min(levers, axis=-1),
    )


def unit_lines(G: Array) -> tuple[Array, Array]:
    """W, rows of length one, and the levers in D [mm/rad], of scaled G, shape (n, m, k).

    The lever of a motor that moves the hand in no pose (a grip's) is infinite, and W has no row for it.
    """
    norms = np.linalg.norm(G, axis=-1)
    W = G / np.where(norms > 0.0, norms, 1.0)[..., None]
    with np.errstate(divide="ignore"):
        levers = np.where(norms > 0.0, 1.0 / norms, np.inf)
    return W[:, np.any(norms > 0.0, axis=0)], levers


def compute_determinants(W: Array) -> Array:
    """The determinant of W where it is square, else the root of det W^T W, which has no sign, shape (n,)."""
    if W.shape[1] == W.shape[2]:
        return np.linalg.det(W)
    return np.sqrt(np.maximum(np.linalg.det(np.swapaxes(W, 1, 2) @ W), 0.0))


def _conditions(rows: Array) -> Array:
    if rows.shape[1] < 2:
        return np.ones(len(rows))
    values = np.linalg.svd(rows / np.maximum(np.abs(rows).max(axis=(1, 2), keepdims=True), _TINY), compute_uv=False)
    return values[:, 0] / np.maximum(values[:, -1], _TINY)


def compute_ellipsoids(mechanism: Mechanism, pose: Array) -> tuple[Ellipsoid, ...]:
    """The manipulability ellipsoids of moves and, where the task has turns, of turns, at a pose (n_task,)."""
    J = np.linalg.pinv(compute_hand_jacobian(mechanism, np.asarray(pose)[None])[0])
    parts = [J[:N_MOVES], J[N_MOVES:]] if len(J) > N_MOVES else [J]
    found = []
    for part in parts:
        U, S, _ = np.linalg.svd(part, full_matrices=False)
        found.append(Ellipsoid(semi_axes=S, directions=U))
    return tuple(found)

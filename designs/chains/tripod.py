"""Three planar chains on base pins at 120 degrees under one plate with a ball at each chain's tip.

Leg i stands on a pin at C_i = Rz(delta_i)(R, 0, 0) whose axis is tangential; alpha_i leans its plane outwards. The
plane's chain carries the ball F_i at the height rho_i = L1 + w above the pin and y sideways. All of HIT, UCI and
KAIST share this; they differ in the planar chain. KJIST turns it over: there the pins are on the plate.

Source: Zhang et al., section III, corrected (see the docstrings and tests/papers/test_zhang_hit.py).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..language.vectors import Rot, Vec, rot_y, rot_z
from ..language.vocabulary import Number, Require, atan2, cos, hypot, sin, sqrt

#: Working modes of a leg with one elbow sign: (pin, elbow); +1 stands up, and has the left elbow on the left.
LEG_BRANCHES: dict[str, tuple[float, float]] = {
    "up-out": (1.0, 1.0),
    "up-in": (1.0, -1.0),
    "down-out": (-1.0, 1.0),
    "down-in": (-1.0, -1.0),
}

DELTAS = (0.0, 2.0 * math.pi / 3.0, 4.0 * math.pi / 3.0)

#: The pairs of legs whose balls the plate keeps sqrt(3) r apart (eq. 12).
PAIRS = ((0, 1), (1, 2), (2, 0))

_STEP_CAP = 0.5
_MAX_STEPS = 40


class LegTip(NamedTuple):
    """A leg's ball seen from its pin: lean of the plane [rad], sideways and upwards from the motor pivots [mm]."""

    alpha: Number
    y: Number
    w: Number


def locate_ball(position: Vec, Q: Rot, delta: float, plate_radius: Number) -> Vec:
    """F_i in the base [mm] from the plate's pose.

    Source: Zhang et al., eq. (5); T(r) read as T_x(r).
    """
    return position + Q.apply(rot_z(delta).apply(Vec(plate_radius, 0.0, 0.0)))


def solve_pin(F: Vec, delta: float, base_radius: Number, pivot: Number, pin: float, require: Require) -> LegTip:
    """The leg's lean and its ball in the leg's plane.

    Args:
        F: ball in the base [mm].
        delta: azimuth of the leg [rad].
        base_radius: R [mm]; pivot: L1, pin to motor pivots plus top bar to ball [mm].
        pin: +1 for the leg that stands up, -1 for the one folded through the pin.
        require: told "on the pin": the ball must not lie on the pin's axis.

    Source: Zhang et al., eqs. (6)-(8). Printed: arctan in (7), y' in the root of (8). Used: atan2, z'.
    """
    local = rot_z(-delta).apply(F) - Vec(base_radius, 0.0, 0.0)
    rho = hypot(local.x, local.z)
    require(rho - 1e-6, "on the pin")
    alpha = atan2(pin * local.x, pin * local.z)
    return LegTip(alpha, local.y, pin * rho - pivot)


def solve_offset_pin(
    F: Vec, delta: float, base_radius: Number, pivot: Number, aside: Number, pin: float, require: Require
) -> LegTip:
    """As `solve_pin`, for a ball that lies aside of the leg's plane.

    Args:
        F, delta, base_radius, pivot, pin: as for `solve_pin`.
        aside: x_F, ball from the leg's plane along its outward normal [mm].
        require: told "on the pin": the ball must stay farther from the pin's axis than its offset.

    Source: derived; Zhang et al. forbid the offset.
    """
    local = rot_z(-delta).apply(F) - Vec(base_radius, 0.0, 0.0)
    squared = local.x * local.x + local.z * local.z - aside * aside
    require(squared - 1e-6, "on the pin")
    rho = sqrt(squared)
    alpha = atan2(pin * local.x, pin * local.z) - atan2(pin * aside, rho)
    return LegTip(alpha, local.y, pin * rho - pivot)


def leg_axes(alpha: Number, delta: float) -> Rot:
    """R_base_leg: x normal to the leg's plane (motor axes), y along the pin, z up the leg."""
    turned = rot_z(delta) @ rot_y(alpha)
    assert isinstance(turned, Rot)
    return turned


def leg_link(axes: Rot, foot: Vec, direction: Number, y: Number, z: Number) -> tuple[Rot, Vec]:
    """Axes and origin of a link in the leg's plane: x along it, z along the motors.

    Args:
        axes, foot: the plane's axes and its origin in the base [mm].
        direction: of the link from +y towards +z [rad].
        y, z: its origin in the plane [mm].
    """
    c, s = cos(direction), sin(direction)
    return Rot(axes.y * c + axes.z * s, axes.z * c - axes.y * s, axes.x), foot + axes.y * y + axes.z * z


def push_row(axes: Rot, in_plane: tuple[Number, Number], arm: Vec, slope: Number = 0.0) -> tuple[Number, ...]:
    """Row of the inverse Jacobian for a motor whose rate is a linear form of the ball's velocity in the leg's plane.

    Args:
        axes: the plane's axes in the base.
        in_plane: rate per velocity along y and along z of the plane [rad/mm].
        arm: ball from the platform's origin, in base axes [mm].
        slope: x_F / rho for a ball aside of the plane: leaning the plane lifts it.

    Source: Zhang et al., eq. (16), as force lines; the offset's term is derived.
    """
    along = axes.y * in_plane[0] + (axes.z + axes.x * slope) * in_plane[1]
    return (*along, *arm.cross(along))


def close_loops(
    y: np.ndarray,
    rho: np.ndarray,
    base_radius: float,
    plate_radius: float,
    starts: np.ndarray,
    aside: float = 0.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Newton on the leans: three squared distances between balls equal 3 r^2.

    Args:
        y, rho: the balls in their legs' planes [mm], shape (n, 3).
        base_radius, plate_radius: R, r [mm].
        starts: leans to start from [rad], shape (n, 3).
        aside: x_F, balls from their legs' planes [mm].

    Returns:
        As `close_circles`.

    Source: Zhang et al., eq. (12), squared so that it is smooth.
    """
    wanted = np.full((len(rho), 3), math.sqrt(3.0) * plate_radius)
    return close_circles(y, rho, base_radius, wanted, starts, aside)


def close_circles(
    y: np.ndarray,
    rho: np.ndarray,
    base_radius: float,
    wanted: np.ndarray,
    starts: np.ndarray,
    aside: float = 0.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Newton on three angles: points on circles about the three pins keep wanted distances.

    Args:
        y, rho: the points in their legs' planes [mm], shape (n, 3).
        base_radius: R [mm].
        wanted: distances of the pairs 1-2, 2-3, 3-1 [mm], shape (n, 3).
        starts: leans to start from [rad], shape (n, 3).
        aside: points from their legs' planes [mm].

    Returns:
        alphas (n, 3) [rad]; residual (n,): largest distance error of the three pairs [mm]; det (n,): determinant of
        the closure's derivative, dimensionless; its sign tells the assembly mode and 0 is the parallel singularity.
    """
    alphas = starts.copy()
    e_y = np.stack([rot_z(d).y.array() for d in DELTAS])
    for _ in range(_MAX_STEPS):
        f, A, _ = _closure(alphas, y, rho, base_radius, wanted, aside, e_y)
        step = _solve3(A, f)
        step = np.clip(np.where(np.isfinite(step), step, 0.1), -_STEP_CAP, _STEP_CAP)
        alphas = alphas - step
        if np.max(np.abs(step), initial=0.0) < 1e-15:
            break
    f, A, scale = _closure(alphas, y, rho, base_radius, wanted, aside, e_y)
    residual = np.max(np.abs(f) / (2.0 * np.maximum(wanted, 1e-9)), axis=-1)
    return np.mod(alphas + math.pi, 2.0 * math.pi) - math.pi, residual, np.linalg.det(A / scale[..., None, None])


def _solve3(A: np.ndarray, f: np.ndarray) -> np.ndarray:
    """X with A x = f by cofactors; not finite where A is singular (batched 3x3, no exception)."""
    c0 = np.cross(A[:, 1], A[:, 2])
    c1 = np.cross(A[:, 2], A[:, 0])
    c2 = np.cross(A[:, 0], A[:, 1])
    det = np.einsum("ni,ni->n", A[:, 0], c0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (c0 * f[:, :1] + c1 * f[:, 1:2] + c2 * f[:, 2:3]) / det[:, None]


def _closure(alphas, y, rho, base_radius, wanted, aside, e_y):
    F, dF = [], []
    for i, delta in enumerate(DELTAS):
        axes = leg_axes(alphas[:, i], delta)
        up, out = axes.z.array(), axes.x.array()
        foot = rot_z(delta).apply(Vec(base_radius, 0.0, 0.0)).array()
        F.append(foot + rho[:, i, None] * up + y[:, i, None] * e_y[i] + aside * out)
        dF.append(rho[:, i, None] * out - aside * up)
    n = len(alphas)
    f, A = np.empty((n, 3)), np.zeros((n, 3, 3))
    for k, (a, b) in enumerate(PAIRS):
        apart = F[a] - F[b]
        f[:, k] = np.einsum("ni,ni->n", apart, apart) - wanted[:, k] ** 2
        A[:, k, a] = 2.0 * np.einsum("ni,ni->n", apart, dF[a])
        A[:, k, b] = -2.0 * np.einsum("ni,ni->n", apart, dF[b])
    scale = 2.0 * np.max(wanted, axis=-1) * np.maximum(np.max(np.abs(rho), axis=-1), 1e-9)
    return f, A, np.maximum(scale, 1e-9)


def plate_pose(F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (n, 3, 3) and origin (n, 3) of the plate from its three balls (n, 3, 3) [mm].

    Source: Zhang et al., eqs. (13)-(15). Printed: o = F3 - F2, which turns the plate's normal downwards for legs
    numbered counter-clockwise. Used: o = F2 - F3.
    """
    n_axis = F[:, 0] - 0.5 * (F[:, 1] + F[:, 2])
    n_axis = n_axis / np.linalg.norm(n_axis, axis=-1, keepdims=True)
    o = F[:, 1] - F[:, 2]
    o = o - np.einsum("ni,ni->n", o, n_axis)[:, None] * n_axis
    o = o / np.linalg.norm(o, axis=-1, keepdims=True)
    return np.stack([n_axis, o, np.cross(n_axis, o)], axis=-1), F.mean(axis=1)

"""Forward kinematics of PATHOS-II: nine sensors in closed form, six motors and the grip by Newton on six tori."""

from __future__ import annotations

import numpy as np

from ..language.poses import Array, rotation_from_vector
from ..language.vectors import Rot, Vec, rot_x, rot_y, rot_z
from ..language.vocabulary import Number, Require, sqrt
from .kinematics import N_LEGS, globe_in_platform, motor_frame, product
from .parameters import PathosParameters

#: Largest step of Newton's method [mm, rad], and the most steps taken.
_SHIFT_CAP, _TURN_CAP, _MAX_STEPS = 30.0, 0.4, 40

#: Closure [mm] at which a pose counts as found; rounding leaves about 1e-13.
CLOSED = 1e-11


def locate_globe(p: PathosParameters, leg: int, angles: tuple[Number, Number, Number]) -> Vec:
    """The globular joint's centre in the base [mm] from theta_1, theta_2, theta_3 [rad] of a leg (0 to 5).

    Source: Kim, Chung, eq. (2).
    """
    motor, foot = motor_frame(p, leg)
    first = product(motor, rot_z(angles[0]))
    second = product(first, rot_y(angles[1]))
    third = product(second, rot_x(angles[2]))
    return foot + first.z * p.lower_link_length + second.z * p.middle_link_length + third.z * p.upper_link_length


def platform_from_globes(
    p: PathosParameters, P_3: Vec, P_2: Vec, P_1: Vec, require: Require
) -> tuple[Rot, Vec, Number]:
    """Axes, origin [mm] and h_0 [mm] of the platform from the centres of the globular joints 1, 5 and 6 [mm].

    Args:
        p: the dimensions.
        P_3, P_2, P_1: joints 1, 5, 6, numbered as in the caption of Fig. 5 (the text exchanges P_1 and P_2, which would
            mirror the answer).
        require: told "plates apart" [mm^2].

    Source: Kim, Chung, eqs. (19), (20). Printed: (19) without saying that h = 2 h_0; (20) whose rows sum to zero, so
    that it has no unique solution. Used: h_0 = h / 2, h from the mean of both distances; the plane through P_1, P_2
    that lies h off P_3. Shown by: tests/papers/test_kim_chung_pathos2.py.
    """
    r = p.plate_radius
    far_1, far_2 = P_1 - P_3, P_2 - P_3
    h2 = 0.5 * (far_1.dot(far_1) + far_2.dot(far_2)) - 3.0 * r * r
    require(h2, "plates apart")
    h = sqrt(h2)
    y = _unit(P_1 - P_2)
    w = (P_1 + P_2) * 0.5 - P_3
    w = w - y * w.dot(y)
    x = _unit(y.cross(w) * h - w * (1.5 * r))
    axes = Rot(x, y, x.cross(y))
    return axes, P_3 + axes.apply(Vec(-r, 0.0, 0.5 * h)), 0.5 * h


def _unit(v: Vec) -> Vec:
    return v * (1.0 / v.norm())


class Tori:
    """The six surfaces on which the motors keep the globular joints: tori about R2 of radii l_2 and l_3.

    Args:
        p: the dimensions.
        motors: theta_1 of all legs (n, 6) [rad].
        h_0: half the distance of the top plates (n,) [mm].
    """

    def __init__(self, p: PathosParameters, motors: Array, h_0: Array) -> None:
        self.l_2, self.l_3 = p.middle_link_length, p.upper_link_length
        n = len(motors)
        self.axes, self.hips, self.centres = np.empty((n, 6, 3, 3)), np.empty((n, 6, 3)), np.empty((n, 6, 3))
        for i in range(N_LEGS):
            motor, foot = motor_frame(p, i)
            first = product(motor, rot_z(motors[:, i]))
            for k, column in enumerate(first):
                self.axes[:, i, :, k] = column.array()
            self.hips[:, i] = (foot + first.z * p.lower_link_length).array()
            self.centres[:, i] = globe_in_platform(p, h_0, i)[1].array()

    def misses(self, R: Array, origin: Array, rows: Array) -> tuple[Array, Array]:
        """Distances from the surfaces (m, 6) [mm] and d(distance)/d(v, omega), (m, 6, 6), for the sets in `rows`."""
        arm = np.einsum("nij,nkj->nki", R, self.centres[rows])
        c = np.einsum("nkij,nki->nkj", self.axes[rows], arm + origin[:, None] - self.hips[rows])
        ring = np.maximum(np.hypot(c[..., 0], c[..., 2]), 1e-9)
        off = ring - self.l_2
        tube = np.maximum(np.hypot(off, c[..., 1]), 1e-9)
        local = np.stack([off * c[..., 0] / ring, c[..., 1], off * c[..., 2] / ring], axis=-1) / tube[..., None]
        n = np.einsum("nkij,nkj->nki", self.axes[rows], local)
        return tube - self.l_3, np.concatenate([n, np.cross(arm, n)], axis=-1)

    def close(self, R: Array, origin: Array) -> tuple[Array, Array, Array]:
        """Newton from start poses (n, 3, 3), (n, 3): poses and the largest distance left (n,) [mm].

        Steps are capped, so that a start stays on its side; a pose that does not close keeps a large distance.
        """
        R, origin, error = R.copy(), origin.copy(), np.full(len(R), np.inf)
        rows = np.arange(len(R))
        scale = float(np.linalg.norm(self.centres[0, 0])) if len(R) else 1.0
        for _ in range(_MAX_STEPS):
            distance, A = self.misses(R[rows], origin[rows], rows)
            before, error[rows] = error[rows], np.max(np.abs(distance), axis=-1)
            # One step more once the closure is reached takes it to the rounding.
            going = ~((before < CLOSED) & (error[rows] < CLOSED))
            rows, distance, A = rows[going], distance[going], A[going]
            if not len(rows):
                break
            A = A / np.array([1.0] * 3 + [scale] * 3)
            singular = np.abs(np.linalg.det(A)) < 1e-12
            A = A + np.where(singular, 1e-3, 0.0)[:, None, None] * np.eye(6)
            step = np.linalg.solve(A, -distance[..., None])[..., 0] / np.array([1.0] * 3 + [scale] * 3)
            big = np.maximum(
                np.linalg.norm(step[:, :3], axis=-1) / _SHIFT_CAP, np.linalg.norm(step[:, 3:], axis=-1) / _TURN_CAP
            )
            step = step / np.maximum(big, 1.0)[:, None]
            origin[rows] += step[:, :3]
            R[rows] = rotation_from_vector(step[:, 3:]) @ R[rows]
        return R, origin, error

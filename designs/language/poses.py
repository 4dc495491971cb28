"""Poses as 4x4 matrices, batch-first: `T_ab` is the pose of b seen from a, so T_ac = T_ab @ T_bc."""

from __future__ import annotations

import numpy as np

from .vectors import Rot, Vec, rot_fixed_xyz

Array = np.ndarray


def pose_from_parts(R: Rot, p: Vec) -> Array:
    """Ts from a rotation and an origin whose components may be arrays; shape (..., 4, 4), [mm]."""
    columns = [R.x.array(), R.y.array(), R.z.array(), p.array()]
    shape = np.broadcast_shapes(*(c.shape[:-1] for c in columns))
    Ts = np.zeros((*shape, 4, 4))
    for i, column in enumerate(columns):
        Ts[..., :3, i] = column
    Ts[..., 3, 3] = 1.0
    return Ts


def pose_from_task(poses: Array) -> Array:
    """Ts_base_platform, shape (..., 4, 4), from rows x, y, z [mm], rx, ry, rz [rad], shape (..., 6)."""
    p = np.moveaxis(np.asarray(poses, dtype=float), -1, 0)
    return pose_from_parts(rot_fixed_xyz(p[3], p[4], p[5]), Vec(p[0], p[1], p[2]))


def task_from_pose(Ts: Array) -> Array:
    """Rows x, y, z [mm], rx, ry, rz [rad], shape (..., 6); ry within +-90 degrees, the inverse of `pose_from_task`."""
    R = Ts[..., :3, :3]
    ry = np.arctan2(-R[..., 2, 0], np.hypot(R[..., 0, 0], R[..., 1, 0]))
    rx = np.arctan2(R[..., 2, 1], R[..., 2, 2])
    rz = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    return np.concatenate([Ts[..., :3, 3], np.stack([rx, ry, rz], axis=-1)], axis=-1)


def invert_pose(Ts: Array) -> Array:
    """T_ba from T_ab, shape (..., 4, 4)."""
    R_t = np.swapaxes(Ts[..., :3, :3], -1, -2)
    out = np.zeros_like(Ts)
    out[..., :3, :3] = R_t
    out[..., :3, 3] = -np.einsum("...ij,...j->...i", R_t, Ts[..., :3, 3])
    out[..., 3, 3] = 1.0
    return out


def transform_points(Ts: Array, points: Array) -> Array:
    """Points given in b, shape (..., n, 3), as seen from a [mm]."""
    return np.einsum("...ij,...nj->...ni", Ts[..., :3, :3], points) + Ts[..., None, :3, 3]


def rotation_about(axis: Array, angle: float | Array) -> Array:
    """Rotation matrices, shape (..., 3, 3), about a unit axis (3,) by angles [rad] (Rodrigues)."""
    a = np.asarray(angle, dtype=float)[..., None, None]
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(a) * K + (1.0 - np.cos(a)) * (K @ K)


def rotation_from_vector(vectors: Array) -> Array:
    """Rotation matrices (..., 3, 3) from rotation vectors, axis times angle [rad], shape (..., 3)."""
    v = np.asarray(vectors, dtype=float)
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    zero = np.zeros_like(v[..., 0])
    K = np.stack([zero, -v[..., 2], v[..., 1], v[..., 2], zero, -v[..., 0], -v[..., 1], v[..., 0], zero], axis=-1)
    K = K.reshape((*v.shape[:-1], 3, 3))
    # sinc and its like stay finite at zero angle.
    first, second = np.sinc(angle / np.pi), 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    return np.eye(3) + first * K + second * (K @ K)


def turn_about(point: Array, axis: Array, angle: float | Array) -> Array:
    """Pose change, shape (..., 4, 4), that turns about a line through a point [mm] by angles [rad]."""
    R = rotation_about(axis, angle)
    T = np.zeros((*R.shape[:-2], 4, 4))
    T[..., :3, :3] = R
    T[..., :3, 3] = np.asarray(point) - R @ np.asarray(point)
    T[..., 3, 3] = 1.0
    return T


def frame(origin: tuple[float, float, float], z: tuple[float, float, float], x: tuple[float, float, float]) -> Array:
    """T of a frame with this origin [mm], its z along `z` and its x in the half plane of `x`; shape (4, 4)."""
    e_z = np.asarray(z, dtype=float) / np.linalg.norm(z)
    e_x = np.asarray(x, dtype=float) - np.dot(x, e_z) * e_z
    e_x /= np.linalg.norm(e_x)
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = e_x, np.cross(e_z, e_x), e_z, origin
    return T

"""Vectors and rotations whose components are any numbers of the vocabulary.

A batch of poses is a vector whose components are arrays; a traced vector has nodes in it. So a formula reads like
the paper's and needs no second version.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .vocabulary import Number, cos, sin, sqrt


class Vec(NamedTuple):
    """A vector of three numbers."""

    x: Number
    y: Number
    z: Number

    def __add__(self, other: Vec) -> Vec:  # type: ignore[override]
        return Vec(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec) -> Vec:
        return Vec(self.x - other.x, self.y - other.y, self.z - other.z)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y, -self.z)

    def __mul__(self, factor: Number) -> Vec:  # type: ignore[override]
        return Vec(self.x * factor, self.y * factor, self.z * factor)

    def __rmul__(self, factor: Number) -> Vec:  # type: ignore[override]
        return self * factor

    def dot(self, other: Vec) -> Number:
        """Scalar product."""
        return self.x * other.x + self.y * other.y + self.z * other.z

    def cross(self, other: Vec) -> Vec:
        """Vector product."""
        return Vec(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    def norm(self) -> Number:
        """Length."""
        return sqrt(self.dot(self))

    def array(self) -> np.ndarray:
        """The components as one array, shape (..., 3)."""
        return np.stack(np.broadcast_arrays(*(np.asarray(c, dtype=float) for c in self)), axis=-1)


def vec_from_array(a: np.ndarray) -> Vec:
    """The vector (batch) held in the last axis of an array, shape (..., 3)."""
    return Vec(a[..., 0], a[..., 1], a[..., 2])


class Rot(NamedTuple):
    """A rotation as its three columns: `R_ab` holds b's axes seen from a."""

    x: Vec
    y: Vec
    z: Vec

    def __matmul__(self, other: Rot | Vec) -> Rot | Vec:  # type: ignore[override]
        if isinstance(other, Rot):
            return Rot(self.apply(other.x), self.apply(other.y), self.apply(other.z))
        return self.apply(other)

    def apply(self, v: Vec) -> Vec:
        """The vector v, given along this frame's axes, along the outer axes."""
        return self.x * v.x + self.y * v.y + self.z * v.z

    def inverse_apply(self, v: Vec) -> Vec:
        """The vector v, given along the outer axes, along this frame's axes."""
        return Vec(self.x.dot(v), self.y.dot(v), self.z.dot(v))


def rot_x(angle: Number) -> Rot:
    """Rotation about x by an angle [rad]."""
    c, s = cos(angle), sin(angle)
    return Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, c, s), Vec(0.0, -s, c))


def rot_y(angle: Number) -> Rot:
    """Rotation about y by an angle [rad]."""
    c, s = cos(angle), sin(angle)
    return Rot(Vec(c, 0.0, -s), Vec(0.0, 1.0, 0.0), Vec(s, 0.0, c))


def rot_z(angle: Number) -> Rot:
    """Rotation about z by an angle [rad]."""
    c, s = cos(angle), sin(angle)
    return Rot(Vec(c, s, 0.0), Vec(-s, c, 0.0), Vec(0.0, 0.0, 1.0))


def rot_fixed_xyz(rx: Number, ry: Number, rz: Number) -> Rot:
    """Q = Rz(rz) Ry(ry) Rx(rx): turns about the fixed axes X, then Y, then Z, by angles [rad].

    Source: Zhang et al., eq. (3). Printed: four wrong entries. Used: the product itself.
    Shown by: tests/papers/test_zhang_hit.py.
    """
    cx, sx, cy, sy, cz, sz = cos(rx), sin(rx), cos(ry), sin(ry), cos(rz), sin(rz)
    return Rot(
        Vec(cz * cy, sz * cy, -sy),
        Vec(cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
        Vec(cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
    )

"""What the joints between two bodies say about pairs of their faces: exempt, or at the same distance at every pose.

A turn about a joint's axis maps a full face of revolution about it to itself. So such a face of one body keeps its
distance from every face of the other, and one pose speaks for all. A bearing's ring is as near the housing's bore
all round at every pose: to search that again at each of a thousand poses would cost more than everything else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import transform_points
from linkwright.generator.assembly import AssembledBody, Assembly
from linkwright.generator.mesh import Mesh
from linkwright.generator.surfaces import is_revolved_about

from .mating import TOLERANCE, mating_faces

Array = np.ndarray

#: How far the ends of an edge may differ in radius or height and lie on one circle [mm].
_ON_CIRCLE = 1e-5
#: Bits 0 to 5 are those of joints; the last two say that a face of A, or of B, is full, and are set on all others too.
_MAX_JOINTS, _FULL_IN_A, _FULL_IN_B = 6, np.uint8(64), np.uint8(128)


@dataclass(frozen=True, slots=True, kw_only=True)
class JointedFaces:
    """Bits per face of two bodies A and B, uint8; a pair of faces that shares a bit has the property.

    Attributes:
        exempt_a, exempt_b: the pair mates in a joint, its gap is a fit.
        steady_a, steady_b: exempt, or one of the two is a full face of revolution about the only joint's axis.
    """

    exempt_a: Array
    exempt_b: Array
    steady_a: Array
    steady_b: Array


class FaceTable:
    """What each joint says about the faces of each body of an assembly; asked once per kind of body and joint."""

    def __init__(self, assembly: Assembly) -> None:
        self._joints = assembly.design.mechanism.joints
        self._known: dict[tuple[object, ...], tuple[Array, Array]] = {}

    def _of(self, body: AssembledBody, joint: Joint) -> tuple[Array, Array]:
        """Mating and full faces, uint8 (n_faces,) each."""
        as_parent = joint.parent == body.body.name
        place = (joint.p_parent, joint.axis_parent) if as_parent else (joint.p_child, joint.axis_child)
        key = (body.body.kind, joint.kind, as_parent, *place)
        if key not in self._known:
            self._known[key] = (
                mating_faces(body, joint, as_parent=as_parent),
                full_faces(body, joint, as_parent=as_parent),
            )
        return self._known[key]

    def classes(self, body: AssembledBody) -> Array:
        """A number per face: equal for faces that run in, and are full about, the same joints of the body."""
        rows = [
            row
            for joint in self._joints
            if body.body.name in (joint.parent, joint.child)
            for row in self._of(body, joint)
        ]
        if not rows:
            return np.zeros(n_faces(body), np.int64)
        return np.unique(np.array(rows), axis=1, return_inverse=True)[1].reshape(-1).astype(np.int64)

    def between(self, a: AssembledBody, b: AssembledBody, Ts_ab: Array) -> JointedFaces | None:
        """What the joints of two bodies say; None if no joint holds them together.

        Args:
            a, b: two bodies of the assembly.
            Ts_ab: all poses of B seen from A that will be looked at, shape (n, 4, 4) [mm]. Steady is claimed only
                of a joint whose two halves are seen to meet at every one of them.

        Raises:
            ValueError: more joints than the bits allow.
        """
        names = {a.body.name, b.body.name}
        joints = [joint for joint in self._joints if {joint.parent, joint.child} == names]
        if not joints:
            return None
        if len(joints) > _MAX_JOINTS:
            raise ValueError(f"{a.body.name} and {b.body.name} share {len(joints)} joints; {_MAX_JOINTS} are the most")
        exempt_a, exempt_b = (np.zeros(n_faces(body), np.uint8) for body in (a, b))
        for k, joint in enumerate(joints):
            exempt_a |= self._of(a, joint)[0] << np.uint8(k)
            exempt_b |= self._of(b, joint)[0] << np.uint8(k)
        steady_a, steady_b = exempt_a, exempt_b
        if len(joints) == 1 and joints[0].kind is JointKind.REVOLUTE and _meets(joints[0], a.body.name, Ts_ab):
            steady_a = exempt_a | self._of(a, joints[0])[1] * _FULL_IN_A | _FULL_IN_B
            steady_b = exempt_b | self._of(b, joints[0])[1] * _FULL_IN_B | _FULL_IN_A
        return JointedFaces(exempt_a=exempt_a, exempt_b=exempt_b, steady_a=steady_a, steady_b=steady_b)


def n_faces(body: AssembledBody) -> int:
    """How many faces the parts of a body have."""
    return sum(len(assembled.solid.surfaces) for assembled in body.parts)


def full_faces(body: AssembledBody, joint: Joint, *, as_parent: bool) -> Array:
    """1 for the faces of a body that a turn about a joint's axis maps to themselves, uint8 (n_faces,).

    These lie on a surface of revolution about the axis and are bounded by circles about it alone, so that no sector,
    hole or notch is missing; running in the joint or not.
    """
    point, axis = (joint.p_parent, joint.axis_parent) if as_parent else (joint.p_child, joint.axis_child)
    flags: list[bool] = []
    for assembled in body.parts:
        R, p = assembled.T_body_part[:3, :3], assembled.T_body_part[:3, 3]
        at, along = R.T @ (np.asarray(point) - p), R.T @ np.asarray(axis)
        revolved = [
            is_revolved_about(s, tuple(at.tolist()), tuple(along.tolist()), TOLERANCE) for s in assembled.solid.surfaces
        ]
        if any(revolved):
            is_full = _bounded_by_circles(assembled.solid.mesh, len(revolved), at, along)
            revolved = [r and f for r, f in zip(revolved, is_full.tolist(), strict=True)]
        flags += revolved
    return np.array(flags, dtype=np.uint8)


def _bounded_by_circles(mesh: Mesh, n: int, point: Array, axis: Array) -> Array:
    """Which of n faces have edges to other faces only along circles about a line, shape (n,)."""
    t = mesh.triangles.astype(np.int64)
    ends = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    faces = np.tile(mesh.faces, 3)
    # Each edge is met twice, once from either side; sorted, the two stand next to each other.
    edges = np.sort(ends, axis=1)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    one, two = order[0::2], order[1::2]
    between = faces[one] != faces[two]
    offset = mesh.vertices - point
    height = offset @ axis
    radius = np.linalg.norm(offset - height[:, None] * axis, axis=1)
    a, b = edges[one].T
    on_circle = (np.abs(height[a] - height[b]) < _ON_CIRCLE) & (np.abs(radius[a] - radius[b]) < _ON_CIRCLE)
    full = np.ones(n, bool)
    full[faces[one][between & ~on_circle]] = False
    full[faces[two][between & ~on_circle]] = False
    return full


def _meets(joint: Joint, name_a: str, Ts_ab: Array) -> bool:
    """The joint's axis and point on A and on B coincide at all poses."""
    on = {joint.parent: (joint.p_parent, joint.axis_parent), joint.child: (joint.p_child, joint.axis_child)}
    name_b = joint.child if joint.parent == name_a else joint.parent
    (p_a, axis_a), (p_b, axis_b) = on[name_a], on[name_b]
    gap = transform_points(Ts_ab, np.array([p_b])) - np.array(p_a)
    turn = np.cross(Ts_ab[:, :3, :3] @ np.array(axis_b), np.array(axis_a))
    return bool((np.abs(gap) < TOLERANCE).all() and (np.abs(turn) < TOLERANCE).all())

"""Which faces of two bodies a joint lets come near each other, and the bodies' meshes with the numbers of their faces.

A joint's motion leaves the gap between certain faces unchanged: two faces of revolution about a revolute joint's
axis, two faces swept along a prismatic joint's axis, the ball of a spherical joint and anything in the other body.
Such a gap is a fit. It is checked once, exactly, by `fits`; the checks over poses exempt these pairs and no others.
Only parts that declare `runs_in_joint` have such faces.

Faces are numbered through a body: a part's faces follow those of the parts before it, in the order of their solids.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import transform_points
from linkwright.generator.assembly import AssembledBody
from linkwright.generator.surfaces import Surface, SurfaceKind, is_revolved_about, is_sphere_at

Array = np.ndarray

#: How far an axis or a centre may lie from the joint's [mm], and how far directions may differ.
TOLERANCE = 1e-6


def mating_faces(body: AssembledBody, joint: Joint, *, as_parent: bool) -> Array:
    """1 for the faces of a body that a joint may bring near their partners in the other body, else 0.

    Args:
        body: parent or child of the joint.
        joint: the joint.
        as_parent: which of the two the body is. A spherical joint's child has the ball: its spheres about the centre
            mate; its parent has the socket: all faces of revolution about the opening's axis mate, seats and rim
            alike, because the ball turns in itself.

    Returns:
        uint8 over the body's faces, shape (n_faces,). A pair of faces is exempt if both are 1.
    """
    socket = joint.kind is JointKind.SPHERICAL and as_parent
    runs = np.concatenate([np.full(len(a.solid.surfaces), a.part.runs_in_joint) for a in body.parts])
    steady = _faces(body, joint, as_parent, is_revolved_about if socket else _KEPT_BY[joint.kind])
    return (runs & steady).astype(np.uint8)


def steady_faces(body: AssembledBody, joint: Joint, *, as_parent: bool) -> Array:
    """Bits by which a search for the end of a joint's travel leaves out pairs of faces that cannot stop it.

    They are those whose gap the motion leaves unchanged, whether or not their parts run in the joint: two faces of
    revolution about a revolute joint's axis, two faces swept along a prismatic one's, a sphere about a ball joint's
    centre and anything. Where such a face ends within a turn it borders a face that is not of this kind, and that one
    meets whatever the first would have met.

    Args:
        body, joint, as_parent: as for `mating_faces`.

    Returns:
        uint8 over the body's faces, shape (n_faces,). A pair is left out if the two share a bit.
    """
    steady = _faces(body, joint, as_parent, _KEPT_BY[joint.kind])
    if joint.kind in (JointKind.REVOLUTE, JointKind.PRISMATIC):
        return steady.astype(np.uint8)
    # Bit 1: a sphere of the child against all of the parent; bit 2: a sphere of the parent against all of the child.
    own, other = (2, 1) if as_parent else (1, 2)
    return np.where(steady, own | other, other).astype(np.uint8)


def _faces(body: AssembledBody, joint: Joint, as_parent: bool, claim: Callable[..., bool]) -> Array:
    """Whether a claim about surface, point and axis holds for each face of a body, the joint seen from its part."""
    point, axis = (joint.p_parent, joint.axis_parent) if as_parent else (joint.p_child, joint.axis_child)
    flags = []
    for assembled in body.parts:
        R, p = assembled.T_body_part[:3, :3], assembled.T_body_part[:3, 3]
        at, along = R.T @ (np.asarray(point) - p), R.T @ np.asarray(axis)
        flags += [claim(surface, at, along, TOLERANCE) for surface in assembled.solid.surfaces]
    return np.array(flags, dtype=bool)


def _is_sphere_at(surface: Surface, point: Array, axis: Array, tol: float) -> bool:
    return is_sphere_at(surface, tuple(point), tol)


def _is_swept_along(surface: Surface, point: Array, axis: Array, tol: float) -> bool:
    if surface.kind is SurfaceKind.PLANE:
        return abs(float(np.dot(surface.axis, axis))) <= tol
    return surface.kind is SurfaceKind.CYLINDER and float(np.linalg.norm(np.cross(surface.axis, axis))) <= tol


#: Which surfaces a joint's motion maps into themselves.
_KEPT_BY: dict[JointKind, Callable[..., bool]] = {
    JointKind.REVOLUTE: is_revolved_about,
    JointKind.PRISMATIC: _is_swept_along,
    JointKind.SPHERICAL: _is_sphere_at,
    JointKind.UNIVERSAL: _is_sphere_at,
}


def body_triangles(body: AssembledBody) -> tuple[Array, Array, Array]:
    """The surface of a body as triangles in its own axes.

    Returns:
        corners, shape (m, 3, 3) [mm]; number of the face in the body, shape (m,), int32; number of the part, shape
        (m,), int32.
    """
    corners, groups, parts, first = [], [], [], 0
    for i, assembled in enumerate(body.parts):
        mesh = assembled.solid.mesh
        corners.append(transform_points(assembled.T_body_part, mesh.vertices)[mesh.triangles])
        groups.append(mesh.faces.astype(np.int32) + np.int32(first))
        parts.append(np.full(len(mesh.triangles), i, dtype=np.int32))
        first += len(assembled.solid.surfaces)
    return np.concatenate(corners), np.concatenate(groups), np.concatenate(parts)

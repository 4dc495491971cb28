"""Which faces of two bodies a joint lets come near each other, and the bodies' meshes with the numbers of their faces.

A joint's motion leaves the gap between certain faces unchanged: two faces of revolution about a revolute joint's
axis, two faces swept along a prismatic joint's axis, the ball of a spherical joint and anything in the other body.
Such a gap is a fit. It is checked once, exactly, by `fits`; the checks over poses exempt these pairs and no others.
Only parts that declare `runs_in_joint` have such faces.

Faces are numbered through a body: a part's faces follow those of the parts before it, in the order of their solids.
"""

from __future__ import annotations

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
    point, axis = (joint.p_parent, joint.axis_parent) if as_parent else (joint.p_child, joint.axis_child)
    flags = []
    for assembled in body.parts:
        R, p = assembled.T_body_part[:3, :3], assembled.T_body_part[:3, 3]
        at, along = R.T @ (np.asarray(point) - p), R.T @ np.asarray(axis)
        runs = assembled.part.runs_in_joint
        flags += [runs and _mates(surface, joint.kind, at, along, as_parent) for surface in assembled.solid.surfaces]
    return np.array(flags, dtype=np.uint8)


def _mates(surface: Surface, kind: JointKind, point: Array, axis: Array, as_parent: bool) -> bool:
    if kind is JointKind.SPHERICAL and not as_parent:
        return is_sphere_at(surface, point, TOLERANCE)
    if kind is JointKind.PRISMATIC:
        along = abs(float(np.dot(surface.axis, axis)))
        flat = surface.kind is SurfaceKind.PLANE and along < TOLERANCE
        return flat or (surface.kind is SurfaceKind.CYLINDER and along > 1.0 - TOLERANCE**2)
    if kind is JointKind.UNIVERSAL:  # two axes at once: no gap but that of a sphere is kept
        return is_sphere_at(surface, point, TOLERANCE)
    return is_revolved_about(surface, point, axis, TOLERANCE)


def body_triangles(body: AssembledBody) -> tuple[Array, Array, Array]:
    """The surface of a body as triangles in its own axes.

    Returns:
        corners, shape (m, 3, 3) [mm]; number of the face in the body, shape (m,), int32; number of the part, (m,), int32.
    """
    corners, groups, parts, first = [], [], [], 0
    for i, assembled in enumerate(body.parts):
        mesh = assembled.solid.mesh
        corners.append(transform_points(assembled.T_body_part, mesh.vertices)[mesh.triangles])
        groups.append(mesh.faces.astype(np.int32) + np.int32(first))
        parts.append(np.full(len(mesh.triangles), i, dtype=np.int32))
        first += len(assembled.solid.surfaces)
    return np.concatenate(corners), np.concatenate(groups), np.concatenate(parts)

"""Exact measures between the faces of two bodies, by the CAD kernel: gaps and common volumes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.poses import transform_points
from linkwright.generator.assembly import AssembledBody

from .contact.distance import compute_distance
from .contact.tree import ContactTree, build_tree
from .mating import body_triangles

Array = np.ndarray

#: Faces nearer than this touch [mm]: the kernel's own tolerance.
TOUCH = 1e-6


@dataclass(frozen=True, kw_only=True)
class BodyFaces:
    """The faces of a body in its own axes, numbered through the body; read from the kernel when first asked for.

    Attributes:
        body: with its solids.
        lower, upper: corners of a box around each face, shape (n_faces, 3) [mm].
        parts: number of each face's part, shape (n_faces,).
        triangles: corners of each face's mesh, per face (m, 3, 3) [mm].
        deviation: of those meshes [mm].
    """

    body: AssembledBody
    lower: Array
    upper: Array
    parts: Array
    triangles: tuple[Array, ...]
    deviation: float

    @cached_property
    def shapes(self) -> tuple[Any, ...]:
        """The faces as shapes of the kernel, each at its place in the body."""
        faces: list[Any] = []
        for assembled in self.body.parts:
            location = location_from_pose(assembled.T_body_part)
            faces += [face.Moved(location) for face in faces_of(assembled.solid.shape)]
        return tuple(faces)

    @cached_property
    def _trees(self) -> dict[int, ContactTree]:
        return {}

    def tree(self, face: int) -> ContactTree:
        """The mesh of one face, searchable; made when first asked for."""
        if face not in self._trees:
            self._trees[face] = build_tree(self.triangles[face])
        return self._trees[face]


def build_body_faces(body: AssembledBody) -> BodyFaces:
    """The faces of a body with boxes that hold them."""
    corners, groups, of_triangle = body_triangles(body)
    n = sum(len(assembled.solid.surfaces) for assembled in body.parts)
    lower, upper, parts = np.full((n, 3), np.inf), np.full((n, 3), -np.inf), np.zeros(n, dtype=int)
    np.minimum.at(lower, groups, corners.min(axis=1))
    np.maximum.at(upper, groups, corners.max(axis=1))
    parts[groups] = of_triangle
    order = np.argsort(groups, kind="stable")
    triangles = tuple(np.split(corners[order], np.cumsum(np.bincount(groups, minlength=n))[:-1]))
    deviation = max(assembled.solid.mesh.deviation for assembled in body.parts)
    return BodyFaces(
        body=body,
        lower=lower - deviation,
        upper=upper + deviation,
        parts=parts,
        triangles=triangles,
        deviation=deviation,
    )


def faces_of(shape: Any) -> list[Any]:
    """The faces of a shape in the order of the kernel's face map, which is that of `Solid.surfaces`."""
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp
    from OCP.TopTools import TopTools_IndexedMapOfShape

    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, found)
    return [found.FindKey(i) for i in range(1, found.Extent() + 1)]


def location_from_pose(T: Array) -> Any:
    """A pose, shape (4, 4) [mm], as a location of the kernel."""
    from OCP.gp import gp_Trsf
    from OCP.TopLoc import TopLoc_Location

    move = gp_Trsf()
    move.SetValues(*(float(x) for x in T[:3].reshape(12)))
    return TopLoc_Location(move)


def compute_gap(
    a: BodyFaces, b: BodyFaces, T_ab: Array, exempt_a: Array, exempt_b: Array, *, margin: float, where: str
) -> float:
    """The least distance between the faces of two bodies, pairs that share an exempting bit left out.

    Args:
        a, b: the bodies.
        T_ab: pose of B seen from A, shape (4, 4) [mm].
        exempt_a, exempt_b: bits per face, uint8, shape (n_faces,).
        margin: distances from here on are of no interest [mm].
        where: names the pair in errors.

    Returns:
        The distance, or `margin` if it is not below; 0 where faces cross [mm].
    """
    near = _near_boxes(a, b, T_ab, margin) & ((exempt_a[:, None] & exempt_b[None, :]) == 0)
    return _least_gap(a, b, T_ab, np.argwhere(near), margin, where)


def compute_least_gap(a: BodyFaces, of_a: Array, b: BodyFaces, of_b: Array, T_ab: Array, *, where: str) -> float:
    """The exact least distance between some faces of A and some of B, however far apart; 0 where they cross [mm].

    Args:
        a, b: the bodies.
        of_a, of_b: numbers of their faces; at least one each.
        T_ab: pose of B seen from A, shape (4, 4) [mm].
        where: names the pair in errors.
    """
    pairs = np.stack(np.meshgrid(of_a, of_b, indexing="ij"), axis=-1).reshape(-1, 2)
    return _least_gap(a, b, T_ab, pairs, np.inf, where)


def _least_gap(a: BodyFaces, b: BodyFaces, T_ab: Array, pairs: Array, margin: float, where: str) -> float:
    """The exact least distance over pairs of faces, or `margin` if it is not below: first by mesh, then by face."""
    # Mesh and face differ by no more than the deviations; doubled, for the kernel takes them as a wish.
    slack = 2.0 * (a.deviation + b.deviation)
    reach, found = margin + slack, []
    for i, j in pairs:
        mesh_gap = compute_distance(a.tree(i), b.tree(j), T_ab, cutoff=reach).value
        if mesh_gap < reach:
            reach = min(reach, mesh_gap + 2.0 * slack)
            found.append((mesh_gap, int(i), int(j)))
    best = margin
    for mesh_gap, i, j in sorted(found):
        if mesh_gap - slack >= best:
            break
        best = min(best, _face_gap(a.shapes[i], b.shapes[j], T_ab, where))
    return best


def _near_boxes(a: BodyFaces, b: BodyFaces, T_ab: Array, margin: float) -> Array:
    """Pairs of faces whose boxes come nearer than a margin, shape (n_a, n_b)."""
    middle, half = 0.5 * (b.lower + b.upper), 0.5 * (b.upper - b.lower)
    centre = transform_points(T_ab, middle)
    extent = half @ np.abs(T_ab[:3, :3]).T
    apart = np.maximum(a.lower[:, None] - (centre + extent)[None], (centre - extent)[None] - a.upper[:, None])
    return np.linalg.norm(np.maximum(apart, 0.0), axis=-1) < margin


def _face_gap(face_a: Any, face_b: Any, T_ab: Array, where: str) -> float:
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape

    extrema = BRepExtrema_DistShapeShape(face_a, face_b.Moved(location_from_pose(T_ab)))
    if not extrema.IsDone() or extrema.NbSolution() == 0:
        raise BuildError(where, "the CAD kernel finds no distance between two faces")
    return float(extrema.Value())


def compute_common_volume(shape_a: Any, shape_b: Any, T_ab: Array, *, where: str) -> float:
    """The volume that two solids share [mm3]; 0 if they only touch.

    Raises:
        BuildError: the kernel gives up.
    """
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    common = BRepAlgoAPI_Common(shape_a, shape_b.Moved(location_from_pose(T_ab)))
    if not common.IsDone() or common.Shape().IsNull():
        raise BuildError(where, "the CAD kernel cannot tell what these two parts share")
    props = GProp_GProps()
    BRepGProp.VolumeProperties_s(common.Shape(), props)
    return abs(float(props.Mass()))

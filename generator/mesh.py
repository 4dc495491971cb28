"""The triangles that stand for a solid at a stated deviation: welded, closed, outward, and each knows its face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.language.errors import BuildError

Array = np.ndarray

#: Largest turn between neighbouring facets [rad]: keeps small fillets and balls round whatever the deviation.
ANGULAR_DEVIATION = 0.2
#: Cells in which corners of neighbouring faces are one [mm]: the kernel gives them bit-equal or 1e-13 apart.
_LATTICE = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True)
class Mesh:
    """A closed surface of triangles.

    Attributes:
        vertices: shape (n, 3), float64 [mm].
        triangles: corners of each, counter-clockwise seen from outside, shape (m, 3), int32.
        faces: index of the solid's face that each triangle lies on, shape (m,), int32.
        deviation: largest distance from the solid that was asked for [mm].
    """

    vertices: Array
    triangles: Array
    faces: Array
    deviation: float


def build_mesh(shape: Any, deviation: float, *, where: str, angular: float = ANGULAR_DEVIATION) -> Mesh:
    """The mesh of a solid of the kernel.

    Args:
        shape: of the kernel.
        deviation: largest distance between solid and mesh [mm].
        where: names the part in errors.
        angular: largest turn between neighbouring facets [rad].

    Raises:
        BuildError: a face cannot be meshed, or the welded triangles do not close.
    """
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools

    if not deviation > 0.0:
        raise BuildError(where, f"a mesh deviation of {deviation:g} mm was asked for; it must be positive")
    # A shape keeps its triangles: before, to get none of another deviation; after, to leave none to others.
    BRepTools.Clean_s(shape)
    BRepMesh_IncrementalMesh(shape, deviation, False, angular, False)
    points, triangles, faces = _collect(shape, where)
    BRepTools.Clean_s(shape)
    vertices, triangles, faces = weld(points, triangles, faces)
    mesh = Mesh(
        vertices=_locked(vertices),
        triangles=_locked(triangles.astype(np.int32)),
        faces=_locked(faces.astype(np.int32)),
        deviation=deviation,
    )
    check_closed(mesh, where)
    return mesh


def _collect(shape: Any, where: str) -> tuple[Array, Array, Array]:
    """All faces' triangles, not yet joined: corners (n, 3), triangles (m, 3), face of each (m,)."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
    from OCP.TopExp import TopExp
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_IndexedMapOfShape

    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, found)
    points: list[Array] = []
    triangles: list[Array] = []
    faces: list[Array] = []
    offset = 0
    for i in range(found.Extent()):
        face, place = TopoDS.Face_s(found.FindKey(i + 1)), TopLoc_Location()
        patch = BRep_Tool.Triangulation_s(face, place)
        if patch is None or patch.NbTriangles() == 0:
            raise BuildError(where, f"the kernel could not mesh face {i} of {found.Extent()}")
        move = place.Transformation()
        nodes = [patch.Node(k).Transformed(move) for k in range(1, patch.NbNodes() + 1)]
        corners = np.array([patch.Triangle(k).Get() for k in range(1, patch.NbTriangles() + 1)], dtype=np.int64) - 1
        if face.Orientation() == TopAbs_REVERSED:
            corners = corners[:, ::-1]
        points.append(np.array([(p.X(), p.Y(), p.Z()) for p in nodes]))
        triangles.append(corners + offset)
        faces.append(np.full(len(corners), i))
        offset += len(nodes)
    return np.concatenate(points), np.concatenate(triangles), np.concatenate(faces)


def weld(points: Array, triangles: Array, faces: Array) -> tuple[Array, Array, Array]:
    """Corners in one lattice cell made one, and triangles that thereby lose a corner dropped (poles of balls).

    Args:
        points: shape (n, 3) [mm].
        triangles: shape (m, 3).
        faces: shape (m,).

    Returns:
        The same three, smaller.
    """
    cells = np.round(points / _LATTICE).astype(np.int64)
    _, first, inverse = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    triangles = inverse.reshape(-1)[triangles]
    a, b, c = triangles.T
    keep = (a != b) & (b != c) & (c != a)
    used, compact = np.unique(triangles[keep], return_inverse=True)
    return points[first][used], compact.reshape(-1, 3), faces[keep]


def compute_mesh_volume(mesh: Mesh) -> float:
    """Enclosed volume [mm3]; negative if the triangles look inwards."""
    corners = mesh.vertices[mesh.triangles] - mesh.vertices.mean(axis=0)
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0)


def check_closed(mesh: Mesh, where: str) -> None:
    """Every edge joins exactly two triangles that run along it in opposite directions, and the volume is positive.

    Raises:
        BuildError: says how many edges do not, or that the mesh is inside out.
    """
    t = mesh.triangles.astype(np.int64)
    ends = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    n = len(mesh.vertices)
    forth, times = np.unique(ends[:, 0] * n + ends[:, 1], return_counts=True)
    back = np.unique(ends[:, 1] * n + ends[:, 0])
    open_edges = len(np.setdiff1d(forth, back))
    doubled = int(np.sum(times > 1))
    if open_edges or doubled or not len(t):
        raise BuildError(
            where,
            f"its mesh of {len(t)} triangles is not closed: {open_edges} open edges, {doubled} edges shared by "
            "more than two triangles; try another mesh deviation",
        )
    volume = compute_mesh_volume(mesh)
    if not volume > 0.0:
        raise BuildError(where, f"its mesh is inside out: volume {volume:.6g} mm3")


def _locked(a: Array) -> Array:
    a = np.ascontiguousarray(a)
    a.setflags(write=False)
    return a

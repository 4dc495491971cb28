"""The mesh file for print and simulation: binary STL from welded meshes, closed in the 32 bits that it stores."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from linkwright.designs.language.errors import ReleaseError
from linkwright.generator.mesh import Mesh

_RECORD = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
HEADER_BYTES = 84


def write_stl(mesh: Mesh, path: Path, name: str, design_hash: str) -> None:
    """Write one closed mesh as binary STL in millimetres.

    Args:
        mesh: welded and outward oriented.
        path: file to write.
        name: of the part, for messages.
        design_hash: goes into the header.

    Raises:
        ReleaseError: rounding to 32 bits would open the mesh or fold it onto itself.
    """
    path.write_bytes(stl_bytes(mesh, name, design_hash))


def stl_bytes(mesh: Mesh, name: str, design_hash: str) -> bytes:
    """The bytes of that file."""
    points, triangles = rounded_mesh(mesh.vertices, mesh.triangles, name)
    corners = points[triangles].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    if np.any(lengths == 0.0):
        n_flat = int(np.sum(lengths == 0.0))
        raise ReleaseError(f"{name}: {n_flat} facets of its STL have no area; choose another mesh_deviation")
    records = np.zeros(len(triangles), dtype=_RECORD)
    records["normal"] = normals / lengths[:, None]
    records["corners"] = corners
    # The word "solid" at the start would make readers take the file for text.
    title = f"linkwright mm {design_hash[:32]} {name}".encode("ascii", "replace")[:80]
    return title.ljust(80, b" ") + np.uint32(len(triangles)).tobytes() + records.tobytes()


def rounded_mesh(vertices: np.ndarray, triangles: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray]:
    """The mesh as 32-bit floats store it: points (n, 3) float32, distinct, and triangles (m, 3) that still close.

    Edges shorter than the rounding collapse; their two triangles go, which leaves the surface closed. Triangles whose
    corners came to lie on one line are turned away by swapping their long edge.

    Raises:
        ReleaseError: the mesh does not close afterwards, or lies on itself.
    """
    # Adding zero turns -0.0 into 0.0: the two are equal and must not count as different bytes.
    rounded = np.asarray(vertices, dtype=np.float32) + np.float32(0.0)
    points, inverse = np.unique(rounded, axis=0, return_inverse=True)
    faces = inverse.reshape(-1)[np.asarray(triangles, dtype=np.int64)]
    distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces = _without_slivers(points.astype(np.float64), faces[distinct])
    if len(np.unique(np.sort(faces, axis=1), axis=0)) != len(faces):
        raise ReleaseError(f"{name}: it is so thin that 32-bit floats fold its mesh onto itself; nothing prints it")
    if not is_closed(faces):
        raise ReleaseError(f"{name}: its mesh does not close in 32-bit floats; choose another mesh_deviation")
    return points, faces


def is_closed(triangles: np.ndarray) -> bool:
    """Every directed edge occurs once, and once the other way round."""
    if len(triangles) == 0:
        return False
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    n = int(edges.max()) + 1
    forward = np.sort(edges[:, 0] * n + edges[:, 1])
    backward = np.sort(edges[:, 1] * n + edges[:, 0])
    return bool(np.all(np.diff(forward) > 0) and np.array_equal(forward, backward))


def _without_slivers(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The same surface without triangles of no area: the longest edge of each is swapped with its neighbour's."""
    faces = triangles.copy()
    for _ in range(len(faces)):
        flat = np.flatnonzero(_doubled_areas(points, faces) == 0.0)
        if len(flat) == 0:
            return faces
        if not _swap_long_edge(points, faces, int(flat[0])):
            return faces
    return faces


def _swap_long_edge(points: np.ndarray, faces: np.ndarray, flat: int) -> bool:
    a, b, c = _longest_edge_first(points, faces[flat])
    starts = np.argwhere((faces == b) & (np.roll(faces, -1, axis=1) == a))
    if len(starts) != 1:
        return False
    neighbour, corner = (int(i) for i in starts[0])
    d = int(faces[neighbour, (corner + 2) % 3])
    faces[flat], faces[neighbour] = (a, d, c), (d, b, c)
    return True


def _longest_edge_first(points: np.ndarray, triangle: np.ndarray) -> tuple[int, int, int]:
    lengths = [np.linalg.norm(points[triangle[(k + 1) % 3]] - points[triangle[k]]) for k in range(3)]
    k = int(np.argmax(lengths))
    return int(triangle[k]), int(triangle[(k + 1) % 3]), int(triangle[(k + 2) % 3])


def _doubled_areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    corners = points[faces]
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)

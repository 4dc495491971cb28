from __future__ import annotations

import numpy as np
import pytest
import trimesh

from linkwright.designs.language.errors import ReleaseError
from linkwright.exports.products import products_of
from linkwright.exports.stl import is_closed, rounded_mesh, stl_bytes, write_stl
from linkwright.generator.mesh import Mesh

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int32)


def mesh_of(vertices, triangles):
    triangles = np.asarray(triangles, dtype=np.int32)
    return Mesh(
        vertices=np.asarray(vertices, float),
        triangles=triangles,
        faces=np.zeros(len(triangles), np.int32),
        deviation=0.1,
    )


def facets_of(content):
    return np.frombuffer(content[84:], dtype=np.dtype([("n", "<f4", (3,)), ("c", "<f4", (3, 3)), ("a", "<u2")]))


def test_stl_of_every_part_is_closed_outward_and_of_the_solid_s_volume(assembly, tmp_path):
    for product in products_of(assembly).values():
        path = tmp_path / f"{product.name}.stl"
        write_stl(product.solid.mesh, path, product.name, assembly.design.hash)
        mesh = trimesh.load_mesh(path)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume > 0.0
        assert abs(mesh.volume - product.solid.volume) <= product.solid.area * product.solid.mesh.deviation


def test_stl_bytes_close_without_welding_by_nearness(assembly):
    # Corners must be equal to the bit: a reader that merges only equal corners finds every edge twice.
    for product in products_of(assembly).values():
        corners = facets_of(stl_bytes(product.solid.mesh, product.name, "0"))["c"].reshape(-1, 3)
        _, index = np.unique(corners.view(np.dtype((np.void, 12))).reshape(-1), return_inverse=True)
        assert is_closed(index.reshape(-1, 3))


def test_stl_normals_are_unit_and_look_outwards():
    content = stl_bytes(mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], TETRAHEDRON), "tetra", "0")
    facets = facets_of(content)
    assert np.linalg.norm(facets["n"], axis=1) == pytest.approx(1.0, abs=1e-6)
    outward = facets["c"].mean(axis=1) - 0.25
    assert np.all(np.einsum("ni,ni->n", outward, facets["n"]) > 0.0)


def test_stl_header_names_the_design_and_does_not_look_like_text():
    content = stl_bytes(mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], TETRAHEDRON), "tetra", "ab" * 32)
    assert b"ab" * 16 in content[:80]
    assert not content.startswith(b"solid")
    assert len(content) == 84 + 50 * 4


def test_stl_collapses_edges_that_32_bits_cannot_hold():
    # Vertex 4 lies 1e-7 beside vertex 1, 1000 mm from the origin, where 32-bit floats are 6e-5 apart.
    vertices = [[0, 0, 0], [1000, 0, 0], [0, 1000, 0], [0, 0, 1000], [1000, 1e-7, 1e-7]]
    triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 4], [1, 4, 3], [4, 2, 3], [2, 0, 3]]
    assert is_closed(np.array(triangles))
    vertices[4][0] = 1000.00001
    vertices[4][1] = vertices[4][2] = 0.0
    points, faces = rounded_mesh(np.array(vertices), np.array(triangles), "thing")
    assert len(points) == 4
    assert len(faces) == 4
    assert is_closed(faces)


def test_stl_turns_away_triangles_whose_corners_came_onto_one_line():
    # Vertex 4 lies on the edge 1-2 once rounded: triangle (1, 2, 4) has no area.
    vertices = np.array([[0, 0, 0], [1000, 0, 0], [0, 1000, 0], [0, 0, 1000], [500, 500, 1e-40]])
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 4], [1, 4, 3], [4, 2, 3], [2, 0, 3]])
    points, faces = rounded_mesh(vertices, triangles, "thing")
    corners = points[faces].astype(float)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert is_closed(faces)
    assert np.all(areas > 0.0)
    assert len(faces) == 6
    assert trimesh.Trimesh(points, faces, process=False).volume == pytest.approx(1e9 / 6.0)


def test_stl_refuses_a_mesh_with_a_hole():
    with pytest.raises(ReleaseError, match="does not close"):
        stl_bytes(mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], TETRAHEDRON[:3]), "open", "0")


def test_stl_refuses_a_mesh_that_rounding_folds_onto_itself():
    # A plate 1e-6 mm thin, 1000 mm away: its two faces become one.
    low = np.array([[1000, 0, 0], [1001, 0, 0], [1000, 1, 0]], float)
    vertices = np.concatenate([low, low + np.array([1e-6, 0, 0])])
    triangles = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    assert is_closed(np.array(triangles))
    with pytest.raises(ReleaseError, match="fold"):
        stl_bytes(mesh_of(vertices, triangles), "thin", "0")


def test_is_closed_refuses_a_flipped_facet_and_an_edge_of_four():
    flipped = TETRAHEDRON.copy()
    flipped[0] = flipped[0][::-1]
    assert is_closed(TETRAHEDRON)
    assert not is_closed(flipped)
    assert not is_closed(np.concatenate([TETRAHEDRON, TETRAHEDRON]))
    assert not is_closed(TETRAHEDRON[:0])

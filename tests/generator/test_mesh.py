from dataclasses import replace

import numpy as np
import pytest
from manifold3d import Error, Manifold, Mesh64

from linkwright.designs.language.errors import BuildError
from linkwright.generator.mesh import Mesh, build_mesh, check_closed, compute_mesh_volume
from linkwright.generator.solids import build_solid
from linkwright.generator.surfaces import SurfaceKind

DEVIATION = 0.02


GENUS = {"rod": 0, "ball_with_neck": 0, "bar": 2, "plate": 7}


@pytest.fixture(params=GENUS)
def name(request):
    return request.param


@pytest.fixture
def solid(name, features):
    return build_solid(features[name], DEVIATION, where=name)


def test_a_mesh_is_a_manifold_with_the_solids_holes_and_volume(name, solid):
    mesh = solid.mesh
    manifold = Manifold(Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
    assert manifold.status() == Error.NoError
    assert manifold.volume() == pytest.approx(compute_mesh_volume(mesh), rel=1e-12)
    assert manifold.volume() == pytest.approx(solid.volume, rel=5e-3)
    assert manifold.genus() == GENUS[name]


def test_a_mesh_has_the_types_and_locks_of_its_contract(solid):
    mesh = solid.mesh
    assert (mesh.vertices.dtype, mesh.triangles.dtype, mesh.faces.dtype) == (np.float64, np.int32, np.int32)
    assert mesh.faces.shape == (len(mesh.triangles),)
    assert set(mesh.faces) == set(range(len(solid.surfaces)))
    assert not any(a.flags.writeable for a in (mesh.vertices, mesh.triangles, mesh.faces))
    assert mesh.deviation == DEVIATION
    assert len(np.unique(np.round(mesh.vertices, 6), axis=0)) == len(mesh.vertices)


def _distance(points, surface):
    """Of points, shape (..., 3), from a plane, sphere or cylinder [mm]."""
    d, axis = points - np.array(surface.point), np.array(surface.axis)
    along = d @ axis
    if surface.kind is SurfaceKind.PLANE:
        return np.abs(along)
    if surface.kind is SurfaceKind.SPHERE:
        return np.abs(np.linalg.norm(d, axis=-1) - surface.radius)
    return np.abs(np.linalg.norm(d - along[..., None] * axis, axis=-1) - surface.radius)


def test_every_corner_lies_on_the_surface_of_its_face_and_no_middle_strays(solid):
    mesh, checked = solid.mesh, 0
    for i, surface in enumerate(solid.surfaces):
        if surface.kind in (SurfaceKind.PLANE, SurfaceKind.SPHERE, SurfaceKind.CYLINDER):
            checked += 1
            triangles = mesh.vertices[mesh.triangles[mesh.faces == i]]
            assert np.max(_distance(triangles, surface)) < 1e-6
            assert np.max(_distance(triangles.mean(axis=1), surface)) < 1.5 * DEVIATION
    assert checked >= 3


def test_outward_normals_of_planes_agree_with_their_triangles(solid):
    mesh = solid.mesh
    for i, surface in enumerate(solid.surfaces):
        if surface.kind is SurfaceKind.PLANE:
            a, b, c = np.moveaxis(mesh.vertices[mesh.triangles[mesh.faces == i]], 1, 0)
            area = np.cross(b - a, c - a).sum(axis=0)
            assert area @ surface.axis == pytest.approx(np.linalg.norm(area), rel=1e-9)


def test_a_finer_deviation_brings_the_volume_closer(ball_with_neck):
    solid = build_solid(ball_with_neck, 0.2, where="ball")
    fine = build_mesh(solid.shape, 0.002, where="ball", angular=0.05)
    again = build_mesh(solid.shape, 0.2, where="ball")
    assert abs(compute_mesh_volume(fine) - solid.volume) < 0.1 * abs(compute_mesh_volume(again) - solid.volume)
    assert np.array_equal(again.triangles, solid.mesh.triangles)


@pytest.fixture
def cube() -> Mesh:
    vertices = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], dtype=np.int32)
    return Mesh(vertices=vertices, triangles=triangles, faces=np.repeat(np.arange(6, dtype=np.int32), 2), deviation=0.1)


def test_a_good_cube_passes(cube):
    check_closed(cube, "cube")
    assert compute_mesh_volume(cube) == pytest.approx(1.0)


@pytest.mark.parametrize(("spoil", "says"), [
    (lambda t: t[1:], "3 open edges"),
    (lambda t: np.concatenate([t[:1, ::-1], t[1:]]), "not closed"),
    (lambda t: np.concatenate([t, t[:1]]), "3 edges shared"),
    (lambda t: t[:, ::-1], "inside out"),
    (lambda t: t[:0], "not closed"),
])  # fmt: skip
def test_a_spoilt_cube_is_refused(cube, spoil, says):
    with pytest.raises(BuildError, match=f"hit: cube: .*{says}"):
        check_closed(replace(cube, triangles=spoil(cube.triangles)), "hit: cube")


def test_a_deviation_of_nothing_is_refused(rod):
    with pytest.raises(BuildError, match="must be positive"):
        build_solid(rod, 0.0, where="rod")

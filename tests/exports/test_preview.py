from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs.language.errors import ReleaseError
from linkwright.exports.preview import SIZE, check_egl, looks_of, render, write_preview
from linkwright.exports.shade import shade
from linkwright.generator.mesh import Mesh


@pytest.fixture(scope="module")
def pixels(assembly, home):
    return render(assembly, home)


def cube(faces):
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]
    return Mesh(
        vertices=corners, triangles=np.array(triangles, np.int32), faces=np.array(faces, np.int32), deviation=0.1
    )


def test_picture_shows_the_assembly_in_the_middle_of_its_paper(pixels):
    assert pixels.shape == (SIZE[1], SIZE[0], 3)
    paper = pixels[0, 0].astype(int)
    drawn = np.abs(pixels.astype(int) - paper).max(axis=2) > 60
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    assert drawn.mean() > 0.05
    # It fills the picture in one direction and is cut off in none.
    assert max(np.ptp(rows) / SIZE[1], np.ptp(columns) / SIZE[0]) > 0.85
    assert rows[0] > 0
    assert rows[-1] < SIZE[1] - 1
    assert columns[0] > 0
    assert columns[-1] < SIZE[0] - 1
    assert abs(0.5 * (columns[0] + columns[-1]) - SIZE[0] / 2) < 0.05 * SIZE[0]


def test_picture_shows_materials_and_dark_edges(pixels):
    red, blue = pixels[..., 0].astype(int), pixels[..., 2].astype(int)
    assert np.mean(red - blue > 60) > 0.003, "bronze seats"
    assert np.mean(pixels.max(axis=2) < 45) > 0.001, "edges"


def test_picture_is_the_same_each_time(assembly, home, pixels):
    assert np.array_equal(render(assembly, home), pixels)


def test_picture_depends_on_the_pose(assembly, design, pixels):
    moved = design.mechanism.place_bodies(np.array([[0.9, 0.9]]))[0]
    assert np.mean(np.any(render(assembly, moved) != pixels, axis=2)) > 0.05


def test_preview_has_the_same_bytes_in_fresh_processes(in_fresh_process):
    script = """
import hashlib, pathlib, tempfile
import numpy as np
from linkwright.generator.assembly import build_assembly
from linkwright.exports.preview import write_preview
design = masts.masts_design()
home = design.mechanism.place_bodies(np.asarray(design.mechanism.home)[None])[0]
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / 'a.png'
    write_preview(build_assembly(design), home, path)
    print(hashlib.sha256(path.read_bytes()).hexdigest())
"""
    assert in_fresh_process(script, 1) == in_fresh_process(script, 2)


def test_edges_are_drawn_between_faces_that_meet_at_an_angle_and_nowhere_else():
    assert len(looks_of(cube(np.repeat(np.arange(6), 2))).edges) == 12
    # All one face: a smooth surface has no edges to draw.
    assert len(looks_of(cube(np.zeros(12))).edges) == 0
    # Each triangle its own face: the diagonals are flat and stay out.
    assert len(looks_of(cube(np.arange(12))).edges) == 12


def test_faces_are_shaded_each_on_its_own():
    looks = looks_of(cube(np.repeat(np.arange(6), 2)))
    assert len(looks.points) == 24
    assert sorted(np.abs(looks.normals).max(axis=1)) == pytest.approx([1.0] * 24)


def test_shade_darkens_the_foot_of_a_wall_and_leaves_open_ground_alone():
    depths = np.full((80, 80), 100.0)
    depths[:, :30] = 95.0
    light = shade(depths, 0.5, 12.0)
    assert light[40, 31] < 0.9
    assert light[40, 70] == pytest.approx(1.0, abs=1e-3)
    assert light[40, 15] == pytest.approx(1.0, abs=1e-3)


def test_shade_leaves_empty_paper_alone():
    assert np.all(shade(np.full((20, 20), np.inf), 0.5, 10.0) == 1.0)


def test_picture_without_the_graphics_library_names_what_to_install():
    with pytest.raises(ReleaseError, match="apt-get install libegl1"):
        check_egl("libNoSuchThing.so.1")


def test_picture_that_cannot_be_written_is_an_error(assembly, home, tmp_path):
    with pytest.raises(ReleaseError, match=r"a\.png"):
        write_preview(assembly, home, tmp_path / "missing" / "a.png")

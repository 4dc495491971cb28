import os
import subprocess
import sys
import warnings
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.generator import solids, store
from linkwright.generator.solids import build_solid
from linkwright.generator.store import Store, bytes_from_solid, content_key, default_root, solid_from_bytes

SCRIPT = """
import hashlib, sys
from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.generator.solids import build_solid
from linkwright.generator.store import bytes_from_solid
seat = dict(top=6.0, diameter=8.0, head_diameter=10.0, head_depth=4.0)
bar = Milled(slabs=(Slab(circles=((0, 0, 6), (150, 0, 6)), low=0, high=6), Slab(circles=((0, 0, 6),), low=6, high=9),
                    Slab(circles=((150, 0, 8),), low=0, high=6)), holes=(Hole(**{**seat, "top": 9.0}),), edge_break=0.4)
ball = Turned(profile=(Vertex(r=0, z=-20), Vertex(r=3, z=-20), Vertex(r=3, z=-91**0.5), Vertex(r=0, z=10, mid=(10, 0))))
for feature in (bar, ball):
    solid = build_solid(feature, 0.05, where="x")
    print(hashlib.sha256(solid.brep).hexdigest(), hashlib.sha256(bytes_from_solid(solid)).hexdigest())
"""


def _same(a, b):
    for field in fields(a):
        x, y = getattr(a, field.name), getattr(b, field.name)
        if field.name == "mesh":
            _same(x, y)
        elif isinstance(x, np.ndarray):
            assert x.dtype == y.dtype
            assert np.array_equal(x, y)
            assert not y.flags.writeable
        else:
            assert x == y, field.name


def test_a_solid_from_the_store_equals_the_built_one_in_every_field(tmp_path, features):
    kept = Store(tmp_path)
    for name, feature in features.items():
        built = build_solid(feature, 0.05, where=name, store=kept)
        _same(built, build_solid(feature, 0.05, where=name, store=Store(tmp_path)))
        assert built.key == content_key(feature, 0.05)


def test_a_stored_part_is_not_built_again(tmp_path, rod, monkeypatch):
    build_solid(rod, 0.05, where="rod", store=Store(tmp_path))
    monkeypatch.setattr(solids, "_build_shape", lambda *_: pytest.fail("built again"))
    assert build_solid(rod, 0.05, where="rod", store=Store(tmp_path)).volume > 0


def test_two_fresh_processes_make_the_same_bytes():
    def run(seed):
        env = {**os.environ, "PYTHONHASHSEED": seed}
        return subprocess.run(
            [sys.executable, "-c", SCRIPT], env=env, check=True, capture_output=True, text=True
        ).stdout

    first = run("1")
    assert len(first.split()) == 4
    assert first == run("2")


def test_reading_the_store_does_not_load_the_kernel_until_a_shape_is_asked_for(tmp_path, rod):
    build_solid(rod, 0.05, where="rod", store=Store(tmp_path))
    script = (
        "import sys\n"
        "from pathlib import Path\n"
        "from linkwright.designs.language.features import Turned, Vertex\n"
        "from linkwright.generator.solids import build_solid\n"
        "from linkwright.generator.store import Store\n"
        "rod = Turned(profile=(Vertex(r=0, z=0), Vertex(r=5, z=0), Vertex(r=5, z=10), Vertex(r=0, z=10)))\n"
        "solid = build_solid(rod, 0.05, where='rod', store=Store(Path(sys.argv[1])))\n"
        "heavy = lambda: sorted({'OCP', 'build123d', 'cadquery', 'manifold3d'} & set(sys.modules))\n"
        "print(heavy()); solid.shape; print(heavy())\n"
    )
    out = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], check=True, capture_output=True, text=True
    ).stdout
    assert out.splitlines() == ["[]", "['OCP']"]


def _entry(root: Path) -> Path:
    (found,) = root.rglob("*.solid")
    return found


@pytest.mark.parametrize("spoil", [
    lambda data: data[:-1],
    lambda data: b"",
    lambda data: data[:-7] + bytes([data[-7] ^ 1]) + data[-6:],
    lambda data: data[:200] + bytes([data[200] ^ 128]) + data[201:],
    lambda data: b"another format" + data,
])  # fmt: skip
def test_a_damaged_entry_is_built_again_and_mended(tmp_path, rod, spoil):
    good = build_solid(rod, 0.05, where="rod", store=Store(tmp_path))
    entry = _entry(tmp_path)
    data = entry.read_bytes()
    entry.write_bytes(spoil(data))
    assert Store(tmp_path).load(good.key) is None
    _same(good, build_solid(rod, 0.05, where="rod", store=Store(tmp_path)))
    assert entry.read_bytes() == data


def test_an_entry_under_another_key_is_not_taken_for_it(rod):
    solid = build_solid(rod, 0.05, where="rod")
    assert solid_from_bytes(bytes_from_solid(solid), solid.key) is not None
    assert solid_from_bytes(bytes_from_solid(solid), "0" * 64) is None


def test_nothing_but_finished_entries_lies_in_the_store(tmp_path, rod):
    build_solid(rod, 0.05, where="rod", store=Store(tmp_path))
    assert [p.suffix for p in tmp_path.rglob("*") if p.is_file()] == [".solid"]


def test_the_key_changes_with_every_number_and_only_with_numbers():
    feature = Milled(slabs=(Slab(circles=((0, 0, 6),), low=0, high=6),), holes=(Hole(top=6, diameter=3),))
    key = content_key(feature, 0.05)
    others = [
        content_key(feature, 0.06),
        content_key(replace(feature, edge_break=0.1), 0.05),
        content_key(replace(feature, holes=(Hole(top=6, diameter=np.nextafter(3, 4)),)), 0.05),
        content_key(replace(feature, holes=(Hole(top=6, diameter=3, upwards=True),)), 0.05),
        content_key(replace(feature, holes=(), windows=feature.slabs), 0.05),
        content_key(Turned(profile=(Vertex(r=0, z=0), Vertex(r=1, z=0), Vertex(r=0, z=1))), 0.05),
    ]
    assert len({key, *others}) == 7
    assert key == content_key(Milled(slabs=(Slab(circles=((0.0, -0.0, 6.0),), low=0, high=6.0),),
                                     holes=(Hole(top=6.0, diameter=3),)), 0.05)  # fmt: skip


def test_the_key_changes_with_the_code_and_the_kernel(rod, monkeypatch):
    key = content_key(rod, 0.05)
    monkeypatch.setattr(store, "code_hash", lambda package: "another")
    assert content_key(rod, 0.05) != key
    monkeypatch.undo()
    monkeypatch.setattr(store, "_kernel_version", lambda: "cadquery-ocp 0")
    assert content_key(rod, 0.05) != key
    monkeypatch.undo()
    assert store._kernel_version().startswith("cadquery-ocp")


def test_a_store_that_cannot_be_written_warns_once_and_builds_all_the_same(tmp_path, rod, ball_with_neck):
    (tmp_path / "file").write_text("not a folder")
    kept = Store(tmp_path / "file")
    with pytest.warns(UserWarning, match="not kept for the next run"):
        assert build_solid(rod, 0.05, where="rod", store=kept).volume > 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        build_solid(ball_with_neck, 0.2, where="ball", store=kept)


def test_the_default_place_follows_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("LINKWRIGHT_CACHE", str(tmp_path / "own"))
    assert default_root() == tmp_path / "own"
    monkeypatch.delenv("LINKWRIGHT_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert default_root() == tmp_path / "xdg" / "linkwright"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert default_root() == Path.home() / ".cache" / "linkwright"

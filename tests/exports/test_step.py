from __future__ import annotations

import dataclasses

import cadquery as cq
import pytest

from linkwright.designs.language.materials import material
from linkwright.exports.products import products_of
from linkwright.exports.reread import reread_assembly, reread_volume
from linkwright.exports.step import write_assembly_step, write_part_step
from linkwright.generator.assembly import Assembly


@pytest.fixture(scope="module")
def written(assembly, home, tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "assembly.step"
    write_assembly_step(assembly, home, path)
    return path


def test_assembly_step_is_read_by_cadquery_with_groups_bodies_and_parts_by_name(written):
    names = set(cq.Assembly.importStep(str(written)).objects)
    assert names == {
        "two_masts", "base", "base/plate", "base/pin_1", "base/pin_2",
        "leg_1", "leg_1/leg_1_arm", "leg_1/leg_1_arm/bar", "leg_1/leg_1_arm/bearing", "leg_1/leg_1_arm/seat",
        "leg_1/leg_1_rod", "leg_1/leg_1_rod/ball_bar",
        "leg_2", "leg_2/leg_2_arm", "leg_2/leg_2_arm/bar", "leg_2/leg_2_arm/bearing", "leg_2/leg_2_arm/seat",
        "leg_2/leg_2_rod", "leg_2/leg_2_rod/ball_bar",
    }  # fmt: skip


def test_assembly_step_keeps_volumes_places_and_colours(written, assembly, home):
    found = {i.path[-2:]: i for i in reread_assembly(written).instances}
    for placed, T in zip(assembly.bodies, home, strict=True):
        for part in placed.parts:
            instance = found[placed.body.name, part.part.name]
            assert instance.volume == pytest.approx(part.solid.volume, rel=1e-5)
            assert instance.T_base_part == pytest.approx(T @ part.T_body_part, abs=1e-9)
            assert instance.colour == pytest.approx(material(part.part.material).colour, abs=1e-6)


def test_assembly_step_holds_each_product_once(written):
    text = written.read_text()
    assert text.count("MANIFOLD_SOLID_BREP(") == 6
    assert text.count("NEXT_ASSEMBLY_USAGE_OCCURRENCE(") == 11 + 5 + 2


def test_assembly_step_is_in_millimetres_and_names_its_design(written, design):
    text = written.read_text()
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    assert design.hash in text[: text.index("DATA;")]


def test_assembly_step_has_a_root_that_shares_its_name_with_nothing_below(assembly, home, tmp_path):
    named = Assembly(design=dataclasses.replace(assembly.design, name="base"), bodies=assembly.bodies)
    write_assembly_step(named, home, tmp_path / "a.step")
    root = cq.Assembly.importStep(str(tmp_path / "a.step"))
    assert root.name == "base_assembly"
    assert "base/plate" in root.objects


def test_assembly_step_keeps_a_long_name_with_quotes_and_signs(assembly, home, tmp_path):
    name = "a b" + " word" * 60 + " it's a 'q' ; # #12 = x"
    base, *others = assembly.bodies
    plate, *pins = base.parts
    plate = dataclasses.replace(plate, part=dataclasses.replace(plate.part, name=name))
    named = Assembly(design=assembly.design, bodies=(dataclasses.replace(base, parts=(plate, *pins)), *others))
    write_assembly_step(named, home, tmp_path / "a.step")
    assert ("base", name) in {i.path[-2:] for i in reread_assembly(tmp_path / "a.step").instances}


def test_assembly_step_has_the_same_bytes_in_fresh_processes_whatever_was_written_before(in_fresh_process):
    script = """
import hashlib, pathlib, tempfile
import numpy as np
from linkwright.generator.assembly import build_assembly
from linkwright.exports.step import write_assembly_step
from linkwright.exports.products import products_of
from linkwright.exports.step import write_part_step
design = masts.masts_design()
home = design.mechanism.place_bodies(np.asarray(design.mechanism.home)[None])[0]
assembly = build_assembly(design)
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / 'a.step'
    for _ in range({times}):
        write_assembly_step(assembly, home, path)
    print(hashlib.sha256(path.read_bytes()).hexdigest())
    for product in products_of(assembly).values():
        write_part_step(product, path, design.hash)
        print(product.name, hashlib.sha256(path.read_bytes()).hexdigest())
"""
    outputs = {in_fresh_process(script.format(times=times), seed) for seed, times in ((1, 1), (2, 3), (3, 2))}
    assert len(outputs) == 1
    assert len(outputs.pop().splitlines()) == 7


def test_part_step_is_one_solid_of_the_part_s_volume(assembly, tmp_path):
    for product in products_of(assembly).values():
        path = tmp_path / f"{product.name}.step"
        write_part_step(product, path, assembly.design.hash)
        volume, n_solids = reread_volume(path)
        assert n_solids == 1
        assert volume == pytest.approx(product.solid.volume, rel=1e-5)

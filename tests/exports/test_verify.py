from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
import trimesh

from linkwright.analysis.findings import Severity
from linkwright.exports.controller import mechanism_from_config, write_controller_config
from linkwright.exports.products import products_of
from linkwright.exports.reread import recover_axes
from linkwright.exports.step import write_assembly_step, write_part_step
from linkwright.exports.stl import write_stl
from linkwright.exports.verify import (
    check_assembly_step,
    check_config,
    check_design_file,
    check_part_steps,
    check_stls,
)
from linkwright.exports.verify_axes import check_axes
from linkwright.generator.assembly import AssembledBody, Assembly


def moved(assembly, body, part, *, by=(0.0, 0.0, 0.0), turn=0.0):
    """The assembly with one part displaced by `by` [mm] and turned about its x [rad] within its body."""
    T = np.eye(4)
    T[1:3, 1:3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    T[:3, 3] = by

    def changed(placed):
        parts = tuple(
            dataclasses.replace(p, T_body_part=p.T_body_part @ T) if p.part.name == part else p for p in placed.parts
        )
        return AssembledBody(
            body=placed.body, parts=parts, mass=placed.mass, centre=placed.centre, inertia=placed.inertia
        )

    bodies = tuple(changed(b) if b.body.name == body else b for b in assembly.bodies)
    return Assembly(design=assembly.design, bodies=bodies)


@pytest.fixture
def config(design, tmp_path):
    path = tmp_path / "kinematics.json"
    write_controller_config(design, {}, path)
    return path


@pytest.fixture
def step(assembly, home, tmp_path):
    path = tmp_path / "assembly.step"
    write_assembly_step(assembly, home, path)
    return path


def messages(result):
    return [f.message for f in result.findings]


def change(path, **numbers):
    config = json.loads(path.read_text())
    assert all(key in config for key in numbers)
    path.write_text(json.dumps(config | numbers))


# The assembly's STEP file


def test_assembly_step_passes_as_written(step, assembly, home):
    result, _ = check_assembly_step(step, assembly, home)
    assert result.findings == ()
    assert result.looked_at == {"instances": 11, "bodies": 5}
    assert result.facts["largest_place_mm"] < 1e-9
    assert result.facts["largest_turn_rad"] < 1e-11


def test_assembly_step_with_a_part_moved_by_a_hundredth_is_found(assembly, home, tmp_path):
    write_assembly_step(moved(assembly, "leg_2_arm", "bearing", by=(0.0, 0.0, 0.01)), home, tmp_path / "a.step")
    result, _ = check_assembly_step(tmp_path / "a.step", assembly, home)
    assert all(f.severity is Severity.ERROR and "leg_2_arm/bearing" in f.message for f in result.findings)
    assert [f.measured for f in result.findings if f.unit == "mm"] == [pytest.approx(0.01, abs=1e-9)]


def test_assembly_step_in_another_pose_is_found(assembly, design, home, tmp_path):
    other = design.mechanism.place_bodies(np.array([[0.3, 0.3]]))[0]
    write_assembly_step(assembly, other, tmp_path / "a.step")
    result, _ = check_assembly_step(tmp_path / "a.step", assembly, home)
    assert len(result.findings) >= 2


def test_assembly_step_with_a_part_missing_or_renamed_is_found(step, assembly, home):
    step.write_text(step.read_text().replace("'seat'", "'sead'"))
    result, _ = check_assembly_step(step, assembly, home)
    assert sorted(messages(result)) == [
        "assembly.step: leg_1_arm/sead does not belong to it", "assembly.step: leg_1_arm/seat is missing",
        "assembly.step: leg_2_arm/sead does not belong to it", "assembly.step: leg_2_arm/seat is missing",
    ]  # fmt: skip


def test_assembly_step_filed_under_another_group_is_found(step, assembly, home):
    step.write_text(step.read_text().replace("'leg_1'", "'left'"))
    result, _ = check_assembly_step(step, assembly, home)
    assert len(result.findings) == 4
    assert all("is filed under 'left', not 'leg_1'" in m for m in messages(result))


def test_assembly_step_with_another_solid_in_a_part_s_place_is_found(assembly, home, tmp_path):
    pin = assembly.body("base").parts[1].solid

    def swapped(placed):
        parts = tuple(dataclasses.replace(p, solid=pin) if p.part.name == "bearing" else p for p in placed.parts)
        return dataclasses.replace(placed, parts=parts)

    other = Assembly(design=assembly.design, bodies=tuple(swapped(b) for b in assembly.bodies))
    write_assembly_step(other, home, tmp_path / "a.step")
    result, _ = check_assembly_step(tmp_path / "a.step", assembly, home)
    assert any("the volume of leg_1_arm/bearing is off by 1.58" in m for m in messages(result))


# The parts' STEP files


def test_part_steps_pass_as_written_and_one_under_another_s_name_is_found(assembly, tmp_path):
    products = [p for p in products_of(assembly).values() if p.is_made][:2]
    paths = {tmp_path / f"{p.name}.step": p for p in products}
    for path, product in paths.items():
        write_part_step(product, path, "0")
    assert check_part_steps(paths).findings == ()
    swapped = dict(zip(paths, reversed(products), strict=True))
    assert check_part_steps(swapped).findings != ()


# The STL files


@pytest.fixture
def stl(assembly, tmp_path):
    product = next(p for p in products_of(assembly).values() if p.name == "arm_seat")
    path = tmp_path / "arm_seat.stl"
    write_stl(product.solid.mesh, path, product.name, "0")
    return path, product


def test_stl_passes_as_written(stl):
    path, product = stl
    result = check_stls({path: product}, product.solid.mesh.deviation)
    assert result.findings == ()
    assert 0.0 < result.facts["largest_volume_share"] < 0.02


def test_stl_without_one_facet_is_found(stl):
    path, product = stl
    content = path.read_bytes()
    n = int.from_bytes(content[80:84], "little")
    path.write_bytes(content[:80] + (n - 1).to_bytes(4, "little") + content[84:-50])
    assert any("not closed" in m for m in messages(check_stls({path: product}, 0.05)))


def test_stl_cut_short_is_found(stl):
    path, product = stl
    path.write_bytes(path.read_bytes()[:-10])
    assert any("do not hold the" in m for m in messages(check_stls({path: product}, 0.05)))


def test_stl_without_content_is_found(stl):
    path, product = stl
    path.write_bytes(b"")
    assert check_stls({path: product}, 0.05).findings != ()


def test_stl_turned_inside_out_is_found(stl):
    path, product = stl
    mesh = trimesh.load_mesh(path)
    mesh.invert()
    path.write_bytes(trimesh.exchange.stl.export_stl(mesh))
    assert any("not oriented outwards" in m for m in messages(check_stls({path: product}, 0.05)))


def test_stl_with_one_facet_flipped_is_found(stl):
    path, product = stl
    content = bytearray(path.read_bytes())
    first = 84 + 12
    content[first : first + 24] = content[first + 12 : first + 24] + content[first : first + 12]
    path.write_bytes(content)
    assert any("not oriented one way" in m for m in messages(check_stls({path: product}, 0.05)))


def test_stl_of_another_part_is_found(stl, assembly):
    path, _ = stl
    other = next(p for p in products_of(assembly).values() if p.name == "base_plate")
    assert any("encloses" in m for m in messages(check_stls({path: other}, 0.05)))


# The config


def test_config_passes_as_written(config, design, masts):
    result = check_config(config, design, masts.ENTRY)
    assert result.findings == ()
    assert result.facts["largest_share"] < 1e-15


@pytest.mark.parametrize(
    "key", ["arm_length_m", "turn_1_max_rad", "home_pose_turn_2_rad", "home_joint_turn_1_rad", "ball_2_max_rad"]
)
def test_config_with_any_number_off_by_a_millionth_is_found(config, design, masts, key):
    value = json.loads(config.read_text())[key]
    change(config, **{key: value * (1.0 + 1e-6)})
    result = check_config(config, design, masts.ENTRY)
    assert [f.subject for f in result.findings] == [(key,)]


def test_config_of_another_design_is_found(config, masts):
    result = check_config(config, masts.masts_design(arm_length=61.4), masts.ENTRY)
    assert any("design_hash" in m for m in messages(result))


# The design file


def test_design_file_passes_as_written_and_a_changed_one_is_found(design, masts, tmp_path):
    from linkwright.designs.file.writer import text_of

    path = tmp_path / "design.toml"
    text = text_of(design, entry=masts.ENTRY)
    path.write_text(text)
    assert check_design_file(path, design, masts.ENTRY).findings == ()
    path.write_text(text.replace("61.3", "61.4"))
    assert "reads as design" in messages(check_design_file(path, design, masts.ENTRY))[0]
    path.write_text(text.replace("61.3", "-61.3"))
    assert "cannot be read back" in messages(check_design_file(path, design, masts.ENTRY))[0]


# The config against the STEP file


def axes(step, config, entry):
    return check_axes(recover_axes(step), mechanism_from_config(config, entry), config)


def test_axes_of_the_step_file_lie_where_the_config_puts_them(step, config, masts):
    result = axes(step, config, masts.ENTRY)
    assert result.findings == ()
    assert result.looked_at["joints"] == 4
    # Each joint shows on both sides: pins in the base, bearing and bore in the arm, seat and ball.
    assert result.looked_at["faces"] >= 8
    assert result.facts["largest_distance_mm"] < 1e-9
    assert result.facts["largest_direction_rad"] < 1e-11


@pytest.mark.parametrize(
    ("body", "part", "by"),
    [
        ("leg_1_arm", "bearing", (0.01, 0.0, 0.0)), ("base", "pin_2", (0.0, 0.01, 0.0)),
        ("leg_2_rod", "ball_bar", (0.0, 0.0, 0.01)), ("leg_2_arm", "seat", (0.0, 0.0, -0.01)),
    ],
)  # fmt: skip
def test_axes_of_a_part_moved_by_a_hundredth_are_found(assembly, home, config, masts, tmp_path, body, part, by):
    write_assembly_step(moved(assembly, body, part, by=by), home, tmp_path / "moved.step")
    result = axes(tmp_path / "moved.step", config, masts.ENTRY)
    assert {f.subject[1:] for f in result.findings} == {(body, part)}
    assert result.findings[0].measured == pytest.approx(0.01, abs=1e-6)


def test_axes_of_a_part_moved_by_a_millimetre_are_missed_at_their_place(assembly, home, config, masts, tmp_path):
    write_assembly_step(moved(assembly, "leg_1_rod", "ball_bar", by=(1.0, 0.0, 0.0)), home, tmp_path / "moved.step")
    result = axes(tmp_path / "moved.step", config, masts.ENTRY)
    assert [f.subject for f in result.findings] == [("ball_1", "leg_1_rod")]
    assert "has no spherical face" in result.findings[0].message


def test_axes_of_a_part_turned_by_a_microradian_are_found(assembly, home, config, masts, tmp_path):
    write_assembly_step(moved(assembly, "base", "pin_1", turn=1e-6), home, tmp_path / "turned.step")
    result = axes(tmp_path / "turned.step", config, masts.ENTRY)
    assert any(f.unit == "rad" and f.measured == pytest.approx(1e-6, rel=1e-3) for f in result.findings)


def test_axes_are_missed_by_a_config_with_a_longer_arm(step, config, masts):
    config_value = json.loads(config.read_text())["parameters_arm_length_m"]
    change(config, parameters_arm_length_m=config_value + 5e-6)
    result = axes(step, config, masts.ENTRY)
    assert {f.subject[0] for f in result.findings} == {"ball_1", "ball_2"}
    assert result.findings[0].measured == pytest.approx(5e-3, rel=1e-3)


def test_axes_of_a_body_that_the_file_lacks_are_found(step, config, masts):
    bodies = {name: body for name, body in recover_axes(step).items() if name != "base"}
    result = check_axes(bodies, mechanism_from_config(config, masts.ENTRY), config)
    assert {f.subject for f in result.findings} == {("turn_1", "base"), ("turn_2", "base")}


def test_axes_of_a_mechanism_whose_bodies_do_not_meet_are_found(step, config, masts, monkeypatch):
    mechanism = mechanism_from_config(config, masts.ENTRY)
    place = type(mechanism).place_bodies

    def apart(self, poses):
        Ts = place(self, poses)
        Ts[:, 2, 0, 3] += 0.02
        return Ts

    monkeypatch.setattr(type(mechanism), "place_bodies", apart)
    result = check_axes(recover_axes(step), mechanism, config)
    assert any("two sides lie 0.02 mm apart" in m for m in messages(result))


def test_checks_that_have_nothing_to_look_at_are_vacuous(config, masts):
    from types import SimpleNamespace

    from linkwright.designs.language.errors import VacuousCheckError

    with pytest.raises(VacuousCheckError, match="STEP"):
        check_part_steps({})
    with pytest.raises(VacuousCheckError, match="STL"):
        check_stls({}, 0.05)
    with pytest.raises(VacuousCheckError, match="no joints"):
        check_axes({}, SimpleNamespace(name="stone", joints=()), config)

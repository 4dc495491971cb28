from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs import catalogue
from linkwright.exports.controller import mechanism_from_config, write_controller_config
from linkwright.exports.step import write_assembly_step
from linkwright.exports.verify import check_assembly_step
from linkwright.exports.verify_axes import check_axes
from linkwright.generator.assembly import build_assembly

BUILDABLE = [name for name in catalogue.names() if catalogue.entry(name).default_design().mechanism.has_solids]


@pytest.fixture(scope="module", params=BUILDABLE)
def built(request):
    return build_assembly(catalogue.entry(request.param).default_design())


def test_written_assembly_of_every_catalogue_design_shows_every_joint_where_its_config_puts_it(built, tmp_path):
    mechanism = built.design.mechanism
    home = mechanism.place_bodies(np.asarray(mechanism.home)[None])[0]
    write_assembly_step(built, home, tmp_path / "assembly.step")
    write_controller_config(built.design, {}, tmp_path / "kinematics.json")
    step, reread = check_assembly_step(tmp_path / "assembly.step", built, home)
    assert step.findings == ()
    rebuilt = mechanism_from_config(tmp_path / "kinematics.json")
    axes = check_axes(reread.bodies, rebuilt, tmp_path / "kinematics.json")
    assert axes.findings == ()
    assert axes.looked_at["joints"] == len(mechanism.joints)
    assert axes.facts["largest_distance_mm"] < 1e-9


def test_written_assembly_of_every_catalogue_design_is_missed_by_a_config_of_other_lengths(built, tmp_path):
    mechanism = built.design.mechanism
    home = mechanism.place_bodies(np.asarray(mechanism.home)[None])[0]
    write_assembly_step(built, home, tmp_path / "assembly.step")
    write_controller_config(built.design, {}, tmp_path / "kinematics.json")
    _, reread = check_assembly_step(tmp_path / "assembly.step", built, home)
    text = (tmp_path / "kinematics.json").read_text()
    lines = [line for line in text.splitlines() if line.strip().startswith('"parameters_') and "_length_m" in line]
    assert lines, "the mechanism has no length to change"
    value = float(lines[0].split(":")[1].strip(" ,"))
    (tmp_path / "kinematics.json").write_text(text.replace(lines[0], lines[0].replace(repr(value), repr(value + 1e-5))))
    axes = check_axes(reread.bodies, mechanism_from_config(tmp_path / "kinematics.json"), tmp_path / "kinematics.json")
    assert len(axes.findings) > 0

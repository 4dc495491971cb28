from __future__ import annotations

import json
import math

import numpy as np
import pytest

from linkwright.designs import catalogue
from linkwright.designs.language.errors import DesignFileError, ReleaseError
from linkwright.designs.language.units import DEG
from linkwright.exports.controller import config_of, mechanism_from_config, read_config, write_controller_config

MEASURED = {"turn_1": (-1.25, 1.3), "ball_1": (0.0, 0.6)}


@pytest.fixture
def written(design, tmp_path):
    path = tmp_path / "kinematics.json"
    write_controller_config(design, MEASURED, path)
    return path


def test_config_says_its_numbers_in_si_with_the_unit_in_the_key(design):
    config = config_of(design, MEASURED)
    assert config["arm_length_m"] == 0.0613
    assert config["turn_1_max_rad"] == 70.0 * DEG
    assert config["turn_1_measured_min_rad"] == -1.25
    assert config["ball_1_measured_max_rad"] == 0.6
    assert "turn_2_measured_max_rad" not in config
    assert config["joint_names"] == ["turn_1", "turn_2", "ball_1", "ball_2"]
    assert config["joint_is_active"] == [True, True, False, False]
    assert (config["branch"], config["assembly_mode"]) == ("plain", "plain")
    assert config["home_pose_turn_1_rad"] == 12.0 * DEG
    assert config["design_hash"] == design.hash


def test_config_is_flat_and_every_number_has_a_unit(written):
    config = json.loads(written.read_text())
    for key, value in config.items():
        assert not isinstance(value, dict)
        if isinstance(value, float):
            assert key.rsplit("_", 1)[1] in ("m", "rad", "kg", "n", "nm")


def test_config_comes_back_as_a_mechanism_of_the_same_kinematics(written, design, masts, rng):
    mechanism = mechanism_from_config(written, masts.ENTRY)
    assert mechanism.sections["parameters"] == design.mechanism.sections["parameters"]
    assert mechanism.sections["joint_limits"] == design.mechanism.sections["joint_limits"]
    poses = rng.uniform(-1.0, 1.0, (50, 2))
    assert np.array_equal(mechanism.place_bodies(poses), design.mechanism.place_bodies(poses))


def test_config_brings_back_every_number_of_a_design_file_to_the_bit(masts, tmp_path, rng):
    for i in range(200):
        # What a design file can say: up to 15 digits, over the range of sizes that people build.
        lengths = [float(f"{v:.{rng.integers(1, 16)}g}") for v in 10.0 ** rng.uniform(-1.0, 3.0, 3)]
        turn = float(f"{rng.uniform(1.0, 179.0):.{rng.integers(1, 16)}g}")
        design = masts.masts_design(half_distance=lengths[0], arm_length=lengths[1], ball_height=lengths[2])
        limits = masts.MastLimits(turn_max=turn * DEG)
        mechanism = masts.Masts({"parameters": design.mechanism.p, "joint_limits": limits})
        if turn < 32.0:
            continue
        import dataclasses

        path = tmp_path / f"{i}.json"
        write_controller_config(dataclasses.replace(design, mechanism=mechanism), {}, path)
        back = mechanism_from_config(path, masts.ENTRY)
        assert back.sections["parameters"] == design.mechanism.p
        assert back.sections["joint_limits"] == limits


@pytest.mark.parametrize("name", catalogue.names())
def test_config_of_every_catalogue_mechanism_comes_back(name, tmp_path, rng):
    design = catalogue.entry(name).default_design()
    path = tmp_path / "kinematics.json"
    write_controller_config(design, {}, path)
    mechanism = mechanism_from_config(path)
    lower, upper = design.box()
    poses = rng.uniform(lower, upper, (20, len(lower)))
    joints, again = design.mechanism.solve_inverse(poses).joints, mechanism.solve_inverse(poses).joints
    assert again == pytest.approx(joints, abs=1e-12)
    assert [j.name for j in mechanism.joints] == [j.name for j in design.mechanism.joints]


def test_config_refuses_two_numbers_of_one_key(design, monkeypatch):
    monkeypatch.setattr(type(design.mechanism), "controller_parameters", lambda self: {"turn_1_max": (1.0, "rad")})
    with pytest.raises(ReleaseError, match="turn_1_max_rad"):
        config_of(design, {})


def test_config_refuses_a_number_that_is_none(design):
    with pytest.raises(ValueError, match="JSON"):
        json.dumps(config_of(design, {"turn_1": (math.nan, 1.0)}), allow_nan=False)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"format": "other"}, "format"),
        ({"format_version": 2}, "format_version"),
        ({"design_hash": None}, "design_hash"),
        ({"joint_names": "turn_1"}, "joint_names"),
    ],
)
def test_config_of_another_format_is_refused(written, change, words):
    config = json.loads(written.read_text()) | change
    written.write_text(json.dumps(config))
    with pytest.raises(DesignFileError, match=words):
        read_config(written)


def test_config_that_is_no_json_is_refused(written):
    written.write_text(written.read_text()[:-20])
    with pytest.raises(DesignFileError, match="no JSON"):
        read_config(written)


def test_config_without_a_number_that_the_mechanism_needs_is_refused(written, masts):
    config = json.loads(written.read_text())
    del config["parameters_arm_length_m"]
    written.write_text(json.dumps(config))
    with pytest.raises(DesignFileError, match="parameters_arm_length_m: is missing"):
        mechanism_from_config(written, masts.ENTRY)

"""The Python API: one pose or many, shapes that match, reasons in words, and a light import."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from linkwright.designs import api, catalogue
from linkwright.designs.language.errors import DesignFileError, ParameterError, UnknownNameError


@pytest.mark.parametrize("name", catalogue.names())
def test_one_pose_gives_the_row_that_a_batch_gives(name):
    mechanism = api.load(name)
    many = np.stack([mechanism.home, mechanism.home]).reshape(2, 1, -1)
    one, batch = api.solve_inverse(mechanism, mechanism.home), api.solve_inverse(mechanism, many)
    assert one.joints.shape == (len(mechanism.joints),)
    assert one.is_reachable.shape == ()
    assert batch.joints.shape == (2, 1, len(mechanism.joints))
    np.testing.assert_array_equal(batch.joints[1, 0], one.joints)
    np.testing.assert_array_equal(batch.active[0, 0], one.joints[: mechanism.n_active])
    for of in (api.compute_jacobian, api.place_bodies):
        np.testing.assert_array_equal(of(mechanism, many)[1, 0], of(mechanism, mechanism.home))
    assert api.place_bodies(mechanism, mechanism.home).shape == (len(mechanism.bodies), 4, 4)
    assert api.compute_jacobian(mechanism, mechanism.home).shape[0] == mechanism.n_active


@pytest.mark.parametrize("name", catalogue.names())
def test_forward_after_inverse_returns_the_home_pose(name):
    mechanism = api.load(name)
    active = api.solve_inverse(mechanism, mechanism.home).active
    answer = api.solve_forward(mechanism, active, near=mechanism.home)
    assert answer.is_solved and answer.reason() == ""
    assert answer.poses.shape == mechanism.home.shape
    np.testing.assert_allclose(answer.poses, mechanism.home, atol=1e-9)
    stacked = api.solve_forward(mechanism, np.tile(active, (2, 3, 1)), near=mechanism.home)
    assert stacked.poses.shape == (2, 3, len(mechanism.task))
    assert stacked.n_candidates.shape == stacked.residual.shape == (2, 3)


def test_a_list_of_numbers_is_a_pose():
    mechanism = api.load("five_bar")
    assert api.solve_inverse(mechanism, [0, 250]).is_reachable


def test_no_poses_give_empty_arrays_of_the_right_shape():
    mechanism = api.load("hit")
    answer = api.solve_inverse(mechanism, np.zeros((0, 6)))
    assert answer.active.shape == (0, 6) and answer.is_reachable.shape == (0,)
    assert api.place_bodies(mechanism, np.zeros((0, 6))).shape == (0, len(mechanism.bodies), 4, 4)


def test_out_of_reach_is_said_in_words_for_one_pose_and_at_its_place_in_a_batch():
    mechanism = api.load("five_bar")
    far = [0.0, 500.0]
    answer = api.solve_inverse(mechanism, far)
    assert not answer.is_reachable
    assert answer.reason() == "right arm stretched"
    batch = api.solve_inverse(mechanism, [[[0.0, 250.0], far]])
    assert [batch.reason(0, i) for i in range(2)] == ["", "right arm stretched"]
    assert api.solve_inverse(mechanism, [0.0, np.nan]).reason() != ""


def test_joint_values_without_a_pose_are_said_in_words():
    answer = api.solve_forward(api.load("five_bar"), [0.0, np.pi])
    assert not answer.is_solved
    assert answer.reason() == "no pose of the working assembly mode"


@pytest.mark.parametrize("poses", [3.0, [1.0, 2.0, 3.0], np.zeros((4, 5))])
def test_a_pose_of_the_wrong_length_is_refused_with_the_coordinates(poses):
    with pytest.raises(ParameterError, match=r"shape of poses .* must hold 2 numbers: x \[mm\], y \[mm\]"):
        api.solve_inverse(api.load("five_bar"), poses)


def test_joint_values_and_near_poses_of_the_wrong_length_are_refused():
    mechanism = api.load("stewart")
    with pytest.raises(ParameterError, match=r"shape of active = \(5,\).*6 numbers: .*\[mm\]"):
        api.solve_forward(mechanism, np.zeros(5))
    with pytest.raises(ParameterError, match="shape of near"):
        api.solve_forward(mechanism, np.zeros(6), near=np.zeros(3))


def test_a_branch_is_chosen_by_name():
    mechanism = api.load("five_bar")
    out, inside = (api.solve_inverse(mechanism, mechanism.home, branch).active for branch in ("out", "in"))
    assert np.all(np.abs(out - inside) > 0.1)
    with pytest.raises(UnknownNameError, match="left"):
        api.solve_inverse(mechanism, mechanism.home, "up")


def test_load_takes_a_file_a_path_and_overrides(tmp_path):
    file = tmp_path / "my.toml"
    file.write_text('mechanism = "five_bar"\n[parameters]\narm_length_mm = 170.0\n', encoding="utf-8")
    for design in (file, str(file)):
        assert api.load(design).sections["parameters"].arm_length == 170.0
    changed = api.load(file, ["parameters.arm_length_mm=175"])
    assert changed.sections["parameters"].arm_length == 175.0
    with pytest.raises(DesignFileError, match="did you mean"):
        api.load("five_baar")


def test_load_design_gives_the_workspace_too():
    assert len(api.load_design("hit").workspace.lower) == 6


def test_importing_the_api_loads_no_heavy_library():
    heavy = ("pydantic", "numba", "llvmlite", "scipy", "trimesh", "build123d", "OCP", "vtkmodules", "click")
    code = (
        "import sys; from linkwright.designs import api; h = api.load('hit'); api.solve_inverse(h, h.home); "
        f"print([m for m in {heavy!r} if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert run.stdout.strip() == "[]"

"""A mechanism in a file outside the package works with every command, and a bad file is refused in clear words."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from linkwright.app.cli import cli
from linkwright.designs import api, catalogue

EXAMPLES = Path(__file__).parents[2] / "examples"
SOURCE = EXAMPLES / "asymmetric_five_bar.py"
DESIGN = EXAMPLES / "asymmetric_five_bar.toml"
NAME = "asymmetric_five_bar"


@pytest.fixture(autouse=True)
def own_catalogue(monkeypatch):
    """What a test adds leaves with it."""
    monkeypatch.setattr(catalogue, "_ENTRIES", dict(catalogue._ENTRIES))
    monkeypatch.delenv("LINKWRIGHT_MECHANISMS", raising=False)


@pytest.fixture
def linkwright(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    return lambda *words, text=None: CliRunner().invoke(cli, list(words), input=text)


@pytest.fixture
def own(linkwright):
    return lambda *words, text=None: linkwright("--mechanisms", str(SOURCE), *words, text=text)


@pytest.fixture
def file_of(tmp_path):
    """A copy of the example with replacements, or a text, as a file of its own."""

    def write(text=None, name="mine.py", **replaced):
        content = SOURCE.read_text(encoding="utf-8") if text is None else text
        for old, new in replaced.get("changes", ()):
            assert old in content
            content = content.replace(old, new)
        path = tmp_path / name
        path.write_text(content, encoding="utf-8")
        return path

    return write


def test_list_shows_it_only_when_its_file_is_named(linkwright, own):
    assert NAME not in linkwright("list").stdout
    assert NAME in own("list").stdout
    assert NAME in {row["name"] for row in json.loads(own("list", "--json").stdout)}


def test_new_writes_a_design_file_that_show_reads_back(own):
    assert own("new", NAME, "-o", "mine.toml").exit_code == 0
    facts = json.loads(own("show", "mine.toml", "--json").stdout)
    assert facts["name"] == NAME
    assert facts["design_hash"] == catalogue.entry(NAME).default_design().hash


def test_forward_after_inverse_returns_its_pose(own):
    inverse = own("ik", str(DESIGN), "--pose", "5,130")
    assert inverse.exit_code == 0
    forward = own("fk", str(DESIGN), text=inverse.stdout)
    assert forward.exit_code == 0
    pose = [float(cell) for cell in forward.stdout.splitlines()[1].split(",")[:2]]
    np.testing.assert_allclose(pose, [5.0, 130.0], atol=1e-9)


def test_an_override_and_its_bounds_hold_for_its_own_keys(own):
    shown = json.loads(own("show", NAME, "--json", "--set", "parameters.left_arm_length_mm=105").stdout)
    assert shown["design"]["parameters"]["left_arm_length_mm"] == 105.0
    refused = own("show", NAME, "--set", "parameters.left_arm_length_mm=-5")
    assert refused.exit_code == 2
    assert "parameters.left_arm_length_mm = -5: must be above 0 mm" in refused.stderr


def test_schema_describes_its_design_file(own):
    jsonschema = pytest.importorskip("jsonschema")
    import tomllib

    table = tomllib.loads(DESIGN.read_text(encoding="utf-8"))
    jsonschema.validate(table, json.loads(own("schema", NAME).stdout))
    jsonschema.validate(table, json.loads(own("schema").stdout))
    table["parameters"]["left_arm_length_mm"] = -1.0
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(table, json.loads(own("schema", NAME).stdout))


def test_dexterity_measures_it(own):
    outcome = own("dexterity", str(DESIGN), "--poses", "50", "--json")
    assert outcome.exit_code == 0, outcome.output
    json.loads(outcome.stdout)


def test_check_passes_on_its_solids(own):
    outcome = own("check", str(DESIGN), "--poses", "40", "--json")
    assert outcome.exit_code == 0, outcome.output
    checks = {check["check"]: check for check in json.loads(outcome.stdout)["checks"]}
    assert checks["fits"]["looked_at"]["joints"] == 5
    assert checks["clearance"]["looked_at"]["pairs"] == 10


def test_check_finds_the_collision_when_its_layers_lie_too_close(own):
    outcome = own("check", str(DESIGN), "--poses", "10", "--set", "parts.bars.layer_gap_mm=0.3", "--json")
    assert outcome.exit_code == 1
    rules = {finding["rule"] for check in json.loads(outcome.stdout)["checks"] for finding in check["findings"]}
    assert any("clearance" in rule for rule in rules), rules


def test_release_writes_and_verifies_it_in_a_process_of_its_own(tmp_path):
    words = ["-m", "linkwright.app", "--mechanisms", str(SOURCE), "release", str(DESIGN), "-o", str(tmp_path / "out")]
    run = subprocess.run(
        [sys.executable, *words, "--poses", "40", "--json"], check=False, capture_output=True, text=True, timeout=300
    )
    assert run.returncode == 0, run.stderr + run.stdout
    config = json.loads((tmp_path / "out" / "controller" / "kinematics.json").read_text(encoding="utf-8"))
    assert config["mechanism"] == NAME
    assert (tmp_path / "out" / "cad" / "assembly.step").stat().st_size > 0


def test_the_environment_names_files_too(linkwright, monkeypatch, file_of):
    other = file_of(name="other.py", changes=[(f'name = "{NAME}"', 'name = "other_bar"')])
    monkeypatch.setenv("LINKWRIGHT_MECHANISMS", os.pathsep.join([str(SOURCE), str(other)]))
    listed = linkwright("list").stdout
    assert NAME in listed and "other_bar" in listed


def test_two_files_may_be_named_and_one_file_twice(linkwright, file_of):
    other = file_of(name="other.py", changes=[(f'name = "{NAME}"', 'name = "other_bar"')])
    words = [word for path in (SOURCE, other, SOURCE) for word in ("--mechanisms", str(path))]
    outcome = linkwright(*words, "list")
    assert outcome.exit_code == 0, outcome.output
    assert "other_bar" in outcome.stdout


def test_a_folder_with_relative_imports_is_a_file_of_mechanisms(linkwright, tmp_path):
    folder = tmp_path / "my_devices"
    folder.mkdir()
    shutil.copy(SOURCE, folder / "bar.py")
    (folder / "__init__.py").write_text("from .bar import ENTRIES\n", encoding="utf-8")
    assert NAME in linkwright("--mechanisms", str(folder), "list").stdout


def test_python_takes_up_the_file_and_solves_a_batch(rng):
    (entry,) = api.add_mechanisms([SOURCE])
    design = api.load_design(str(DESIGN))
    assert entry.name == design.mechanism.name
    poses = rng.uniform(*design.box(), (50, 2))
    answer = api.solve_inverse(design.mechanism, poses)
    assert answer.is_reachable.all()
    np.testing.assert_allclose(api.solve_forward(design.mechanism, answer.active).poses, poses, atol=1e-9)


def test_its_jacobian_equals_finite_differences_and_its_loops_close(rng):
    api.add_mechanisms([SOURCE])
    design = api.load_design(str(DESIGN))
    mechanism, step = design.mechanism, 1e-5
    poses = rng.uniform(*design.box(), (20, 2))
    J = api.compute_jacobian(mechanism, poses)
    for k, shift in enumerate(np.eye(2) * step):
        up, down = (api.solve_inverse(mechanism, poses + sign * shift).active for sign in (1.0, -1.0))
        np.testing.assert_allclose(J[..., k], (up - down) / (2.0 * step), rtol=1e-6, atol=1e-10)
    names = [body.name for body in mechanism.bodies]
    Ts = api.place_bodies(mechanism, poses)
    for joint in mechanism.joints:
        ends = [
            (Ts[:, names.index(body)] @ np.array([*point, 1.0]))[:, :3]
            for body, point in ((joint.parent, joint.p_parent), (joint.child, joint.p_child))
        ]
        np.testing.assert_allclose(*ends, atol=1e-9)


def test_a_design_file_cannot_name_code(own, tmp_path):
    (tmp_path / "sly.toml").write_text('mechanism = "mine"\nmechanisms = "mine.py"\n', encoding="utf-8")
    outcome = own("show", "sly.toml")
    assert outcome.exit_code == 2 and "mechanism = 'mine'" in outcome.stderr


BAD_FILES = {
    "no python": ("ENTRIES = (\n", "mine.py:1: is no Python: '(' was never closed"),
    "an error inside": ("import math\n\nmath.sqrt(-1.0)\n", "mine.py:3: fails: ValueError: math domain error"),
    "no entries": ("NAME = 1\n", "mine.py: has no ENTRIES; it must define ENTRIES = (Entry(...), ...)"),
    "entries of another kind": ("ENTRIES = ('hit',)\n", "mine.py: has ENTRIES = ('hit',); it must define"),
    "empty entries": ("ENTRIES = ()\n", "mine.py: has ENTRIES = (); it must define"),
}


@pytest.mark.parametrize(("text", "message"), BAD_FILES.values(), ids=BAD_FILES)
def test_a_bad_file_is_refused_with_file_and_line(linkwright, file_of, text, message):
    outcome = linkwright("--mechanisms", str(file_of(text)), "list")
    assert outcome.exit_code == 2
    assert message in outcome.stderr
    assert "fault of" not in outcome.stderr


def test_a_missing_file_is_refused(linkwright):
    outcome = linkwright("--mechanisms", "nowhere.py", "list")
    assert outcome.exit_code == 2 and "nowhere.py: does not exist" in outcome.stderr
    folder = linkwright("--mechanisms", ".", "list")
    assert folder.exit_code == 2 and "is a folder without __init__.py" in folder.stderr


def test_a_name_of_the_catalogue_is_refused_and_nothing_is_taken_up(linkwright, file_of):
    path = file_of(changes=[(f'name = "{NAME}"', 'name = "hit"')])
    before = catalogue.entry("hit")
    outcome = linkwright("--mechanisms", str(path), "list")
    assert outcome.exit_code == 2
    assert "there is already a mechanism called 'hit'" in outcome.stderr
    assert catalogue.entry("hit") is before


def test_a_mechanism_whose_defaults_do_not_build_is_refused_at_its_line(linkwright, file_of):
    path = file_of(changes=[("        self.home = self._right_angles()", "        self.home = self._no_such_thing()")])
    line = path.read_text(encoding="utf-8").splitlines().index("        self.home = self._no_such_thing()") + 1
    outcome = linkwright("--mechanisms", str(path), "list")
    assert outcome.exit_code == 2
    assert f"mine.py:{line}: {NAME} cannot be built with its defaults: AttributeError" in outcome.stderr


def test_an_entry_that_disagrees_with_its_mechanism_is_refused(linkwright, file_of):
    renamed = file_of(name="renamed.py", changes=[("name=AsymmetricFiveBar.name", 'name="another"')])
    outcome = linkwright("--mechanisms", str(renamed), "list")
    assert outcome.exit_code == 2 and "the entry is called 'another'" in outcome.stderr
    short = file_of(name="short.py", changes=[("lower=(-20.0, 105.0)", "lower=(-20.0,)")])
    outcome = linkwright("--mechanisms", str(short), "list")
    assert outcome.exit_code == 2 and "corners have 1 and 2 numbers, the task 2 coordinates" in outcome.stderr


def test_a_fault_of_the_mechanism_at_work_is_told_apart_from_a_fault_of_linkwright(linkwright, file_of):
    path = file_of(changes=[("return right.pivot, left.pivot,", "return right.pivot, left.pivott,")])
    outcome = linkwright("--mechanisms", str(path), "ik", NAME, "--pose", "5,130")
    line = next(i for i, text in enumerate(path.read_text("utf-8").splitlines(), 1) if "left.pivott" in text)
    assert outcome.exit_code == 2
    assert f"a fault of the mechanism at {path}:{line}" in outcome.stderr

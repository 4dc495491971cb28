"""The command line as a whole: words, exit codes, errors, and what it loads."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import jsonschema
import pytest

from linkwright.app.cli import COMMANDS
from linkwright.designs import catalogue
from linkwright.designs.language.supplies import names

HEAVY = ("OCP", "build123d", "cadquery", "numba", "trimesh", "vtk", "manifold3d", "scipy", "rich", "pydantic")


def run_fresh(code, *words):
    """A new interpreter without anything on its input."""
    return subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        check=False,
        env={**os.environ, "COLUMNS": "120"},
    )


@pytest.mark.parametrize("word", list(COMMANDS))
def test_every_word_explains_itself(linkwright, word):
    result = linkwright(word, "--help")
    assert result.exit_code == 0
    assert "--json" in result.stdout


def test_help_names_every_word_and_the_exit_codes(linkwright):
    text = linkwright("--help").stdout
    assert all(f"\n  {word} " in text for word in COMMANDS)
    assert "Exit codes" in text


def test_version_is_told(linkwright):
    assert linkwright("--version").stdout.startswith("linkwright, version ")


@pytest.mark.parametrize("name", catalogue.names())
def test_ik_of_the_home_pose_loads_no_heavy_library(name):
    code = (
        f"import sys, json\nfrom linkwright.app.cli import cli\ntry:\n    cli(['ik', '{name}'])\n"
        f"except SystemExit as end:\n    print(json.dumps([end.code, [m for m in {HEAVY} if m in sys.modules]]))"
    )
    lines = run_fresh(code).stdout.splitlines()
    assert json.loads(lines[-1]) == [0, []]
    assert len(lines) == 3
    assert lines[1].endswith("true,")


def test_an_interrupt_ends_with_130(linkwright, monkeypatch):
    def interrupt(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr("linkwright.app.commands.show.load_design", interrupt)
    assert linkwright("show", "arm").exit_code == 130


def test_a_fault_of_ours_ends_with_2_and_hides_its_traceback_until_asked(linkwright, monkeypatch):
    def fail(*args, **kwargs):
        raise ZeroDivisionError("nothing to share by")

    monkeypatch.setattr("linkwright.app.commands.show.load_design", fail)
    result = linkwright("show", "arm")
    assert result.exit_code == 2
    assert "ZeroDivisionError: nothing to share by" in result.stderr
    assert "--debug" in result.stderr
    assert "Traceback" not in result.stderr
    assert "Traceback" in linkwright("show", "arm", "--debug").stderr


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["show", "devise.toml"], "devise.toml: file: does not exist"),
        (["show", "amr"], "did you mean arm?"),
        (["show", "arm", "--set", "parameters.fore_mm=-5"], "--set: parameters.fore_mm = -5: must be above 0 mm"),
        (["show", "arm", "--set", "parameters.for_mm=5"], "did you mean parameters.fore_mm?"),
        (["show", "arm", "--set", "nonsense"], "must be key=value"),
        (["new", "robot"], "there is no mechanism called 'robot'"),
        (["schema", "robot"], "there is no mechanism called 'robot'"),
    ],
)
def test_a_wrong_design_is_one_line_and_code_two(linkwright, words, told):
    result = linkwright(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert len(result.stderr.splitlines()) == 1
    as_json = linkwright(*words, "--json")
    assert (as_json.exit_code, as_json.stderr) == (2, "")
    assert told in json.loads(as_json.stdout)["error"]["message"]


def test_several_errors_are_a_line_each_and_a_list_in_json(linkwright, tmp_path):
    (tmp_path / "bad.toml").write_text('mechanism = "arm"\n[parameters]\nfore_mm = -1\nupper_mm = nan\n')
    result = linkwright("show", "bad.toml")
    assert [line.split(": ")[1] for line in result.stderr.splitlines()] == ["bad.toml:3", "bad.toml:4"]
    errors = json.loads(linkwright("show", "bad.toml", "--json").stdout)["error"]["errors"]
    assert [(e["line"], e["key"], e["value"]) for e in errors] == [
        (3, "parameters.fore_mm", -1),
        (4, "parameters.upper_mm", "nan"),
    ]


@pytest.mark.parametrize(
    "words",
    [
        ["explode"],
        ["show"],
        ["show", "arm", "--no-such"],
        ["ik", "arm", "--format", "xml"],
        ["check", "arm", "--poses", "0"],
        ["check", "arm", "--seed", "-1"],
        ["release", "arm"],
    ],
)
def test_wrong_usage_ends_with_code_two(linkwright, words):
    result = linkwright(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "Usage:" in result.stderr


def test_wrong_usage_in_json(linkwright):
    assert json.loads(linkwright("show", "--json").stdout)["error"]["kind"] == "UsageError"


def test_list_names_every_mechanism(linkwright):
    assert linkwright("list").stdout.startswith("arm ")
    assert {row["name"] for row in json.loads(linkwright("list", "--json").stdout)} == set(catalogue.names())


def test_list_of_supplies_shows_what_a_design_file_can_name(linkwright):
    text = linkwright("list", "--supplies").stdout
    tables = json.loads(linkwright("list", "--supplies", "--json").stdout)
    assert {"bearings", "motors", "screws", "materials"} <= set(tables)
    for name, rows in tables.items():
        assert all(row["name"] in text for row in rows), name
    assert set(names("bearings")) == {row["name"] for row in tables["bearings"]}
    assert all(isinstance(row["bore_mm"], float) for row in tables["bearings"])


def test_new_writes_a_file_that_show_and_schema_take_and_never_overwrites(linkwright, tmp_path):
    assert linkwright("new", "arm").exit_code == 0
    assert linkwright("show", "arm.toml").exit_code == 0
    (tmp_path / "arm.toml").write_text("mine")
    refused = linkwright("new", "arm")
    assert refused.exit_code == 2
    assert "arm.toml exists" in refused.stderr
    assert (tmp_path / "arm.toml").read_text() == "mine"
    assert linkwright("new", "arm", "--force", "-o", "arm.toml").exit_code == 0
    assert (tmp_path / "arm.toml").read_text() == linkwright("new", "arm", "-o", "-").stdout


def test_show_tells_parameters_derived_numbers_joints_and_hash(linkwright):
    text = linkwright("show", "arm", "--set", "parameters.fore_mm=90").stdout
    for words in ("[parameters]", "fore_mm *", "elbow to hand", "reach", "190", "shoulder", "driven", "x_min_mm "):
        assert words in text
    facts = json.loads(linkwright("show", "arm", "--json").stdout)
    assert facts["design_hash"] == catalogue.entry("arm").default_design().hash
    assert facts["design_hash"] in linkwright("show", "arm").stdout
    assert facts["derived"]["reach"]["value"] == 180.0
    assert facts["design"]["parts"]["bars"]["n_screws"] == 4


def test_show_toml_is_the_resolved_design(linkwright, tmp_path):
    (tmp_path / "r.toml").write_text(linkwright("show", "arm", "--toml", "--set", "parameters.fore_mm=90").stdout)
    hashes = {
        json.loads(linkwright("show", *words, "--json").stdout)["design_hash"]
        for words in (["r.toml"], ["arm", "--set", "parameters.fore_mm=90"])
    }
    assert len(hashes) == 1


def test_schema_of_one_and_of_all_mechanisms(linkwright):
    for words in ([], ["arm"]):
        jsonschema.Draft202012Validator.check_schema(json.loads(linkwright("schema", *words).stdout))

"""Poses in, joint values out, and back: as CSV, as JSON lines, through a pipe."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

POSES = "x_mm,y_mm\n80,70\n-20.25,150\n500,0\n100,80\n"


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_ik_answers_in_degrees_and_says_why_a_pose_is_out_of_reach(linkwright):
    result = linkwright("ik", "arm", text=POSES)
    rows = rows_of(result.stdout)
    assert list(rows[0]) == ["shoulder_deg", "elbow_deg", "reachable", "reason"]
    assert [row["reachable"] for row in rows] == ["true", "true", "false", "true"]
    assert (rows[2]["shoulder_deg"], rows[2]["elbow_deg"], rows[2]["reason"]) == ("", "", "stretched")
    assert float(rows[3]["elbow_deg"]) == pytest.approx(90.0, abs=1e-12)
    assert result.exit_code == 1
    assert "1 of 4 poses" in result.stderr


def test_exit_code_is_zero_when_all_poses_are_reachable(linkwright):
    assert linkwright("ik", "arm", "--pose", "80,70").exit_code == 0


def test_ik_then_fk_returns_the_poses(linkwright, rng):
    poses = rng.uniform(40.0, 110.0, (200, 2))
    text = "x_mm,y_mm\n" + "".join(f"{x!r},{y!r}\n" for x, y in poses.tolist())
    back = linkwright("fk", "arm", text=linkwright("ik", "arm", "--all", text=text).stdout)
    assert back.exit_code == 0
    found = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows_of(back.stdout)])
    np.testing.assert_allclose(found, poses, rtol=0.0, atol=1e-11)


def test_fk_keeps_a_row_without_values_and_its_reason(linkwright):
    back = linkwright("fk", "arm", text=linkwright("ik", "arm", text=POSES).stdout)
    rows = rows_of(back.stdout)
    assert len(rows) == 4
    assert rows[2]["x_mm"] == ""
    assert rows[2]["reason"] == "no values given: stretched"
    assert back.exit_code == 1


def test_ik_reads_what_fk_writes(linkwright):
    there = linkwright("fk", "arm", text=linkwright("ik", "arm", text=POSES).stdout).stdout
    assert [row["reachable"] for row in rows_of(linkwright("ik", "arm", text=there).stdout)] == [
        "true",
        "true",
        "false",
        "true",
    ]


def test_json_lines_are_recognised_and_answered_in_kind(linkwright):
    result = linkwright("ik", "arm", text='{"x_mm": 80, "y_mm": 70}\n\n{"y_mm": 0, "x_mm": 500}\n')
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [row["reachable"] for row in rows] == [True, False]
    assert rows[1]["elbow_deg"] is None
    back = linkwright("fk", "arm", text=result.stdout)
    assert json.loads(back.stdout.splitlines()[0])["x_mm"] == pytest.approx(80.0, abs=1e-11)
    assert back.exit_code == 1


def test_form_of_the_output_can_be_asked_for(linkwright):
    assert json.loads(linkwright("ik", "arm", "--json", "--pose", "80,70").stdout)["reachable"] is True
    assert json.loads(linkwright("ik", "arm", "--json", text="x_mm,y_mm\n80,70\n").stdout)["reachable"] is True
    assert linkwright("ik", "arm", "--format", "csv", "--pose", "80,70").stdout.startswith("shoulder_deg,")


def test_passive_joints_come_after_the_active_ones(linkwright):
    header = linkwright("ik", "arm", "--all", "--pose", "80,70").stdout.splitlines()[0]
    assert header == "shoulder_deg,elbow_deg,wrist_deg,reachable,reason"


def test_negative_numbers_are_values_not_options(linkwright):
    assert linkwright("ik", "arm", "--pose", "-80,-70").exit_code == 0


def test_files_are_read_and_written(linkwright, tmp_path):
    (tmp_path / "poses.csv").write_text("# a comment\ny_mm, x_mm\n70, 80\n\n")
    assert linkwright("ik", "arm", "-i", "poses.csv", "-o", "joints.csv").exit_code == 0
    back = linkwright("fk", "arm", "-i", "joints.csv")
    assert float(rows_of(back.stdout)[0]["x_mm"]) == pytest.approx(80.0, abs=1e-11)


def test_a_parameter_override_changes_the_answer(linkwright):
    default = linkwright("ik", "arm", "--pose", "80,70").stdout
    assert linkwright("ik", "arm", "--pose", "80,70", "--set", "parameters.fore_mm=90").stdout != default


def test_fk_refuses_an_ambiguous_row_until_a_near_pose_decides(linkwright):
    refused = linkwright("fk", "arm", "--joints", "10,-120")
    assert refused.exit_code == 1
    assert "2 legal poses" in refused.stdout
    assert linkwright("fk", "arm", "--joints", "10,-120", "--near", "80,70").exit_code == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x_mm,y_cm\n1,2\n", ["stdin:2", "no column called 'y_cm'", "did you mean y_mm?"]),
        ("x_mm\n1\n", ["column y_mm is missing"]),
        ("x_mm,y_mm,x_mm\n1,2,3\n", ["'x_mm' is named twice"]),
        ("x_mm,y_mm\n1\n", ["stdin:2", "1 cells where the header names 2"]),
        ("x_mm,y_mm\n1,two\n", ["stdin:2", "column y_mm = 'two'", "finite number"]),
        ("x_mm,y_mm\n1,nan\n", ["column y_mm = 'nan'"]),
        ("x_mm,y_mm\n1,1_0\n", ["column y_mm = '1_0'"]),
        ("x_mm,y_mm\n80,70\n1,\n", ["stdin:3", "column y_mm is empty"]),
        ("80,70\n", ["the first line must name the columns"]),
        ("x_mm,y_mm\n", ["the input is empty"]),
        ("", ["the input is empty"]),
        ('{"x_mm": 80, "y_mm": true}\n', ["column y_mm = True"]),
        ('{"x_mm": 80}\n', ["column y_mm is missing"]),
        ('{"x_mm": 80, "y_mm": 70}\n{"x_mm": 80,\n', ["stdin:2", "not a JSON object"]),
    ],
)
def test_wrong_rows_are_refused_with_line_and_column(linkwright, text, words):
    result = linkwright("ik", "arm", text=text)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert all(word in result.stderr for word in words), result.stderr
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    "words",
    [
        ["ik", "arm", "--pose", "80"],
        ["ik", "arm", "--pose", "80,x"],
        ["fk", "arm", "--joints", "1,2,3"],
        ["fk", "arm", "--joints", "1,2", "--near", "1"],
        ["ik", "arm", "-i", "missing.csv"],
        ["ik", "arm", "--pose", "80,70", "--branch", "sideways"],
        ["ik", "arm", "--pose", "80,70", "-o", "no/such/folder.csv"],
    ],
)
def test_wrong_options_end_with_code_two_and_one_line(linkwright, words):
    result = linkwright(*words)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert "Traceback" not in result.stderr

"""`linkwright dexterity`: the page, the JSON, the table of poses, and what it refuses."""

from __future__ import annotations

import csv
import io
import json

import pytest


def facts(result):
    assert result.stdout, result.stderr
    return json.loads(result.stdout)


def test_the_page_says_what_was_measured_and_where(linkwright):
    result = linkwright("dexterity", "five_bar")
    assert result.exit_code == 0
    for words in (
        "condition_position",
        "nearest singular poses",
        "global isotropy index",
        "serial_margin",
        "stretched",
    ):
        assert words in result.stdout


def test_json_holds_the_page_and_every_key_says_its_unit(linkwright):
    found = facts(linkwright("dexterity", "haptic_pen", "--json"))
    assert set(found["pose"]) == {"x_mm", "y_mm", "z_mm", "rx_deg", "rz_deg"}
    assert found["workspace"]["n_poses"] == found["global_isotropy"]["n_poses"] == 1000
    assert found["at_pose"]["condition"] == pytest.approx(1.0 / found["at_pose"]["isotropy"])
    spread = found["workspace"]["measures"]["condition"]
    assert spread["least"] <= spread["median"] <= spread["greatest"]


def test_the_papers_index_of_table_7_comes_out_of_the_command(linkwright):
    """A quarter of the workspace, every second place; the index is decided on its border."""
    words = ["--set", "workspace.x_min_mm=0", "--set", "workspace.y_min_mm=0", "--grid", "9,6,11"]
    scales = ["--motors", "1.6,1,1,1.6,1,1", "--hand", "1,1,1.5,36,39"]
    result = linkwright("dexterity", "haptic_pen", "--json", *words, "--rings", "45", "--ring-count", "14", *scales)
    index = facts(result)["global_isotropy"]
    assert index["n_poses"] == 9 * 6 * 11 * 617
    assert index["index_of_reachable"] == pytest.approx(0.2345, abs=5e-4)


def test_a_pose_and_an_override_change_the_answer(linkwright):
    default = facts(linkwright("dexterity", "five_bar", "--json"))
    moved = facts(linkwright("dexterity", "five_bar", "--json", "--pose", "20,250"))
    longer = facts(linkwright("dexterity", "five_bar", "--json", "--set", "parameters.tip_link_length_mm=190"))
    assert moved["pose"] == {"x_mm": 20.0, "y_mm": 250.0}
    assert len({d["at_pose"]["condition"] for d in (default, moved, longer)}) == 3
    assert default["workspace"] == moved["workspace"]


def test_every_pose_visited_is_written_with_its_measures(linkwright, tmp_path):
    assert linkwright("dexterity", "five_bar", "--grid", "5,4", "-o", "map.csv").exit_code == 0
    rows = list(csv.DictReader(io.StringIO((tmp_path / "map.csv").read_text())))
    assert len(rows) == 20
    assert {row["reachable"] for row in rows} == {"true"}
    assert all(float(row["condition"]) >= 1.0 for row in rows)


def test_poses_out_of_reach_are_told_and_end_with_code_one(linkwright):
    result = linkwright("dexterity", "five_bar", "--json", "--set", "workspace.y_max_mm=600")
    assert result.exit_code == 1
    found = facts(result)
    assert found["workspace"]["n_unreachable"] == found["global_isotropy"]["n_unreachable"] > 0
    assert found["global_isotropy"]["index"] == 0.0 < found["global_isotropy"]["index_of_reachable"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--pose", "0,5000"], "cannot be reached"),
        (["--pose", "0"], "1 numbers where 2 belong"),
        (["--grid", "3,x"], "no list of numbers"),
        (["--grid", "3,3,3"], "must be one number, or 2"),
        (["--rings", "30"], "needs a task with turns"),
        (["--motors", "1"], "must be 2 numbers"),
        (["--length", "0"], "--length"),
    ],
)
def test_what_cannot_be_measured_is_refused_with_a_reason(linkwright, words, told):
    result = linkwright("dexterity", "five_bar", *words)
    assert result.exit_code == 2
    assert told in result.stderr
    assert "Traceback" not in result.stderr

"""A report becomes plain JSON, the same for the same design, and never holds what is no number."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from linkwright.analysis.findings import CheckResult, Finding, Report, Severity
from linkwright.analysis.report import findings_json, line_of, plain

FINDING = Finding(
    rule="r",
    severity=Severity.WARNING,
    subject=("a", "b"),
    message="m",
    measured=np.float64(0.5),
    pose={"x_mm": np.float64(1.0)},
    location=(1.0, 2.0, 3.0),
    key="clearance.minimum_mm",
)


def report_of(**facts):
    return Report(results=(CheckResult(check="c", looked_at={"pairs": np.int64(3)}, findings=(FINDING,), facts=facts),))


def test_report_is_json_and_equal_however_the_file_was_laid_out(each_design):
    report = report_of(limits={"j": np.array([1.0, 2.0])}, severity=Severity.NOTE)
    moved = dataclasses.replace(each_design, path="elsewhere.toml", lines={"clearance": 7})
    tables = [findings_json(report, design) for design in (each_design, moved)]
    assert tables[0] == tables[1]
    assert json.loads(json.dumps(tables[0], allow_nan=False)) == tables[0]
    assert tables[0]["checks"][0]["facts"] == {"limits": {"j": [1.0, 2.0]}, "severity": "note"}
    assert tables[0]["design_hash"] == each_design.hash


def test_strict_counts_a_warning_as_failure(each_design):
    assert findings_json(report_of(), each_design)["summary"]["passes"] is True
    assert findings_json(report_of(), each_design, strict=True)["summary"]["passes"] is False


def test_places_are_added_when_asked_for(each_design):
    moved = dataclasses.replace(each_design, path="d.toml", lines={"clearance": 7})
    finding = findings_json(report_of(), moved, with_places=True)["checks"][0]["findings"][0]
    assert (finding["path"], finding["line"]) == ("d.toml", 7)
    assert line_of(moved, "sampling.seed") is None


@pytest.mark.parametrize("value", [float("nan"), float("inf"), np.array([0.0, np.nan]), object(), {"deep": [np.inf]}])
def test_what_is_no_json_value_is_refused_with_its_place(each_design, value):
    with pytest.raises(ValueError, match=r"c\.facts\.least"):
        findings_json(report_of(least=value), each_design)


def test_plain_turns_numpy_into_python():
    assert plain({"a": (np.int64(1), np.bool_(True))}, "x") == {"a": [1, True]}

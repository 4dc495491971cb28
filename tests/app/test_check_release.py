"""What `check` and `release` make of a report: words, JSON, exit codes. The solids themselves are tested elsewhere."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from linkwright.analysis.findings import CheckResult, Finding, Report, Severity
from linkwright.designs.language.errors import ReleaseError, VacuousCheckError

ERROR = Finding(
    rule="clearance",
    severity=Severity.ERROR,
    subject=("upper", "fore"),
    message="the [bars] touch",
    pose={"x_mm": 80.0, "y_mm": 70.0},
    measured=0.123456789,
    limit=0.5,
    unit="mm",
    location=(1.0, 2.0, 3.0),
    key="parameters.fore_mm",
    suggestion="make the fore bar shorter",
)
WARNING = Finding(rule="fit", severity=Severity.WARNING, subject=("base",), message="loose", key="clearance.minimum_mm")


def report_of(*findings):
    facts = {"minimum_mm": np.float64(0.25), "joints": [{"joint": "elbow", "measured_deg": 12.5}], "by_pair": {"a": 1}}
    return Report(
        results=(
            CheckResult(check="clearance", looked_at={"poses": 1000, "pairs": 406}, findings=findings, facts=facts),
            CheckResult(check="fits", looked_at={"joints": 3}),
        )
    )


@pytest.fixture
def house(monkeypatch):
    """Stands in for the upper storeys; collects what they were called with."""
    seen = SimpleNamespace(report=report_of(), designs=[], released={})

    def build_assembly(design, *, store, progress):
        seen.designs.append(design)
        return SimpleNamespace(design=design)

    def check_design(assembly, *, store, progress):
        progress(1, 2, "looking")
        if isinstance(seen.report, Exception):
            raise seen.report
        return seen.report

    def release(design, out, *, store, progress, strict):
        if isinstance(seen.report, Exception):
            raise seen.report
        seen.released = {"out": out, "strict": strict}
        written = seen.report.passes(strict=strict)
        paths = ["cad/assembly.step", "design.toml", *(f"mesh/part_{i}.stl" for i in range(9))]
        table = {
            "files": [SimpleNamespace(path=path) for path in paths],
            "mass_kg": 2.5,
            "parts": [SimpleNamespace(count=3, purchased=""), SimpleNamespace(count=4, purchased="688ZZ")],
        }
        manifest = SimpleNamespace(**table, model_dump=lambda mode: {"mass_kg": 2.5})
        return SimpleNamespace(path=out, report=seen.report, manifest=manifest if written else None, written=written)

    for name, words in {
        "analysis.feasibility": {"check_design": check_design},
        "exports.release": {"release": release},
        "generator.assembly": {"build_assembly": build_assembly},
        "generator.store": {"Store": lambda root: None},
    }.items():
        module = ModuleType(f"linkwright.{name}")
        module.__dict__.update(words)
        monkeypatch.setitem(sys.modules, module.__name__, module)
    return seen


@pytest.mark.parametrize(
    ("findings", "flags", "code"),
    [
        ((), [], 0),
        ((), ["--strict"], 0),
        ((WARNING,), [], 0),
        ((WARNING,), ["--strict"], 1),
        ((ERROR,), [], 1),
    ],
)
@pytest.mark.parametrize("words", [["check", "arm"], ["release", "arm", "-o", "out"]])
def test_exit_code_follows_the_findings(linkwright, house, words, findings, flags, code):
    house.report = report_of(*findings)
    for more in ([], ["--json"]):
        result = linkwright(*words, *flags, *more)
        assert result.exit_code == code, result.output
        assert result.stderr == ""


def test_check_tells_a_finding_with_its_numbers_pose_line_and_cure(linkwright, house, tmp_path):
    (tmp_path / "d.toml").write_text('mechanism = "arm"\n\n[parameters]\nfore_mm = 90\n')
    house.report = report_of(ERROR, WARNING)
    text = linkwright("check", "d.toml").stdout
    for words in (
        "error [clearance] upper / fore",
        "the [bars] touch",
        "measured 0.123457 mm, limit 0.5 mm",
        "x_mm = 80, y_mm = 70",
        "1, 2, 3 mm",
        "parameters.fore_mm (d.toml:4)",
        "make the fore bar shorter",
        "1000 poses, 406 pairs",
        "minimum_mm: 0.25",
        "elbow",
        "12.5",
        "FAIL",
        "1 error, 1 warning, 0 notes",
    ):
        assert words in text
    assert text.index("error [clearance]") < text.index("warning [fit]")


def test_joint_limits_are_told_in_degrees_beside_the_declared_ones(linkwright, house):
    row = {
        "lower": -1.0,
        "upper": 2.0,
        "declared_lower": -0.5,
        "declared_upper": 1.5,
        "unit": "rad",
        "unlimited": False,
        "stopped_below_by": "",
        "stopped_above_by": "base/lug - fore/eye",
    }
    slide = {**row, "unit": "mm", "unlimited": True}
    facts = {"limits": {"elbow": row, "slide": slide}, "azimuths": [float(i) for i in range(36)]}
    house.report = Report(results=(CheckResult(check="joint-limits", looked_at={"joints": 2}, facts=facts),))
    text = linkwright("check", "arm").stdout
    elbow, slide = (next(line for line in text.splitlines() if line.startswith(name)) for name in ("elbow", "slide"))
    assert elbow.split() == ["elbow", "-57.30", "-28.65", "85.94", "114.59", "deg", "base/lug", "-", "fore/eye"]
    assert slide.split() == ["slide", "-1.00", "-0.50", "1.50", "2.00", "mm", "nothing"]
    assert "azimuths: 36 numbers, 0 to 35" in text


def test_check_tells_that_a_design_passes(linkwright, house):
    assert "PASS  arm: 0 errors" in linkwright("check", "arm").stdout


def test_check_as_json_is_the_whole_report_with_places(linkwright, house, tmp_path):
    (tmp_path / "d.toml").write_text('mechanism = "arm"\n\n[parameters]\nfore_mm = 90\n')
    house.report = report_of(ERROR, WARNING)
    table = json.loads(linkwright("check", "d.toml", "--json").stdout)
    assert table["summary"] == {"passes": False, "strict": False, "n_errors": 1, "n_warnings": 1, "n_notes": 0}
    assert table["checks"][0]["looked_at"] == {"poses": 1000, "pairs": 406}
    assert table["checks"][0]["findings"][0]["line"] == 4
    assert table["checks"][0]["findings"][1]["line"] is None


def test_seed_and_poses_are_overrides_of_the_sampling(linkwright, house):
    linkwright("check", "arm", "--seed", "7", "--poses", "11", "--set", "sampling.n_poses=5")
    assert (house.designs[0].sampling.seed, house.designs[0].sampling.n_poses) == (7, 11)


@pytest.mark.parametrize("words", [["check", "arm"], ["release", "arm", "-o", "out"]])
@pytest.mark.parametrize("error", [VacuousCheckError("no pairs to look at"), ReleaseError("cannot be written")])
def test_an_error_of_the_upper_storeys_is_one_line_and_code_two(linkwright, house, words, error):
    house.report = error
    result = linkwright(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"error: {error}\n"
    assert json.loads(linkwright(*words, "--json").stdout)["error"]["message"] == str(error)


def test_release_shows_what_was_written_and_what_for(linkwright, house):
    text = linkwright("release", "arm", "-o", "out", "--strict").stdout
    assert house.released == {"out": Path("out"), "strict": True}
    for words in (
        "PASS",
        "assembly.step  the whole device",
        "9 files .stl",
        "manifest.json",
        "12 files",
        "3 parts to make",
        "4 to buy",
        "2.5 kg",
    ):
        assert words in text
    assert "part_3" not in text


def test_a_refused_release_says_that_nothing_was_written(linkwright, house):
    house.report = report_of(ERROR)
    assert "nothing was written to out" in linkwright("release", "arm", "-o", "out").stdout
    table = json.loads(linkwright("release", "arm", "-o", "out", "--json").stdout)
    assert (table["written"], table["manifest"]) == (False, None)
    assert table["findings"]["summary"]["n_errors"] == 1

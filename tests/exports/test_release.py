from __future__ import annotations

import hashlib
import json
import re
import shutil
from pathlib import Path

import pytest

from linkwright.analysis.findings import CheckResult, Finding, Report, Severity
from linkwright.designs.design import Outputs
from linkwright.designs.language.errors import ReleaseError
from linkwright.exports import release as door
from linkwright.exports.manifest import changed_files, read_manifest
from linkwright.exports.release import measured_limits, release
from linkwright.generator.store import Store

LIMITS = {"turn_1": {"lower": -1.25, "upper": 1.3}, "ball_2": {"lower": 0.0, "upper": 0.6}}


def report_of(*severities):
    findings = tuple(
        Finding(rule="clearance", severity=s, subject=("leg_1_arm", "base"), message="0.1 mm apart") for s in severities
    )
    limits = CheckResult(check="joint-limits", looked_at={"joints": 4}, facts={"limits": LIMITS})
    return Report(results=(limits, CheckResult(check="clearance", looked_at={"poses": 1}, findings=findings)))


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture(scope="session")
def store(tmp_path_factory):
    return Store(tmp_path_factory.mktemp("store"))


@pytest.fixture
def verdict(monkeypatch):
    """Replaces the checks, which have tests of their own, by a report of the given severities."""

    def given(*severities):
        monkeypatch.setattr(door, "check_design", lambda assembly, **_: report_of(*severities))

    given()
    return given


@pytest.fixture
def quick(masts):
    """A design that is written without a picture."""
    return masts.masts_design(outputs=Outputs(preview=False))


@pytest.fixture(scope="module")
def released(design, masts, store, tmp_path_factory):
    """One release with all files, for the tests that only look at it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(door, "check_design", lambda assembly, **_: report_of())
        return release(design, tmp_path_factory.mktemp("place") / "out", store=store, entry=masts.ENTRY)


def test_release_writes_every_file_and_nothing_else(released):
    files = sorted(p.relative_to(released.path).as_posix() for p in released.path.rglob("*") if p.is_file())
    parts = ["arm_bar", "arm_seat", "base_pin", "base_plate", "rod_ball_bar"]
    assert files == [
        "cad/assembly.step", *(f"cad/parts/{name}.step" for name in parts), "controller/kinematics.json", "design.toml",
        "findings.json", "manifest.json", *(f"mesh/{name}.stl" for name in parts), "preview.png",
    ]  # fmt: skip
    assert names_in(released.path.parent) == ["out"]
    assert released.written


def test_release_has_a_manifest_that_its_files_bear_out(released, tmp_path):
    manifest = read_manifest(released.path)
    assert manifest == released.manifest
    assert changed_files(manifest, released.path) == ()
    row = next(r for r in manifest.files if r.path == "cad/assembly.step")
    content = (released.path / "cad/assembly.step").read_bytes()
    assert (row.sha256, row.n_bytes) == (hashlib.sha256(content).hexdigest(), len(content))
    copy = shutil.copytree(released.path, tmp_path / "copy")
    (copy / "mesh/arm_bar.stl").write_bytes(b"x")
    (copy / "extra").write_bytes(b"x")
    (copy / "design.toml").unlink()
    assert changed_files(manifest, copy) == ("design.toml", "extra", "mesh/arm_bar.stl")


def test_release_weighs_its_bodies_and_lists_its_parts(released, assembly):
    manifest = released.manifest
    assert [b.name for b in manifest.bodies] == [b.body.name for b in assembly.bodies]
    assert manifest.mass_kg == pytest.approx(sum(b.mass for b in assembly.bodies), abs=1e-8)
    assert sum(p.count * p.mass_kg for p in manifest.parts) == pytest.approx(manifest.mass_kg, abs=1e-7)
    assert {(p.name, p.count, p.purchased) for p in manifest.parts} >= {("MR106ZZ", 2, "MR106ZZ"), ("arm_bar", 2, "")}
    assert {"linkwright", "cadquery", "numpy", "trimesh", "vtk", "python"} <= manifest.tools.keys()


def test_release_tells_the_controller_the_measured_limits(released):
    config = json.loads((released.path / "controller/kinematics.json").read_text())
    assert config["turn_1_measured_max_rad"] == 1.3
    assert config["ball_2_measured_max_rad"] == 0.6


def test_release_keeps_what_the_reading_back_measured(released):
    checks = {c["check"]: c for c in json.loads((released.path / "findings.json").read_text())["checks"]}
    assert {
        "step-reread",
        "part-step-reread",
        "stl-reread",
        "config-reread",
        "config-axes",
        "design-reread",
    } <= checks.keys()
    assert checks["config-axes"]["facts"]["largest_distance_mm"] < 1e-6


def test_release_holds_no_time_host_or_path(released):
    import datetime
    import socket

    content = b"".join(p.read_bytes() for p in released.path.rglob("*") if p.is_file() and p.suffix != ".png")
    text = content.decode("latin-1")
    assert str(released.path.parent) not in text
    assert str(Path.home()) + "/" not in text
    assert str(datetime.datetime.now().astimezone().year) not in re.sub(r"[0-9a-f]{64}", "", text.split("DATA;")[0])
    assert not re.search(r"\b20\d\d-\d\d-\d\d", text)
    if len(socket.gethostname()) > 4:
        assert socket.gethostname() not in text


def test_release_has_the_same_bytes_in_fresh_processes(in_fresh_process):
    # The picture has such a test of its own.
    script = """
import hashlib, pathlib, tempfile
from linkwright.analysis.findings import CheckResult, Report
from linkwright.designs.design import Outputs
from linkwright.exports import release as door
facts = {'limits': {'turn_1': {'lower': -1.25, 'upper': 1.3}}}
limits = CheckResult(check="joint-limits", looked_at={"joints": 1}, facts=facts)
door.check_design = lambda assembly, **_: Report(results=(limits,))
design = masts.masts_design(outputs=Outputs(preview=False))
with tempfile.TemporaryDirectory() as folder:
    result = door.release(design, pathlib.Path(folder) / 'out', entry=masts.ENTRY)
    print(hashlib.sha256((result.path / 'manifest.json').read_bytes()).hexdigest())
    for row in result.manifest.files:
        print(row.path, row.sha256)
"""
    first = in_fresh_process(script, 1)
    assert len(first.splitlines()) == 1 + 14
    assert in_fresh_process(script, 2) == first


def test_release_of_a_failing_design_writes_nothing(quick, masts, store, verdict, tmp_path):
    verdict(Severity.WARNING, Severity.ERROR)
    result = release(quick, tmp_path / "deep" / "out", store=store, entry=masts.ENTRY)
    assert not result.written
    assert result.manifest is None
    assert result.report.count(Severity.ERROR) == 1
    assert names_in(tmp_path) == []


def test_release_with_warnings_fails_only_when_strict(quick, masts, store, verdict, tmp_path):
    verdict(Severity.WARNING)
    assert not release(quick, tmp_path / "out", store=store, entry=masts.ENTRY, strict=True).written
    assert not (tmp_path / "out").exists()
    assert release(quick, tmp_path / "out", store=store, entry=masts.ENTRY).written


def test_release_of_a_failing_design_leaves_an_older_release(quick, masts, store, verdict, tmp_path):
    release(quick, tmp_path / "out", store=store, entry=masts.ENTRY)
    before = (tmp_path / "out" / "manifest.json").read_bytes()
    verdict(Severity.ERROR)
    assert not release(masts.masts_design(arm_length=70.0), tmp_path / "out", store=store, entry=masts.ENTRY).written
    assert (tmp_path / "out" / "manifest.json").read_bytes() == before
    assert names_in(tmp_path) == ["out"]


def test_release_replaces_an_older_release_and_drops_what_is_no_longer_asked_for(
    quick, masts, store, verdict, tmp_path
):
    release(quick, tmp_path / "out", store=store, entry=masts.ENTRY)
    bare = masts.masts_design(outputs=Outputs(step=False, stl=False, preview=False))
    release(bare, tmp_path / "out", store=store, entry=masts.ENTRY)
    assert names_in(tmp_path / "out") == ["controller", "design.toml", "findings.json", "manifest.json"]


def test_release_without_a_config_writes_none(masts, store, verdict, tmp_path):
    bare = masts.masts_design(outputs=Outputs(controller=False, stl=False, preview=False))
    result = release(bare, tmp_path / "out", store=store, entry=masts.ENTRY)
    assert names_in(tmp_path / "out") == ["cad", "design.toml", "findings.json", "manifest.json"]
    assert "config-axes" not in {r.check for r in result.report.results}


def test_release_refuses_a_folder_of_somebody_else_before_any_work(quick, masts, verdict, tmp_path, monkeypatch):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "manifest.json").write_text('{"format": "of somebody else"}')
    monkeypatch.setattr(door, "build_assembly", lambda *_, **__: pytest.fail("built although nothing can be written"))
    with pytest.raises(ReleaseError, match="nothing was touched"):
        release(quick, tmp_path / "out", entry=masts.ENTRY)
    assert names_in(tmp_path / "out") == ["manifest.json"]


def test_release_into_a_place_that_cannot_be_written_fails_before_any_work(
    quick, masts, verdict, tmp_path, monkeypatch
):
    (tmp_path / "file").write_text("x")
    monkeypatch.setattr(door, "build_assembly", lambda *_, **__: pytest.fail("built although nothing can be written"))
    with pytest.raises(ReleaseError, match="cannot be written"):
        release(quick, tmp_path / "file" / "out", entry=masts.ENTRY)
    assert names_in(tmp_path) == ["file"]


@pytest.mark.parametrize(
    ("writer", "spoil", "words"),
    [
        ("write_stl", lambda path: path.write_bytes(path.read_bytes()[:-50]), "stl-reread"),
        ("write_part_step", lambda path: path.write_text("ISO-10303-21;"), "cannot read it back"),
        ("write_assembly_step", lambda path: path.write_text(path.read_text().replace("'seat'", "'x'")), "step-reread"),
        (
            "write_controller_config",
            lambda path: path.write_text(path.read_text().replace("0.0613", "0.0614")),
            "config-axes",
        ),
    ],
)
def test_release_whose_bytes_are_spoiled_is_not_put_in_place(
    quick, masts, store, verdict, tmp_path, monkeypatch, writer, spoil, words
):
    write = getattr(door, writer)

    def spoiled(*args):
        write(*args)
        spoil(next(a for a in args if isinstance(a, Path)))

    monkeypatch.setattr(door, writer, spoiled)
    with pytest.raises(ReleaseError, match=words):
        release(quick, tmp_path / "out", store=store, entry=masts.ENTRY)
    assert names_in(tmp_path) == []


def test_release_meshes_anew_when_the_checks_meshes_are_too_coarse(masts, store, verdict, tmp_path):
    coarse = masts.masts_design(outputs=Outputs(step=False, controller=False, preview=False, mesh_deviation=0.05))
    fine = masts.masts_design(outputs=Outputs(step=False, controller=False, preview=False, mesh_deviation=0.004))
    sizes = [
        (release(design, tmp_path / name, store=store, entry=masts.ENTRY).path / "mesh/arm_seat.stl").stat().st_size
        for name, design in (("coarse", coarse), ("fine", fine))
    ]
    assert sizes[1] > 1.5 * sizes[0]


def test_release_tells_its_progress(quick, masts, store, verdict, tmp_path):
    told = []
    release(quick, tmp_path / "out", store=store, entry=masts.ENTRY, progress=lambda *step: told.append(step))
    assert [what for _, _, what in told if what.startswith("write ")] == [
        "write design.toml", "write controller/kinematics.json", "write cad", "write mesh",
    ]  # fmt: skip


def test_measured_limits_are_those_of_the_report():
    assert measured_limits(report_of()) == {"turn_1": (-1.25, 1.3), "ball_2": (0.0, 0.6)}
    assert measured_limits(Report(results=())) == {}

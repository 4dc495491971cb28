"""The HIT device end to end on its real solids: released once, then asked everything that a maker would ask."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

from linkwright.analysis.clearance import check_clearance
from linkwright.analysis.feasibility import declared_poses
from linkwright.designs.file.reader import load_design
from linkwright.designs.language.joints import JointKind
from linkwright.designs.language.poses import invert_pose
from linkwright.exports.controller import mechanism_from_config
from linkwright.exports.release import release
from linkwright.exports.reread import recover_axes
from linkwright.generator.assembly import build_assembly
from linkwright.generator.store import Store


@pytest.fixture(scope="module")
def released(tmp_path_factory):
    """A release from an empty part cache."""
    folder = tmp_path_factory.mktemp("hit")
    store = Store(folder / "cache" / "solids")
    design = load_design("hit")
    result = release(design, folder / "out", store=store)
    return SimpleNamespace(design=design, result=result, folder=folder / "out", store=store, root=folder)


def _result(released, check):
    return next(r for r in released.result.report.results if r.check == check)


def test_it_passes_every_check_and_looked_at_what_it_says(released):
    assert released.result.written
    assert [f.message for f in released.result.report.findings] == []
    clearance = _result(released, "clearance")
    assert clearance.looked_at["poses"] == 1001
    assert clearance.looked_at["pairs"] == 29 * 28 // 2
    assert released.design.allowed == ()


def test_its_bodies_keep_the_asked_clearance_over_the_declared_workspace(released):
    facts = _result(released, "clearance").facts
    assert facts["minimum_clearance_mm"] >= released.design.clearance.minimum
    assert len(facts["minimum_clearance_pair"]) == 2


def test_a_minimum_clearance_above_the_measured_one_is_found(released):
    """The check can fail: asking for more than there is names the pair that has least."""
    design = load_design("hit", ["clearance.minimum_mm=0.9", "sampling.n_poses=10"])
    assembly = build_assembly(design, store=released.store)
    result = check_clearance(assembly, declared_poses(assembly))
    nearest = set(_result(released, "clearance").facts["minimum_clearance_pair"])
    assert any(set(f.subject) == nearest for f in result.findings if f.rule == "clearance")


def test_its_declared_limits_lie_within_the_measured_ones(released):
    limits = _result(released, "joint-limits").facts["limits"]
    joints = released.design.mechanism.joints
    assert set(limits) == {j.name for j in joints}
    for joint in joints:
        assert limits[joint.name]["lower"] <= joint.lower + 1e-9
        assert limits[joint.name]["upper"] >= joint.upper - 1e-9


def test_its_cones_measure_what_the_formula_says(released):
    cones = _result(released, "joint-limits").facts["cones"]
    formula = math.degrees(released.design.mechanism.derived_numbers()["cone_half_angle"][0])
    assert len(cones) == 3
    for cone in cones.values():
        assert len(cone["azimuths"]) == 24
        assert np.abs(np.array(cone["tilts"]) - formula).max() <= 0.05


def test_axes_recovered_from_the_step_meet_at_100_poses(released, rng):
    """Faces of the re-read STEP, taken into their bodies at home and moved by body poses, meet their partners."""
    mechanism = released.design.mechanism
    bodies = recover_axes(released.folder / "cad" / "assembly.step")
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    back = invert_pose(mechanism.place_bodies(mechanism.home[None])[0])
    lower, upper = released.design.box()
    Ts = mechanism.place_bodies(rng.uniform(lower, upper, (100, 6)))
    worst = 0.0
    for joint in mechanism.joints:
        lines = [_recovered(bodies, mechanism, back, index, joint, end) for end in ("parent", "child")]
        (p_a, d_a), (p_b, d_b) = lines
        T_a, T_b = Ts[:, index[joint.parent]], Ts[:, index[joint.child]]
        at_a, at_b = (T[:, :3, :3] @ p + T[:, :3, 3] for T, p in ((T_a, p_a), (T_b, p_b)))
        apart = at_b - at_a
        if joint.kind is JointKind.REVOLUTE:
            along_a, along_b = T_a[:, :3, :3] @ d_a, T_b[:, :3, :3] @ d_b
            assert np.abs(np.cross(along_a, along_b)).max() < 1e-9, joint.name
            apart = apart - np.sum(apart * along_a, -1)[:, None] * along_a
        worst = max(worst, float(np.linalg.norm(apart, axis=-1).max()))
    assert worst <= 1e-6


def _recovered(bodies, mechanism, back, index, joint, end):
    """A round face of the body that lies where the joint claims, in the body's frame: a point, and an axis or None."""
    name = getattr(joint, end)
    T = back[index[name]]
    claimed, axis = np.array(getattr(joint, f"p_{end}")), np.array(getattr(joint, f"axis_{end}"))
    if joint.kind is JointKind.SPHERICAL:
        centres = [T[:3, :3] @ np.array(s.centre) + T[:3, 3] for s in bodies[name].spheres]
        return min(centres, key=lambda c: np.linalg.norm(c - claimed)), None
    best = None
    for cylinder in bodies[name].cylinders:
        point, along = T[:3, :3] @ np.array(cylinder.point) + T[:3, 3], T[:3, :3] @ np.array(cylinder.direction)
        if np.linalg.norm(np.cross(along, axis)) < 1e-6:
            foot = claimed - point
            off = np.linalg.norm(foot - foot @ along * along)
            if best is None or off < best[0]:
                best = off, point, along
    assert best is not None, f"{joint.name}: no cylinder of {name} is parallel to its axis"
    return best[1], best[2]


def test_its_config_solves_like_the_design(released, rng):
    rebuilt = mechanism_from_config(released.folder / "controller" / "kinematics.json")
    lower, upper = released.design.box()
    poses = rng.uniform(lower, upper, (50, 6))
    want = released.design.mechanism.solve_inverse(poses).joints
    assert np.abs(rebuilt.solve_inverse(poses).joints - want).max() < 1e-12


def test_a_second_release_of_the_same_design_has_the_same_bytes(released):
    again = release(load_design("hit"), released.root / "again", store=released.store)
    assert again.written
    first, second = (
        {p.relative_to(f): p.read_bytes() for p in sorted(f.rglob("*")) if p.is_file()}
        for f in (released.folder, released.root / "again")
    )
    assert list(first) == list(second)
    assert [str(name) for name in first if first[name] != second[name]] == []


def test_a_base_radius_of_70_makes_neighbouring_legs_collide_and_writes_nothing(released):
    """The reference's known-bad design: elbows of neighbouring sub-chains meet low in the workspace."""
    design = load_design(
        "hit", ["parameters.base_radius_mm=70", "parameters.platform_radius_mm=70", "sampling.n_poses=60"]
    )
    result = release(design, released.root / "bad", store=released.store)
    assert not result.written
    assert not (released.root / "bad").exists()
    found = [f for f in result.report.findings if f.rule == "interference"]
    assert found
    assert any(f.subject[0][:5] != f.subject[1][:5] and f.measured > 0.0 for f in found)


def test_its_findings_and_manifest_are_readable_by_machines(released):
    findings = json.loads((released.folder / "findings.json").read_text())
    manifest = json.loads((released.folder / "manifest.json").read_text())
    assert findings["summary"]["passes"] and findings["summary"]["n_errors"] == 0
    assert len(findings["checks"]) == len(released.result.report.results)
    assert manifest["design_hash"] == released.design.hash
    on_disk = {p.relative_to(released.folder).as_posix() for p in released.folder.rglob("*") if p.is_file()}
    assert {row["path"] for row in manifest["files"]} == on_disk - {"manifest.json"}


def _self_intersections(path):
    """Faces of a mesh file that cut through others, by a library that had no part in making it."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    meshes.compute_selection_by_self_intersections_per_face()
    return meshes.current_mesh().selected_face_number()


def test_no_mesh_cuts_through_itself(released, tmp_path):
    """What neither closedness nor winding shows: two closed shells in one file may overlap."""
    import trimesh

    files = sorted((released.folder / "mesh").glob("*.stl"))
    assert len(files) > 30
    assert [path.name for path in files if _self_intersections(path)] == []
    one, other = trimesh.creation.box((10, 10, 10)), trimesh.creation.box((10, 10, 10))
    bad = trimesh.util.concatenate([one, other.apply_translation((4.0, 3.0, 2.0))])
    bad.export(tmp_path / "bad.stl")
    assert _self_intersections(tmp_path / "bad.stl") > 0

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from linkwright.analysis.findings import Severity
from linkwright.analysis.joint_limits import measure_joint_limits
from linkwright.analysis.mating import body_triangles, mating_faces, steady_faces
from linkwright.designs.language.bodies import Part, Placement
from linkwright.designs.language.errors import KinematicsError, VacuousCheckError
from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.designs.language.joints import JointKind
from linkwright.generator.store import Store
from linkwright.generator.surfaces import SurfaceKind

DEG = math.pi / 180.0


def post(x: float, y: float, radius: float, low: float, high: float, name: str = "post") -> Part:
    profile = (Vertex(r=0.0, z=low), Vertex(r=radius, z=low), Vertex(r=radius, z=high), Vertex(r=0.0, z=high))
    return Part(name=name, feature=Turned(profile=profile), at=Placement(origin=(x, y, 0.0)), material="steel_c45")


def pin(radius: float = 3.0, runs: bool = True) -> Part:
    part = post(0.0, 0.0, radius, -8.0, 8.0, "pin")
    return Part(name="pin", feature=part.feature, material="steel_c45", runs_in_joint=runs)


def arm(length: float = 40.0, half_width: float = 4.0, bore: float = 6.2) -> Part:
    """A bar along x whose eye runs on the pin; its outline ends round, its edges are straight."""
    slab = Slab(circles=((0.0, 0.0, 5.0), (length, 0.0, half_width)), low=-3.0, high=3.0)
    feature = Milled(
        slabs=(slab, Slab(circles=((0.0, 0.0, 6.0),), low=-3.0, high=3.0)), holes=(Hole(top=3.0, diameter=bore),)
    )
    return Part(name="bar", feature=feature, material="aluminium_6082", runs_in_joint=True)


def straight_arm(length: float, half_width: float) -> Part:
    slab = Slab(circles=((0.0, 0.0, half_width), (length, 0.0, half_width)), low=-3.0, high=3.0)
    return Part(
        name="bar",
        feature=Milled(slabs=(slab,), holes=(Hole(top=3.0, diameter=6.2),)),
        material="aluminium_6082",
        runs_in_joint=True,
    )


def hinge_with_stops(assemble, angles: tuple[float, ...], lower: float, upper: float, home: float = 0.0):
    """Posts of radius 2 at distance 30: a bar of half width 5 meets them where sin(beta) = (5 + 2) / 30."""
    posts = tuple(
        post(30.0 * math.cos(a), 30.0 * math.sin(a), 2.0, -5.0, 5.0, f"post_{i}") for i, a in enumerate(angles)
    )
    return assemble(JointKind.REVOLUTE, (pin(), *posts), (straight_arm(60.0, 5.0),), lower, upper, home)


def test_a_hinge_stops_where_the_closed_form_says(assemble):
    assembly = hinge_with_stops(assemble, (100.0 * DEG, -70.0 * DEG), -50.0 * DEG, 80.0 * DEG, home=10.0 * DEG)
    result = measure_joint_limits(assembly)
    limits, beta = result.facts["limits"]["hinge_0"], math.asin(7.0 / 30.0)
    assert limits["upper"] == pytest.approx(100.0 * DEG - beta, abs=0.01 * DEG)
    assert limits["lower"] == pytest.approx(-70.0 * DEG + beta, abs=0.01 * DEG)
    assert not limits["unlimited"]
    assert limits["stopped_above_by"] == "base/post_0 - arm/bar"
    assert limits["stopped_below_by"] == "base/post_1 - arm/bar"
    assert result.findings == ()


def test_a_declared_limit_beyond_the_stop_is_a_finding_and_one_before_it_is_none(assemble):
    beta = math.asin(7.0 / 30.0)
    true_upper = 100.0 * DEG - beta
    for excess, n_findings in ((0.02 * DEG, 1), (-0.02 * DEG, 0)):
        assembly = hinge_with_stops(assemble, (100.0 * DEG, -70.0 * DEG), 0.0, true_upper + excess)
        result = measure_joint_limits(assembly)
        assert len(result.findings) == n_findings
    finding = measure_joint_limits(hinge_with_stops(assemble, (100.0 * DEG,), 0.0, 120.0 * DEG)).findings[0]
    assert finding.rule == "joint-limit" and finding.severity is Severity.ERROR
    assert finding.limit == pytest.approx(120.0) and finding.unit == "deg"
    assert finding.measured == pytest.approx(true_upper / DEG, abs=0.01)
    assert finding.location is not None and math.hypot(*finding.location[:2]) == pytest.approx(30.0, abs=2.1)


def test_a_hinge_that_meets_nothing_is_unlimited(assemble):
    result = measure_joint_limits(hinge_with_stops(assemble, (), -math.pi, math.pi))
    limits = result.facts["limits"]["hinge_0"]
    assert limits["unlimited"] and limits["upper"] == pytest.approx(math.pi) and result.findings == ()


def test_bodies_that_overlap_at_home_have_no_travel(assemble):
    assembly = hinge_with_stops(assemble, (0.0,), -10.0 * DEG, 10.0 * DEG)
    result = measure_joint_limits(assembly)
    limits = result.facts["limits"]["hinge_0"]
    assert (limits["lower"], limits["upper"]) == (0.0, 0.0) and len(result.findings) == 2


def test_a_slide_stops_at_the_end_of_its_groove(assemble):
    frame = (post(20.0, 0.0, 3.0, 15.0, 16.0, "top"), post(20.0, 0.0, 3.0, -31.0, -30.0, "bottom"))
    rod = (post(20.0, 0.0, 3.0, -4.0, 4.0, "rod"),)
    result = measure_joint_limits(assemble(JointKind.PRISMATIC, frame, rod, -25.0, 12.0, home=2.0))
    limits = result.facts["limits"]["hinge_0"]
    assert limits["upper"] == pytest.approx(11.0, abs=0.005) and limits["lower"] == pytest.approx(-26.0, abs=0.005)
    assert limits["unit"] == "mm"


def test_a_ball_joint_leans_until_a_wall_on_one_side_and_further_on_the_others(assemble):
    """A rod along z and a wall at x = 20: the rod's upper rim meets it when leaning towards +x, and not towards -x."""
    rod = Part(
        name="rod",
        feature=Turned(
            profile=(Vertex(r=0.0, z=5.0), Vertex(r=2.0, z=5.0), Vertex(r=2.0, z=40.0), Vertex(r=0.0, z=40.0))
        ),
        material="steel_c45",
    )
    wall = Part(
        name="wall",
        feature=Milled(slabs=(Slab(circles=((0.0, 20.0, 1.0), (0.0, -20.0, 1.0)), low=0.0, high=60.0),)),
        at=Placement(origin=(21.0, 0.0, 0.0)),
        material="steel_c45",
    )
    assembly = assemble(JointKind.SPHERICAL, (wall,), (rod,), 0.0, 40.0 * DEG, home=5.0 * DEG)
    result = measure_joint_limits(assembly, n_azimuths=8)
    cone = result.facts["cones"]["hinge_0"]
    # The rod's upper rim, at distance 40 and 2 beside the axis, meets the plane x = 20.
    expected = math.degrees(math.asin(20.0 / math.hypot(40.0, 2.0)) - math.atan2(2.0, 40.0))
    assert min(cone["tilts"]) == pytest.approx(expected, abs=0.01)
    assert cone["azimuths"][int(np.argmin(cone["tilts"]))] == pytest.approx(0.0)
    assert cone["tilts"][4] > expected + 90.0
    assert result.facts["limits"]["hinge_0"]["upper"] == pytest.approx(math.radians(expected), abs=0.01 * DEG)
    assert [f.rule for f in result.findings] == ["joint-limit"]


def test_a_formula_that_claims_more_than_the_solids_allow_is_a_warning(assemble):
    rod, wall = post(0.0, 0.0, 2.0, 5.0, 40.0, "rod"), post(30.0, 0.0, 3.0, 0.0, 60.0, "wall")
    assembly = assemble(JointKind.SPHERICAL, (wall,), (rod,), 0.0, 10.0 * DEG)
    measured = min(measure_joint_limits(assembly, n_azimuths=1).facts["cones"]["hinge_0"]["tilts"])
    for claim, rules in ((measured + 0.06, ["cone-formula"]), (measured + 0.04, [])):
        assembly.design.mechanism.derived_numbers = lambda c=claim: {"cone_half_angle": (c * DEG, "deg", "claim")}
        result = measure_joint_limits(assembly, n_azimuths=1)
        assert [f.rule for f in result.findings] == rules
        assert result.facts["cones"]["hinge_0"]["formula"] == pytest.approx(claim)


def test_no_joints_is_a_vacuous_check(assemble):
    with pytest.raises(VacuousCheckError):
        measure_joint_limits(assemble(JointKind.REVOLUTE, (pin(),), (arm(),), 0.0, 1.0, n_joints=0))


def test_a_mechanism_whose_bodies_miss_their_joint_is_refused(assemble):
    assembly = hinge_with_stops(assemble, (), 0.0, 1.0)
    mechanism = assembly.design.mechanism
    place = mechanism.place_bodies

    def misplace(poses):
        Ts = place(poses)
        Ts[:, 1, 0, 3] += 0.01
        return Ts

    mechanism.place_bodies = misplace
    with pytest.raises(KinematicsError, match=r"misses base by 0\.01 mm"):
        measure_joint_limits(assembly)


def test_equal_joints_are_measured_once_and_remembered_on_disk(assemble, tmp_path, monkeypatch):
    calls = []

    from linkwright.analysis import joint_limits as joint_limits_module
    from linkwright.analysis.joint_travel import measure_joint

    monkeypatch.setattr(
        joint_limits_module, "measure_joint", lambda *args: (calls.append(args), measure_joint(*args))[1]
    )
    store = Store(tmp_path)
    posts = (post(0.0, 30.0, 2.0, -5.0, 5.0),)
    assembly = assemble(JointKind.REVOLUTE, (pin(), *posts), (straight_arm(60.0, 5.0),), 0.0, 1.0, n_joints=2)
    first = measure_joint_limits(assembly, store=store)
    assert first.looked_at == {"joints": 2, "distinct": 1, "azimuths": 0}
    assert len(calls) == 1
    again = measure_joint_limits(assembly, store=store)
    assert len(calls) == 1
    assert again == first
    entry = next((tmp_path / "measured").rglob("*.json"))
    entry.write_text(entry.read_text().replace("true", "false", 1))
    damaged = measure_joint_limits(assembly, store=store)
    assert len(calls) == 2
    assert damaged == first


def test_a_store_that_cannot_be_written_costs_a_warning_only(assemble, tmp_path):
    (tmp_path / "measured").write_text("in the way")
    assembly = hinge_with_stops(assemble, (), 0.0, 1.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = measure_joint_limits(assembly, store=Store(tmp_path))
    assert result.looked_at["joints"] == 1 and any("not kept" in str(w.message) for w in caught)


def test_mating_faces_are_those_of_revolution_about_the_axis_on_running_parts_only(assemble):
    assembly = hinge_with_stops(assemble, (90.0 * DEG,), 0.0, 1.0)
    base, joint = assembly.body("base"), assembly.design.mechanism.joints[0]
    flags = mating_faces(base, joint, as_parent=True)
    n_pin = len(base.parts[0].solid.surfaces)
    assert flags.dtype == np.uint8 and flags[:n_pin].all() and not flags[n_pin:].any()
    child = assembly.body("arm")
    kinds = [s.kind for s in child.parts[0].solid.surfaces]
    bits = mating_faces(child, joint, as_parent=False)
    # Bore and round end about the pin, and both flat sides; not the far end, nor the straight edges.
    assert sum(bits) == 4
    assert {k for k, b in zip(kinds, bits, strict=True) if b} == {SurfaceKind.PLANE, SurfaceKind.CYLINDER}
    idle = assemble(JointKind.REVOLUTE, (pin(runs=False),), (arm(),), 0.0, 1.0)
    assert not mating_faces(idle.body("base"), joint, as_parent=True).any()
    assert steady_faces(idle.body("base"), joint, as_parent=True).all()


def test_body_triangles_are_those_of_all_parts_in_the_body_frame(assemble):
    assembly = hinge_with_stops(assemble, (90.0 * DEG,), 0.0, 1.0)
    corners, groups, parts = body_triangles(assembly.body("base"))
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    for i, assembled in enumerate(assembly.body("base").parts):
        assert volumes[parts == i].sum() == pytest.approx(assembled.solid.volume, rel=0.02)
    assert corners[parts == 1].reshape(-1, 3).mean(axis=0)[1] == pytest.approx(30.0, abs=0.5)
    assert groups.max() + 1 == sum(len(a.solid.surfaces) for a in assembly.body("base").parts)
    assert np.all(groups[parts == 1] >= len(assembly.body("base").parts[0].solid.surfaces))

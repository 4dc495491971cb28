"""Interference and clearance of bodies over poses, each rule on a design that breaks it and on one that does not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.analysis.clearance import check_clearance
from linkwright.designs.design import Allowed, Clearance, Design, Workspace
from linkwright.designs.language.bodies import Body, Part, Placement
from linkwright.designs.language.errors import UnknownNameError, VacuousCheckError
from linkwright.designs.language.features import Milled, Slab, Turned, Vertex
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.mechanism import Coordinate, InverseSolution, Mechanism
from linkwright.designs.language.poses import turn_about
from linkwright.generator.assembly import build_assembly

STEEL = "steel_c45"


class Slide(Mechanism):
    """A base, and bodies that slide along x (mm) and turn about z (deg) together; reach ends at x = 100."""

    name, title, source, sections = "slide", "a slide", "", {}
    task = (Coordinate(name="x", unit="mm"), Coordinate(name="rz", unit="deg"))
    home = np.zeros(2)
    branches, assembly_mode = ("only",), "only"

    def __init__(self, *bodies, joints=()):
        self.bodies, self.joints = bodies, tuple(joints)

    def solve_inverse(self, poses, branch=None):
        margins = 100.0 - poses[:, :1]
        return InverseSolution(
            joints=np.zeros((len(poses), 0)),
            margins=margins,
            requirements=("rail end",),
            is_reachable=(margins >= 0.0).all(axis=1),
        )

    def place_bodies(self, poses):
        Ts = np.tile(np.eye(4), (len(poses), len(self.bodies), 1, 1))
        Ts[:, 1:] = turn_about(np.zeros(3), np.array([0.0, 0.0, 1.0]), poses[:, 1])[:, None]
        Ts[:, 1:, 0, 3] += poses[:, :1]
        return Ts

    def solve_forward(self, active, near=None):
        raise NotImplementedError

    def compute_jacobian(self, poses):
        raise NotImplementedError

    def derived_numbers(self):
        return {}

    def controller_parameters(self):
        return {}


def _block(x, y, z):
    """A block of about x by y by z [mm] whose corners are rounded by 0.01, its middle at the origin."""
    r = 0.01
    corners = tuple((sx * (x / 2 - r), sy * (y / 2 - r), r) for sx in (-1, 1) for sy in (-1, 1))
    return Milled(slabs=(Slab(circles=corners, low=-z / 2, high=z / 2),))


def _tube(inner, outer, height):
    low, high = -height / 2, height / 2
    corners = ((inner, low), (outer, low), (outer, high), (inner, high))
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners))


def _body(name, *features, runs=False, at=(0.0, 0.0, 0.0)):
    parts = tuple(
        Part(name=f"part_{k}", feature=f, material=STEEL, runs_in_joint=runs, at=Placement(origin=at))
        for k, f in enumerate(features)
    )
    return Body(name=name, kind=name, group="", parts=parts)


def _check(mechanism, poses, **changes):
    design = Design(
        name="slide",
        mechanism=mechanism,
        workspace=Workspace(lower=(0.0, 0.0), upper=(1.0, 1.0)),
        **{"clearance": Clearance(minimum=0.5), **changes},
    )
    return check_clearance(build_assembly(design), np.asarray(poses, dtype=float))


def test_two_overlapping_bars_are_found_with_the_volume_that_they_share():
    result = _check(
        Slide(_body("base", _block(60, 10, 10)), _body("slide", _block(60, 10, 10))),
        [[90.0, 0.0], [55.0, 0.0], [40.0, 0.0], [70.0, 0.0]],
    )
    (finding,) = result.findings
    assert finding.rule == "interference"
    assert finding.severity == "error"
    assert finding.subject == ("base", "slide")
    # They share 20 x 10 x 10 mm at x = 40, but for eight roundings of 0.01.
    assert finding.measured == pytest.approx(2000.0, abs=0.01)
    assert finding.pose == {"x_mm": 40.0, "rz_deg": 0.0}
    assert finding.location == pytest.approx((20.0, 0.0, 0.0), abs=1e-6)
    assert "2 of 4 poses" in finding.message
    assert result.looked_at == {"poses": 4, "pairs": 1, "bodies": 2}


def test_a_body_inside_another_collides_though_no_surfaces_meet():
    mechanism = Slide(_body("base", _block(60, 40, 40)), _body("slide", _block(10, 10, 10)))
    result = _check(mechanism, [[80.0, 0.0], [0.0, 0.3]])
    (finding,) = result.findings
    assert finding.rule == "interference"
    assert finding.measured == pytest.approx(1000.0, abs=0.01)
    assert "wholly" in finding.message
    assert result.facts["minimum_clearance_mm"] == 0.0


def test_a_body_in_the_bore_of_another_is_free():
    mechanism = Slide(_body("base", _tube(20, 30, 40)), _body("slide", _block(10, 10, 10)))
    result = _check(mechanism, [[0.0, 0.0], [0.0, 0.5]])
    assert result.findings == ()
    assert result.facts["minimum_clearance_mm"] == pytest.approx(20.0 - 5.0 * math.sqrt(2.0), abs=0.1)


def test_a_gap_below_the_minimum_is_found_and_one_above_it_is_not():
    mechanism = Slide(_body("base", _block(60, 10, 10)), _body("slide", _block(60, 10, 10)))
    poses = [[90.0, 0.0], [60.3, 0.0], [75.0, 0.0]]
    result = _check(mechanism, poses)
    (finding,) = result.findings
    allowance = result.facts["mesh_allowance_mm"]
    assert allowance == pytest.approx(2 * Clearance().mesh_deviation)
    assert finding.rule == "clearance"
    assert finding.measured == pytest.approx(0.3 - allowance, abs=1e-6)
    assert finding.limit == 0.5
    assert finding.pose["x_mm"] == 60.3
    assert finding.location[0] == pytest.approx(30.15, abs=1e-6)
    assert finding.key == "clearance.minimum_mm"
    assert "1 of 3 poses" in finding.message
    assert _check(mechanism, poses, clearance=Clearance(minimum=0.3 - allowance - 1e-6)).findings == ()


def test_facts_name_the_nearest_pairs_first_in_the_base_frame():
    bodies = [
        _body("base", _block(10, 10, 10)),
        _body("near", _block(10, 10, 10), at=(13.0, 0.0, 0.0)),
        _body("far", _block(10, 10, 10), at=(0.0, 40.0, 0.0)),
    ]
    facts = _check(Slide(*bodies), [[5.0, 0.0], [0.0, 0.0], [9.0, 0.0]]).facts
    assert facts["minimum_clearance_pair"] == ["base", "near"]
    assert facts["minimum_clearance_mm"] == pytest.approx(3.0 - facts["mesh_allowance_mm"], rel=2e-3)
    assert facts["minimum_clearance_pose"] == {"x_mm": 0.0, "rz_deg": 0.0}
    assert facts["minimum_clearance_location_mm"][0] == pytest.approx(6.5, abs=0.01)
    clearances = [row["clearance_mm"] for row in facts["nearest"]]
    assert clearances == sorted(clearances)
    assert len(clearances) == 3


def _hinge(gap, runs=True, extra=()):
    """A pin in a bushing, turning about z; `extra` parts ride on the pin."""
    pin = Turned(profile=(Vertex(r=0, z=-30), Vertex(r=5, z=-30), Vertex(r=5, z=30), Vertex(r=0, z=30)))
    child = _body("slide", pin, runs=runs)
    parts = child.parts + tuple(
        Part(name=f"extra_{k}", feature=f, material=STEEL, at=Placement(origin=at)) for k, (f, at) in enumerate(extra)
    )
    joint = Joint(
        name="hinge",
        kind=JointKind.REVOLUTE,
        parent="base",
        child="slide",
        p_parent=(0, 0, 0),
        axis_parent=(0, 0, 1),
        p_child=(0, 0, 0),
        axis_child=(0, 0, 1),
        lower=-3.0,
        upper=3.0,
    )
    base = _body("base", _tube(5.0 + gap, 12.0, 40.0), runs=runs)
    return Slide(base, Body(name="slide", kind="slide", group="", parts=parts), joints=(joint,))


TURNS = [[0.0, a] for a in (-2.0, 0.0, 1.0)]


def test_a_pin_near_its_bore_is_exempt_only_if_it_runs_in_the_joint():
    block = (_block(4, 4, 4), (0.0, 9.0, 25.0))
    assert _check(_hinge(0.05, extra=[block]), TURNS).findings == ()
    (finding,) = _check(_hinge(0.05, runs=False, extra=[block]), TURNS).findings
    assert finding.rule == "clearance"


def test_what_rides_on_the_pin_is_not_exempt():
    (finding,) = _check(_hinge(0.05, extra=[(_block(4, 4, 4), (0.0, 9.0, 22.2))]), TURNS).findings
    assert finding.rule == "clearance"
    assert finding.measured == pytest.approx(0.2 - 0.04, abs=1e-6)
    (finding,) = _check(_hinge(0.05, extra=[(_block(4, 4, 4), (0.0, 9.0, 21.0))]), TURNS).findings
    assert finding.rule == "interference"
    assert finding.measured == pytest.approx(4.0 * 4.0 * 1.0, abs=0.01)


def test_a_declared_contact_is_left_out_and_reported_with_its_reason():
    bodies = [_body(n, _block(10, 10, 10)) for n in ("base", "one", "two")]
    allowed = (Allowed(pair=("one", "base"), reason="rests on it"), Allowed(pair=("one", "two"), reason="glued"))
    result = _check(Slide(*bodies), [[50.0, 0.0]], allowed=allowed)
    assert result.findings == ()
    assert result.looked_at["pairs"] == 1
    assert {"pair": ["one", "base"], "reason": "rests on it"} in result.facts["allowed"]
    with pytest.raises(UnknownNameError, match="three"):
        _check(Slide(*bodies), [[50.0, 0.0]], allowed=(Allowed(pair=("one", "three"), reason="typo"),))


def test_poses_out_of_reach_are_one_finding_and_are_not_placed():
    mechanism = Slide(_body("base", _block(10, 10, 10)), _body("slide", _block(10, 10, 10)))
    result = _check(mechanism, [[50.0, 0.0], [130.0, 0.0], [140.0, 0.0]])
    (finding,) = result.findings
    assert finding.rule == "unreachable"
    assert finding.subject == ("rail end",)
    assert finding.measured == -40.0
    assert finding.pose["x_mm"] == 140.0
    assert result.looked_at["poses"] == 1
    assert result.facts["unreachable_poses"] == 2


def test_a_check_that_looks_at_nothing_is_refused():
    two = Slide(_body("base", _block(10, 10, 10)), _body("slide", _block(10, 10, 10)))
    with pytest.raises(VacuousCheckError, match="no poses"):
        _check(two, np.zeros((0, 2)))
    with pytest.raises(VacuousCheckError, match="none of 1 poses"):
        _check(two, [[200.0, 0.0]])
    with pytest.raises(VacuousCheckError, match="no pairs"):
        _check(Slide(_body("base", _block(10, 10, 10))), [[0.0, 0.0]])
    with pytest.raises(VacuousCheckError, match="no pairs"):
        _check(two, [[50.0, 0.0]], allowed=(Allowed(pair=("base", "slide"), reason="all"),))
    with pytest.raises(VacuousCheckError, match="exempt"):
        _check(_hinge(0.05), TURNS)


def test_progress_is_told_of_every_pair():
    bodies = [_body(n, _block(10, 10, 10)) for n in ("base", "one", "two")]
    design = Design(name="slide", mechanism=Slide(*bodies), workspace=Workspace(lower=(0.0, 0.0), upper=(1.0, 1.0)))
    told = []
    check_clearance(build_assembly(design), np.array([[50.0, 0.0]]), progress=lambda *args: told.append(args))
    assert sorted(done for done, _, _ in told) == [1, 2, 3]
    assert {text for _, _, text in told} == {"base / one", "base / two", "one / two"}

from __future__ import annotations

import math

import pytest

from linkwright.analysis.findings import Severity
from linkwright.analysis.fits import check_fits
from linkwright.designs.chains.pivot import Lay
from linkwright.designs.chains.spherical_joint import SOCKET_16, SOCKET_20, ball_bar, socket_parts
from linkwright.designs.language.bodies import Part, Placement
from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.designs.language.hardware import purchased_part, screw_feature
from linkwright.designs.language.joints import JointKind
from linkwright.designs.language.supplies import screw
from linkwright.generator.store import Store


def disc(
    name: str, radius: float, low: float, high: float, *, bore: float = 0.0, x: float = 0.0, runs: bool = False
) -> Part:
    profile = (Vertex(r=bore, z=low), Vertex(r=radius, z=low), Vertex(r=radius, z=high), Vertex(r=bore, z=high))
    return Part(
        name=name,
        feature=Turned(profile=profile),
        at=Placement(origin=(x, 0.0, 0.0)),
        material="steel_c45",
        runs_in_joint=runs,
    )


def hinge(assemble, pin_radius: float = 3.0, bore: float = 3.01, parent: tuple[Part, ...] = (), runs: bool = True):
    pin = disc("pin", pin_radius, -10.0, 10.0, runs=True)
    eye = disc("eye", 8.0, -4.0, 4.0, bore=bore, runs=runs)
    return assemble(JointKind.REVOLUTE, (pin, *parent), (eye,), -1.0, 1.0)


def test_the_running_clearance_is_the_exact_gap_of_the_mating_faces(assemble):
    result = check_fits(hinge(assemble))
    assert result.facts["running_clearances_mm"]["hinge_0"] == pytest.approx(0.01, abs=1e-6)
    assert result.findings == ()


def test_a_pin_as_wide_as_its_bore_is_no_running_fit(assemble):
    for bore in (3.0, 2.9):
        findings = check_fits(hinge(assemble, bore=bore)).findings
        assert [f.rule for f in findings] == ["fit"] and findings[0].severity is Severity.ERROR
        assert findings[0].measured == pytest.approx(0.0, abs=1e-6) and findings[0].unit == "mm"


def test_a_joint_that_no_face_runs_in_is_an_error(assemble):
    result = check_fits(hinge(assemble, runs=False))
    assert [f.rule for f in result.findings] == ["fit"]
    assert "nothing holds it" in result.findings[0].message and result.facts["running_clearances_mm"]["hinge_0"] is None


def test_overlapping_parts_of_one_body_are_found_with_their_volume(assemble):
    """Two equal discs of radius 5 whose axes are 6 apart share a lens of closed form."""
    parts = (disc("left", 5.0, 20.0, 22.0, x=0.0), disc("right", 5.0, 20.0, 22.0, x=6.0))
    findings = check_fits(hinge(assemble, parent=parts)).findings
    half = math.acos(3.0 / 5.0)
    lens = 2.0 * 25.0 * half - 6.0 * 4.0
    assert [f.rule for f in findings] == ["part-overlap"]
    assert findings[0].subject == ("base", "left", "right")
    assert findings[0].measured == pytest.approx(2.0 * lens, rel=1e-6) and findings[0].unit == "mm3"
    assert findings[0].location == pytest.approx((3.0, 0.0, 21.0), abs=0.05)


def test_a_part_inside_another_is_an_overlap(assemble):
    parts = (disc("shell", 9.0, 20.0, 30.0), disc("core", 2.0, 23.0, 26.0))
    findings = check_fits(hinge(assemble, parent=parts)).findings
    assert [f.subject for f in findings] == [("base", "shell", "core")]
    assert findings[0].measured == pytest.approx(math.pi * 4.0 * 3.0, rel=1e-6)


def test_parts_that_touch_face_to_face_do_not_overlap(assemble):
    parts = (disc("ring", 9.0, 20.0, 24.0, bore=4.0), disc("plug", 4.0, 20.0, 24.0), disc("lid", 9.0, 24.0, 25.0))
    assert check_fits(hinge(assemble, parent=parts)).findings == ()


def screwed(depth: float) -> tuple[Part, ...]:
    row = screw("ISO4762-M4")
    block = Milled(
        slabs=(Slab(circles=((0.0, 0.0, 10.0),), low=20.0, high=40.0),),
        holes=(Hole(top=40.0, diameter=4.0, depth=depth, thread="M4"),),
    )
    place = Placement(origin=(0.0, 0.0, 40.0), z=(0.0, 0.0, -1.0))
    return (
        Part(name="block", feature=block, material="aluminium_6082"),
        purchased_part("screw", screw_feature(row.name, 12.0), row, place, length=12.0),
    )


def test_a_screw_in_its_threaded_hole_touches_and_one_longer_than_its_hole_overlaps(assemble):
    assert check_fits(hinge(assemble, parent=screwed(12.5))).findings == ()
    findings = check_fits(hinge(assemble, parent=screwed(10.0))).findings
    assert [f.subject for f in findings] == [("base", "block", "screw")]
    # Two millimetres of shank, less the chamfer of its tip.
    assert 0.8 * math.pi * 4.0 * 2.0 < findings[0].measured < math.pi * 4.0 * 2.0


@pytest.mark.parametrize("d", [SOCKET_16, SOCKET_20], ids=["ball of 16", "ball of 20"])
def test_the_parts_of_a_socket_mate_face_to_face_and_the_ball_has_its_film_of_grease(assemble, d):
    bar = Part(name="ball_bar", feature=ball_bar(d), material="steel_100cr6", runs_in_joint=True)
    parts = socket_parts(d, "socket", Lay(), housing="aluminium_6082", seats="bronze_cusn8")
    result = check_fits(assemble(JointKind.SPHERICAL, parts, (bar,), 0.0, 0.5))
    assert result.findings == ()
    assert result.facts["running_clearances_mm"]["hinge_0"] == pytest.approx(d.seat_clearance, abs=1e-6)


def test_nothing_to_look_at_is_a_vacuous_check(assemble):
    one, other = disc("a", 3.0, 0.0, 1.0), disc("b", 3.0, 5.0, 6.0)
    assembly = assemble(JointKind.REVOLUTE, (one,), (other,), 0.0, 1.0, n_joints=0)
    with pytest.raises(VacuousCheckError):
        check_fits(assembly)


def test_a_second_run_reads_what_the_first_one_measured(assemble, tmp_path, monkeypatch):
    store, parts = Store(tmp_path), (disc("left", 5.0, 20.0, 22.0), disc("right", 5.0, 20.0, 22.0, x=6.0))
    first = check_fits(hinge(assemble, parent=parts), store=store)

    def never(*args, **kwargs):
        raise AssertionError("measured again")

    monkeypatch.setattr("linkwright.analysis.fits.compute_common_volume", never)
    monkeypatch.setattr("linkwright.analysis.fits.compute_least_gap", never)
    assert check_fits(hinge(assemble, parent=parts), store=store) == first
    with pytest.raises(AssertionError, match="measured again"):
        check_fits(hinge(assemble, parent=parts))

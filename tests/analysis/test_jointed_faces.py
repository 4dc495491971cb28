"""Faces that keep their distance under a joint's turn: named exactly, and never at the price of a missed contact."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from linkwright.analysis.contact.bodies import build_contact_body, scan_pair
from linkwright.analysis.jointed_faces import FaceTable, full_faces
from linkwright.designs.language.bodies import Body, Part, Placement
from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import turn_about
from linkwright.generator.assembly import AssembledBody, AssembledPart
from linkwright.generator.solids import build_solid
from linkwright.generator.surfaces import SurfaceKind

HINGE = Joint(
    name="hinge",
    kind=JointKind.REVOLUTE,
    parent="a",
    child="b",
    p_parent=(0, 0, 0),
    axis_parent=(0, 0, 1),
    p_child=(0, 0, 0),
    axis_child=(0, 0, 1),
    lower=-3.0,
    upper=3.0,
)


def _ring(inner, outer, low, high, holes=()):
    corners = ((inner, low), (outer, low), (outer, high), (inner, high))
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners), holes=holes)


def _bar(length, low, high):
    return Milled(slabs=(Slab(circles=((0, 0, 5), (length, 0, 5)), low=low, high=high),))


def _body(name, *features):
    parts = []
    for k, feature in enumerate(features):
        part = Part(name=f"part_{k}", feature=feature, material="steel_c45", at=Placement())
        solid = build_solid(feature, 0.02, where=name)
        parts.append(AssembledPart(part=part, solid=solid, T_body_part=np.eye(4)))
    body = Body(name=name, kind=name, group="", parts=tuple(p.part for p in parts))
    return AssembledBody(body=body, parts=tuple(parts), mass=1.0, centre=np.zeros(3), inertia=np.eye(3))


class _Joints:
    """As much of an assembly as a table of faces asks for."""

    def __init__(self, *joints):
        self.design = self
        self.mechanism = self
        self.joints = joints


def _turns(n):
    return turn_about(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.linspace(-3.0, 3.0, n))


def _scan(a, b, Ts, joint=HINGE, need=0.5):
    table = FaceTable(_Joints(joint))
    one, two = (build_contact_body(body, table.classes(body)) for body in (a, b))
    return (
        scan_pair(one, two, Ts, need=need, faces=table.between(a, b, Ts)).scan,
        scan_pair(one, two, Ts, need=need).scan,
    )


def test_a_ring_is_full_about_its_axis_and_about_no_other():
    ring = _body("a", _ring(4.0, 8.0, 0.0, 5.0))
    assert full_faces(ring, HINGE, as_parent=True).tolist() == [1, 1, 1, 1]
    aside = dataclasses.replace(HINGE, p_parent=(0.5, 0, 0))
    assert full_faces(ring, aside, as_parent=True).sum() == 0
    tilted = dataclasses.replace(HINGE, axis_parent=(0.0, 1.0, 0.0))
    assert full_faces(ring, tilted, as_parent=True).sum() == 0


def test_a_hole_takes_fullness_from_the_faces_that_it_breaks_only():
    ring = _body("a", _ring(4.0, 12.0, 0.0, 5.0, holes=(Hole(x=8.0, top=5.0, diameter=2.0, depth=2.0),)))
    surfaces = ring.parts[0].solid.surfaces
    full = full_faces(ring, HINGE, as_parent=True).tolist()
    kept = [
        (s.kind, s.point[2] if s.kind is SurfaceKind.PLANE else s.radius)
        for s, f in zip(surfaces, full, strict=True)
        if f
    ]
    assert sorted(kept) == [(SurfaceKind.CYLINDER, 4.0), (SurfaceKind.CYLINDER, 12.0), (SurfaceKind.PLANE, 0.0)]


def test_a_bars_side_is_not_full_though_it_lies_across_the_axis():
    assert full_faces(_body("a", _bar(40.0, 0.0, 4.0)), HINGE, as_parent=True).sum() == 0


def test_bars_that_pass_each_other_closely_at_some_angles_only_are_found_at_each_of_these():
    a = _body("a", _bar(40.0, 0.0, 4.0))
    b = _body("b", Milled(slabs=(Slab(circles=((30, 0, 5), (60, 0, 5)), low=4.2, high=8.0),)))
    with_joint, without = _scan(a, b, _turns(25))
    near = without.values < 0.5
    assert 0 < near.sum() < 12
    np.testing.assert_array_equal(with_joint.values < 0.5, near)
    np.testing.assert_allclose(with_joint.values[near], without.values[near], atol=1e-9)


@pytest.mark.parametrize("gap", [0.3, 0.9])
def test_a_ring_in_a_housing_has_one_distance_at_all_poses(gap):
    housing = _body("a", _ring(10.0 + gap, 16.0, -5.0, 5.0), _bar(40.0, 5.5, 9.0))
    b = _body("b", _ring(6.0, 10.0, -4.0, 4.0), _ring(2.0, 3.0, -20.0, 5.4))
    with_joint, without = _scan(housing, b, _turns(15))
    assert with_joint.value == pytest.approx(without.value, abs=1e-3)
    assert with_joint.value == pytest.approx(0.1, abs=1e-9)
    far = _body("b", _ring(6.0, 10.0, -4.0, 4.0))
    with_joint, without = _scan(housing, far, _turns(15))
    # The facets of the two meshes shift against each other within their deviation of 0.02 each.
    assert with_joint.value == pytest.approx(gap, abs=0.04)
    np.testing.assert_array_equal(with_joint.values < 0.5, without.values < 0.5)


def test_a_joint_whose_halves_do_not_meet_makes_nothing_steady():
    a, b = _body("a", _ring(10.2, 16.0, -5.0, 5.0)), _body("b", _ring(6.0, 10.0, -4.0, 4.0))
    Ts = _turns(5)
    Ts[3, 0, 3] = 0.19
    with_joint, without = _scan(a, b, Ts)
    assert with_joint.value == pytest.approx(without.value, abs=1e-9)
    assert with_joint.pose == 3
    table = FaceTable(_Joints(HINGE))
    apart = table.between(a, b, Ts)
    np.testing.assert_array_equal(apart.steady_a, apart.exempt_a)
    assert (table.between(a, b, _turns(5)).steady_a != apart.exempt_a).any()
    assert table.between(a, _body("c", _ring(1.0, 2.0, 0.0, 1.0)), Ts) is None
